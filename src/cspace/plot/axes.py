"""Where pictures are drawn: figures and axes, made when none is given."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, Final

from cspace.arrays import Array
from cspace.errors import InputError, MissingExtraError
from cspace.plot.colors import INK

SQUARE: Final = 6.4
"""Width of a picture in space [inch], without labels at its side."""
PLACE: Final = {"mfc": "white", "mec": INK, "mew": 1.4, "zorder": 7}
"""The style of a marked place: a start, a goal, a minimum."""


def need_matplotlib() -> None:
    """Raise MissingExtraError unless matplotlib can be imported."""
    try:
        import matplotlib.pyplot  # noqa: F401
    except ImportError:
        raise MissingExtraError("plot", "drawing") from None


def space_axes(ax: Any | None, *, aside: float = 0.0) -> Any:
    """The given 3-D axes, or new ones in a figure that leaves `aside` inches free at the left."""
    need_matplotlib()
    import matplotlib.pyplot as plt

    if ax is None:
        width = SQUARE + aside
        figure = plt.figure(figsize=(width, SQUARE - 0.6), dpi=120)
        return figure.add_axes((aside / width, 0.0, SQUARE / width, 0.94), projection="3d")
    if not hasattr(ax, "get_proj"):
        raise InputError("this picture needs 3-D axes; make them with plt.subplot(projection='3d')")
    return ax


def flat_axes(ax: Any | None) -> Any:
    """The given 2-D axes, or new ones in a new figure."""
    need_matplotlib()
    import matplotlib.pyplot as plt

    if ax is None:
        figure = plt.figure(figsize=(7.2, 6.0), dpi=120, layout="constrained")
        return figure.add_subplot()
    if hasattr(ax, "get_proj"):
        raise InputError("this picture needs 2-D axes; make them with plt.subplots()")
    return ax


def write_title(axes: Any, title: str, size: float = 9.0) -> list[Any]:
    """The title above 2-D axes, if there is one."""
    return [axes.set_title(title, fontsize=size, color=INK, loc="left")] if title else []


def draw_lines(axes: Any, pieces: Iterable[Array], **style: Any) -> list[Any]:
    """Polylines (m, 2) each."""
    from matplotlib.collections import LineCollection

    return [axes.add_collection(LineCollection(list(pieces), **style))]


def draw_polygons(axes: Any, shapes: Iterable[Array], **style: Any) -> list[Any]:
    """Polygons (m, 2) each."""
    from matplotlib.collections import PolyCollection

    return [axes.add_collection(PolyCollection(list(shapes), **style))]


def draw_image(axes: Any, grid: Any, shade: Array, **style: Any) -> list[Any]:
    """The colours or numbers of the cells of a grid (rows, columns, ...)."""
    xmin, ymin, xmax, ymax = grid.bounds
    box = (xmin, xmax, ymin, ymax)
    return [axes.imshow(shade, extent=box, origin="lower", interpolation="nearest", **style)]
