"""Worlds of the plane and routes through them, each planner's own idea beneath its path."""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import chain
from typing import Any, Final

import numpy as np

from cspace.errors import InputError, InputTypeError
from cspace.plot import colors
from cspace.plot.axes import (
    PLACE,
    draw_image,
    draw_lines,
    draw_polygons,
    flat_axes,
    need_matplotlib,
    write_title,
)
from cspace.plot.files import Steps
from cspace.plot.planner_overlays import draw_idea, replaced_at, shown_events

SHUT: Final = (0.72, 0.74, 0.77)
"""Where no obstacle is and the centre may not be: within the radius of one, or in a blocked cell."""
FREE: Final = (1.0, 1.0, 1.0)
PANEL: Final = 3.6
"""Side of one world in a picture of several [inch]."""
TITLE: Final = 0.12
"""What a title takes, over the side of a world."""
FRAMES: Final = 60
"""The number of frames of an animation of a search."""
STILL: Final = 12
"""Frames that show the path at its end."""
INTERVAL: Final = 80
"""How long a frame is shown [ms]."""


def world(world: Any, *, ax: Any | None = None) -> list[Any]:
    """Draw a PolygonWorld, an OccupancyGrid or an EvidenceGrid: obstacles dark, free space white. Unknown
    cells of an EvidenceGrid are grey, and the others the darker the likelier they are occupied. Returns the
    artists."""
    if not hasattr(world, "kind"):
        raise _wrong(world, "world", "a PolygonWorld, an OccupancyGrid or an EvidenceGrid")
    if world.kind == "evidence":
        return _evidence(flat_axes(ax), world)
    return _ground(flat_axes(ax), world, world)


def _evidence(axes: Any, grid: Any) -> list[Any]:
    """The probabilities of cells between the colours of free space and of obstacles."""
    axes.tick_params(labelsize=8, colors=colors.INK)
    p = grid.probability[..., None]
    shade = (1 - p) * np.array(FREE) + p * np.array(_rgb(colors.WALL))
    shade[~grid.known] = SHUT
    drawn = draw_image(axes, grid, shade, zorder=0)
    axes.set_aspect("equal")
    return drawn


def _rgb(color: Any) -> tuple[float, float, float]:
    from matplotlib.colors import to_rgb

    return to_rgb(color)


def _ground(axes: Any, world: Any, asked: Any) -> list[Any]:
    """The free space of a world on the colour of obstacles; between them what it shuts of the world that was
    asked: it may be that one, but with obstacles grown by a radius, or polygons as cells."""
    xmin, ymin, xmax, ymax = asked.bounds
    axes.set(xlim=(xmin, xmax), ylim=(ymin, ymax), aspect="equal")
    axes.tick_params(labelsize=8, colors=colors.INK)
    from matplotlib.patches import Rectangle

    box = Rectangle((xmin, ymin), xmax - xmin, ymax - ymin, color=colors.WALL, linewidth=0, zorder=0)
    below = [axes.add_patch(box)]
    if asked is not world:
        below += _free(axes, asked, SHUT)
    return [*below, *_free(axes, world, FREE)]


def _free(axes: Any, world: Any, color: tuple[float, float, float]) -> list[Any]:
    """The free space of a world in a colour."""
    if world.kind == "grid":
        shade = np.broadcast_to(np.array([*color, 1.0]), (*world.shape, 4)).copy()
        shade[world.blocked] = (*colors.WALL, 0.0)
        shown = axes.axis()
        drawn = draw_image(axes, world, shade, zorder=0)
        axes.axis(shown)
        return drawn
    style = dict(facecolors=[color], edgecolors=[color], linewidths=0.6, zorder=0)
    return draw_polygons(axes, world._core.triangles(), **style)


def route(route: Any, *, ax: Any | None = None, idea: bool = True) -> list[Any]:
    """Draw a route in its world: what the planner looked at, the path, start (circle) and goal (star).

    idea: also draw what the planner works with (cells, graph, diagram, waves, hit points) and its search.
    Returns the artists.
    """
    if not hasattr(route, "planner"):
        raise _wrong(route, "route", "a Route, as cs.navigate answers")
    axes = flat_axes(ax)
    artists = _ground(axes, route.world, route._given_world)
    if idea:
        artists += draw_idea(axes, route)
    if len(route.path):
        artists += axes.plot(
            *route.path.T, color=colors.PATH, linewidth=2.0, zorder=6, solid_capstyle="round"
        )
    artists += draw_ends(axes, route)
    said = f"{route.length:.5g} m" if route else route.status
    return artists + write_title(axes, f"{route.planner}: {said}")


def draw_ends(axes: Any, route: Any) -> list[Any]:
    """Start (circle) and goal (star)."""
    return [*axes.plot(*route.start, "o", ms=7, **PLACE), *axes.plot(*route.goal, "*", ms=12, **PLACE)]


def routes(routes: Sequence[Any], *, columns: int | None = None) -> Any:
    """Several routes side by side, one set of axes each; returns the figure."""
    need_matplotlib()
    import matplotlib.pyplot as plt

    if not isinstance(routes, Sequence):
        raise _wrong(routes, "routes", "a list of Routes")
    if not len(routes):
        raise InputError("routes is empty; give one route or more")
    wide = columns or math.ceil(math.sqrt(len(routes)))
    high = math.ceil(len(routes) / wide)
    tall = max(map(_aspect, routes)) + TITLE
    figure, grid = plt.subplots(
        high, wide, figsize=(PANEL * wide, PANEL * tall * high), dpi=120, layout="constrained", squeeze=False
    )
    for axes, each in zip(grid.flat, routes, strict=False):
        route(each, ax=axes)
        axes.set(xticks=[], yticks=[])
    for axes in grid.flat[len(routes) :]:
        axes.set_axis_off()
    return figure


def _aspect(route: Any) -> float:
    """How many times as high as wide the world of a route is, within reason."""
    xmin, ymin, xmax, ymax = route.world.bounds
    return float(np.clip((ymax - ymin) / (xmax - xmin), 0.3, 2.0))


def animation(route: Any, *, ax: Any | None = None, frames: int = FRAMES) -> Any:
    """A search as it happened, then its path: a matplotlib FuncAnimation, which `cs.plot.save` writes as a
    GIF.

    frames: into how many pictures the events of `route.trace` are divided.
    """
    if not hasattr(route, "planner"):
        raise _wrong(route, "route", "a Route, as cs.navigate answers")
    axes = flat_axes(ax)
    import matplotlib
    from matplotlib.animation import FuncAnimation

    _ground(axes, route.world, route._given_world)
    events = shown_events(route)
    until = replaced_at(events)
    only_grows = bool((until == len(events)).all())
    order = np.linspace(0, 1, max(len(events), 1))
    tints = matplotlib.colormaps["viridis"](order)  # as the picture of the whole search
    pieces = np.stack([events.start, events.end], axis=1) if len(events) else np.empty((0, 2, 2))
    (searched,) = draw_lines(axes, [], linewidths=1.2, zorder=4)
    reached = axes.scatter([], [], s=6, zorder=5)
    (path,) = axes.plot([], [], color=colors.PATH, linewidth=2.2, zorder=6)
    ends = draw_ends(axes, route)

    def told(frame: int) -> int:
        return math.ceil(len(pieces) * min(max(frame + 1, 0), frames) / frames)

    def show(frame: int, since: int = 0) -> tuple[list[Any], list[Any]]:
        seen = told(frame)
        new = np.arange(since, seen) if only_grows else np.flatnonzero(until[:seen] >= seen)
        searched.set(segments=pieces[new], color=tints[new])
        reached.set_offsets(pieces[new, 1])
        reached.set_color(tints[new])
        path.set_data(*(route.path.T if frame >= frames else np.empty((2, 0))))
        over = [path, *ends]
        return ([searched, reached], over) if only_grows else ([], [searched, reached, *over])

    film: Any = FuncAnimation(
        axes.figure,
        lambda frame: list(chain(*show(frame))),
        frames=frames + STILL,
        interval=INTERVAL,
        blit=True,
    )
    film.steps = Steps(frames + STILL, INTERVAL, lambda frame: show(frame, told(frame - 1)))
    return film


def _wrong(value: Any, subject: str, remedy: str) -> InputTypeError:
    return InputTypeError(f"{subject} is an object of type {type(value).__name__}; give {remedy}")
