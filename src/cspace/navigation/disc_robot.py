"""Discs among polygons: their ends, and verdicts that hold for the disc and not only for the polygon around
it.

A world grown by a disc has polygons in place of arcs around corners. Its gaps are open exactly if the disc
fits, so what it connects and divides is right but for places that the corners of those polygons cover: ends
that lie there, and nooks. The clearance of the world itself decides about these. A descent may rest before a
side of such a polygon and not before the arc: polygons of many sides decide about that.
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
"""Sides around a disc where 32 have closed a way or hold a descent: they give away 5e-6 of the radius."""


class DiscFits(NamedTuple):
    """What stands against a verdict in a world of grown polygons."""

    clearance: float
    """How far some way from start to goal keeps from walls [m]."""
    radius: float
    """Of the disc [m]."""

    @property
    def reason(self) -> str:
        """The verdict in a sentence."""
        return (
            f"polygons around corners close the way of a disc of radius {self.radius:g} m, which fits: "
            f"some way keeps {self.clearance:.9g} m from walls; planner 'voronoi' without a radius finds it"
        )


def fitted(world: PolygonWorld, grown: PolygonWorld, radius: float, start: Any, goal: Any) -> PolygonWorld:
    """The grown world, or one in which a disc fits at its ends where it does in truth; InputError where it
    does not."""
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
    if route.status == "local_minimum":  # which a side of a polygon may be where an arc is none
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
