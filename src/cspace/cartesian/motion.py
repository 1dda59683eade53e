"""Motions of the tip along lines, arcs and polylines: every branch followed, timed and compared."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from inspect import signature
from typing import TYPE_CHECKING, Any, Final, cast

import numpy as np
from numpy.typing import ArrayLike

from cspace.arrays import Array, one_array, one_number, truth_value
from cspace.cartesian.free_turn import find_free_turns, tool_axis
from cspace.cartesian.joint_branches import JointBranch, JointBranches
from cspace.cartesian.redundant_path import follow_poses
from cspace.cartesian.scene_check import Touch, find_touches, space_of_curves
from cspace.errors import InputError, InputTypeError, suggest
from cspace.kinematics import KinematicModel
from cspace.kinematics.batch import check_robot, find_pose, limits_of
from cspace.model import Limits
from cspace.spatial import as_pose
from cspace.spatial.checks import PoseLike, one_pose
from cspace.tables import count_things, one_line, shown, tabulate
from cspace.tolerances import (
    FARTHEST,
    LIMIT_ROUNDING,
    PATH_START,
    SHORTENED_PARTS,
    SHORTENED_WITHIN,
    SHORTEST_PATH_PIECE,
)
from cspace.trajectory.cartesian_makers import arc_path, is_repeated, pose_path
from cspace.trajectory.cartesian_path import CartesianPath, check_cartesian_path, stay_at
from cspace.trajectory.path import Path
from cspace.trajectory.time_parametrize import time_parametrize
from cspace.trajectory.timed_motion import TimedMotion, stand_still
from cspace.trajectory.timed_path import TimedPath

if TYPE_CHECKING:
    from cspace.collision import Scene
    from cspace.collision.checks import HasGeometry
    from cspace.planning import ArmSpace

RANKING_GRID: Final = 100
"""Intervals with which branches are compared: their durations are off by a few percent, alike for all."""

CLOSE_RANKING: Final = 0.05
"""Part of a duration on this grid by which the branches of a free turn may be in the wrong order: they are of
different shapes, and those so near to the fastest are timed exactly."""


@tabulate("cartesian", "branches", "s_end", "duration", "stopped_by", "reason")
class CartesianMotion(TimedMotion):
    """A motion of the joints that moves the tip along a Cartesian path; falsy where there is none.

    A TimedMotion, whose path has the parameter s of the Cartesian path. cartesian: that path. branches: all
    that were followed, with where and why the others end. chosen: the number of the one that is taken, or −1.
    durations (k,): of each branch on a coarse grid [s], inf where there is none, nan where none was needed.
    s_end: how far the tip goes. stopped_by: why a motion that goes as far as possible ends before the path
    does; empty if it arrives.
    """

    stopped_by: str = ""

    def __init__(
        self,
        timed: TimedPath,
        cartesian: CartesianPath,
        branches: Sequence[JointBranch],
        chosen: int,
        durations: Array,
    ) -> None:
        super().__init__(timed)
        self.cartesian, self.branches, self.chosen = cartesian, tuple(branches), chosen
        self.durations = durations
        self.s_end = max((branch.s_end for branch in branches), default=0.0)

    def __repr__(self) -> str:
        arrived = sum(map(bool, self.branches))
        branches = count_things(len(self.branches), "branch", "branches")
        text = f"{arrived} of {branches} along {shown(self.cartesian.length)}"
        part = f" up to {shown(self.s_end)}" if self.stopped_by else ""
        return one_line("CartesianMotion", f"{text}{part}, {self.reason or shown(self.duration) + ' s'}")


def move_cartesian(
    robot: KinematicModel,
    path: CartesianPath,
    start: ArrayLike | None = None,
    *,
    speed: float | None = None,
    turn_rate: float | None = None,
    feed: float | None = None,
    velocity: ArrayLike | None = None,
    acceleration: ArrayLike | None = None,
    jerk: ArrayLike | bool | None = None,
    torque: ArrayLike | bool | None = None,
    free_axis: str | ArrayLike | None = None,
    scene: Scene | None = None,
    margin: float = 0.0,
    limits: bool | Limits = True,
    tolerance: float = 1e-5,
    grid: int | None = None,
    as_far_as_possible: bool = False,
) -> CartesianMotion:
    """The fastest motion of the joints that moves the tip along a Cartesian path.

    Every branch of solutions is followed along the path, each that arrives is timed, and the fastest is
    taken. A redundant arm is planned along the whole path at once (follow_redundant).

    path: such as of line_path. start (dof,) [rad or m]: the configuration at its begin, whose branch alone
    is followed. speed [m/s], turn_rate [rad/s]: of the tip, at most; feed [m/s]: held where the limits
    allow it. velocity, acceleration, jerk, torque, grid: as of time_parametrize. free_axis: an axis of the
    tip about which it may turn freely ("z", or a direction (3,) in its frame), never slower than without.
    scene: obstacles; branches that touch them or the arm itself are left out, proved with `margin` [m] to
    spare. limits: True for those of the robot, False for none, or Limits. tolerance [m and rad]: the largest
    distance of the tip from the path, checked at five places of each piece of the joint path.
    as_far_as_possible: where no branch arrives, the motion along the part of the path that the farthest one
    follows; stopped_by says what ends it, and s_end where.

    Returns a CartesianMotion; falsy, with reason and place s, where no branch arrives, each touches
    something, or the limits cannot be kept. Near singular configurations the joints slow the tip down, and
    `binding` says which. Raises InputError for wrong shapes, NaN, and a start that is not on the path.
    """
    check_robot(robot)
    check_cartesian_path(path)
    axis = None if free_axis is None else tool_axis(free_axis)
    first = None if start is None else _check_start(robot, path, start, axis)
    if first is not None and (outside := _explain_outside(robot, first, limits)):
        return _refuse(robot, path, (), first, outside, 0.0)
    follow = _make_follower(robot, first, axis, limits, tolerance, scene is not None)
    found = follow(path)
    shortens, stopped_by, whole = truth_value(as_far_as_possible, "as_far_as_possible"), "", path
    if not found and shortens:
        stopped_by = found.reason
        path, found = _follow_part(path, follow, found)
    if not found:
        return _refuse_branches(robot, path, found)
    options: dict[str, Any] = {
        "velocity": velocity,
        "acceleration": acceleration,
        "jerk": jerk,
        "torque": torque,
        "speed": speed,
        "turn_rate": turn_rate,
        "feed": feed,
        "grid": grid,
    }
    space = None if scene is None else space_of_curves(cast("HasGeometry", robot), scene, margin)
    motion, touches = _take_fastest(robot, path, found.branches, options, space, axis is not None)
    if shortens and touches:
        motion, stopped_by = _stop_before(robot, motion, touches, options) or (motion, stopped_by)
    if stopped_by and motion:
        motion.cartesian, motion.stopped_by, motion.s_end = whole, stopped_by, motion.path.length
    return motion


def move_linear(
    robot: KinematicModel, goal: PoseLike, *, start: ArrayLike, **options: Any
) -> CartesianMotion:
    """The motion of the tip on a straight line to a pose, its rotation about a fixed axis.

    goal (4, 4): T_base_tip; that of the start gives a motion of zero length. start (dof,) [rad or m]: the
    present configuration, or a named pose. options: as of move_cartesian.
    """
    first = _read_call(robot, start, options, "move_linear")
    return _move_along_poses(robot, first, one_pose(goal, "goal pose")[None], options)


def move_arc(
    robot: KinematicModel,
    goal: PoseLike | None = None,
    *,
    start: ArrayLike,
    via: ArrayLike | None = None,
    center: ArrayLike | None = None,
    axis: ArrayLike | None = None,
    angle: float | None = None,
    rotation: str | None = None,
    **options: Any,
) -> CartesianMotion:
    """The motion of the tip on a circular arc: to a pose through a point, or about an axis by an angle.

    start (dof,) [rad or m]: the present configuration, or a named pose. goal, via, center, axis, angle,
    rotation: as of arc_path. options: as of move_cartesian.
    """
    first = _read_call(robot, start, options, "move_arc")
    if goal is None and angle is not None and one_number(angle, "angle") == 0.0:
        return _stay(robot, first, options)
    arc = arc_path(robot.fk(first), goal, via=via, center=center, axis=axis, angle=angle, rotation=rotation)
    return move_cartesian(robot, arc, first, **options)


def move_through(
    robot: KinematicModel,
    poses: ArrayLike,
    *,
    start: ArrayLike,
    deviation: float = 0.0,
    turn_deviation: float | None = None,
    **options: Any,
) -> CartesianMotion:
    """The motion of the tip on straight lines through poses, its corners blended.

    poses (n, 4, 4): T_base_tip, without that of the start. start (dof,) [rad or m]: the present
    configuration, or a named pose. deviation [m], turn_deviation [rad]: as of pose_path; 0 stops at each
    corner. options: as of move_cartesian.
    """
    first = _read_call(robot, start, options, "move_through")
    rows = as_pose(poses, "poses")
    if rows.ndim != 3:
        raise InputError(f"poses has shape {rows.shape}, expected (n, 4, 4)")
    corners = {"deviation": deviation, "turn_deviation": turn_deviation}
    return _move_along_poses(robot, first, rows, options, corners)


def _read_call(robot: KinematicModel, start: ArrayLike, options: dict[str, Any], function: str) -> Array:
    """The configuration of a start; InputTypeError for options that move_cartesian does not have."""
    check_robot(robot)
    known = set(signature(move_cartesian).parameters) - {"robot", "path", "start"}
    for name in options:
        if name not in known:
            raise InputTypeError(str(suggest("option", name, known, owner=function)))
    return _read_start(robot, start)


def _read_start(robot: KinematicModel, start: ArrayLike) -> Array:
    given = find_pose(robot, start)
    return one_array(given, "start", (len(robot.joint_names),), "one configuration", largest=FARTHEST)


def _move_along_poses(
    robot: KinematicModel, first: Array, T: Array, options: dict[str, Any], corners: Any = None
) -> CartesianMotion:
    """The motion from a configuration through poses (n, 4, 4); of zero length if it is at all of them."""
    begin = robot.fk(first)
    if all(is_repeated(begin, each) for each in T):
        return _stay(robot, first, options)
    path = pose_path(np.concatenate([begin[None], T]), **(corners or {}))
    return move_cartesian(robot, path, first, **options)


def _stay(robot: KinematicModel, q: Array, options: dict[str, Any]) -> CartesianMotion:
    """The motion of zero length at a configuration within the limits."""
    path = stay_at(robot.fk(q))
    if outside := _explain_outside(robot, q, options.get("limits", True)):
        return _refuse(robot, path, (), q, outside, 0.0)
    return CartesianMotion(stand_still(q, 1.0, "", np.nan, robot.joint_names), path, (), -1, np.zeros(0))


def _make_follower(
    robot: KinematicModel,
    start: Array | None,
    axis: Array | None,
    limits: bool | Limits,
    tolerance: float,
    has_scene: bool,
) -> Callable[[CartesianPath], JointBranches]:
    """The function that finds the branches along a path; axis (3,) of the tip, of a free turn."""
    if axis is None:
        return lambda path: follow_poses(robot, path, start, limits, tolerance)
    options: Any = {"limits": limits, "tolerance": tolerance, "always_searches": has_scene}
    return lambda path: find_free_turns(robot, path, axis, start, **options)


def _follow_part(
    path: CartesianPath, follow: Callable[[CartesianPath], JointBranches], found: JointBranches
) -> tuple[CartesianPath, JointBranches]:
    """The part of a path that can be followed, and its branches.

    It ends before the farthest branch does where rounding asks, or where a chain of stations ended it.
    """
    end = max((branch.s_end for branch in found.branches), default=0.0)

    def try_without(share: float) -> JointBranches | None:
        if not end * (1.0 - share) > SHORTEST_PATH_PIECE:
            return None
        return follow(path.part(end * (1.0 - share))) or None

    tried = ((share, try_without(share)) for share in SHORTENED_PARTS)
    high, best = next(((share, each) for share, each in tried if each), (1.0, None))
    if best is None:
        return path, found
    low = max((share for share in SHORTENED_PARTS if share < high), default=0.0)
    while high - low > SHORTENED_WITHIN:
        middle = 0.5 * (low + high)
        if followed := try_without(middle):
            high, best = middle, followed
        else:
            low = middle
    return path.part(end * (1.0 - high)), best


def _check_start(robot: KinematicModel, path: CartesianPath, start: ArrayLike, axis: Array | None) -> Array:
    """The start (dof,) at the first pose, up to a turn about an axis (3,) of the tip if there is one."""
    q = _read_start(robot, start)
    T, first = robot.fk(q), path(0.0)
    off = float(np.linalg.norm(T[:3, 3] - first[:3, 3]))
    apart = T[:3, :3] - first[:3, :3]
    turned = float(np.linalg.norm(apart) * np.sqrt(0.5) if axis is None else np.linalg.norm(apart @ axis))
    if max(off, turned) > PATH_START:
        raise InputError(
            f"start is {off:.3g} m and {turned:.3g} rad from the begin of the path; move there first, or"
            " leave start out"
        )
    return q


def _explain_outside(robot: KinematicModel, q: Array, limits: bool | Limits) -> str:
    """Which joint of a start is beyond its limits, in words; empty if none is."""
    bounds = limits_of(robot.limits, limits, robot.name)
    over = np.maximum(q - bounds.upper, bounds.lower - q)
    j = int(np.argmax(over))
    if over[j] <= LIMIT_ROUNDING * max(1.0, abs(q[j])):
        return ""
    return (
        f"at s = 0: {robot.joint_names[j]} of the start is {q[j]:.6g},"
        f" beyond its limits {bounds.lower[j]:.6g} … {bounds.upper[j]:.6g}"
    )


def _take_fastest(
    robot: KinematicModel,
    path: CartesianPath,
    branches: Sequence[JointBranch],
    options: dict[str, Any],
    space: ArmSpace | None,
    turns: bool,
) -> tuple[CartesianMotion, dict[int, Touch]]:
    """The motion along the fastest branch that touches nothing, or none and what each touches.

    turns: branches of a free turn that are nearly as fast on the coarse grid are timed exactly.
    """
    close = CLOSE_RANKING if turns else 0.0
    durations = np.full(len(branches), np.nan)
    arrived = [k for k, branch in enumerate(branches) if branch]
    refused: list[str] = []
    touches: dict[int, Touch] = {}
    if len(arrived) > 1:
        coarse = options | {"grid": RANKING_GRID}
        for k in arrived:
            timed = time_parametrize(_joints(branches[k]), robot, positions=False, **coarse)
            durations[k] = timed.duration if timed else np.inf
        arrived.sort(key=lambda k: durations[k])
    best: CartesianMotion | None = None
    for k in arrived:
        if best is not None and not durations[k] < (1.0 + close) * durations[best.chosen]:
            break
        joints = _joints(branches[k])
        if space is not None and (found := find_touches(space, joints, first=True)):
            touches[k] = found[0]
            refused.append(_say_where(found[0]))
            continue
        timed = time_parametrize(joints, robot, positions=False, **options)
        if not timed:
            refused.append(timed.reason)
        elif best is None or timed.duration < best.duration:
            best = CartesianMotion(timed, path, branches, k, durations)
    if best is not None:
        return best, {}
    q = _joints(branches[arrived[0]]).start
    reason = "; ".join(dict.fromkeys(refused))
    farthest = max((touch.s for touch in touches.values()), default=np.nan)
    return _refuse(robot, path, branches, q, reason, farthest, durations), touches


def _stop_before(
    robot: KinematicModel, refused: CartesianMotion, touches: dict[int, Touch], options: dict[str, Any]
) -> tuple[CartesianMotion, str] | None:
    """The motion along the branch that is free farthest, up to what it touches, and that; None from there."""
    k, touch = max(touches.items(), key=lambda each: each[1].s)
    if not touch.s > SHORTEST_PATH_PIECE:
        return None
    joints = _joints(refused.branches[k]).part(touch.s)
    timed = time_parametrize(joints, robot, positions=False, **options)
    motion = CartesianMotion(timed, refused.cartesian, refused.branches, k, refused.durations)
    return motion, _say_where(touch)


def _say_where(touch: Touch) -> str:
    return f"at s = {touch.s:.6g}: {touch.text}"


def _joints(branch: JointBranch) -> Path:
    assert branch.path is not None
    return branch.path


def _refuse_branches(robot: KinematicModel, path: CartesianPath, found: JointBranches) -> CartesianMotion:
    """No motion, as no branch arrives: it stays at the start of the first."""
    place = max((branch.s_end for branch in found.branches), default=0.0)
    q = found.branches[0].q_start if found.branches else np.zeros(robot.dof)
    return _refuse(robot, path, found.branches, q, found.reason, place)


def _refuse(
    robot: KinematicModel,
    path: CartesianPath,
    branches: Sequence[JointBranch],
    q: Array,
    reason: str,
    place: float,
    durations: Array | None = None,
) -> CartesianMotion:
    """No motion: it stays at q."""
    timed = stand_still(q, path.length or 1.0, reason, place, robot.joint_names)
    none = np.full(len(branches), np.inf) if durations is None else durations
    return CartesianMotion(timed, path, branches, -1, none)
