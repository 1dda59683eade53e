"""Disc robots among polygons: endpoints and verdicts that hold for the exact disc, not only for its
polygon.

A world grown by a disc has polygons in place of arcs around corners. Its gaps are open exactly if the disc
fits, so its connectivity is correct except for positions that the corners of those polygons cover: start or
goal positions there, and nooks. The clearance in the original world decides these cases. A gradient descent
may stop at a side of such a polygon but not at the arc; polygons with more sides decide this case.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final, NamedTuple

from cspace.errors import InputError
from cspace.navigation.planners import module_of
from cspace.navigation.route import Route, new_route
from cspace.navigation.voronoi import voronoi
from cspace.tolerances import ON_WALL

if TYPE_CHECKING:
    from cspace.maps import PolygonWorld

__all__ = ["DiscFits", "fitted", "plan_disc"]

FINE: Final = 1024
"""Sides of the polygons where 32 sides have closed a path or stopped a descent: they exceed the disc by
5e-6 of the radius."""


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
            f"polygons around corners close the way of a disc of radius {self.radius:g} m, which fits: "
            f"some way keeps {self.clearance:.9g} m from walls; planner 'voronoi' without a radius finds it"
        )


def fitted(world: PolygonWorld, grown: PolygonWorld, radius: float, start: Any, goal: Any) -> PolygonWorld:
    """The grown world, or a finer one if the disc fits at start and goal; InputError where it does not fit."""
    ends = [world.check_free(start, "start"), world.check_free(goal, "goal")]
    if all(grown.is_free(end) for end in ends):
        return grown
    xmin, ymin, xmax, ymax = world.bounds
    least = radius - ON_WALL * max(xmax - xmin, ymax - ymin)
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
    planner: str,
    ends: tuple[Any, Any],
    options: dict[str, Any],
) -> Route:
    """The route of a disc among polygons; `grown` is the world grown by its radius [m]."""
    plan = module_of(planner).plan
    route: Route = plan(fitted(world, grown, radius, *ends), *ends, **options)
    if route.status == "local_minimum":  # at a side of the polygon, but not at the arc
        route = plan(world.inflate(radius, sides=FINE, keep=ends), *ends, **options)
    if route.status != "unreachable":
        return route
    widest = voronoi.plan(world, *ends)
    if not widest or (clearance := widest.evidence.least_clearance) <= radius * (1 + 1e-9):
        return route
    fine: Route = plan(world.inflate(radius, sides=FINE, keep=ends), *ends, **options)
    if fine.status != "unreachable":
        return fine
    return new_route(
        route.world,
        planner,
        route.options,
        (route.start, route.goal),
        "undetermined",
        route.path,
        route.length,
        route.stats,
        DiscFits(clearance, radius),
    )
