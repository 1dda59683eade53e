"""The result of inverse kinematics for one goal: the configurations, and functions of them."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING, Any, Final, cast

import numpy as np

from cspace import _core
from cspace.arrays import Array
from cspace.errors import InputError, InputTypeError
from cspace.ik.answers import INCOMPLETE, METRICS, NEAREST, SINGULAR, UNREACHABLE, VERDICTS, Answers
from cspace.ik.branches import branch_labels
from cspace.ik.context import About
from cspace.ik.goals.given import one_configuration
from cspace.ik.goals.partial import position_goal
from cspace.ik.locked_joints import locked_in_words
from cspace.ik.self_motion.self_motion import SelfMotion, self_motion_at
from cspace.ik.solver import Solver
from cspace.ik.wrapping import all_windings, into_limits, measure_violations, wrap_joints
from cspace.kinematics.batch import check_choice, limits_of
from cspace.model import Limits
from cspace.tables import html_table, one_line, shown
from cspace.tolerances import FAR_GOAL, ORIENTATION_KEPT, SLIGHT_MISS

if TYPE_CHECKING:
    from cspace.collision import Scene
    from cspace.collision.checks import HasGeometry

ORIENTATION_FIRST: Final = 1e4
"""Weight of a radian, in lengths of the arm, in the search for the distance: the orientation is kept."""


POSE_ASKS: Final = 6

UNCERTIFIED: Final = (
    "completeness could not be certified, because some solutions nearly coincide, or share the angles that "
    "distinguish them"
)


class Solutions(Answers, _core.SolutionsBase):
    """Every configuration that reaches one goal.

    q: (k, dof) [rad, m], revolute joints in (−π, π]; locked joints have the given values, and a configuration
    chosen by near=, or for more than one redundant joint, lies within limits. goal: T_base_tip (4, 4).
    Truthy if there is a solution; `status` is "exact", "singular", "unreachable" or "least_squares", and
    `reason` states it in one sentence. The filters `within`, `nearest`, `wrapped` return the same kind of
    object.
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
        """A result from its parts: rows q (k, dof), and the branch number and kind of each.

        goal: a pose (4, 4) or a point (3,).
        """
        goal = np.ascontiguousarray(position_goal(goal) if goal.shape == (3,) else goal)
        q = np.ascontiguousarray(q, dtype=np.float64)
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
    def goal_parts(self) -> dict[str, Any]:
        """The parts of the goal by keyword: {"position": p, "direction": d} and the like, or {"pose": T}. The
        goal itself is then one of the poses that satisfy them.
        """
        return dict(self._wanted.value)

    @property
    def branch(self) -> tuple[str, ...]:
        """A name for each solution: shoulder, elbow and wrist where the arm has them, else a number."""
        return branch_labels(self.solver, self.q, self._branch_numbers)

    @property
    def out_of_reach(self) -> float:
        """How far [m] the goal would have to move, its orientation kept, to be reached."""
        if self._status != UNREACHABLE:
            return 0.0
        return nearest_to_goal(self, ORIENTATION_FIRST)[1]

    @property
    def reason(self) -> str:
        """The result as one sentence."""
        if self._note is not None:
            return self._note
        if self._status == UNREACHABLE:
            return unreachable_reason(self)
        if self._status == NEAREST and len(self):
            miss = self._wanted.distance_in_words(self.solver.fk(self.q[0]))
            return f"no configuration reaches {self._wanted.text}; the nearest one misses it by {miss}"
        text = how_many(len(self)) + " the goal"
        if self._about is not None and self._about.values:
            return f"{text}, {spread_in_words(self._about)}" + ("" if self.complete else f"; {UNCERTIFIED}")
        if self.freedom:
            k = len(self.freedom)
            free = f"{k} dimension{'s' if k > 1 else ''} free: {', '.join(self.freedom)}"
            text = f"{len(self)} of the configurations that reach the goal, which leaves {free}"
        if self._status == SINGULAR:
            moving = sorted({name for self_motion in self.self_motions for name in self_motion.joints})
            is_pose = "pose" in self._wanted.value
            cause = "the pose is singular" if is_pose else "the goal leaves a self-motion"
            text += f"; {cause}: {', '.join(moving)} can move while the tip does not"
        return text if self.complete else text + "; " + UNCERTIFIED

    @property
    def self_motions(self) -> tuple[SelfMotion, ...]:
        """The one-parameter self-motions among the solutions, empty unless the pose is singular."""
        solver, q = self._whole
        rows = np.flatnonzero(self._is_self_motion)
        locked = {} if self._about is None else {k: float(v) for k, v in self._about.locked.items()}
        whole_pose = not self._is_point
        return tuple(self_motion_at(solver, int(row), q[row], whole_pose, locked) for row in rows)

    def __iter__(self) -> Iterator[Array]:
        return iter(self.q)

    def __getitem__(self, row: int) -> Array:
        return cast(Array, self.q[row])

    def within(self, limits: Limits | None = None, *, windings: bool = False) -> Solutions:
        """The solutions inside the limits, each revolute joint first moved by a multiple of 2π to fit.

        limits: the robot's own unless given. A joint that rounding takes past a limit is set to it, so q is
        inside exactly. windings: every combination of multiples of 2π that fits, not only one.
        """
        bounds = limits_of(self.solver.limits, limits, self.solver.name)
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
            note = limits_reason(self.solver, settled, bounds)
        return self._take(rows, q, note)

    def free(
        self, scene: Scene | None = None, *, robot: HasGeometry | None = None, margin: float = 0.0
    ) -> Solutions:
        """The solutions at which the robot touches neither the obstacles of a scene nor itself.

        robot: whose collision geometry counts; the robot that was asked unless given. margin [m]: everything
        closer than this counts as touching. If none is left, the reason says what they touch. Raises
        InputError for a robot without collision geometry, and for a Solver without a robot.
        """
        from cspace.collision.checks import collides, explain_contacts

        whose = self.solver._robot if robot is None else robot
        if whose is None:
            raise InputError(f"{self.solver.name} is a solver without a robot; give free(scene, robot=…)")
        q = np.ascontiguousarray(self.q)
        touching = collides(whose, q, scene, margin=margin)
        note = None
        if len(q) and touching.all():
            note = f"every solution touches something: {explain_contacts(whose, q, scene, margin)}"
        return self._take(np.flatnonzero(~touching), q[~touching], note)

    def nearest(self, q: Any, metric: str = "euclidean") -> Solutions:
        """The one solution nearest to q (dof,), each revolute joint taken by the turn that brings it closest.

        metric: "euclidean" (root of the sum of squares) or "max" (largest joint difference). Turns that
        would leave the robot's limits are not taken where another one stays inside. Of a self-motion
        the representative counts; its `nearest` says which member comes nearest.
        """
        seed = one_configuration(self.solver, q, "q")
        check_choice(metric, "metric", METRICS)
        return self._nearest_of_all(seed, metric, self.solver.limits) if self else self

    def _nearest_of_all(self, seed: Array, metric: str, limits: Limits) -> Solutions:
        moved, row = self._towards(seed, metric, limits)
        return self._take(row[None], moved[row[None]], None)

    def _nearest_within(self, q: Any, limits: Limits) -> Solutions:
        """The one solution within limits that is nearest to q (dof,), or none with the reason."""
        seed = one_configuration(self.solver, q, "near")
        inside = self.within(limits)
        return inside._nearest_of_all(seed, METRICS[0], limits) if inside else inside

    def _chosen_within(self, limits: Limits) -> Solutions:
        """The same for the nearest configuration of a self-motion that was searched: none if it breaks the
        limits, as no other one keeps them."""
        inside = self.within(limits)
        if inside or not self:
            return inside
        return inside._take(range(0), inside.q, chosen_reason(self.solver, self.q, limits, self.complete))

    def _with_members(self, seed: Array, limits: Limits, within: float = np.inf) -> Solutions:
        """The same solutions, self-motions by their members nearest to a seed (dof,): where it is near
        enough, and within limits where the representative is not.
        """
        q, bounds = self.q.copy(), (limits.lower, limits.upper)
        for self_motion in self.self_motions:
            row = self_motion.row
            member = self_motion.nearest(seed)
            if np.abs(member - seed).max() < within:
                q[row] = member
            if not into_limits(q[row], self.solver.joint_types, *bounds)[1]:
                q[row] = self_motion._nearest_within(seed, limits)
        return self._take(np.arange(len(self)), q, self._note)

    def wrapped(self) -> Solutions:
        """The same solutions with revolute joints in (−π, π]."""
        return self._take(np.arange(len(self)), wrap_joints(self.q, self.solver.joint_types), self._note)

    def violations(self, limits: Limits | None = None) -> tuple[dict[str, float], ...]:
        """Per solution, the joints that no multiple of 2π brings into the limits, and by how much [rad, m].

        Empty for exactly the solutions that `within` keeps.
        """
        bounds = limits_of(self.solver.limits, limits, self.solver.name)
        settled, kinds = self._settled(bounds), self.solver.joint_types
        excess = measure_violations(settled, kinds, bounds.lower, bounds.upper)
        names = self.solver.joint_names
        return tuple({name: float(e) for name, e in zip(names, row, strict=True) if e > 0} for row in excess)

    def _take(self, rows: Any, q: Array, note: str | None) -> Solutions:
        numbers = (self._branch_numbers[row] for row in rows)
        flags = (self._is_self_motion[row] for row in rows)
        about = None if self._about is None else self._about.take(rows, len(rows) == len(self))
        return Solutions.of(self.solver, self.goal, self._verdict, q, numbers, flags, note, about)

    def __reduce__(self) -> tuple[Any, ...]:
        numbers = (self._branch_numbers, self._is_self_motion, self._note, self._about)
        return Solutions.of, (self.solver, self.goal, self._verdict, self.q, *numbers)

    def __repr__(self) -> str:
        return one_line("Solutions", f"{self.status}: {self.reason}")

    def __str__(self) -> str:
        lines = [f"{self.solver.name}: {self.reason}"]
        for label, q in zip(self.branch, np.round(self.q, 4) + 0.0, strict=True):
            lines.append("  [" + ", ".join(f"{angle: .4f}" for angle in q) + f"]  {label}")
        return "\n".join(lines)

    def _repr_html_(self) -> str:
        rows = [[*map(shown, q), label] for label, q in zip(self.branch, self.q, strict=True)]
        return html_table(f"{self.solver.name}: {self.reason}", [*self.solver.joint_names, "branch"], rows)


def how_many(k: int) -> str:
    return "1 configuration reaches" if k == 1 else f"{k} configurations reach"


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
        T = found.solver.fk(found._partial.own_joints(nearest_to_goal(found)[0]))
        p = found._wanted.value.get("position")
        return (
            f"{name} cannot reach {found._partial.text}: the nearest configuration misses it by "
            f"{found._partial.distance_in_words(T)}"
            + hint_for_slight_miss(float(found._partial.residual(T)))
            + hint_for_far_goal(p, T)
        )
    q, missing, turned = nearest_to_goal(found, ORIENTATION_FIRST)
    far = hint_for_far_goal(found.goal if found._is_point else found.goal[:3, 3], found.solver.fk(q))
    if found._is_point:
        return f"out of reach: the goal would have to move {missing:.4g} m for {name} to reach it{far}"
    if turned > min(ORIENTATION_KEPT, missing):
        return (
            f"{name} ({found.solver.dof} joints) cannot reach this orientation: the nearest configuration "
            f"misses it by {np.degrees(turned):.4g}° and {missing:.4g} m"
            + hint_for_slight_miss(max(turned, missing))
            + far
        )
    short = "" if found.solver.dof >= POSE_ASKS else f" ({found.solver.dof} joints; a pose needs 6)"
    return (
        f"out of reach: the goal would have to move {missing:.4g} m, its orientation kept, "
        f"for {name}{short} to reach it" + (hint_for_slight_miss(missing) if short else "") + far
    )


def hint_for_slight_miss(miss: float) -> str:
    """The remedy if an arm with few joints misses a goal only by rounding [m, rad]."""
    if miss > SLIGHT_MISS:
        return ""
    return ", which rounded robot data may cause; least_squares=True returns the nearest configuration"


def hint_for_far_goal(p: Any, T: Array) -> str:
    """The remedy if the distance of a goal p (its open coordinates None) is in another unit than the arm's
    metres; T: the nearest pose of the tip.
    """
    given = [] if p is None else [x for x in p if x is not None]
    if not np.linalg.norm(given) > FAR_GOAL * np.linalg.norm(T[:3, 3]) > 0.0:
        return ""
    return "; the arm is in metres, is the goal in millimetres?"


def nearest_to_goal(found: Solutions, radian: float = 1.0) -> tuple[Array, float, float]:
    """Of a goal out of reach: the configuration, with the goal's virtual joints, that misses it least; by how
    far [m] and by what angle [rad]. radian: how many metres one weighs.
    """
    if found._is_point:
        return *_core._ik_nearest_position(found.solver, found.goal), 0.0
    if found._partial is None:
        return _core._ik_nearest_pose(found.solver, found.goal, radian)
    (extended, _), goal = found._whole, found._partial

    def judged(q: Array) -> tuple[Array, float, float]:
        each = goal.misses(found.solver.fk(goal.own_joints(q)))
        away, turned = (float(max(miss, default=0.0)) for miss in each)
        return q, away, turned

    weights = (1.0, ORIENTATION_FIRST)
    made = (judged(_core._ik_nearest_pose(extended, found.goal, weight)[0]) for weight in weights)
    return min(made, key=lambda one: one[1] + radian * one[2])


def limits_reason(solver: Solver, q: Array, limits: Limits) -> str:
    """Why no row of q (k, dof) is within limits."""
    joint = worst_joint(solver, q, limits)
    return f"{how_many(len(q))} the goal, none within limits; the nearest one has {joint}"


def chosen_reason(solver: Solver, q: Array, limits: Limits, complete: bool) -> str:
    """Why the configuration q (1, dof), which a search for the nearest within limits chose, is not within."""
    found = "no configuration that reaches the goal is within limits"
    if not complete:
        found = "no configuration within limits was found that reaches the goal"
    return f"{found}; the one nearest to near= has {worst_joint(solver, q, limits)}"


def worst_joint(solver: Solver, q: Array, limits: Limits) -> str:
    """Of the row of q (k, dof) that breaks limits least, the joint that breaks them most, and by how much."""
    excess = measure_violations(q, solver.joint_types, limits.lower, limits.upper)
    best = int(np.argmin(excess.max(axis=1)))
    joint = int(np.argmax(excess[best]))
    unit = "rad" if solver.joint_types[joint] == "R" else "m"
    return f"{solver.joint_names[joint]} out by {excess[best, joint]:.4g} {unit}"


_core._ik_results(Solutions)
