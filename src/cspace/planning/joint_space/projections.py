"""Projection: two joints of a configuration space, over samples of the others."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from cspace.arrays import Array
from cspace.planning.joint_space.cells import JointPair
from cspace.planning.joint_space.shares import find_standard_error, find_wilson_interval
from cspace.tables import one_line, tabulate


@tabulate()
@dataclass(frozen=True, eq=False)
class Projection(JointPair):
    """For each cell of two joints, whether the others can be set so that the robot is free.

    joints: the two, by number; joint_names, units: their names, "rad" or "m". lower, upper (2,): their range;
    wraps (2,): whether both ends are the same place.
    is_free (n1, n2): bool, True where a configuration was found whose two joints are at the centre of the
    cell, and which is free. share (n1, n2): the share of samples of the other joints that are free there.
    samples: how many there were. complete: whether it was as many as asked for, before the time was up.
    """

    is_free: npt.NDArray[np.bool_]
    share: Array
    samples: int
    complete: bool

    @property
    def cells(self) -> tuple[Array, Array]:
        """The coordinates (n1,) and (n2,) [rad or m] of the centres of the cells."""
        return self._grid_of(self.lower, self.share.shape).centers()

    @property
    def standard_error(self) -> Array:
        """The standard error of `share` (n1, n2)."""
        error: Array = find_standard_error(self.share, self.samples)
        return error

    @property
    def interval(self) -> Array:
        """Between which shares (2, n1, n2) the true ones lie with 95 % confidence each (Wilson 1927)."""
        return find_wilson_interval(self.share, self.samples)

    def __repr__(self) -> str:
        n1, n2 = self.share.shape
        first, second = self.joint_names
        return one_line(
            "Projection",
            f"onto {first} and {second}, {n1} x {n2} cells, {self.samples} samples:"
            f" {self.is_free.mean():.1%} can be free",
        )
