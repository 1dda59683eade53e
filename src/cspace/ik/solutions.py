"""The result of inverse kinematics for one goal: the configurations, and functions of them."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING, Any, Final, cast

import numpy as np

from cspace import _core
from cspace.arrays import Array
from cspace.errors import InputError, InputTypeError, attribute_error
from cspace.ik.branches import branch_labels
from cspace.ik.context import About
from cspace.ik.derivative import solve_derivative
from cspace.ik.goals.given import one_configuration
from cspace.ik.locked_joints import locked_in_words
from cspace.ik.on_limits import settle_on_limits
from cspace.ik.self_motion.self_motion import SelfMotion, self_motion_at
from cspace.ik.wrapping import all_windings, into_limits, measure_violations, nearest_winding, wrap_joints
from cspace.kinematics.batch import check_choice
from cspace.tolerances import ORIENTATION_KEPT, SLIGHT_MISS

if TYPE_CHECKING:
    from cspace.ik.goals.partial import PartialGoal
    from cspace.ik.solver import Solver
    from cspace.kinematics import KinematicModel
    from cspace.model import Limits


UNREACHABLE: Final = 0
EXACT: Final = 1
SINGULAR: Final = 2
NEAREST: Final = 3
INCOMPLETE: Final = 8
"""Added to a verdict where solutions may be missing."""
VERDICTS: Final = ("unreachable", "exact", "singular", "least_squares")
METRICS: Final = ("euclidean", "max")
ORIENTATION_FIRST: Final = 1e4
"""Weight of a radian, in lengths of the arm, in the search for the distance: the orientation is kept."""


POSE_ASKS: Final = 6

UNCERTIFIED: Final = (
    "completeness could not be certified, because some solutions nearly coincide, or share the angles that "
    "distinguish them"
)


class Solutions(_core.SolutionsBase):
    """Every configuration that reaches one goal.

    q: (k, dof) [rad, m], revolute joints in (−π, π]. goal: T_base_tip (4, 4). Truthy if there is a
    solution; `status` is "exact", "singular", "unreachable" or "least_squares", and `reason` states it in one
    sentence. The filters `within`, `nearest`, `wrapped` return the same kind of object.
    """

    __slots__ = ()

    @classmethod
    def of(
        cls,
        solver: Solver,
        goal: Array,
        verdict: int,
        q: Array,
        branches: Iterable[int],
        self_motion: Iterable[bool],
        note: str | None = None,
        about: About | None = None,
    ) -> Solutions:
        """A result from its parts: rows q (k, dof), and the branch number and kind of each."""
        goal, q = np.ascontiguousarray(goal), np.ascontiguousarray(q, dtype=np.float64)
        numbers, flags = tuple(map(int, branches)), tuple(map(bool, self_motion))
        return cast(Solutions, _core._ik_make(solver, goal, verdict, q, numbers, flags, note, about))

    @property
    def status(self) -> str:
        """ "exact", "singular" (some rows represent a self-motion), "unreachable" or "least_squares"."""
        return VERDICTS[self._status]

    @property
    def _status(self) -> int:
        return self._verdict & ~INCOMPLETE

    @property
    def complete(self) -> bool:
        """Whether every solution is listed, self-motions by a representative. A closed form always lists them
        all; the general method certifies it goal by goal.
        """
        return self._status != NEAREST and not self._verdict & INCOMPLETE

    @property
    def residual(self) -> Array:
        """How far fk(q) is from the goal, (k,): the larger of the position error [m] and the angle [rad]."""
        if self._partial is not None:
            return self._partial.residual(self.solver.fk(self.q))
        return pose_errors(self.solver, self.q, self.goal)

    @property
    def goal_parts(self) -> dict[str, Any]:
        """The parts of the goal by keyword: {"position": p, "direction": d} and the like, or {"pose": T}. The
        goal itself is then one of the poses that satisfy them.
        """
        if self._partial is not None:
            return dict(self._partial.value)
        return {"position" if self.goal.shape == (3,) else "pose": self.goal}

    @property
    def _partial(self) -> PartialGoal | None:
        return None if self._about is None else cast("PartialGoal | None", self._about.goal)

    @property
    def freedom(self) -> tuple[str, ...]:
        """The names of the parameters that the goal leaves free, one per dimension; empty if it leaves
        none except in self-motions.
        """
        return () if self._about is None else cast("tuple[str, ...]", self._about.freedom)

    @property
    def derivative(self) -> Array:
        """dq per base twist [v; ω] of the goal, (k, dof, 6): ik(exp(twist) goal) is q + derivative @ twist
        to first order. NaN where a solution is singular. Computed on access.
        """
        if self._partial is not None:
            moves = solve_derivative(self._about.extended, self._about.q)
            return np.swapaxes(self._partial.own_joints(np.swapaxes(moves, 1, 2)), 1, 2)
        return solve_derivative(self.solver, self.q, self.goal.shape == (3,))

    @property
    def branch(self) -> tuple[str, ...]:
        """A name for each solution: shoulder, elbow and wrist where the arm has them, else its branch
        number.
        """
        return branch_labels(self.solver, self.q, self._branch_numbers)

    @property
    def out_of_reach(self) -> float:
        """The distance [m] of the goal from the reachable poses: how far it would have to move with its
        orientation kept.
        """
        if self._status != UNREACHABLE:
            return 0.0
        if self.goal.shape == (3,):
            return float(_core._ik_nearest_position(self.solver, self.goal)[1])
        if self._partial is not None:
            return nearest_to_goal(self, ORIENTATION_FIRST)[1]
        return float(_core._ik_nearest_pose(self.solver, self.goal, ORIENTATION_FIRST)[1])

    @property
    def reason(self) -> str:
        """The result as one sentence."""
        if self._note is not None:
            return self._note
        if self._status == UNREACHABLE:
            return unreachable_reason(self)
        text = how_many(len(self)) + " the goal"
        if self._about is not None and self._about.values:
            return f"{text}, {spread_in_words(self._about)}" + ("" if self.complete else f"; {UNCERTIFIED}")
        if self.freedom:
            k = len(self.freedom)
            free = f"{k} dimension{'s' if k > 1 else ''} free: {', '.join(self.freedom)}"
            text = f"{len(self)} of the configurations that reach the goal, which leaves {free}"
        if self._status == SINGULAR:
            moving = sorted({name for self_motion in self.self_motions for name in self_motion.joints})
            is_pose = self.goal.shape == (4, 4) and self._partial is None
            cause = "the pose is singular" if is_pose else "the goal leaves a self-motion"
            text += f"; {cause}: {', '.join(moving)} can move while the tip does not"
        return text if self.complete else text + "; " + UNCERTIFIED

    @property
    def self_motions(self) -> tuple[SelfMotion, ...]:
        """The one-parameter self-motions among the solutions, empty unless the pose is singular."""
        rows = [row for row, is_self_motion in enumerate(self._is_self_motion) if is_self_motion]
        if self._partial is not None:
            extended = self._about.extended
            return tuple(self_motion_at(extended, row, self._about.q[row], True) for row in rows)
        whole_pose = self.goal.shape == (4, 4)
        return tuple(self_motion_at(self.solver, row, self.q[row], whole_pose) for row in rows)

    if not TYPE_CHECKING:  # type checkers report such names themselves

        def __getattr__(self, name: str) -> Any:
            raise attribute_error(self, name)

    def __iter__(self) -> Iterator[Array]:
        return iter(self.q)

    def __getitem__(self, row: int) -> Array:
        return cast(Array, self.q[row])

    def within(self, limits: Limits | None = None, *, windings: bool = False) -> Solutions:
        """The solutions inside the limits, each revolute joint first moved by a multiple of 2π to fit.

        limits: the robot's own unless given. A joint that rounding takes past a limit is set to it, so q is
        inside exactly. windings: every combination of multiples of 2π that fits, not only one.
        """
        bounds = bounds_of(self.solver, limits)
        kinds = self.solver.joint_types
        if not isinstance(windings, (bool, np.bool_)):
            raise InputTypeError(f"windings must be True or False, got {type(windings).__name__}")
        settled = self._settled(bounds)
        if windings:
            rows, q = all_windings(settled, kinds, bounds.lower, bounds.upper)
        else:
            moved, fits = into_limits(settled, kinds, bounds.lower, bounds.upper)
            rows, q = np.flatnonzero(fits), moved[fits]
        note = None
        if len(rows) == 0 and len(self):
            note = limits_reason(self, settled, bounds)
        return self._take(rows, q, note)

    def _settled(self, limits: Limits) -> Array:
        """The solutions (k, dof), those that rounding takes past a limit set to it."""
        return settle_on_limits(self.solver, self.q, limits, slice(6 if self.goal.shape == (4, 4) else 3))

    def nearest(self, q: Any, metric: str = "euclidean") -> Solutions:
        """The one solution nearest to q (dof,), each revolute joint taken by the turn that brings it closest.

        metric: "euclidean" (root of the sum of squares) or "max" (largest joint difference). Turns that
        would leave the robot's limits are not taken where another one stays inside. Of a family the
        representative counts; its `nearest` says which member comes nearest.
        """
        seed = one_configuration(self.solver, q, "q")
        check_choice(metric, "metric", METRICS)
        if not self:
            return self
        limits = self.solver.limits
        moved = nearest_winding(self.q, seed, self.solver.joint_types, limits.lower, limits.upper)
        gap = np.abs(moved - seed)
        distance = gap.max(axis=1) if metric == "max" else np.linalg.norm(gap, axis=1)
        row = int(np.argmin(distance))
        return self._take(np.array([row]), moved[[row]], None)

    def _with_members(self, seed: Array, within: float = np.inf) -> Solutions:
        """The same solutions, self-motions by their members nearest to a seed (dof,) if near enough."""
        q = self.q.copy()
        for self_motion in self.self_motions:
            member = self_motion.nearest(seed)
            if np.abs(member - seed).max() < within:
                q[self_motion.row] = member
        return self._take(np.arange(len(self)), q, self._note)

    def wrapped(self) -> Solutions:
        """The same solutions with revolute joints in (−π, π]."""
        return self._take(np.arange(len(self)), wrap_joints(self.q, self.solver.joint_types), self._note)

    def violations(self, limits: Limits | None = None) -> tuple[dict[str, float], ...]:
        """Per solution, the joints that no multiple of 2π brings into the limits, and by how much [rad, m].

        Empty for exactly the solutions that `within` keeps.
        """
        bounds = bounds_of(self.solver, limits)
        excess = measure_violations(
            self._settled(bounds), self.solver.joint_types, bounds.lower, bounds.upper
        )
        names = self.solver.joint_names
        return tuple({name: float(e) for name, e in zip(names, row, strict=True) if e > 0} for row in excess)

    @property
    def _goal_pose(self) -> Array:
        return self.goal if self.goal.shape == (4, 4) else position_goal(self.goal)

    def _take(self, rows: Any, q: Array, note: str | None) -> Solutions:
        numbers = (self._branch_numbers[row] for row in rows)
        flags = (self._is_self_motion[row] for row in rows)
        about = None if self._about is None else self._about.take(rows, len(rows) == len(self))
        return Solutions.of(self.solver, self._goal_pose, self._verdict, q, numbers, flags, note, about)

    def __reduce__(self) -> tuple[Any, ...]:
        numbers = (self._branch_numbers, self._is_self_motion, self._note, self._about)
        return Solutions.of, (self.solver, self._goal_pose, self._verdict, self.q, *numbers)

    def __repr__(self) -> str:
        lines = [f"Solutions({self.status}: {self.reason})"]
        if len(self):
            for label, q in zip(self.branch, self.q, strict=True):
                lines.append(
                    "  [" + ", ".join(f"{angle: .4f}" for angle in np.round(q, 4) + 0.0) + f"]  {label}"
                )
        return "\n".join(lines)


def bounds_of(solver: KinematicModel, limits: Limits | None) -> Limits:
    """The limits that count: the robot's own unless others are given, which must have as many joints."""
    bounds: Limits = solver.limits if limits is None else limits
    sizes = [getattr(getattr(bounds, side, None), "shape", None) for side in ("lower", "upper")]
    if None in sizes:
        raise InputTypeError(f"limits is a {type(limits).__name__}, expected cspace.model.Limits")
    if sizes != [(solver.dof,)] * 2:
        raise InputError(f"limits are for {sizes[0]} joints, {solver.name} has ({solver.dof},)")
    return bounds


def pose_errors(solver: KinematicModel, q: Array, goal: Array) -> Array:
    """Per configuration the larger of the position error [m] and the rotation angle [rad] between fk(q) and
    goal.
    """
    if q.size == 0:
        return np.zeros(q.shape[:-1])
    T = solver.fk(q)
    if goal.shape[-1] == 3:
        return cast(Array, np.linalg.norm(T[..., :3, 3] - goal, axis=-1))
    away = np.linalg.norm(T[..., :3, 3] - goal[..., :3, 3], axis=-1)
    # ‖R − R_goal‖_F = 2√2 sin(angle/2), which keeps its digits for small angles.
    gap = np.linalg.norm(T[..., :3, :3] - goal[..., :3, :3], axis=(-2, -1))
    turned = 2 * np.arcsin(np.minimum(gap / (2 * np.sqrt(2)), 1.0))
    return cast(Array, np.maximum(away, turned))


def how_many(k: int) -> str:
    return "1 configuration reaches" if k == 1 else f"{k} configurations reach"


def position_goal(p: Array) -> Array:
    """A position goal (3,) in the shape of a pose, its rotation unknown."""
    T = np.full((4, 4), np.nan)
    T[:3, 3] = p
    return T


def spread_in_words(about: About) -> str:
    """At which values of the redundant joint branches are listed."""
    where = "its feasible intervals"
    if not about.feasible:
        where = "the values that reach it, none of them within limits"
    values = f"{about.values} value{'s' if about.values > 1 else ''}"
    return f"at {values} of {about.freedom[0]} spread over {where}"


def unreachable_reason(found: Solutions) -> str:
    name = found.solver.name
    if found._about is not None and found._about.locked:
        return f"nothing reaches the goal with {locked_in_words(found.solver, found._about.own_locked)}"
    if found._partial is not None:
        q, _, miss = nearest_to_goal(found)
        left = float(found._partial.residual(found.solver.fk(found._partial.own_joints(q))))
        return (
            f"{name} cannot reach {found._partial.text}: the nearest configuration misses it by {miss}"
            + hint_for_slight_miss(left)
        )
    if found.goal.shape == (3,):
        return f"out of reach: the goal would have to move {found.out_of_reach:.4g} m for {name} to reach it"
    _, missing, turned = _core._ik_nearest_pose(found.solver, found.goal, ORIENTATION_FIRST)
    if turned > min(ORIENTATION_KEPT, missing):
        return (
            f"{name} ({found.solver.dof} joints) cannot reach this orientation: the nearest configuration "
            f"misses it by {np.degrees(turned):.4g}° and {missing:.4g} m"
            + hint_for_slight_miss(max(turned, missing))
        )
    short = "" if found.solver.dof >= POSE_ASKS else f" ({found.solver.dof} joints; a pose needs 6)"
    return (
        f"out of reach: the goal would have to move {missing:.4g} m, its orientation kept, "
        f"for {name}{short} to reach it" + (hint_for_slight_miss(missing) if short else "")
    )


def hint_for_slight_miss(miss: float) -> str:
    """The remedy if an arm with few joints misses a goal only by rounding [m, rad]."""
    if miss > SLIGHT_MISS:
        return ""
    return ", which rounded robot data may cause; least_squares=True returns the nearest configuration"


def nearest_to_goal(found: Solutions, radian: float = 1.0) -> tuple[Array, float, str]:
    """Of a partial goal out of reach: the configuration of the longer arm that misses it least; by how far
    [m], and by how much in words. radian: how many metres one weighs where what is missed is compared.
    """
    extended, goal = found._about.extended, found._about.goal

    def size(q: Array) -> float:
        distances, angles = goal.misses(found.solver.fk(goal.own_joints(q)))
        return float(max(distances, default=0.0) + radian * max(angles, default=0.0))

    q = min(
        (_core._ik_nearest_pose(extended, found.goal, weight)[0] for weight in (1.0, ORIENTATION_FIRST)),
        key=size,
    )
    T = found.solver.fk(goal.own_joints(q))
    return q, float(max(goal.misses(T)[0], default=0.0)), goal.distance_in_words(T)


def limits_reason(found: Solutions, q: Array, limits: Limits) -> str:
    excess = measure_violations(q, found.solver.joint_types, limits.lower, limits.upper)
    best = int(np.argmin(excess.max(axis=1)))
    joint = int(np.argmax(excess[best]))
    unit = "rad" if found.solver.joint_types[joint] == "R" else "m"
    return (
        f"{how_many(len(found))} the goal, none within limits; the nearest one has "
        f"{found.solver.joint_names[joint]} out by {excess[best, joint]:.4g} {unit}"
    )


_core._ik_results(Solutions)
