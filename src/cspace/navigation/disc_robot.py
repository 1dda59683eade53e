"""Disc robots among polygons: endpoints and verdicts that hold for the exact disc, not only for its
polygon.

A world grown by a disc has polygons in place of arcs around corners. Its gaps are open exactly if the disc
fits, so its connectivity is correct except for positions that the corners of those polygons cover: start or
goal positions there, and nooks. The clearance in the original world decides these cases. A gradient descent
may stop at a side of such a polygon but not at the arc; polygons with more sides decide this case. Around a
disc that is tiny beside the world the sides are so short that rounding hides where the Voronoi diagram goes;
the diagram of the original world differs by no more than the radius and serves in its place.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from cspace.errors import InputError
from cspace.maps import PolygonWorld
from cspace.maps.outlines import longer_side
from cspace.navigation.checks import check_ends
from cspace.navigation.planner import PlanePlanner
from cspace.navigation.route import Route, new_route
from cspace.navigation.voronoi.voronoi import Voronoi, VoronoiEvidence
from cspace.tolerances import CHORD_OF_CLEARANCE, DISC_FITS, FINE_SIDES, ON_WALL, TINY_DISC


class DiscFits(NamedTuple):
    """The clearance that contradicts a verdict in a world of grown polygons."""

    clearance: float
    """The clearance of some path from start to goal [m]."""
    radius: float
    """Radius of the disc [m]."""

    @property
    def reason(self) -> str:
        """The verdict as one sentence."""
        return (
            f"the disc of radius {self.radius:g} m fits, but the polygons around corners close its passage: "
            f"a path with clearance {self.clearance:.9g} m exists; find it with "
            "planner='voronoi' and no radius"
        )


def fit_world(world: PolygonWorld, grown: PolygonWorld, radius: float, start: Any, goal: Any) -> PolygonWorld:
    """The grown world, or a finer one if the disc fits at start and goal; InputError where it does not."""
    ends = check_ends(world, start, goal)
    if all(grown.is_free(end) for end in ends):
        return grown
    least = radius - ON_WALL * longer_side(world.bounds)
    for name, end in zip(("start", "goal"), ends, strict=True):
        if (clearance := float(world.clearance(end))) < least:
            raise InputError(
                f"{name} ({end[0]:g}, {end[1]:g}) is {clearance:.6g} m from a wall; a disc of radius "
                f"{radius:g} m does not fit there"
            )
    return world.inflate(radius, keep=ends)


def plan_disc(
    world: PolygonWorld,
    grown: PolygonWorld,
    radius: float,
    planner: PlanePlanner,
    ends: tuple[Any, Any],
) -> Route:
    """The route of a disc among polygons; `grown` is the world grown by its radius [m]."""
    grown = fit_world(world, grown, radius, *ends)
    tiny = None
    if isinstance(planner, Voronoi) and radius < TINY_DISC * longer_side(world.bounds):
        tiny = _plan_tiny_disc(world, radius, planner, ends)
    if tiny is not None:
        return tiny
    route = planner.plan(grown, *ends)
    if route.status == "local_minimum":  # at a side of the polygon, but not at the arc
        route = planner.plan(world.inflate(radius, sides=FINE_SIDES, keep=ends), *ends)
    if route.status != "unreachable":
        return route
    widest = Voronoi().plan(world, *ends)
    if not widest or (clearance := widest.evidence.least_clearance) <= radius * (1 + DISC_FITS):
        return route
    fine = planner.plan(world.inflate(radius, sides=FINE_SIDES, keep=ends), *ends)
    if fine.status != "unreachable":
        return fine
    ends, walked = (route.start, route.goal), (route.path, route.length, route.stats)
    return new_route(route.world, route._asked, ends, "undetermined", *walked, DiscFits(clearance, radius))


def _plan_tiny_disc(
    world: PolygonWorld, radius: float, planner: Voronoi, ends: tuple[Any, Any]
) -> Route | None:
    """The route on the diagram of the original world, if the disc fits through wherever it leads."""
    route = planner.plan(world, *ends)
    if not route:
        return route if route.status == "unreachable" else None
    found: VoronoiEvidence = route.evidence
    if found.on_diagram * (1 - CHORD_OF_CLEARANCE) <= radius:
        return None
    left = VoronoiEvidence(*(max(clearance - radius, 0.0) for clearance in found))
    walked = (route.path, route.length, route.stats)
    return new_route(world, route._asked, (route.start, route.goal), route.status, *walked, left)
