"""What numeric inverse kinematics answers: a configuration, and whether it reaches the goal."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, Final

import numpy as np
import numpy.typing as npt

from cspace.arrays import Array, as_floats
from cspace.errors import InputError
from cspace.ik.wrapping import nearest_winding
from cspace.kinematics import KinematicModel
from cspace.tables import html_table, one_line, shown, tabulate

REACHED: Final = 0
STALLED: Final = 1
Flags = npt.NDArray[np.bool_]
Counts = npt.NDArray[np.int64]
ENDINGS: Final = ("reached", "stalled", "out of iterations")


@tabulate()
@dataclass(frozen=True, eq=False, repr=False)
class NumericSolution:
    """The configuration at which a descent ended, one per goal.

    q (..., dof) [rad, m]. goal (..., 4, 4). success (...): whether fk(q) is the goal within the tolerance;
    with limits q lies inside them, reached or not. position_error (...) [m] and rotation_error (...) [rad]:
    lengths of the parts of the error that count. iterations (...): of the descent that ended at q.
    start (...): which start it came from, 0 for the first. Truthy if every goal is reached.
    """

    robot: KinematicModel
    goal: Array
    q: Array
    position_error: Array
    rotation_error: Array
    iterations: Counts
    start: Counts
    _ending: Counts
    _starts: int
    _limits: Array

    @classmethod
    def of(
        cls, robot: KinematicModel, goal: Array, q: Array, info: Array, starts: int, limits: Array
    ) -> NumericSolution:
        """An answer from the numbers (..., 5) of the core: both errors, iterations, start, ending."""
        errors, counts = info[..., :2], info[..., 2:].astype(np.int64)
        position_error, rotation_error = (np.asarray(errors[..., k]) for k in range(2))
        iterations, start, ending = (np.asarray(counts[..., k]) for k in range(3))
        return cls(robot, goal, q, position_error, rotation_error, iterations, start, ending, starts, limits)

    def __bool__(self) -> bool:
        return bool(self.success.all())

    @property
    def success(self) -> Flags:
        """Whether each goal is reached, (...)."""
        return np.asarray(self._ending == REACHED)

    @property
    def residual(self) -> Array:
        """The larger of position error [m] and rotation error [rad], (...)."""
        return np.maximum(self.position_error, self.rotation_error)

    @property
    def status(self) -> Any:
        """ "reached", "stalled" (a local minimum of the error) or "out of iterations"; of a batch (...)."""
        words = np.array(ENDINGS)[self._ending]
        return str(words) if words.ndim == 0 else words

    @property
    def reason(self) -> str:
        """The verdict as one sentence; of a batch, how many goals were reached."""
        if self.q.ndim > 1:
            reached = int(np.count_nonzero(self.success))
            return f"{reached} of {self.success.size} goals reached"
        left = f"{float(self.position_error):.3g} m and {np.degrees(float(self.rotation_error)):.3g}°"
        which = "the first start" if self.start == 0 else f"start {int(self.start) + 1} of {self._starts}"
        if self:
            return f"reached from {which} in {int(self.iterations)} iterations; {left} are left"
        tried = "one start" if self._starts == 1 else f"{self._starts} starts"
        how = "a local minimum" if self._ending == STALLED else "where the iterations ran out"
        text = f"not reached from {tried}: the best result misses it by {left}, at {how}"
        at_limit = self._at_limits()
        return (
            text + (f", with {', '.join(at_limit)} at a limit" if at_limit else "") + "; this proves nothing"
        )

    def _at_limits(self) -> list[str]:
        if not self._limits.size:
            return []
        at = (self.q <= self._limits[0]) | (self.q >= self._limits[1])
        return [name for name, at_limit in zip(self.robot.joint_names, at, strict=True) if at_limit]

    def __repr__(self) -> str:
        return one_line("NumericSolution", f"of {self.robot.name}: {self.reason}")


@dataclass(frozen=True, eq=False, repr=False)
class SampledSolutions:
    """The different solutions of one goal that descents from many starts found: a sample, never all for sure.

    q (k, dof) [rad, m] in the order found. hits (k,): how many of the starts ended in each. goal (4, 4).
    starts: how many there were. Truthy if there is one.
    """

    robot: KinematicModel
    goal: Array
    q: Array
    hits: Counts
    residual: Array
    starts: int

    complete: Final = False

    def __len__(self) -> int:
        return len(self.q)

    def __iter__(self) -> Iterator[Array]:
        return iter(self.q)

    def __getitem__(self, row: int) -> Array:
        return np.asarray(self.q[row])

    @property
    def unseen(self) -> float:
        """An estimate of the share of starts that lead to solutions not found yet (Good 1953): the share of
        those found, among the successful starts, that were found once.
        """
        reached = int(self.hits.sum())
        return float(np.count_nonzero(self.hits == 1)) / reached if reached else 1.0

    @property
    def reason(self) -> str:
        """What was found as one sentence."""
        reached = int(self.hits.sum())
        if not reached:
            return f"none of {self.starts} starts reached the goal; this proves nothing"
        found = "one solution" if len(self) == 1 else f"{len(self)} different solutions"
        once = int(np.count_nonzero(self.hits == 1))
        return (
            f"{found} from {reached} of {self.starts} starts, {once} of them found once;"
            " a sample, there may be more"
        )

    def nearest(self, q: Any) -> Array:
        """The solution nearest to q (dof,), its angles turned to where they are closest.

        Raises InputError where nothing was found.
        """
        wanted = as_floats(q, "q", last=(self.robot.dof,))
        if not len(self):
            raise InputError(self.reason)
        free = np.full(self.robot.dof, np.inf)
        turned = nearest_winding(self.q, wanted, self.robot.joint_types, -free, free)
        return np.asarray(turned[np.argmin(np.linalg.norm(turned - wanted, axis=1))])

    def __repr__(self) -> str:
        return one_line("SampledSolutions", f"of {self.robot.name}: {self.reason}")

    def _repr_html_(self) -> str:
        rows = [[*map(shown, q), str(hits)] for q, hits in zip(self.q, self.hits, strict=True)]
        return html_table(f"{self.robot.name}: {self.reason}", [*self.robot.joint_names, "hits"], rows)
