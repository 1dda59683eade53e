"""What the planners of the grid family share: moves, metrics, costs, errors, traces.

They are one best-first search in the compiled core; a planner is an order, a rule for moves and one for
parents.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from cspace import _core
from cspace.arrays import Array, as_floats
from cspace.errors import InputError, InputTypeError, suggest
from cspace.maps import OccupancyGrid
from cspace.navigation.route import Route
from cspace.navigation.text import counted
from cspace.search.trace import Trace

if TYPE_CHECKING:
    import numpy.typing as npt

__all__ = ["CORNERS", "METRICS", "WORDS", "Settings", "at_least_one", "checked_ends", "metric_of"]
__all__ += ["over_costs", "positive_costs", "reason", "search", "traced"]

CORNERS: Final = {"never": 0, "one": 1, "always": 2}
"""When a diagonal step is allowed: both cells beside it are free, one is, always."""

METRICS: Final = {"octile": 0, "manhattan": 1, "euclidean": 2}
"""What a planner counts on: eight moves, four, or eight with the straight line to the goal as the remaining
distance."""

FOUR_MOVES: Final = 3
WORDS: Final = ("settle",)


class Settings(NamedTuple):
    """What the compiled search is told, in its order."""

    kind: int
    corners: int = 0
    metric: int = 0
    g_weight: float = 1.0
    h_weight: float = 1.0
    bound: float = 1.0
    costs: Array | None = None
    """(rows, columns)."""
    least_cost: float = 1.0


BEST_FIRST: Final = 0
FOCAL: Final = 1
JUMP_POINTS: Final = 2
THETA_STAR: Final = 3
LAZY_THETA_STAR: Final = 4
WAVES: Final = 5


def metric_of(metric: str, corners: str) -> tuple[int, int]:
    """The numeric values of the corner rule and the metric; UnknownNameError suggests the nearest name."""
    try:
        number, rule = METRICS[metric], CORNERS[corners]
        return (FOUR_MOVES if number == 1 else rule), number
    except (KeyError, TypeError):
        if not isinstance(metric, str) or metric not in METRICS:
            raise suggest("metric", metric, METRICS) from None
        raise suggest("corner rule", corners, CORNERS) from None


def positive_costs(world: Any, costs: ArrayLike | None) -> tuple[Array | None, float]:
    """Costs of the cells, (rows, columns), and the least; InputError on a wrong shape or one that is not
    positive."""
    if costs is None:
        return None, 1.0
    array = np.ascontiguousarray(as_floats(costs, "costs"))
    if array.shape != world.shape:
        raise InputError(f"costs has shape {array.shape}; the grid has {world.shape} cells")
    least = float(array.min())
    if least <= 0:
        row, column = map(int, np.argwhere(array == least)[0])
        rule = "a cell costs more than nothing; blocked cells belong into the grid"
        raise InputError(f"costs[{row}, {column}] is {least:g}; {rule}")
    return array, least


def over_costs(
    settings: Settings, world: Any, metric: str, corners: str, costs: ArrayLike | None
) -> Settings:
    """The settings of a planner with its options metric=, corners= and costs= (rows, columns) put in."""
    array, least = positive_costs(world, costs)
    rule, number = metric_of(metric, corners)
    return settings._replace(corners=rule, metric=number, costs=array, least_cost=least)


def at_least_one(value: float, name: str) -> float:
    """A factor of the best way; InputError where it is below 1."""
    if (factor := float(as_floats(value, name))) < 1:
        raise InputError(f"{name} is {factor:g}; it must be 1 or more")
    return factor


def search(
    world: Any, start: Any, goal: Any, name: str, options: dict[str, Any], settings: Settings
) -> Route:
    """Asks the compiled search; start, goal (2,) [m]."""
    made: Route | None = _core._grid_route(world, start, goal, name, options, *settings)
    if made is None:
        ends = checked_ends(world, start, goal)
        made = _core._grid_route(world, *ends, name, options, *settings)
        assert made is not None
    return made


def checked_ends(world: Any, start: Any, goal: Any) -> tuple[Array, Array]:
    """Start and goal as points (2,) [m] in free cells; InputError names the one that is not."""
    if not isinstance(world, OccupancyGrid):
        raise InputTypeError(f"world must be an OccupancyGrid, got an object of type {type(world).__name__}")
    return world.check_free(start, "start"), world.check_free(goal, "goal")


def reason(route: Route) -> str:
    """The verdict of a planner of this family, as one sentence."""
    cells = route.stats.nodes
    if route:
        return f"found a way of {route.length:.6g} m after settling {counted(cells, 'cell')}"
    if route.evidence is not None:
        parts = route.evidence["parts"]
        return (
            f"no way leads to the goal: it lies in another of the {parts} connected parts of the free cells"
        )
    return (
        f"no way leads to the goal: after {counted(cells, 'expansion')} nothing that can be reached is left"
    )


def traced(route: Route, settings: Settings) -> Trace:
    """The cells in the order of their expansion, each from its parent: start, end (k, 2) [m]; value [m], or
    [m · cost], is the path so far."""
    world = route.world
    found = _core._grid_order(world, route.start, route.goal, route.planner, None, *settings)
    cells: npt.NDArray[np.int32] = found[0]
    at, parent = world.center_of(cells[:, :2]), world.center_of(cells[:, 2:])
    return Trace(WORDS, np.zeros(len(cells), np.int8), parent, at, found[1])
