"""Where pictures are drawn: figures and axes, made when none is given."""

from __future__ import annotations

from typing import Any

from cspace.errors import InputError, MissingExtraError

__all__ = ["flat_axes", "space_axes"]


def need_matplotlib() -> None:
    """Raise MissingExtraError unless matplotlib can be imported."""
    try:
        import matplotlib.pyplot  # noqa: F401
    except ImportError:
        raise MissingExtraError("plot", "drawing") from None


def space_axes(ax: Any | None, *, aside: float = 0.0) -> Any:
    """The given 3-D axes, or new ones; `aside`: the share of the figure left free at the left."""
    need_matplotlib()
    import matplotlib.pyplot as plt

    if ax is None:
        figure = plt.figure(figsize=(8.0, 5.8), dpi=120)
        return figure.add_axes((aside, 0.0, 1.0 - aside, 0.94), projection="3d")
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
        raise InputError("this picture lies in a plane; give 2-D axes, as plt.subplots() makes them")
    return ax
