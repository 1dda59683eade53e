"""What tracking answers: every branch with the poses it reaches and why it ends, and the best of them."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from cspace.arrays import Array
from cspace.errors import Renamed
from cspace.ik.branches import branch_labels
from cspace.ik.solver import as_solver
from cspace.kinematics import KinematicModel, singularity
from cspace.tables import html_table, one_line, tabulate


@tabulate()
@dataclass(frozen=True, eq=False, repr=False)
class Branch(Renamed):
    """One way of the joints along the poses, as far as it goes.

    q (m, dof) [rad, m]: the configurations at the m poses it reaches, each angle continuous from pose to
    pose. end: where it ends, 12.25 being a quarter of the way from pose 12 to pose 13 and n − 1 the last.
    cause: "end", "limit", "singularity", "jump" or "unreachable"; joint: the one that ended it, for a limit
    and a jump. last (dof,): the configuration there. singular_value: the least one of the Jacobian there,
    lengths over the arm's. cost: of q. Truthy if it reaches every pose.
    """

    robot: KinematicModel
    poses: Array
    q: Array
    end: float
    cause: str
    joint: str | None
    last: Array
    singular_value: float
    cost: float
    number: int = -1

    def __bool__(self) -> bool:
        return self.cause == "end"

    def __len__(self) -> int:
        return len(self.q)

    @property
    def name(self) -> str:
        """The name of the solution it begins with, as robot.ik gives it; empty for a start of one's own."""
        if self.number < 0:
            return ""
        return branch_labels(
            as_solver(self.robot), self.q[:1] if len(self.q) else self.last[None], (self.number,)
        )[0]

    @property
    def reason(self) -> str:
        """Where it ends and why, as one sentence."""
        if self:
            return f"follows {all_of(len(self.poses))}"
        return f"ends {describe_place(self.end, len(self.q))}: {self.explain_cause()}"

    def explain_cause(self) -> str:
        """Why it ends, as a clause."""
        if self.cause == "limit":
            return f"{self.joint} would leave its limits"
        if self.cause == "unreachable":
            return "no configuration reaches the path beyond"
        if self.cause == "singularity":
            joints = singularity(self.robot, self.last).joints
            lost = f" ({', '.join(joints)} are dependent)" if len(joints) < len(self.last) else ""
            return f"the arm is singular{lost} and cannot continue"
        if self.joint is None:
            return "the joints would jump"
        return f"{self.joint} would move farther than max_step before the next pose"

    def __repr__(self) -> str:
        label = f" ({self.name})" if self.name else ""
        return one_line("Branch", f"of {self.robot.name}{label}: {self.reason}")


@dataclass(frozen=True, eq=False, repr=False)
class Track(Renamed):
    """The branches along a path of poses, best first choice at hand.

    branches: every one, in the order of the solutions at the first pose. best: the one that follows all poses
    at the least cost; where none does, the one that gets farthest (None where not even the first pose is
    reached). q (m, dof) [rad, m]: that of best, m = n poses if the track is truthy. poses (n, 4, 4).
    complete: whether branches holds every one there is. Truthy if a branch follows every pose.
    """

    robot: KinematicModel
    poses: Array
    branches: tuple[Branch, ...]
    complete: bool
    _note: str

    @cached_property
    def best(self) -> Branch | None:
        """The branch that follows all poses at the least cost, else the one that gets farthest."""
        return min(self.branches, key=_order) if self.branches else None

    def __bool__(self) -> bool:
        return bool(self.best)

    def __len__(self) -> int:
        return len(self.branches)

    def __iter__(self) -> Iterator[Branch]:
        return iter(self.branches)

    def __getitem__(self, number: int) -> Branch:
        return self.branches[number]

    @property
    def q(self) -> Array:
        """The configurations of the best branch, (m, dof)."""
        return np.empty((0, len(self.robot.joint_names))) if self.best is None else self.best.q

    @property
    def cost(self) -> float:
        """The cost of the best branch; inf if none follows every pose."""
        return self.best.cost if self.best else math.inf

    @property
    def ends(self) -> Array:
        """Where each branch ends, (b,): number of a pose and the share of the way to the next."""
        return np.array([branch.end for branch in self.branches])

    @property
    def cause(self) -> tuple[str, ...]:
        """Why each branch ends: "end", "limit", "singularity", "jump" or "unreachable"."""
        return tuple(branch.cause for branch in self.branches)

    @property
    def reason(self) -> str:
        """The verdict as one sentence."""
        if self.best is None:
            return f"no branch begins: {self._note}"
        through, b, n = sum(map(bool, self.branches)), len(self.branches), len(self.poses)
        of = "the branch" if b == 1 else f"{through or 'none'} of {b} branches"
        verb = "follow" if through > 1 else "follows"
        if through:
            return f"{of} {verb} {all_of(n)}; the cost is {self.cost:.4g}" + self._note
        if b == 1:
            return f"the branch {self.best.reason}" + self._note
        return f"{of} follows {all_of(n)}; the best {self.best.reason}" + self._note

    def __repr__(self) -> str:
        return one_line("Track", f"of {self.robot.name}: {self.reason}")

    def __str__(self) -> str:
        lines = [f"{branch.name or 'branch'}: {branch.reason}" for branch in self.branches]
        return "\n  ".join([f"{self.robot.name}: {self.reason}", *lines])

    def _repr_html_(self) -> str:
        rows = [[branch.name or "branch", branch.reason] for branch in self.branches]
        return html_table(f"{self.robot.name}: {self.reason}", ["branch", "course"], rows)


def all_of(n: int) -> str:
    """How many poses there are, all of them."""
    return "the one pose" if n == 1 else f"all {n} poses"


def describe_place(end: float, reached: int) -> str:
    """The place of an end as text; reached: the number of poses before it."""
    if reached == 0:
        return "before pose 0"
    row = min(int(end), reached - 1)
    share = end - row
    if share == 0:
        return f"at pose {row}"
    return f"{share:.3g} of the way from pose {row} to pose {row + 1}"


def _order(branch: Branch) -> tuple[bool, float, float]:
    """Branches that follow every pose first, the cheapest of them; then those that get farthest."""
    if branch:
        return False, branch.cost, 0.0
    return True, -branch.end if len(branch) else math.inf, branch.cost
