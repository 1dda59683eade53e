"""Slice: two joints of a configuration space, the others held."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import numpy.typing as npt

from cspace.arrays import Array, guard_memory
from cspace.planning.joint_space.cells import ROWS_AT_ONCE, Grid, JointPair
from cspace.tables import one_line, tabulate

SELF = "self"
"""What blocks a configuration in which the robot touches itself, or what it carries."""


@tabulate()
@dataclass(frozen=True, eq=False)
class Slice(JointPair):
    """Where a robot is free while two joints move and the others are held.

    at (dof,) [rad or m]: where they are held; joints: the two, by number; joint_names, units: their names,
    "rad" or "m". lower, upper (2,): their range; wraps (2,): whether both ends are the same place. bitmap
    (n1, n2): bool, True where the robot touches something at the centre of a cell; row i belongs to the first
    joint, column j to the second, in ascending order. is_proved (n1, n2): bool, True where the whole cell is
    as its centre; the others are decided at their centres alone. obstacles: the names that `obstacle_map`
    counts, the last is "self".
    """

    at: Array
    bitmap: npt.NDArray[np.bool_]
    is_proved: npt.NDArray[np.bool_]
    obstacles: tuple[str, ...]
    _find_obstacles: Callable[[Array], npt.NDArray[np.int32]]

    @property
    def proved(self) -> float:
        """The share of cells that are proved."""
        return share_of(self.is_proved)

    @property
    def free_share(self) -> float:
        """The share of cells whose centre is free."""
        return share_of(~self.bitmap)

    @property
    def free_bounds(self) -> tuple[float, float]:
        """Two numbers between which the free share of the whole range is proved to lie."""
        return share_of(self.is_proved & ~self.bitmap), share_of(~(self.is_proved & self.bitmap))

    @property
    def cells(self) -> tuple[Array, Array]:
        """The coordinates (n1,) and (n2,) [rad or m] of the centres of the cells."""
        return self._grid.centers()

    def configurations(self) -> Array:
        """The configurations (n1, n2, dof) at the centres of the cells."""
        n1, n2 = self.bitmap.shape
        with guard_memory("size", (n1, n2), 3.0 * n1 * n2 * len(self.at), "take fewer cells"):
            first, second = np.meshgrid(*self.cells, indexing="ij")
            rows = self._grid.configurations(first.ravel(), second.ravel())
        return rows.reshape(n1, n2, -1)

    @cached_property
    def obstacle_map(self) -> npt.NDArray[np.int32]:
        """What blocks each cell: int32 (n1, n2), its place in `obstacles`, −1 where the centre is free.

        Where the robot touches several things it is one of them, the same in every call, and an obstacle
        rather than the robot itself.
        """
        found = np.full(self.bitmap.shape, -1, dtype=np.int32)
        places = np.argwhere(self.bitmap)
        first, second = self.cells
        for begin in range(0, len(places), ROWS_AT_ONCE):
            i, j = places[begin : begin + ROWS_AT_ONCE].T
            found[i, j] = self._find_obstacles(self._grid.configurations(first[i], second[j]))
        return found

    @property
    def _grid(self) -> Grid:
        return self._grid_of(self.at, self.bitmap.shape)

    def __getstate__(self) -> dict[str, Any]:
        """What pickle stores: the obstacles in place of the robot that finds them."""
        return self.__dict__ | {"obstacle_map": self.obstacle_map, "_find_obstacles": None}

    def __repr__(self) -> str:
        n1, n2 = self.bitmap.shape
        first, second = self.joint_names
        return one_line(
            "Slice",
            f"of {first} and {second}, {n1} x {n2} cells: {self.free_share:.1%} free,"
            f" {self.proved:.1%} proved",
        )


def share_of(cells: npt.NDArray[np.bool_]) -> float:
    """The share of cells that are True; a larger set never has the smaller share."""
    return int(np.count_nonzero(cells)) / cells.size


def name_obstacles(obstacles: tuple[str, ...]) -> tuple[str, ...]:
    """The names of what may block a configuration."""
    return (*obstacles, SELF)
