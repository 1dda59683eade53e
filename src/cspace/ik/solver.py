"""The solver of one arm: built from its joint axes at zero and its limits, it answers goals of every kind.

A `Robot` keeps one; it can also be used without a Robot.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import cached_property
from typing import TYPE_CHECKING, Any, Protocol, TypeVar, cast

import numpy as np

from cspace import _core
from cspace.arrays import Array, one_number
from cspace.errors import InputError, InputTypeError
from cspace.ik.conditions import NoClosedFormError, explain_missing_form
from cspace.ik.goals.partial import PartialGoal
from cspace.ik.locked_joints import joint_number, locked_values
from cspace.kinematics import KinematicModel, assemble_chain
from cspace.kinematics.batch import limits_of
from cspace.model import Chain, Limits, chain, from_screws
from cspace.tables import tabulate
from cspace.tolerances import REACH_ROUNDING

if TYPE_CHECKING:
    from cspace.collision.checks import HasGeometry

MAX_JOINTS = 16
MAX_SETTLED = 6
"""Joints that a pose determines at most."""
MAX_SOLUTIONS = 16
MOST_KEPT = 32
"""Solvers kept for locked joints, and as many for partial goals; a loop over more values builds its own."""
Key = TypeVar("Key")


class HasSolver(Protocol):
    """A Robot or a Solver."""

    @property
    def solver(self) -> Solver: ...


@tabulate("name", "joint_names", "joint_types", "base", "tip", "max_solutions")
class Solver(_core.SolverBase, KinematicModel):
    """Every configuration of one arm that reaches a goal: `solve`.

    chain: the joint axes and the tip at zero, as of `robot.chain`. limits: of its joints; those of the chain
    unless given, False for none. name: in messages, that of the chain unless given.

    The solver finds its closed form, or the general method, when it is first asked (microseconds to
    milliseconds), and keeps it; several threads may use one solver. It is also a kinematic model: `fk`,
    `jacobian`, `dof`, `joint_names`, `joint_types`, `limits`, `chain` are those of the arm.

    Raises NoClosedFormError for mimic joints, no joint or more than sixteen; InputError for limits of another
    number of joints.
    """

    _robot: HasGeometry | None = None
    """The robot whose solver it is: `Solutions.free` checks it for collisions."""

    def __init__(self, chain: Chain, limits: Limits | bool | None = None, *, name: str | None = None) -> None:
        if not isinstance(chain, Chain):
            raise InputTypeError(
                f"Solver takes a Chain, got {type(chain).__name__}; robot.chain is one, and"
                " Solver.from_screws takes joint axes"
            )
        own = chain.coordinates.limits
        limited = chain.with_limits(limits_of(own, limits, chain.name))
        self._read(limited, chain.name if name is None else name)

    def _read(self, source: Chain, name: str, goal_joints: Sequence[int] = (), reach: float = np.inf) -> None:
        super().__init__(assemble_chain(source), name)
        n = len(source.joint_types)
        if source.dof != n or not 1 <= n <= MAX_JOINTS:
            raise NoClosedFormError(explain_missing_form(self))
        self._goal_joints, self._reach = tuple(goal_joints), reach
        self._locked: dict[Any, Solver] = {}
        self._extended: dict[Any, Solver] = {}
        self._limited: dict[Any, Solver] = {}
        weight = np.ones(n)
        weight[list(goal_joints)] = 0.0  # a goal's own joints do not count in distances
        _core._ik_build(
            self,
            np.ascontiguousarray(source.axes),
            np.ascontiguousarray(source.points),
            np.array([kind == "P" for kind in source.joint_types], dtype=np.float64),
            np.ascontiguousarray(source.T_zero),
            np.ascontiguousarray(self.limits.lower),
            np.ascontiguousarray(self.limits.upper),
            weight,
            reach,
        )

    @classmethod
    def from_screws(cls, axes: Any, points: Any, T_zero: Any, **options: Any) -> Solver:
        """The solver of a serial arm from its joint axes at zero.

        axes (n, 3), points (n, 3) [m], T_zero (4, 4): the tip in the base with all joints at zero. options:
        joint_types, lower, upper, name, joint_names and the others of model.from_screws, which also names the
        errors.
        """
        return cls(chain(from_screws(axes, points, T_zero, **options)))

    @property
    def solver(self) -> Solver:
        """The solver itself, so that a function that takes a robot also takes a solver."""
        return self

    @cached_property
    def is_redundant(self) -> bool:
        """Whether a pose leaves some joints free, so that joints have to be locked."""
        return _core._ik_room(self) == 0

    @property
    def max_solutions(self) -> int:
        """The largest number of solutions that a goal can have, with all redundant joints locked."""
        return _core._ik_room(self) or MAX_SOLUTIONS

    @cached_property
    def redundant_joints(self) -> tuple[int, ...]:
        """The redundant joints that are locked unless others are named, by number, ascending."""
        return tuple(_core._ik_default_locked(self))

    def check_swivel(self) -> Solver:
        """The solver itself. Raises InputError for an arm without two spherical joints: it has no swivel."""
        if self.joint_types != "R" * 7:
            raise InputError(f"{self.name} has no swivel, which needs seven revolute joints")
        if not _core._ik_has_swivel(self):
            raise InputError(
                f"{self.name} has no swivel in closed form: axes 1, 2, 3 must meet in a point, axes 5, 6, 7"
                " in another, to rounding; lock a joint with locked= instead"
            )
        return self

    def redundancy_degree(self, locked: Sequence[int] = ()) -> int:
        """The number of dimensions that a pose leaves free, with these joints locked at typical values."""
        joints = {joint_number(self, joint, "locked") for joint in locked}
        return _core._ik_redundancy_degree(self, sorted(joints))

    def limited(self, limits: Limits) -> Solver:
        """The solver of the same arm with other limits, or the solver itself if they are its own."""
        if limits is self.limits:
            return self
        return keep_solver(
            self._limited,
            (limits.lower.tobytes(), limits.upper.tobytes()),
            lambda: make_solver(self.chain.with_limits(limits), self.name, self._goal_joints, self._reach),
        )

    def lock(self, values: Mapping[int, float]) -> Solver:
        """The solver of the other joints, with these joints (by number) at fixed values [rad or m]."""
        if not values:
            return self
        values = {k: one_number(v, f"locked[{k}]") for k, v in locked_values(self, values).items()}

        def build() -> Solver:
            moving = [k for k in range(self.dof) if k not in values]
            goal_joints = [i for i, k in enumerate(moving) if k in self._goal_joints]
            return make_solver(self.chain.lock(values), self.name, goal_joints, self._reach)

        return keep_solver(self._locked, tuple(sorted(values.items())), build)

    def extend(self, goal: PartialGoal) -> Solver:
        """The solver of the arm with the virtual joints of a partial goal."""
        if not (goal.before or goal.behind):
            return self

        def build() -> Solver:
            longer = goal.extend_chain(self.chain)
            first, n = len(goal.before), len(longer.joint_names)
            added = [*range(first), *range(first + self.dof, n)]
            reach = largest_reach(self.chain) if "ray" in goal.kind else np.inf
            return make_solver(longer, self.name, added, reach)

        return keep_solver(self._extended, goal.key, build)

    def __reduce__(self) -> tuple[Any, ...]:
        return make_solver, (self.chain, self.name, self._goal_joints, self._reach)

    def __repr__(self) -> str:
        return f"<Solver {self.name}: {self.joint_types}, {self.base} → {self.tip}>"


def keep_solver(solvers: dict[Key, Solver], key: Key, build: Callable[[], Solver]) -> Solver:
    """The solver of that key, built if it is not there; the oldest of many is dropped."""
    found = solvers.get(key)
    if found is None:
        if len(solvers) >= MOST_KEPT:
            solvers.pop(next(iter(solvers)), None)
        found = solvers[key] = build()
    return found


def largest_reach(source: Chain) -> float:
    """No point of the tip is farther from the base [m]: all links in one line; infinite for prismatic joints,
    whose limits a solution may break."""
    if "P" in source.joint_types:
        return float("inf")
    corners: Array = np.vstack([np.zeros(3), source.points, source.T_zero[:3, 3]])
    return float(np.linalg.norm(np.diff(corners, axis=0), axis=1).sum()) * (1 + REACH_ROUNDING)


def solver_of_robot(robot: KinematicModel) -> Solver:
    """The solver of a robot's chain. Raises NoClosedFormError for a floating base too."""
    if robot.floating:
        raise NoClosedFormError(explain_missing_form(robot))
    made = Solver(robot.chain, robot.limits if robot.chain.dof == robot.dof else None, name=robot.name)
    made._robot = cast("HasGeometry", robot)
    return made


def as_solver(arm: HasSolver | KinematicModel) -> Solver:
    """The solver of a robot, or a solver itself. Raises InputTypeError for what is neither."""
    if not isinstance(arm, KinematicModel):
        raise InputTypeError(
            f"this function takes a robot or an ik.Solver first, got {type(arm).__name__};"
            " cspace.load_robot(name) makes a robot"
        )
    return cast("HasSolver", arm).solver


def make_solver(source: Chain, name: str, goal_joints: Sequence[int], reach: float) -> Solver:
    """A solver of a chain whose goal joints stand for what a goal leaves open; also that of a pickle."""
    made = Solver.__new__(Solver)
    made._read(source, name, goal_joints, reach)
    return made
