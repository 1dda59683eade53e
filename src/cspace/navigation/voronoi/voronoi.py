"""The Voronoi roadmap: ways that keep as far from walls as walls let them.

The Voronoi diagram of free space is where two walls or more are equally near: straight lines, and parabolas
between a wall and a point that free space bends around. Away from its nearest wall, a point reaches the
diagram without losing clearance, so that the way on the diagram whose least clearance is largest is as wide
as any way at all (Ó'Dúnlaing & Yap 1985, "A 'retraction' method for planning the motion of a disc"). The
diagram is traced arc by arc, exact up to rounding; that it has as many cycles as free space has holes is
asked before it is used.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Final, NamedTuple

import numpy as np
import numpy.typing as npt

from cspace import _core
from cspace.arrays import Array
from cspace.maps import PolygonWorld
from cspace.maps.outlines import longer_side
from cspace.navigation.checks import need_polygons
from cspace.navigation.planner import PlanePlanner
from cspace.navigation.route import Route
from cspace.navigation.text import explain_division
from cspace.search import option
from cspace.tables import show_fields
from cspace.tolerances import DIAGRAM_CHORD

PREFER: Final = ("clearance", "length")


class VoronoiEvidence(NamedTuple):
    """How far a way keeps from walls [m]."""

    least_clearance: float
    """On the whole path. With prefer="clearance" no path from start to goal has more."""
    on_diagram: float
    """Between the places where the way enters and leaves the diagram."""
    at_start: float
    at_goal: float


@show_fields
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


@dataclass(frozen=True, eq=False)
class Voronoi(PlanePlanner):
    """The way over the Voronoi diagram of a PolygonWorld; route.evidence is a VoronoiEvidence.

    The trace contains the search: "retract" leads from start and goal up to the diagram, its value [m] the
    clearance there; "widen" reaches a vertex by the widest path, its value [m] that path's least clearance;
    "expand" by the shortest, its value [m] that path's length.
    """

    name = "voronoi"
    summary = "widest path, on the generalized Voronoi diagram"
    events = ("retract", "widen", "expand")

    prefer: str = option(
        "clearance",
        '"clearance" for the shortest of all ways on the diagram whose least clearance, that of start and '
        "goal counted, is as large as on any way: where an end is the narrowest place, for the shortest that "
        'is nowhere narrower. "length" for the shortest whatever its clearance.',
        choices=PREFER,
        subject="choice of prefer=",
    )
    tolerance: float | None = option(
        None,
        "how far the polyline may lie from parabolas, by default a ten thousandth of the world's longer "
        "side, and never more than a hundredth of the clearance.",
        unit="m",
        above=0,
    )

    def _fill_in(self, world: Any) -> Voronoi:
        if self.tolerance is not None:
            return self
        return self._in_force(tolerance=DIAGRAM_CHORD * longer_side(world.bounds))

    def _search(self, traced: bool, world: Any, start: Any, goal: Any) -> Any:
        settings = self.prefer == "clearance", self.tolerance, VoronoiEvidence
        return _core._voronoi(traced, world, world._core, self, start, goal, *settings)

    def explain_route(self, route: Route) -> str:
        if route:
            found: VoronoiEvidence = route.evidence
            wide = "; no path keeps farther" if self.prefer == "clearance" else ""
            way = f"{found.least_clearance:.6g} m from walls, {found.on_diagram:.6g} m on the diagram"
            return f"it keeps {way}{wide}"
        if route.status == "undetermined":
            return "rounding has lost part of the diagram: the distance between walls is below rounding"
        return explain_division(route.world)


def voronoi_diagram(world: PolygonWorld, tolerance: float | None = None) -> VoronoiDiagram:
    """The Voronoi diagram of the free space of a PolygonWorld, kept with the world.

    tolerance [m]: how far polylines may lie from parabolas, as for the planner "voronoi".
    """
    need_polygons(world)
    chord: Any = Voronoi(tolerance=tolerance)._fill_in(world).tolerance
    return VoronoiDiagram(*_core._voronoi_diagram(world._core, chord))
