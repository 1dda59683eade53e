"""What the planners of the grid family share: moves, metrics, costs, errors, traces.

They are one best-first search in the compiled core; a planner is an order, a rule for moves and one for
parents.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any, ClassVar, Final, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from cspace import _core
from cspace.arrays import Array, as_floats
from cspace.errors import InputError
from cspace.navigation.planner import PlanePlanner
from cspace.navigation.route import Route
from cspace.search import option
from cspace.tables import count_things

CORNERS: Final = {"never": 0, "one": 1, "always": 2}
"""When a diagonal step is allowed: both cells beside it are free, one is, always."""

METRICS: Final = {"octile": 0, "manhattan": 1, "euclidean": 2}
"""What a planner counts on: eight moves, four, or eight with the straight line to the goal as the remaining
distance."""

FOUR_MOVES: Final = 3


def describe_costs(parts: int, cost: float, least: float) -> dict[str, Any]:
    """How many parts divide start from goal, or what the way costs and any way at least."""
    return {"parts": parts} if parts else {"cost": cost, "at_least": least}


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
    describe: Any = describe_costs
    """What makes the evidence."""


BEST_FIRST: Final = 0
FOCAL: Final = 1
JUMP_POINTS: Final = 2
THETA_STAR: Final = 3
LAZY_THETA_STAR: Final = 4
WAVES: Final = 5


def corners_option(
    meaning: str = 'whether a diagonal step may pass blocked cells: "never", with "one" beside it, "always".',
) -> Any:
    """The option for the corners of blocked cells."""
    return option("never", meaning, choices=CORNERS, subject="corner rule")


class SearchPlanner(PlanePlanner):
    """A planner that is a setting of the compiled search. The trace contains the event "settle": the segment
    from a cell's parent to the cell; its value is the path length [m], or cost [m · cost], to it."""

    world: ClassVar[str] = "grid"
    events: ClassVar[tuple[str, ...]] = ("settle",)

    @cached_property
    def _settings(self) -> Settings:
        return self._make_settings()

    def _make_settings(self) -> Settings:
        """The settings without the costs of cells."""
        raise NotImplementedError

    def _settings_in(self, world: Any) -> Settings:
        """The settings for a world."""
        return self._settings

    def _search(self, traced: bool, world: Any, start: Any, goal: Any) -> Any:
        return _core._grid_route(traced, world, world, self, start, goal, *self._settings_in(world))

    def explain_route(self, route: Route) -> str:
        cells = route.stats.nodes
        if route:
            return f"found a path of {route.length:.6g} m after expanding {count_things(cells, 'cell')}"
        if route.evidence is not None:
            parts = f"the {route.evidence['parts']} connected parts of the free cells"
            return f"no path to the goal: it lies in another of {parts}"
        return f"no path to the goal: no open node is left after {count_things(cells, 'expansion')}"


@dataclass(frozen=True, eq=False)
class GridPlanner(SearchPlanner):
    """A search by steps from cell to cell."""

    metric: str = option(
        "octile",
        '"octile" (eight moves), "manhattan" (four), or "euclidean" (eight, with the straight line as the '
        "remaining distance).",
        choices=METRICS,
    )
    corners: str = corners_option()

    kind: ClassVar[int] = BEST_FIRST
    """The number of the search in the core."""

    def _make_settings(self) -> Settings:
        rule = FOUR_MOVES if self.metric == "manhattan" else CORNERS[self.corners]
        return Settings(self.kind, rule, METRICS[self.metric], **self._weigh_nodes())

    def _weigh_nodes(self) -> dict[str, Any]:
        """The factors of the order of expansion that differ from those of A*."""
        return {}


@dataclass(frozen=True, eq=False)
class CostPlanner(GridPlanner):
    """A search over cells that may have costs; route.evidence["cost"] is then what the way costs."""

    costs: ArrayLike | None = option(
        None,
        "of the cells (rows, columns), each more than 0; with None a way costs its length, else a step costs "
        "its length times the mean of its two cells.",
    )

    def _settings_in(self, world: Any) -> Settings:
        if self.costs is None:
            return self._settings
        array = np.ascontiguousarray(as_floats(self.costs, "costs"))
        if array.shape != world.shape:
            raise InputError(f"costs has shape {array.shape}; the grid has {world.shape} cells")
        least = float(array.min())
        if least <= 0:
            row, column = map(int, np.argwhere(array == least)[0])
            rule = "costs must be positive; mark blocked cells in the grid"
            raise InputError(f"costs[{row}, {column}] is {least:g}; {rule}")
        return self._settings._replace(costs=array, least_cost=least)
