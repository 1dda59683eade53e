"""The words around inverse kinematics: what is asked, whether it makes sense, who answers."""

from __future__ import annotations

import os
from typing import Any, cast

import numpy as np
import numpy.typing as npt

from cspace import _core
from cspace.arrays import Array, as_floats, leading_axes
from cspace.errors import InputError, InputTypeError
from cspace.ik.about import About
from cspace.ik.conditions import NoClosedFormError
from cspace.ik.partial import KEYWORDS, PartialGoal, check_tool_axis, is_open, partial_goal
from cspace.ik.prepare import check_chain, prepare
from cspace.ik.solutions import NEAREST, Solutions, position_goal
from cspace.ik.solutions_batch import SolutionsBatch
from cspace.ik.solve_partial import own_columns, solve_partial
from cspace.ik.windings import wrap
from cspace.kinematics.batch import check_robot
from cspace.spare import spare_array
from cspace.spatial import as_pose
from cspace.tolerances import FARTHEST

__all__ = ["inverse_kinematics"]

MOST_THREADS = 1024
MAX_POSITION_JOINTS = 3
Counts = npt.NDArray[np.int64]
Verdicts = npt.NDArray[np.uint8]


def inverse_kinematics(
    robot: Any,
    goal: Any = None,
    *,
    position: Any = None,
    rotation: Any = None,
    direction: Any = None,
    look_at: Any = None,
    ray: Any = None,
    angle_to: Any = None,
    tool_axis: Any = "z",
    angle: Any = None,
    near: Any = None,
    fixed: Any = None,
    swivel: Any = None,
    samples: int | None = None,
    least_squares: bool = False,
    threads: int | None = None,
) -> Solutions | SolutionsBatch:
    """Every configuration q with fk(q) = goal.

    goal: T_base_tip, (4, 4) or (..., 4, 4), or anything `as_pose` takes. Instead of it, parts of a pose,
    alone or together: position: of the tip [m], (3,) or (..., 3), None for coordinates that do not matter,
    or (..., 2) for an arm in the plane; rotation (3, 3); direction (3,): where the tool axis points.
    position goes with rotation, direction, angle_to=(axis of the base, angle to it of the tool axis [rad]),
    and in the plane with angle: of the tip [rad]. look_at (3,): a point on the tool axis, ahead of the tip.
    ray=(p, d): the line through p along d on which the tool axis lies. tool_axis: "x", "y", "z", "-z" or a
    direction in the tip.

    near: (dof,), a configuration; the answer is the one solution nearest to it, and joints that the pose
    leaves free take its values. fixed: joints held at given values, by name or number, {"joint7": 0.3};
    arrays of values are solved together with the goals. swivel: of an arm with two spherical joints, the
    angle of its elbow about the line from shoulder to wrist [rad] (see `cs.ik.swivel`), or an array.
    samples: of an arm with one joint to spare, at how many values of it the branches are listed (16 unless
    given). least_squares: where nothing reaches the goal, answer with the configuration that misses it least
    (a radian weighs like the arm's characteristic length). threads: for a batch, all cores unless given; the
    answer does not depend on it.

    An arm with more than six joints, or some of which do the work of others, leaves freedom, which
    `freedom` of the answer names. With fixed= for all of the joints to spare every solution of the others is
    listed; with near= the nearest of all configurations, limits aside; else, with one joint to spare, all
    branches at values of it spread over its feasible intervals, and with more the configuration nearest to
    the middle of the limits.

    Returns `Solutions` for one goal, `SolutionsBatch` for many. An unreachable goal is an answer (falsy,
    with the reason); a goal that is no pose raises InputError; joints that mimic others, a floating base or
    more than sixteen joints raise NoClosedFormError.
    """
    check_robot(robot)
    workers = count_of_threads(threads)
    if not isinstance(least_squares, (bool, np.bool_)):
        raise InputTypeError(f"least_squares must be True or False, got {type(least_squares).__name__}")
    if angle is not None:
        goal, position = planar_poses(robot, goal, position, angle), None
    named = (position, rotation, direction, look_at, ray, angle_to)
    given = {name: value for name, value in zip(KEYWORDS, named, strict=True) if value is not None}
    check_tool_axis(tool_axis, given)
    if (goal is None) == (not given):
        raise InputTypeError(
            "ik needs one goal: robot.ik(T) with the pose of the tip in the base, or parts of it by name,"
            " such as robot.ik(position=p)"
        )
    if given and (fixed is not None or samples is not None or swivel is not None):
        raise InputTypeError("fixed=, swivel= and samples= go with a full pose")
    found: Solutions | SolutionsBatch
    if given and not is_plain_position(robot, given):
        found = ask_partial(robot, partial_goal(given, tool_axis), workers, near)
    elif position is not None:
        prepare(robot)
        p = points_in_base(robot, position)
        found = _core._ik_position(robot, p) if p.ndim == 1 else solve_positions(robot, p, workers)
    else:
        prepare(robot)
        T = goal_array(goal)
        if swivel is not None:
            if fixed is not None or samples is not None or least_squares:
                raise InputTypeError("swivel= goes with near= alone: it holds what is to spare")
            return at_swivel(robot, T, swivel, near)
        if fixed is not None or samples is not None or not robot._ik_direct:
            return redundant(robot, T, fixed, samples, near, least_squares, workers)
        found = solve_many(robot, T, workers) if T.ndim > 2 else solve_one(robot, T, near)
    if isinstance(found, SolutionsBatch):
        if near is not None or least_squares:
            raise InputTypeError("near= and least_squares= are for one goal; a batch has .nearest(q)")
        return found
    if least_squares and not found:
        return least_squares_answer(robot, found)
    return found if near is None else found.nearest(near)


def at_swivel(robot: Any, T: Array, swivel: Any, near: Any) -> Solutions | SolutionsBatch:
    from cspace.ik.swivel import solve_swivel

    return solve_swivel(robot, checked_poses(T), swivel, near)


def checked_poses(T: Array) -> Array:
    """Poses that may have come unchecked, none of them too far away."""
    T = as_pose(T, "goal")
    if len(beyond := np.argwhere(is_far(T[..., :3, 3]))):
        index = tuple(map(int, beyond[0]))
        raise too_far(f"goal {index}" if index else "goal", T[index][:3, 3])
    return T


def redundant(
    robot: Any, T: Array, fixed: Any, samples: Any, near: Any, least_squares: bool, workers: int
) -> Solutions | SolutionsBatch:
    from cspace.ik.redundant import redundant_answer

    found = redundant_answer(
        robot, checked_poses(T), fixed=fixed, samples=samples, near=near, threads=workers
    )
    if isinstance(found, SolutionsBatch):
        if least_squares:
            raise InputTypeError("least_squares= is for one goal")
        return found
    if least_squares and not found:
        if fixed:
            raise InputTypeError("least_squares= does not go with fixed=: it moves every joint")
        return least_squares_answer(robot, found)
    return found


def is_plain_position(robot: Any, given: dict[str, Any]) -> bool:
    """Whether a goal is a whole point for an arm of up to three joints, which are solved directly."""
    short = len(robot.chain.joint_types) <= MAX_POSITION_JOINTS
    return short and list(given) == ["position"] and not is_open(given["position"])


def ask_partial(robot: Any, goal: PartialGoal, workers: int = 1, near: Any = None) -> Any:
    def ask(whole: Any, T: Array) -> Solutions | SolutionsBatch:
        prepare(whole)
        if not whole._ik_direct:
            seed = None if near is None else near_of_whole(robot, goal, whole, near)
            return redundant(whole, T, None, None, seed, False, workers)
        return solve_many(whole, T, workers) if T.ndim > 2 else solve_one(whole, T, None)

    check_chain(robot)
    return solve_partial(robot, goal, ask)


def near_of_whole(robot: Any, goal: PartialGoal, whole: Any, near: Any) -> Array:
    """A configuration of the arm with zeros for the joints that stand for what the goal leaves open."""
    seed = as_floats(near, "near", last=(robot.dof,), largest=FARTHEST)
    out = np.zeros((*seed.shape[:-1], whole.dof))
    out[..., own_columns(robot, goal)] = seed
    return out


def points_in_base(robot: Any, position: Any) -> Array:
    """Points in the base (..., 3); points of the plane (..., 2) are lifted to the height that a planar arm
    keeps.
    """
    if len(robot.chain.joint_types) > MAX_POSITION_JOINTS:
        raise NoClosedFormError(
            f"position goals are for arms of up to {MAX_POSITION_JOINTS} joints; {robot.name} has "
            f"{len(robot.chain.joint_types)}, which leaves freedom: give a full pose"
        )
    p = as_floats(position, "position")
    if p.ndim > 0 and p.shape[-1] == 2:
        p = lifted(robot, p)
    if p.ndim == 0 or p.shape[-1] != 3:
        raise InputError(
            f"position has shape {p.shape}, expected (..., 3), or (..., 2) for an arm in the plane"
        )
    if p.ndim == 1 and is_far(p):
        raise too_far("position", p)
    return np.ascontiguousarray(p)


def planar_poses(robot: Any, goal: Any, position: Any, angle: Any) -> Array:
    """Poses of an arm in the plane from points (..., 2) and angles (...) of the tip's x axis."""
    if goal is not None or position is None:
        raise InputTypeError("angle= goes with position=(x, y), the place of the tip of an arm in the plane")
    p = as_floats(position, "position", last=(2,), largest=FARTHEST)
    T_zero = robot.chain.T_zero
    turn = as_floats(angle, "angle", largest=FARTHEST) - np.arctan2(T_zero[1, 0], T_zero[0, 0])
    p = lifted(robot, p)
    T = np.zeros((*leading_axes(position=p.shape[:-1], angle=turn.shape), 4, 4))
    T[..., 0, 0] = T[..., 1, 1] = np.cos(turn)
    T[..., 1, 0] = np.sin(turn)
    T[..., 0, 1] = -T[..., 1, 0]
    T[..., 2, 2] = T[..., 3, 3] = 1.0
    T[..., :3, :3] = T[..., :3, :3] @ T_zero[:3, :3]
    T[..., :3, 3] = p
    return T


def lifted(robot: Any, p: Array) -> Array:
    """Points (..., 2) of the plane z = constant in which an arm keeps its tip, as points (..., 3)."""
    chain = robot.chain
    turns = np.array([kind == "R" for kind in chain.joint_types])
    in_plane = np.where(turns, np.abs(chain.axes[:, 2]) > 1 - 1e-12, np.abs(chain.axes[:, 2]) < 1e-6)
    if not in_plane.all():
        raise InputError(
            f"position has shape {p.shape}, but {robot.name} does not move in a plane z = constant"
        )
    return np.concatenate([p, np.full((*p.shape[:-1], 1), chain.T_zero[2, 3])], axis=-1)


def goal_array(goal: Any) -> Array:
    """The goals as contiguous float64; a plain batch goes on unchecked, for the core checks every goal
    itself.
    """
    if type(goal) is np.ndarray and goal.dtype == np.float64 and goal.ndim > 2 and goal.shape[-2:] == (4, 4):
        return np.require(goal, requirements=["C", "A"])
    return np.require(as_pose(goal, "goal"), requirements=["C", "A"])


def solve_one(robot: Any, T: Array, near: Any) -> Solutions:
    if near is None:
        found = _core._ik_single(robot, T)
        if found is None:
            raise too_far("goal", T[:3, 3])
        return cast(Solutions, found)
    seed = as_floats(near, "near", last=(robot.dof,), largest=FARTHEST)
    if seed.ndim != 1:
        raise InputError(f"near has shape {seed.shape}, expected ({robot.dof},): one configuration")
    if is_far(T[:3, 3]):
        raise too_far("goal", T[:3, 3])
    return cast(Solutions, _core._ik_careful(robot, T, np.ascontiguousarray(seed)))


def is_far(p: Array) -> Any:
    """Whether points (..., 3) lie too far away, (...); sums that no float64 holds are not formed."""
    return np.minimum(np.abs(p), 2 * FARTHEST).sum(axis=-1) > FARTHEST


def too_far(subject: str, p: Array) -> InputError:
    return InputError(f"{subject} lies at {p.tolist()} m; goals up to {FARTHEST:g} m away make sense")


def count_of_threads(threads: int | None) -> int:
    if threads is None:
        return os.cpu_count() or 1
    if isinstance(threads, bool) or not isinstance(threads, (int, np.integer)):
        raise InputTypeError(
            f"threads is a {type(threads).__name__}, expected a number or None for all cores"
        )
    if not 1 <= threads <= MOST_THREADS:
        raise InputError(f"threads is {threads}, expected 1 to {MOST_THREADS}, or None for all cores")
    return int(threads)


def solve_many(robot: Any, T: Array, workers: int) -> SolutionsBatch:
    leading = T.shape[:-2]
    answers = room_for(robot, leading)
    bad = _core._ik_many(robot, T.reshape(-1, 4, 4), *answers, workers)
    if bad < len(answers[0]):
        as_pose(T, "goal")  # finds the words for what is wrong
        index = tuple(map(int, np.unravel_index(bad, leading)))
        raise too_far(f"goal {index}", T[index][:3, 3])
    return shaped(robot, T, leading, answers)


def solve_positions(robot: Any, p: Array, workers: int) -> SolutionsBatch:
    leading = p.shape[:-1]
    answers = room_for(robot, leading)
    bad = _core._ik_positions(robot, p.reshape(-1, 3), *answers, workers)
    if bad < len(answers[0]):
        index = tuple(map(int, np.unravel_index(bad, leading)))
        raise too_far(f"position {index}", p[index])
    return shaped(robot, p, leading, answers)


def room_for(robot: Any, leading: tuple[int, ...]) -> tuple[Array, Counts, Verdicts]:
    """Arrays for the answers to n goals: q (n, k_max, dof), count (n,), verdict (n,)."""
    n = int(np.prod(leading))
    q = spare_array((n, robot._ik_room, robot.dof))
    return q, np.empty(n, dtype=np.int64), np.empty(n, dtype=np.uint8)


def shaped(
    robot: Any, goal: Array, leading: tuple[int, ...], answers: tuple[Array, Counts, Verdicts]
) -> SolutionsBatch:
    q, count, verdict = answers
    q = q.reshape(*leading, robot._ik_room, robot.dof)
    return SolutionsBatch(robot, goal, q, count.reshape(leading), verdict.reshape(leading))


def least_squares_answer(robot: Any, found: Solutions) -> Solutions:
    goal = found.goal
    if found._partial is not None:
        return least_squares_partial(robot, found)
    if goal.shape == (3,):
        q, missing = _core._ik_position_miss(robot, goal)
        goal, text = position_goal(goal), f"{missing:.4g} m"
    else:
        q, away, turned = _core._ik_miss(robot, goal, 1.0)
        text = f"{away:.4g} m and {np.degrees(turned):.4g}°"
    q = wrap(q, robot.joint_types)
    note = f"nothing reaches the goal; the nearest configuration misses it by {text}"
    return cast(Solutions, _core._ik_make(robot, goal, NEAREST, q[None, :], (-1,), (False,), note))


def least_squares_partial(robot: Any, found: Solutions) -> Solutions:
    """The nearest configuration of the longer arm, without the goal's joints."""
    about, goal = found._about, found._partial
    q, away, turned = _core._ik_miss(about.whole, found.goal, 1.0)
    q = wrap(q, about.whole.joint_types)[None]
    note = (
        f"nothing reaches {goal.text}; the nearest configuration misses it by {away:.4g} m and "
        f"{np.degrees(turned):.4g}°"
    )
    own = np.ascontiguousarray(q[:, own_columns(robot, goal)])
    about = About(goal, about.whole, q, about.freedom)
    return cast(Solutions, _core._ik_make(robot, found.goal, NEAREST, own, (-1,), (False,), note, about))
