"""Grid search: A* and its kin over equal cells of the configurations of an arm with one to three joints."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any, Final

import numpy as np
import numpy.typing as npt
from numpy.typing import ArrayLike

from cspace._core import ArmPlan, ArmPlans, ArmProblems, GridRule, plan_each_on_grid, plan_on_grid
from cspace.arrays import Array, as_floats
from cspace.errors import InputError
from cspace.planning.arm_planner import Seed
from cspace.planning.edge_planner import ENDS, EdgePlanner, name_blocker
from cspace.planning.space import ArmSpace
from cspace.search import option
from cspace.tables import join_words, shown
from cspace.tolerances import LARGEST_NUMBER, LEAST_GAIN

METHODS: Final[Mapping[str, int]] = MappingProxyType(
    {"a_star": 0, "dijkstra": 1, "best_first": 2, "breadth_first": 3}
)
"""The orders of expansion, with their numbers in the core."""

HEURISTICS: Final = ("distance", "potential")

MOST_JOINTS: Final = 3
"""A grid of four joints has a hundred million nodes at 3.6° already."""

MOST_NODES: Final = 1 << 24
"""Nodes of a grid: three joints at 1.4°; a search that reaches all of them fills 400 MB."""

INFLUENCE: Final = 0.1
"""Share of the arm's reach within which obstacles repel, by default: some widths of a link."""

REPELLED_STEPS: Final = 4.0
"""By how many steps of the grid a node at half of rho_0 is farther by default, as in the plane, where cells
next to walls are four cells higher."""

POTENTIAL_WEIGHT: Final = 1.5
"""The bound on the cost of a path with the potential by default; at 1 the repulsion would have no effect."""


@dataclass(frozen=True, eq=False)
class GridSearch(EdgePlanner):
    """Best-first search over a grid of configurations, for arms with one to three joints.

    The nodes are the corners of equal cells between the limits; the grid is closed where a joint wraps.
    Edges join a node to its neighbours, and starts and goals to the corners of their cells and to each other;
    each is proved when the search comes to it. Methods: "a_star" (Hart, Nilsson & Raphael 1968) and
    "dijkstra" (1959) find a path of least length over the grid, "breadth_first" one of the fewest edges,
    "best_first" some path with few expansions (Pearl 1984). The search is complete to its resolution: if the
    grid holds no path, that is the reason, with the status "undetermined".

    heuristic: "distance", the L2 norm of the joints to the nearest goal, d. Or "potential",
    U = d + min(½ k_r (1/ρ − 1/ρ₀)², cap), with ρ the least distance of the arm from obstacles, and the
    diagonal of the space as cap: A* takes min(scale U, weight d), so its path is at most `weight` times as
    long as the shortest over the grid; "best_first" takes U alone.

    stats: "expansions" counts the nodes that were expanded, "grid_cost" is the length of the path before it
    was shortened, "cells" (dof,) the grid.
    """

    name = "grid_search"
    summary = "A*, Dijkstra, best-first or breadth-first search over a grid of up to three joints"

    method: str = option(
        "a_star",
        '"a_star", "dijkstra", "best_first" or "breadth_first"',
        choices=METHODS,
        subject="search method",
    )
    heuristic: str = option(
        "distance",
        'what "a_star" and "best_first" take for the remaining cost: "distance" or "potential"',
        choices=HEURISTICS,
    )
    step: float = option(
        0.1, "longest side of a cell", unit="rad or m", minimum=LEAST_GAIN, maximum=LARGEST_NUMBER
    )
    cells: ArrayLike | None = option(
        None, "the number of cells per joint, one for all or (dof,); by default that of step="
    )
    reach: int = option(1, "how many steps along each joint an edge spans at most", minimum=1, maximum=8)
    weight: float | None = option(
        None,
        "w, the bound on the length relative to the shortest path over the grid, for A*; by default 1, with "
        "the potential 1.5",
        minimum=1,
        maximum=LARGEST_NUMBER,
    )
    k_r: float | None = option(
        None,
        "repulsion; by default a node at half of rho_0 is four steps farther",
        unit="rad m²",
        minimum=0,
        maximum=LARGEST_NUMBER,
    )
    rho_0: float | None = option(
        None,
        "the distance of influence of obstacles; by default a tenth of the arm's reach",
        unit="m",
        minimum=LEAST_GAIN,
        maximum=LARGEST_NUMBER,
    )
    scale: float = option(
        1.0, "the factor of the potential before it is compared", minimum=0, maximum=LARGEST_NUMBER
    )

    def _fill_in(self, space: ArmSpace) -> GridSearch:
        """The options as they are used in a space."""
        cells = self._count_cells(space)
        rho_0 = INFLUENCE * space.reach if self.rho_0 is None else self.rho_0
        sides = (space.upper - space.lower) / cells
        k_r = 2 * REPELLED_STEPS * float(sides.min()) * rho_0**2 if self.k_r is None else self.k_r
        weight = {"distance": 1.0, "potential": POTENTIAL_WEIGHT}[self.heuristic]
        return self._in_force(
            cells=tuple(cells.tolist()),
            weight=weight if self.weight is None else self.weight,
            k_r=k_r,
            rho_0=rho_0,
        )

    def _count_cells(self, space: ArmSpace) -> npt.NDArray[np.int32]:
        """The number of cells (dof,) of each joint. Raises InputError for grids that are not searched."""
        if not 1 <= space.dof <= MOST_JOINTS:
            raise InputError(
                f"{space.geometry.robot} has {space.dof} joints, and a grid takes one to {MOST_JOINTS}; "
                "choose another planner, such as 'rrt_connect' or 'aorrtc', or lock joints"
            )
        sides = (space.upper - space.lower) / self.step
        counts = np.maximum(1.0, np.ceil(sides)) if self.cells is None else as_floats(self.cells, "cells")
        if counts.ndim > 1 or (counts.ndim == 1 and len(counts) != space.dof):
            raise InputError(f"cells has shape {counts.shape}; give one number, or one per joint")
        if (counts != np.floor(counts)).any() or (counts < 1).any():
            raise InputError(f"cells is {self.cells}; the numbers must be whole and positive")
        nodes = math.prod((np.broadcast_to(counts, space.dof) + 1.0).tolist())
        if nodes > MOST_NODES:
            raise InputError(
                f"the grid has {nodes:.3g} nodes, and {MOST_NODES} at most are searched; give a larger step= "
                "or fewer cells="
            )
        return np.ascontiguousarray(np.broadcast_to(counts, space.dof), dtype=np.int32)

    def _make_rule(self, space: ArmSpace) -> GridRule:
        """The options as the core takes them."""
        given = self._fill_in(space).values
        return GridRule(
            np.array(given["cells"], dtype=np.int32),
            METHODS[self.method],
            self.reach,
            given["weight"],
            self.heuristic == "potential",
            self.scale,
            given["k_r"],
            given["rho_0"],
            float(np.linalg.norm(space.upper - space.lower)),
        )

    def _plan_rows(self, space: ArmSpace, rows: tuple[Array, Array], rng: Seed) -> ArmPlan:
        """See EdgePlanner."""
        rule, options = self._make_rule(space), self._make_options(rng)
        return plan_on_grid(space.checker.core, space.bounds, space.wraps, *rows, options, rule)

    def _plan_each_rows(self, space: ArmSpace, problems: ArmProblems, rng: Seed, threads: int) -> ArmPlans:
        """See EdgePlanner."""
        rule, options = self._make_rule(space), self._make_options(rng)
        return plan_each_on_grid(
            space.checker.core, space.bounds, space.wraps, problems, options, rule, threads
        )

    def _list_stats(self, space: ArmSpace, found: Any) -> dict[str, Any]:
        """See EdgePlanner."""
        cells = self._fill_in(space).values["cells"]
        return {**found.stats, "grid_cost": found.raw_cost, "cells": cells}

    def _explain_end(self, space: ArmSpace, rows: tuple[Array, Array], found: Any) -> tuple[str, str]:
        """See EdgePlanner."""
        status, reason = super()._explain_end(space, rows, found)
        if status != "undetermined":
            return status, reason
        distance, _, _ = found.approach
        expansions = found.stats["expansions"]
        cells = " × ".join(map(str, self._fill_in(space).values["cells"]))
        causes = {
            "disconnected": f"the grid of {cells} cells holds no path: no open node is left after "
            f"{expansions} expansions; a smaller step= may find one",
            "time limit": f"the time limit was reached after {expansions} expansions",
            "edge budget": f"the edge budget was used up after {expansions} expansions",
        }
        parts = [causes[ENDS[found.status]], f"the search came within {shown(distance)} of a goal"]
        return status, join_words([*parts, *name_blocker(space, found)])
