"""Plans of a robot, one or many."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any, Final

import numpy as np
from numpy.typing import ArrayLike

from cspace.arrays import Array, whole_number
from cspace.collision import MeshJudge, Scene
from cspace.errors import InputError, InputTypeError, suggest
from cspace.plan_motion.find import explain_goals, find_goals
from cspace.plan_motion.goals import GoalLike, Goals
from cspace.planning import ArmPlanner, ArmSpace, Plan, find_planner
from cspace.robot import Robot
from cspace.tables import html_table, one_line, shown

Seed = int | np.random.Generator | None

VERIFICATIONS: Final = ("mesh",)
"""What a path can be checked with once more."""

MOST_THREADS: Final = 1024
"""Threads that are believed."""


def plan(
    robot: Robot,
    start: ArrayLike,
    goal: GoalLike,
    scene: Scene | None = None,
    *,
    planner: str | ArmPlanner = "rrt_connect",
    margin: float = 0.0,
    rng: Seed = 0,
    verify: str | MeshJudge | None = None,
    **options: Any,
) -> Plan:
    """A free way of a robot from a start to a goal, every motion of it proved.

    start: a configuration (dof,) [rad or m], or several (s, dof) to choose from; or a name of
    `robot.named_poses`, such as "home". goal: the same; or a pose (4, 4) of the tip, reached by whichever of
    its IK solutions within the limits is easiest; the keywords of `robot.ik` as a dict, such as
    {"position": p}; or a `planning.Region` of poses, of which free configurations are sampled. Of redundant
    arms the solutions are samples over the self-motion. scene: None without obstacles. planner: a name of
    `cs.planning.PLANNERS`, or an ArmPlanner. margin [m]: everything keeps so far away from everything else.
    rng: seed or generator; the same seed gives the same plan on every machine. options: those of the planner.
    verify: "mesh" checks the path once more, at samples, with the exact shapes of the links in place of their
    spheres (needs the extra `mesh`); a path that fails is not returned. A collision.MeshJudge of a robot with
    the same joints may be given instead, such as the one with meshes where this one has given spheres.

    The Plan is truthy if a way was found, and says why where not: "unreachable" if no IK solution exists or
    all of them touch something, "undetermined" if the planner's budget was used up, if only samples of
    infinitely many IK solutions were tried, or if the meshes touch something on the path.
    Raises InputError for a start or a given goal that touches something or is outside the limits,
    UnknownNameError for an unknown planner, InputTypeError for an unknown option.
    """
    chosen = find_planner(planner, options)
    space = _make_space(robot, scene, margin)
    judge = None if verify is None else _find_judge(robot, space, verify)
    starts = space.as_rows(start, "start")
    goals = find_goals(robot, space, starts, goal)
    found = _plan_to_goals(chosen, space, starts, goals, rng)
    if found.status in ("invalid_start", "invalid_goal"):
        raise InputError(found.reason)
    return found if judge is None or not found else _verify_plan(found, chosen, judge)


def plan_many(
    robot: Robot,
    starts: ArrayLike,
    goals: ArrayLike | Sequence[GoalLike],
    scene: Scene | None = None,
    *,
    planner: str | ArmPlanner = "rrt_connect",
    margin: float = 0.0,
    rng: Seed = 0,
    threads: int = 0,
    **options: Any,
) -> Plans:
    """A plan for each of many problems in one scene, on all threads; each is the same as alone.

    starts (n, dof) or one (dof,) for all. goals: n configurations (n, dof), n poses (n, 4, 4), or a list of n
    goals as `plan` takes them. threads: 0 for all. Other arguments as of plan. A problem whose start or goal
    is not free has the status "invalid_start" or "invalid_goal" instead of an error.
    """
    chosen = find_planner(planner, options)
    count = whole_number(threads, "threads", 0, MOST_THREADS, "0 for every processor")
    space = _make_space(robot, scene, margin)
    if isinstance(goals, (Mapping, str)) or not np.iterable(goals):
        raise InputTypeError(
            f"goals is a {type(goals).__name__}; it must be a list of goals, one per problem"
        )
    wanted = list(goals)
    _check_each(wanted, space.dof)
    rows = space.as_rows(starts, "starts")
    if len(rows) not in (1, len(wanted)):
        raise InputError(f"there are {len(rows)} starts and {len(wanted)} goals; give one start, or as many")
    rows = np.broadcast_to(rows, (len(wanted), space.dof)) if len(rows) == 1 else rows
    rows = np.ascontiguousarray(rows)
    if isinstance(goals, np.ndarray) and goals.shape == rows.shape:  # one configuration each
        ends = space.as_rows(goals, "goals")
        problems = [(rows[k : k + 1], ends[k : k + 1]) for k in range(len(rows))]
        return Plans(chosen.plan_each(space, problems, rng=rng, threads=count))
    sets = [find_goals(robot, space, rows[k : k + 1], goal) for k, goal in enumerate(wanted)]
    problems = [(rows[k : k + 1], each.rows) for k, each in enumerate(sets) if len(each.rows)]
    found = iter(chosen.plan_each(space, problems, rng=rng, threads=count))
    plans = [
        next(found) if len(each.rows) else _make_negative(space, chosen, each.status, each.reason)
        for each in sets
    ]
    for k, each in enumerate(sets):
        if plans[k].status == "invalid_goal" and not each.is_given:
            plans[k] = _plan_to_more(chosen, space, rows[k : k + 1], each, rng)
    return Plans(plans)


def _check_each(goals: Sequence[GoalLike], dof: int) -> None:
    """Raises InputError where the goals are the numbers of one configuration."""
    if any(isinstance(goal, (int, float, np.number)) for goal in goals):
        raise InputError(
            f"goals are {len(goals)} numbers; give one goal per problem: configurations (n, {dof}), poses"
            " (n, 4, 4), or a list of goals"
        )


def _find_judge(robot: Robot, space: ArmSpace, verify: str | MeshJudge) -> MeshJudge:
    """The judge of a path, as given or of the robot itself."""
    if not isinstance(verify, MeshJudge):
        if verify not in VERIFICATIONS:
            raise suggest("verification", verify, VERIFICATIONS)
        return MeshJudge(robot, space.scene, space.margin)
    if verify.joint_names != robot.joint_names:
        raise InputError(
            f"verify is a judge of the joints {', '.join(verify.joint_names)}; it must have those of"
            f" {robot.name}: {', '.join(robot.joint_names)}"
        )
    return verify


def _verify_plan(found: Plan, planner: ArmPlanner, judge: MeshJudge) -> Plan:
    """The plan if the exact shapes of the links touch nothing on its path; else why not, without a path."""
    verdict = judge.judge_path(found.path)
    stats = {**found.stats, "mesh_samples": verdict.samples, "mesh_step": verdict.step}
    if verdict:
        return replace(found, reason=f"{found.reason}; with meshes {verdict.reason}", stats=stats)
    reason = (
        f"a path of length {shown(found.cost)} is free for the spheres of the robot, but not for its meshes:"
        f" {verdict.reason}; plan with a larger margin, or cover the meshes more closely"
    )
    return replace(_make_negative(found.space, planner, "undetermined", reason), stats=stats)


def _plan_to_goals(planner: ArmPlanner, space: ArmSpace, starts: Array, goals: Goals, rng: Seed) -> Plan:
    """A plan to the configurations of a goal; if none of them is free and others exist, to those."""
    if not len(goals.rows):
        return _make_negative(space, planner, goals.status, goals.reason)
    found = planner.plan(space, starts, goals.rows, rng=rng)
    if found.status == "invalid_goal" and not goals.is_given:
        return _plan_to_more(planner, space, starts, goals, rng)
    return found


def _plan_to_more(planner: ArmPlanner, space: ArmSpace, starts: Array, goals: Goals, rng: Seed) -> Plan:
    """A plan where no configuration of a goal is free: to further ones, or the reason why there is none."""
    if goals.find_more is not None:
        return _plan_to_goals(planner, space, starts, goals.find_more(), rng)
    return _make_negative(space, planner, *explain_goals(space, goals))


class Plans(Sequence[Plan]):
    """The plans of many problems: plans[k] is a Plan.

    path (n, m, dof): their corners, NaN beyond the last. corners (n,): how many each has, 0 without a path.
    status: of each. cost (n,): inf without a path. found (n,): which have one.
    """

    def __init__(self, plans: Sequence[Plan]) -> None:
        self._plans = list(plans)
        self.status = tuple(each.status for each in self._plans)
        self.cost: Array = np.array([each.cost for each in self._plans])
        self.corners = np.array([len(each) for each in self._plans], dtype=np.intp)
        self.found = np.array([bool(each) for each in self._plans])

    @property
    def path(self) -> Array:
        """The corners (n, m, dof), NaN beyond the last of each."""
        dof = self._plans[0].space.dof if self._plans else 0
        shape = (len(self), int(self.corners.max(initial=0)), dof)
        rows: Array = np.full(shape, np.nan, dtype=np.float64)
        for row, each in zip(rows, self._plans, strict=True):
            row[: len(each)] = each.path
        return rows

    def __len__(self) -> int:
        return len(self._plans)

    def __getitem__(self, k: Any) -> Any:
        return Plans(self._plans[k]) if isinstance(k, slice) else self._plans[k]

    def __repr__(self) -> str:
        counts = ", ".join(f"{n} {status}" for status, n in Counter(self.status).items())
        return one_line(
            "Plans", f"of {len(self)} problem{'' if len(self) == 1 else 's'}{': ' if counts else ''}{counts}"
        )

    def _repr_html_(self) -> str:
        rows = [(str(k), p.status, str(len(p)), shown(p.cost)) for k, p in enumerate(self._plans)]
        return html_table(repr(self)[1:-1], ("problem", "status", "corners", "cost"), rows)


def _make_space(robot: Robot, scene: Scene | None, margin: float) -> ArmSpace:
    """The space of a robot; InputTypeError for what is not one."""
    if not isinstance(robot, Robot):
        kind = type(robot).__name__
        raise InputTypeError(f"robot is a {kind}; it must be a cspace.Robot, such as cs.load_robot('panda')")
    return ArmSpace(robot, scene, margin)


def _make_negative(space: ArmSpace, planner: ArmPlanner, status: str, reason: str) -> Plan:
    """A plan without a path."""
    path = np.empty((0, space.dof))
    return Plan(status, reason, path, np.inf, -1, -1, False, {}, space, planner)
