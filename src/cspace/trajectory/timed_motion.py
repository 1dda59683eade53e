"""TimedMotion: a timed path with what it was made from."""

from __future__ import annotations

from typing import Any

import numpy as np

from cspace.arrays import Array
from cspace.tables import tabulate
from cspace.trajectory.limit_check import BindingLimit
from cspace.trajectory.path import Path
from cspace.trajectory.timed_path import Grid, SlowStretch, TimedPath
from cspace.trajectory.trajectory import Trajectory


@tabulate("path", "duration", "proved", "converged", "reason")
class TimedMotion(Trajectory):
    """A motion along a path that somebody chose; falsy where there is none.

    timed: the TimedPath, of which path, proved, converged, place and parameter(t) are those of the motion
    too.
    """

    def __init__(self, timed: TimedPath) -> None:
        self.timed = timed
        super().__init__(timed.dof, timed.duration, timed.joint_names, timed.reason)

    @property
    def path(self) -> Path:
        """The path of the joints."""
        return self.timed.path

    @property
    def proved(self) -> bool:
        """Whether no limit is exceeded anywhere, and not only at samples."""
        return self.timed.proved

    @property
    def converged(self) -> bool:
        """Whether a finer grid would not change the duration by more than the tolerance."""
        return self.timed.converged

    @property
    def place(self) -> float:
        """At which parameter of the path there is no motion; nan where it is no single place."""
        return self.timed.place

    @property
    def knots(self) -> Array:
        """The times (k,) [s] of the places of the grid."""
        return self.timed.knots

    def parameter(self, t: Any, order: int = 0) -> Array:
        """The parameter s of the path, ṡ or s̈ (...) at times t (...) [s]; order: 0, 1 or 2."""
        return self.timed.parameter(t, order)

    def binding(self, limits: Any = None) -> tuple[BindingLimit, ...]:
        """When which limit binds, as of the TimedPath."""
        return self.timed.binding(limits)

    def below_feed(self) -> tuple[SlowStretch, ...]:
        """When the tip is slower than its feed, as of the TimedPath."""
        return self.timed.below_feed()

    def scaled(self, factor: float) -> TimedPath:
        """The same path, slower by a factor."""
        return self.timed.scaled(factor)

    def reversed(self) -> TimedPath:
        """The motion from its end to its start."""
        return self.timed.reversed()

    @property
    def _no_motion(self) -> str:
        return self.timed._no_motion

    def _evaluate(self, times: Array, order: int) -> Array:
        return self.timed._evaluate(times, order)

    def _evaluate_joint(self, joint: int, times: Array, order: int, before: bool) -> Array:
        return self.timed._evaluate_joint(joint, times, order, before)

    def _turning_times(self, order: int) -> list[Array]:
        return self.timed._turning_times(order)


def stand_still(q: Array, length: float, reason: str, place: float, joint_names: Any) -> TimedPath:
    """No motion: it stays at q (dof,). Without a reason that is what was asked for."""
    still = Path([0.0, length], np.nan_to_num(np.stack([q, q]))[None])
    empty = Grid(np.zeros(0, dtype=np.int32), np.zeros(0), np.zeros(0))
    return TimedPath(
        still,
        empty,
        np.zeros(0),
        proved=not reason,
        converged=not reason,
        reason=reason,
        place=place,
        joint_names=joint_names,
    )
