"""What each planner works with, beneath its path: cells, graphs, diagrams, waves, the points it touched."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any, Final

import numpy as np

from cspace.arrays import Array
from cspace.plot import colors
from cspace.plot.axes import draw_image, draw_lines, draw_polygons
from cspace.plot.fields import draw_bands

MOST_EVENTS: Final = 20_000
"""Events that a picture shows: of more every second, third … is drawn; a reader could not tell them apart."""
CROWD: Final = 1000
"""Lines from which on each is drawn thinner and fainter."""
FAINT: Final = (0.78, 0.81, 0.86)
"""Lines of what the planner prepared."""


def draw_idea(axes: Any, route: Any) -> list[Any]:
    """Draw what a route's planner prepared and what it looked at; returns the artists."""
    drawn = PREPARED.get(route.planner), SEARCHED.get(route.planner, draw_events)
    return [artist for draw in drawn if draw for artist in draw(axes, route)]


def shown_events(route: Any) -> Any:
    """The trace of a route, as a picture shows it: jumps from cell to cell along the moves that they stand
    for, of eight directions diagonal first, else straight first, whichever way is free."""
    trace = route.trace
    if route.planner != "jump_point_search":
        return trace
    turns = np.array([turn_of(route, *ends) for ends in zip(trace.start, trace.end, strict=True)])
    start = np.stack([trace.start, turns.reshape(-1, 2)], axis=1).reshape(-1, 2)
    end = np.stack([turns.reshape(-1, 2), trace.end], axis=1).reshape(-1, 2)
    return replace(trace, kind=trace.kind.repeat(2), start=start, end=end, value=trace.value.repeat(2))


def turn_of(route: Any, start: Array, end: Array) -> Array:
    """Where the moves of a jump turn: (2,) [m]."""
    step = end - start
    if route.options["metric"] == "manhattan":
        turns = [np.array((end[0], start[1])), np.array((start[0], end[1]))]
    else:
        slant = np.sign(step) * np.abs(step).min()
        turns = [start + slant, end - slant]
    side = 0.1 * route.world.resolution  # of a way between centres, past free corners even
    for turn in turns:
        if route.world.path_clearance([start, turn, end]) > side:
            return turn
    return turns[0]


def replaced_at(events: Any) -> Array:
    """The number of the event that gives the end of each event another parent: (k,); k where none does.

    A tree that is rewired has one edge to each node. Events of searches that rewire nothing stay.
    """
    count = len(events)
    until = np.full(count, count)
    if len(events.only("rewire")):
        node = np.unique(events.end, axis=0, return_inverse=True)[1].ravel()
        order = np.argsort(node, kind="stable")
        again = node[order[1:]] == node[order[:-1]]
        until[order[:-1][again]] = order[1:][again]
    return until


def draw_events(axes: Any, route: Any) -> list[Any]:
    """The events of the trace in the order of time, blue to yellow: lines, or dots where they have no
    length. Of a tree that is rewired, the edges that it has at the end."""
    events = shown_events(route)
    kept = replaced_at(events) == len(events)
    names = ("kind", "start", "end", "value")
    return draw_trace(axes, replace(events, **{name: getattr(events, name)[kept] for name in names}))


def draw_expanded(axes: Any, route: Any) -> list[Any]:
    """The events "expand" alone, where others are drawn as what the planner prepared."""
    return draw_trace(axes, route.trace.only("expand"))


def draw_trace(axes: Any, events: Any) -> list[Any]:
    if not len(events):
        return []
    kept = slice(None, None, 1 + len(events) // MOST_EVENTS)
    start, end = events.start[kept], events.end[kept]
    when = np.linspace(0, 1, len(start))
    is_line = np.any(start != end, axis=1)
    artists: list[Any] = []
    if is_line.any():
        pieces = np.stack([start, end], axis=1)[is_line]
        style = dict(linewidths=0.8, alpha=0.8) if len(pieces) < CROWD else dict(linewidths=0.4, alpha=0.35)
        artists += draw_lines(axes, pieces, array=when[is_line], cmap="viridis", zorder=3, **style)
    if not is_line.all():
        dots = end[~is_line]
        artists.append(axes.scatter(*dots.T, c=when[~is_line], cmap="viridis", s=4, linewidths=0, zorder=3))
    return artists


def draw_cells(axes: Any, route: Any) -> list[Any]:
    """The cells of a grid that were expanded, by when."""
    grid, events = route.world, route.trace
    if not len(events):
        return []
    when = np.full(grid.shape, np.nan)
    column, row = np.floor((events.end - grid.origin) / grid.resolution).astype(int).T
    inside = (row >= 0) & (row < grid.rows) & (column >= 0) & (column < grid.columns)
    when[row[inside], column[inside]] = np.linspace(0, 1, len(events))[inside]
    return draw_image(axes, grid, when, cmap="viridis", alpha=0.75)


def draw_walk(axes: Any, route: Any) -> list[Any]:
    """The line to the goal, and where a robot without a map met walls and left them."""
    m_line = np.stack([route.start, route.goal])
    artists: list[Any] = axes.plot(*m_line.T, "--", color=FAINT, linewidth=1.2, zorder=2)
    for word, marker, tint in (("hit", "x", colors.INK), ("leave", "o", colors.JOINT)):
        places = route.trace.only(word).end
        if len(places):
            artists += axes.plot(*places.T, marker, color=tint, ms=6, mfc="none", mew=1.6, zorder=8)
    return artists


def draw_traced_diagram(axes: Any, route: Any) -> list[Any]:
    """What a robot has traced of the diagram and along walls, and the points where walls meet."""
    trace = route.trace
    artists: list[Any] = []
    for word, tint in (("trace", colors.JOINT), ("roll", FAINT)):
        part = trace.only(word)
        if len(part):
            artists += draw_lines(
                axes, np.stack([part.start, part.end], axis=1), colors=[tint], linewidths=2.4, zorder=2
            )
    meets = route.evidence.meets
    if len(meets):
        artists += axes.plot(*meets.T, "o", color=colors.INK, ms=4, mfc="none", mew=1.2, zorder=8)
    return artists


def draw_visibility_graph(axes: Any, route: Any) -> list[Any]:
    from cspace.navigation.visibility.visibility_graph import visibility_graph

    nodes, edges = visibility_graph(route.world)
    return draw_lines(axes, nodes[edges], colors=[FAINT], linewidths=0.5, zorder=2)


def draw_exact_cells(axes: Any, route: Any) -> list[Any]:
    from cspace.navigation.cells.exact_cells import exact_cells

    corners, _ = exact_cells(route.world)
    wide = corners[:, 1, 0] > corners[:, 0, 0]
    style = dict(facecolors="none", edgecolors=[FAINT], linewidths=0.7, zorder=2)
    return draw_polygons(axes, corners[wide], **style)


def draw_squares(axes: Any, route: Any) -> list[Any]:
    """The free squares that were made, beneath them those that were split."""
    artists: list[Any] = []
    for word, face in (("split", "none"), ("free", (*FAINT, 0.35))):
        made = route.trace.only(word)
        if len(made):
            (x, y), (u, v) = made.start.T, made.end.T
            corners = np.stack([x, y, u, y, u, v, x, v], axis=1).reshape(-1, 4, 2)
            style = dict(facecolors=[face], edgecolors=[FAINT], linewidths=0.5, zorder=2)
            artists += draw_polygons(axes, corners, **style)
    return artists


def draw_convex_polygons(axes: Any, route: Any) -> list[Any]:
    if route.world.kind == "grid":  # runs of cells, which are to be seen already
        return []
    shapes = route.world._core.convex_polygons()
    return draw_polygons(axes, shapes, facecolors="none", edgecolors=[FAINT], linewidths=0.6)


def draw_brushfire(axes: Any, route: Any) -> list[Any]:
    """How far from the walls each cell is, and the cells where fires meet."""
    from cspace.navigation.fields.brushfire import brushfire_diagram

    grid = route.world
    diagram = brushfire_diagram(grid)
    far = np.where(diagram.clearance > 0, diagram.clearance, np.nan)
    shade = draw_image(axes, grid, far, cmap="Blues", alpha=0.9)
    row, column = np.nonzero(diagram.cells)
    centers = grid.center_of(np.stack([row, column], axis=1))
    return [*shade, axes.scatter(*centers.T, s=2, color=colors.INK, linewidths=0, zorder=3)]


def draw_voronoi(axes: Any, route: Any) -> list[Any]:
    """The arcs of the diagram."""
    from cspace.navigation.voronoi.voronoi import voronoi_diagram

    arcs = [points for points, _ in voronoi_diagram(route.world).arcs]
    return draw_lines(axes, arcs, colors=[colors.JOINT], linewidths=0.8, zorder=2)


def draw_navigation_function(axes: Any, route: Any) -> list[Any]:
    """The navigation function as bands, and its saddles (×)."""
    function = route.evidence.function
    artists = draw_bands(axes, route)
    if function is not None:
        artists += axes.plot(*function.saddles.T, "x", color=colors.INK, ms=5, mew=1.2, zorder=5)
    return artists


PREPARED: Final[dict[str, Callable[[Any, Any], list[Any]]]] = {
    "visibility_graph": draw_visibility_graph,
    "exact_cells": draw_exact_cells,
    "approximate_cells": draw_squares,
    "any_angle": draw_convex_polygons,
    "brushfire": draw_brushfire,
    "voronoi": draw_voronoi,
    "harmonic": draw_bands,
    "potential_field": draw_bands,
    "rimon_koditschek": draw_navigation_function,
}
"""What a planner computes before a query."""

CELL_PLANNERS: Final = (
    *("a_star", "dijkstra", "fast_marching", "focal_search", "greedy_best_first", "potential_a_star"),
    *("theta_star", "wavefront", "weighted_a_star"),
)

SEARCHED: Final[dict[str, Callable[[Any, Any], list[Any]] | None]] = {
    **{name: draw_cells for name in CELL_PLANNERS},
    **{name: draw_walk for name in ("bug_1", "bug_2", "tangent_bug")},
    "voronoi_bug": draw_traced_diagram,
    "approximate_cells": draw_expanded,
    **dict.fromkeys(("brushfire", "harmonic", "rimon_koditschek", "voronoi")),
}
"""How a planner's search is drawn, where not as its events; None where it is not."""
