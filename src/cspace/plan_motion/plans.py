"""Plans of a robot, one or many."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from math import inf
from typing import Any, Final, cast

import numpy as np
from numpy.typing import ArrayLike

from cspace._core import ArmProblems
from cspace.arrays import Array, whole_number
from cspace.collision import MeshJudge, Scene
from cspace.errors import InputError, InputTypeError, name_type, suggest
from cspace.plan_motion.find import POSE_ROWS
from cspace.plan_motion.goal_search import PROOF_SECONDS, GoalSearch, make_negative
from cspace.plan_motion.goals import GoalLike, Goals
from cspace.plan_motion.poses import solve_each_pose
from cspace.plan_motion.separation import REASON, Separation
from cspace.planning import ArmPlanner, ArmSpace, Plan, Plans, find_planner
from cspace.planning.edge_planner import join_problems
from cspace.robot import Robot
from cspace.tables import shown

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
    `robot.named_poses`, such as "home". goal: the same; or a pose (4, 4) of the tip or several (g, 4, 4),
    reached by whichever of their IK solutions within the limits is easiest; the keywords of `robot.ik` as a
    dict, such as {"position": p}; or a `planning.Region` of poses, of which free configurations are sampled.
    Of redundant arms the solutions are samples over the self-motion. scene: None without obstacles. planner:
    a name of `cs.planning.PLANNERS`, or an ArmPlanner. margin [m]: everything keeps so far away from
    everything else. rng: seed or generator; the same seed gives the same plan on every machine. options:
    those of the planner.
    verify: "mesh" checks the path once more, at samples, with the exact shapes of the links in place of their
    spheres (needs the extra `mesh`); a path that fails is not returned. A collision.MeshJudge of a robot with
    the same joints may be given instead, such as the one with meshes where this one has given spheres.

    The Plan is truthy if a way was found, and says why where not: "unreachable" if no IK solution exists, if
    all of them touch something, or if a proof shows that two joints cannot get there; "undetermined" if the
    planner's budget was used up, if only samples of infinitely many IK solutions were tried, or if the meshes
    touch something on the path.
    Raises InputError for a start or a given goal that touches something or is outside the limits,
    UnknownNameError for an unknown planner, InputTypeError for an unknown option.
    """
    chosen = find_planner(planner, options)
    space = _make_space(robot, scene, margin)
    judge = None if verify is None else _find_judge(robot, space, verify)
    starts = space.as_rows(start, "start")
    search = GoalSearch(robot, chosen, space, rng)
    found = search.plan(starts, search.find(starts, goal))
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
    verify: str | MeshJudge | None = None,
    **options: Any,
) -> Plans:
    """A plan for each of many problems in one scene, on all threads; each is the same as alone.

    starts (n, dof) or one (dof,) for all. goals: n configurations (n, dof), n poses (n, 4, 4), or a list of n
    goals as `plan` takes them. threads: 0 for all. Other arguments as of plan; a time limit is that of each
    problem. A problem whose start or goal is not free has the status "invalid_start" or "invalid_goal"
    instead of an error.

    The Plans have `status`, `cost`, `corners` and `found` at once; plans[k], a Plan, is made when it is read.
    """
    chosen = find_planner(planner, options)
    count = whole_number(threads, "threads", 0, MOST_THREADS, "0 for every processor")
    space = _make_space(robot, scene, margin)
    judge = None if verify is None else _find_judge(robot, space, verify)
    if isinstance(goals, (Mapping, str)) or not np.iterable(goals):
        raise InputTypeError(f"goals is {name_type(goals)}; it must be a list of goals, one per problem")
    is_array = isinstance(goals, np.ndarray) and goals.ndim > 1
    wanted: Any = goals if is_array else list(goals)
    if not is_array:
        _check_each(wanted, space.dof)
    rows = _repeat_starts(space.as_rows(starts, "starts"), len(wanted))
    if is_array and len(rows) and wanted.shape == rows.shape:  # one configuration each
        ends = space.as_rows(wanted, "goals")
        plans = chosen.plan_each(space, ArmProblems(rows, None, ends, None), rng=rng, threads=count)
        if space.dof == 2:
            plans = _prove_unreachable(
                plans, chosen, space, rows, [ends[k : k + 1] for k in range(len(ends))]
            )
    else:
        plans = _plan_to_goals(robot, chosen, space, rows, wanted, rng, count)
    return plans if judge is None else _verify_plans(plans, chosen, judge)


def _repeat_starts(rows: Array, count: int) -> Array:
    """Starts (n, dof), one per problem."""
    if len(rows) not in (1, count):
        raise InputError(f"there are {len(rows)} starts and {count} goals; give one start, or as many")
    return np.ascontiguousarray(np.broadcast_to(rows, (count, rows.shape[1])))


def _plan_to_goals(
    robot: Robot,
    planner: ArmPlanner,
    space: ArmSpace,
    starts: Array,
    goals: Sequence[Any],
    rng: Seed,
    threads: int,
) -> Plans:
    """A plan per goal of any kind: the configurations of all goals are found, then planned to at once."""
    sets, left = _find_each(robot, planner, space, starts, goals, threads)
    planned = [k for k, each in enumerate(sets) if len(each.rows)]
    problems = join_problems(
        space, [(starts[k : k + 1], sets[k].rows) for k in planned], [left[k] for k in planned]
    )
    found = planner.plan_each(space, problems, rng=rng, threads=threads)
    others = {
        k: make_negative(space, planner, each.status, each.reason)
        for k, each in enumerate(sets)
        if not len(each.rows)
    }
    for k, status in zip(planned, found.status, strict=True):
        if status == "invalid_goal" and not sets[k].is_given:
            search = GoalSearch(robot, planner, space, rng, left[k])
            others[k] = search.plan_to_more(starts[k : k + 1], sets[k])
    plans = found._replace(len(sets), others, planned)
    if space.dof != 2:
        return plans
    return _prove_unreachable(
        plans, planner, space, starts, [each.rows if each.is_whole else None for each in sets]
    )


def _prove_unreachable(
    plans: Plans, planner: ArmPlanner, space: ArmSpace, starts: Array, goals: Sequence[Array | None]
) -> Plans:
    """The plans of two joints, those unreachable of which it is proved, in time, that there is no way."""
    open_ends = [k for k, each in enumerate(plans.status) if each == "undetermined" and goals[k] is not None]
    if not open_ends or getattr(planner, "time_limit", inf) <= PROOF_SECONDS:
        return plans
    proof = Separation(space)
    others = {
        k: make_negative(space, planner, "unreachable", REASON)
        for k in open_ends
        if proof.divides(starts[k : k + 1], cast(Array, goals[k]))
    }
    return plans._replace(len(plans), others, range(len(plans)))


def _find_each(
    robot: Robot, planner: ArmPlanner, space: ArmSpace, starts: Array, goals: Sequence[Any], threads: int
) -> tuple[list[Goals], list[float]]:
    """The configurations of goals of any kind, and what time is left to each [s]."""
    ready: Sequence[Goals | None] = [None] * len(goals)
    is_endless = getattr(planner, "time_limit", inf) == inf
    if is_endless and isinstance(goals, np.ndarray) and _are_poses(goals, space.dof):
        ready = solve_each_pose(robot, space, starts, np.ascontiguousarray(goals), threads)
    sets, left = [], []
    for k, (goal, found) in enumerate(zip(goals, ready, strict=True)):
        search = GoalSearch(robot, planner, space, 0)
        sets.append(search.find(starts[k : k + 1], goal) if found is None else found)
        left.append(search.limit.left)
    return sets, left


def _are_poses(goals: Array, dof: int) -> bool:
    """Whether an array has the shape of poses (n, 4, 4), and not that of configurations of four joints."""
    return goals.dtype == np.float64 and goals.shape[1:] == (4, 4) and dof != POSE_ROWS


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
        return replace(found, reason=f"{found.reason}; {judge.basis} {verdict.reason}", stats=stats)
    reason = (
        f"a path of length {shown(found.cost)} is free for the spheres of the robot, but not for its meshes:"
        f" {verdict.reason}; plan with a larger margin, or cover the meshes more closely"
    )
    return replace(make_negative(found.space, planner, "undetermined", reason), stats=stats)


def _verify_plans(plans: Plans, planner: ArmPlanner, judge: MeshJudge) -> Plans:
    """Each of the plans as _verify_plan has it."""
    found = {k: _verify_plan(plans[k], planner, judge) for k in np.flatnonzero(plans.found).tolist()}
    return plans._replace(len(plans), found, range(len(plans)))


def _make_space(robot: Robot, scene: Scene | None, margin: float) -> ArmSpace:
    """The space of a robot; InputTypeError for what is not one."""
    if not isinstance(robot, Robot):
        raise InputTypeError(
            f"robot is {name_type(robot)}; it must be a cspace.Robot, such as cs.load_robot('panda')"
        )
    return ArmSpace(robot, scene, margin)
