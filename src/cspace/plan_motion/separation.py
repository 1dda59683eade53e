"""Proofs that two joints cannot get from a start to a goal."""

from __future__ import annotations

from math import inf
from typing import Final

import numpy as np
import numpy.typing as npt

from cspace.arrays import Array
from cspace.planning import ArmSpace, JointSpace

CELLS: Final = 512
"""Cells along each joint: an eighth of a second's work."""

AROUND: Final = np.array([(i, j) for i in (-1, 0, 1) for j in (-1, 0, 1) if (i, j) != (0, 0)])
"""The eight neighbours of a cell."""

REASON: Final = (
    "blocked configurations divide the two joints: no way leads from the start to the goal, which a grid of"
    f" {CELLS} by {CELLS} cells proves"
)

Mask = npt.NDArray[np.bool_]
Integers = npt.NDArray[np.int64]


class Separation:
    """What a way of two joints cannot pass: cells of which all configurations are proved to be blocked.

    A way from one of the other cells leads on to one of its eight neighbours that is not blocked either.
    time_limit [s]: after it no more cells are proved.
    """

    def __init__(self, space: ArmSpace, time_limit: float = inf) -> None:
        whole = JointSpace(space.geometry, space.scene, margin=space.margin)
        cells = whole.slice((0, 1), size=CELLS, time_limit=None if time_limit == inf else time_limit)
        self._open: Mask = ~(cells.is_proved & cells.bitmap)
        self._lower, self._size, self._wraps = whole.lower, whole.upper - whole.lower, whole.wraps

    def divides(self, starts: Array, goals: Array) -> bool:
        """Whether no way leads from any of the starts (s, 2) to any of the goals (g, 2), all of them free."""
        reached = self._reach(self._cells_of(starts))
        return not bool(reached[tuple(self._cells_of(goals).T)].any())

    def _cells_of(self, q: Array) -> Integers:
        """The cells (n, 2) of configurations (n, 2)."""
        share = (q - self._lower) / self._size
        share = np.where(self._wraps, share - np.floor(share), share)
        cells: Integers = np.clip(np.floor(CELLS * share), 0, CELLS - 1).astype(np.int64)
        return cells

    def _reach(self, front: Integers) -> Mask:
        """The cells to which those of the front are connected."""
        reached = np.zeros_like(self._open)
        while len(front):
            reached[tuple(front.T)] = True
            near = (front[:, None] + AROUND).reshape(-1, 2)
            near = np.where(self._wraps, near % CELLS, near)
            near = near[((near >= 0) & (near < CELLS)).all(axis=1)]
            near = near[self._open[tuple(near.T)] & ~reached[tuple(near.T)]]
            front = np.stack(np.unravel_index(np.unique(near @ (CELLS, 1)), self._open.shape), axis=1)
        return reached
