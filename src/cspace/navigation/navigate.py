"""From start to goal through a world, by any planner."""

from __future__ import annotations

from collections.abc import Callable, Hashable
from typing import Any, Final, TypeAlias

from numpy.typing import ArrayLike

from cspace.arrays import positive_number
from cspace.errors import InputError, InputTypeError
from cspace.maps import OccupancyGrid, PolygonWorld
from cspace.maps.points import check_inflation
from cspace.navigation.cache import keep_with
from cspace.navigation.disc_robot import plan_disc
from cspace.navigation.planner import PlanePlanner
from cspace.navigation.planners import PLANNERS, find_planner
from cspace.navigation.route import Route
from cspace.tolerances import MOST_DERIVED

NO_RADIUS: Final = 0.0
"""The robot is a point."""

World: TypeAlias = PolygonWorld | OccupancyGrid
"""Every kind of world that `navigate` takes: each has a `kind`, "polygons" or "grid", and can be inflated."""


def navigate(
    world: World,
    start: ArrayLike,
    goal: ArrayLike,
    planner: str | PlanePlanner = "any_angle",
    *,
    radius: float = NO_RADIUS,
    resolution: float | None = None,
    **options: Any,
) -> Route:
    """The way of a robot from start to goal, as a planner finds it.

    world: a PolygonWorld or an OccupancyGrid; a planner of the other kind gets it converted. resolution [m]:
    the side of the cells that polygons become for planners over cells, which `route.reason` tells; by default
    about 1/200 of the longer side of the bounds, as `PolygonWorld.to_grid` chooses it. start, goal: (2,) [m].
    planner: a name of `cs.navigation.PLANNERS`, or a PlanePlanner such as `AStar(metric="manhattan")`.
    radius [m] of the robot: 0 for a point, else obstacles are grown by it first. options: those of the
    planner. The Route is truthy if a path was found, and says why where not; where start and goal are the
    same point its path is that point, (1, 2).
    Raises UnknownNameError on an unknown planner, InputTypeError on an unknown option or no world, InputError
    on points that are not finite, outside the bounds or inside an obstacle.
    """
    chosen = PLANNERS.get(planner) if type(planner) is str and not options else None
    if chosen is None:
        chosen = find_planner(planner, options)
    given, kind = world, getattr(world, "kind", None)
    if kind != chosen.world or radius is not NO_RADIUS or resolution is not None:
        world = _prepare_world(world, kind, chosen, radius, resolution)
    try:
        if world is not given and isinstance(given, PolygonWorld) and isinstance(world, PolygonWorld):
            route = plan_disc(given, world, float(radius), chosen, (start, goal))
        else:
            route = chosen.plan(world, start, goal)
    except InputError as error:
        if not str(error).startswith(("start (", "goal (")):
            raise
        raise InputError(f"{error}{_describe_conversion(given, world, radius)}") from None
    if world is not given:
        vars(route)["given_world"] = given
    return route


def _describe_conversion(given: World, world: World, radius: float) -> str:
    """What was done to the world in which an end is not free."""
    said = f"; obstacles are grown by the robot's radius, {radius:g} m" if radius else ""
    if given.kind == "polygons" and isinstance(world, OccupancyGrid):
        said += f"; polygons became cells of {world.resolution:g} m, give a smaller resolution="
    return said


def _prepare_world(
    world: World, kind: str | None, planner: PlanePlanner, radius: float, resolution: float | None
) -> World:
    """The world grown by the robot's radius and of the kind that the planner works in."""
    if kind not in {"polygons", "grid"}:
        raise InputTypeError(
            f"world must be a PolygonWorld or an OccupancyGrid, got an object of type {type(world).__name__}"
        )
    key = planner.world, planner.takes_cells
    if radius is NO_RADIUS and resolution is None:
        ready: World | None = vars(world).get("_derived", {}).get(key)
        if ready is not None:
            return ready
    if grown := check_inflation(radius):
        world = _derive_world(world, ("grown", grown), lambda: world.inflate(grown))
    side = None
    if resolution is not None:
        side = positive_number(resolution, "resolution", "it must be a positive length [m], one number")
    if kind == "grid" and side is not None:
        raise InputTypeError("resolution= is for polygons that become a grid; this world has its own")
    if kind == planner.world:
        return world
    if isinstance(world, OccupancyGrid):
        if planner.takes_cells and planner.takes_grid(world):
            return world
        polygons = _derive_world(world, "polygons", lambda: PolygonWorld.from_grid(world))
        return _derive_world(world, key, lambda: polygons)
    return _derive_world(world, ("grid", side), lambda: world.to_grid(side))


def _derive_world(world: World, key: Hashable, make: Callable[[], World]) -> World:
    """What `make` makes of a world, kept with it for the next query."""
    return keep_with(world, "_derived", key, make, MOST_DERIVED)
