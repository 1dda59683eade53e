"""D* Lite: a shortest path that is mended when cells become blocked or free (Koenig & Likhachev 2002)."""

from __future__ import annotations

import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt
from numpy.typing import ArrayLike

from cspace import _core
from cspace.arrays import Array, as_floats
from cspace.errors import CspaceError, InputError, InputTypeError
from cspace.maps import OccupancyGrid
from cspace.maps.points import as_point
from cspace.navigation.checks import check_ends, need_grid
from cspace.navigation.grid.search import METRICS, GridPlanner
from cspace.navigation.route import STATUSES, Route, Stats, new_route
from cspace.search import option
from cspace.tables import count_things, tabulate


@tabulate("grid", "route")
class DStarLite:
    """A robot on its way over a grid of which it learns more.

    grid: what is known at first; it stays as it is. start, goal: (2,) [m] in free cells. metric: "octile"
    (eight moves) or "manhattan" (four). corners: as for A*. Tell what changes by `set_blocked` and where
    the robot is by `move`; `route` is the shortest path from there, of the same length as that of a fresh
    search. Threads that share one are served one by one. After Ctrl-C the search goes on where it stopped.
    """

    def __init__(
        self,
        grid: OccupancyGrid,
        start: ArrayLike,
        goal: ArrayLike,
        *,
        metric: str = "octile",
        corners: str = "never",
    ) -> None:
        planner = DStarLiteSearch(metric, corners)
        need_grid(grid, "world")
        self._begin(grid, check_ends(grid, start, goal), planner)

    def _begin(self, grid: OccupancyGrid, ends: tuple[Array, Array], planner: DStarLiteSearch) -> None:
        self._grid, self._ends, self._planner = grid, ends, planner
        self._core = _core.GridReplanner(grid, planner._settings.corners, *ends)
        self._route: Route | None = None
        self._settled = np.empty((0, 2), np.int32)
        self._busy = threading.Lock()
        self._user = 0

    @contextmanager
    def _turn(self) -> Iterator[None]:
        """The only use of the search; CspaceError in a signal handler amid another one of its thread."""
        if self._user == threading.get_ident():
            raise CspaceError("this DStarLite is being searched; a signal handler must use another one")
        with self._busy:
            self._user = threading.get_ident()
            try:
                yield
            finally:
                self._user = 0

    @property
    def grid(self) -> OccupancyGrid:
        """The grid as it is known now."""
        with self._turn():
            cells = self._core.unpack()
        return OccupancyGrid(cells.view(np.bool_), self._grid.resolution, self._grid.origin)

    def set_blocked(self, cells: ArrayLike, blocked: bool = True) -> None:
        """Cells (row, column), (k, 2) or (2,), have become blocked, or free; InputError for one outside."""
        if not isinstance(blocked, (bool, np.bool_)):
            raise InputTypeError(f"blocked must be True or False, got {blocked!r}")
        index = np.atleast_2d(as_floats(cells, "cells", last=(2,)))
        if index.ndim != 2:
            raise InputError(f"cells has shape {index.shape}, expected (k, 2)")
        wrong = (index != np.floor(index)) | (index < 0) | (index >= self._grid.shape)
        if wrong.any():
            row, column = index[wrong.any(axis=1)][0]
            rows, columns = self._grid.shape
            message = f"cells holds ({row:g}, {column:g}); the grid has rows 0 … {rows - 1}, "
            raise InputError(message + f"columns 0 … {columns - 1}")
        with self._turn():
            self._route = None
            self._core.set(np.ascontiguousarray(index, np.int32), bool(blocked))

    def move(self, point: ArrayLike) -> None:
        """The robot is at a point (2,) [m] now; InputError outside the grid."""
        x, y = as_point(point, "point")
        self._grid.cell_of((x, y))
        with self._turn():
            self._core.move((x, y))
            self._ends = (np.array([x, y]), self._ends[1])
            self._route = None

    @property
    def route(self) -> Route:
        """The shortest path from where the robot is; unreachable also while its cell or the goal's is
        blocked.

        route.stats says what mending took, not what the whole search has. route.world is the grid given
        first.
        """
        with self._turn():
            if self._route is None:
                began = time.perf_counter()
                status, path, length, nodes, edges, self._settled = self._core.replan()
                stats, found = Stats(nodes, edges, time.perf_counter() - began), STATUSES[status]
                self._route = new_route(self._grid, self._planner, self._ends, found, path, length, stats)
            return self._route

    def __reduce__(self) -> tuple[Any, ...]:
        """The grid, what is known of it now and the ends: copies and pickles search from there anew."""
        with self._turn():
            changed = np.argwhere(self._core.unpack().view(np.bool_) != self._grid.blocked)
            cells = np.ascontiguousarray(changed, np.int32)
            return _make_again, (self._grid, self._ends, self._planner, cells)

    def __repr__(self) -> str:
        (x0, y0), (x1, y1) = self._ends
        return f"<DStarLite from ({x0:g}, {y0:g}) to ({x1:g}, {y1:g}) over {self._grid!r}>"


def _make_again(
    grid: OccupancyGrid,
    ends: tuple[Array, Array],
    planner: DStarLiteSearch,
    changed: npt.NDArray[np.int32],
) -> DStarLite:
    """A planner with the same ends and cells; changed: (k, 2) cells that are not as in the grid."""
    made = DStarLite.__new__(DStarLite)
    made._begin(grid, ends, planner)
    blocked = grid.blocked[tuple(changed.T)]
    made._core.set(changed[blocked], False)
    made._core.set(changed[~blocked], True)
    return made


@dataclass(frozen=True, eq=False)
class DStarLiteSearch(GridPlanner):
    """The shortest path over the cells of a grid, searched from the goal: D* Lite before any change."""

    name = "d_star_lite"
    summary = "shortest path over cells, repaired after map changes"

    metric: str = option("octile", '"octile" or "manhattan".', choices=METRICS)

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.metric == "euclidean":
            raise InputError("metric is 'euclidean'; D* Lite counts steps: 'octile' or 'manhattan'")

    def plan(self, world: Any, start: ArrayLike, goal: ArrayLike) -> Route:
        return self._replanner(world, start, goal).route

    def _replanner(self, world: Any, start: Any, goal: Any) -> DStarLite:
        made = DStarLite.__new__(DStarLite)
        made._begin(world, check_ends(world, start, goal), self)
        return made

    def explain_route(self, route: Route) -> str:
        if route:
            return super().explain_route(route)
        cells = count_things(route.stats.nodes, "cell")
        return f"no path to the goal, as is known after expanding {cells} more"

    def _record(self, route: Route) -> Any:
        """The cells in the order in which a fresh search settles them."""
        fresh = self._replanner(route.world, route.start, route.goal)
        assert fresh.route is not None
        at = route.world.center_of(fresh._settled)
        return np.zeros(len(at), np.int8), at, at, np.zeros(len(at))
