"""The Voronoi roadmap: ways that keep as far from walls as walls let them.

The Voronoi diagram of free space is where two walls or more are equally near: straight lines, and parabolas
between a wall and a point that free space bends around. Away from its nearest wall, a point reaches the
diagram without losing clearance, so that the way on the diagram whose least clearance is largest is as wide
as any way at all (Ó'Dúnlaing & Yap 1985, "A 'retraction' method for planning the motion of a disc"). The
diagram is traced arc by arc, exact up to rounding; that it has as many cycles as free space has holes is
asked before it is used.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final, NamedTuple

import numpy as np
import numpy.typing as npt

from cspace import _core
from cspace.arrays import Array, as_floats
from cspace.errors import InputError, suggest
from cspace.navigation.text import divided
from cspace.navigation.worlds import need_polygons
from cspace.search.trace import Trace
from cspace.tolerances import DIAGRAM_CHORD

if TYPE_CHECKING:
    from cspace.maps import PolygonWorld
    from cspace.navigation.route import Route

__all__ = ["VoronoiDiagram", "VoronoiEvidence", "plan", "reason", "trace", "voronoi_diagram"]

PREFER: Final = ("clearance", "length")
WORDS: Final = ("retract", "widen", "expand")


class VoronoiEvidence(NamedTuple):
    """How far a way keeps from walls [m]."""

    least_clearance: float
    """On the whole way. With prefer="clearance" no way from start to goal has more."""
    on_diagram: float
    """Between the places where the way enters and leaves the diagram."""
    at_start: float
    at_goal: float


class VoronoiDiagram(NamedTuple):
    """The Voronoi diagram of a world's free space: n vertices and k arcs."""

    vertices: Array
    """(n, 2) [m]: corners of free space, points as far from three walls or more, and joints of arcs."""
    clearance: Array
    """(n,) [m]: how far the vertices are from walls."""
    ends: npt.NDArray[np.int32]
    """(k, 2): the vertices that each arc joins."""
    arcs: list[tuple[Array, Array]]
    """k pairs: a polyline (m, 2) [m], and its clearance (m,) [m]."""
    is_whole: bool
    """Whether each component's part has as many cycles as the component has holes. False where rounding has
    lost arcs."""


def plan(
    world: PolygonWorld,
    start: Any,
    goal: Any,
    *,
    prefer: str = "clearance",
    tolerance: float | None = None,
) -> Route:
    """The way from start to goal (2,) [m] over the Voronoi diagram of a PolygonWorld.

    prefer: "clearance" for the shortest of all ways on the diagram whose least clearance, that of start and
    goal counted, is as large as on any way: where an end is the narrowest place, for the shortest that is
    nowhere narrower. "length" for the shortest whatever its clearance. tolerance [m]: how far the polyline
    may lie from parabolas, by default a ten thousandth of the world's longer side, and never more than a
    hundredth of the clearance.

    route.evidence is a VoronoiEvidence. UnknownNameError for another preference, InputError on a tolerance
    that is not positive.
    """
    if prefer not in PREFER:
        raise suggest("choice of prefer=", prefer, PREFER)
    chord = chord_of(world, tolerance)
    asked = prefer == PREFER[0], chord
    given = ("voronoi", {"prefer": prefer, "tolerance": chord}, VoronoiEvidence, world._core)
    route: Route | None = _core._voronoi(world, *given, start, goal, *asked)
    if route is None:
        ends = world.check_free(start, "start"), world.check_free(goal, "goal")
        route = _core._voronoi(world, *given, *ends, *asked)
        assert route is not None
    return route


def reason(route: Route) -> str:
    """The verdict as one sentence."""
    if route:
        found: VoronoiEvidence = route.evidence
        wide = "; no way keeps farther" if route.options["prefer"] == PREFER[0] else ""
        way = f"{found.least_clearance:.6g} m from walls, {found.on_diagram:.6g} m on the diagram"
        return f"it keeps {way}{wide}"
    if route.status == "undetermined":
        return "rounding has lost part of the diagram: walls lie closer to each other than numbers tell"
    return divided(route.world.components)


def trace(route: Route) -> Trace:
    """The search: "retract" leads from start and goal up to the diagram, its value [m] the clearance there;
    "widen" reaches a vertex by the widest way, its value [m] that way's least clearance; "expand" by the
    shortest, its value [m] that way's length. start, end: (k, 2) [m]."""
    options = route.options
    asked = options["prefer"] == PREFER[0], options["tolerance"]
    return Trace(WORDS, *_core._voronoi_trace(route.world._core, route.start, route.goal, *asked))


def voronoi_diagram(world: PolygonWorld, tolerance: float | None = None) -> VoronoiDiagram:
    """The Voronoi diagram of the free space of a PolygonWorld, kept with the world.

    tolerance [m]: how far polylines may lie from parabolas, as in `plan`.
    """
    need_polygons(world)
    made = VoronoiDiagram(*_core._voronoi_diagram(world._core, chord_of(world, tolerance)))
    return made


def chord_of(world: PolygonWorld, tolerance: float | None) -> float:
    """The tolerance [m] as given, or that of the world; InputError where it is not positive."""
    if tolerance is None:
        left, low, right, high = world.bounds
        return float(DIAGRAM_CHORD * max(right - left, high - low))
    chord = float(as_floats(tolerance, "tolerance"))
    if not chord > 0:
        raise InputError(f"tolerance is {chord:g}; it must be positive [m]")
    return chord
