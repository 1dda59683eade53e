"""From a configuration to a goal in time: plan, rounded corners, timing, torques, and a check of the
result."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, Final

import numpy as np
from numpy.typing import ArrayLike

from cspace.arrays import Array, bounded_number, shape_of
from cspace.cartesian.scene_check import bound_bends, find_touches, space_of_curves
from cspace.collision import Scene
from cspace.collision.checks import collides
from cspace.errors import InputError, InputTypeError
from cspace.plan_motion.goals import GoalLike
from cspace.plan_motion.plans import Seed, plan
from cspace.planning import ArmPlanner, ArmSpace, Plan
from cspace.planning.space import are_names
from cspace.robot import Robot
from cspace.tables import one_line, shown, tabulate
from cspace.tolerances import LEAST_DEVIATION, MOTION_CHECK_EXCESS, MOTION_CHECK_STEP, PATH_CURVED
from cspace.trajectory import Path, TimedPath, blend, time_parametrize
from cspace.trajectory.timed_motion import TimedMotion, stand_still

MOST_CHECKED: Final = 20_000
"""Of them; a longer motion is checked in larger steps."""


OF_OTHERS: Final = {
    "feed": "speed= limits the speed of the tip; move_linear and its like hold a feed",
    "duration": "scaled(factor) of the motion makes it slower; move_to takes a duration",
    "cycle": "move_to takes it, without a plan",
    "profile": "move_to takes it, without a plan",
    "frame": "speed= and turn_rate= are those of the tip; time_parametrize takes a frame",
    "grid": "time_parametrize takes it",
}
"""Keywords of other functions that make motions, and what goes in their place."""


@tabulate("duration", "plan", "deviations", "checked")
class Motion(TimedMotion):
    """A motion to a goal; falsy where there is none.

    A TimedMotion. plan: the Plan whose corners were rounded. deviations (k,): how far from each corner the
    path may pass [rad or m]; 0 where it stops. checked: the number of configurations that were looked at once
    more, and none touched anything.
    """

    def __init__(self, timed: TimedPath, found: Plan, deviations: Array, checked: int) -> None:
        super().__init__(timed)
        self.plan, self.deviations, self.checked = found, deviations, checked

    def __repr__(self) -> str:
        text = (
            f"{shown(self.duration)} s, {len(self.plan.path)} corners, {self.checked} configurations checked"
        )
        return one_line("Motion", self.reason or text)


def move(
    robot: Robot,
    start: ArrayLike,
    goal: GoalLike,
    scene: Scene | None = None,
    *,
    deviation: float = 0.2,
    velocity: ArrayLike | None = None,
    acceleration: ArrayLike | None = None,
    jerk: ArrayLike | bool | None = None,
    torque: ArrayLike | bool | None = None,
    speed: float | None = None,
    turn_rate: float | None = None,
    planner: str | ArmPlanner = "rrt_connect",
    margin: float = 0.0,
    rng: Seed = 0,
    **options: Any,
) -> Motion:
    """The motion of a robot to a goal around obstacles, as fast as its limits allow.

    A free way is planned, its corners are rounded, the path is timed, and the result is checked once more
    against the scene and all limits, at times along it.

    start (dof,) [rad or m], or a named pose. goal, scene, planner, margin, rng, options: as of plan.
    deviation [rad or m, L2 norm]: how far the motion may pass from the corners of the plan; less where
    something is near, and it stops at corners that cannot be rounded. Straight legs are proved by the plan,
    and rounded corners with 0.3 mm and more to spare. velocity, acceleration, jerk, torque, speed, turn_rate:
    as of time_parametrize; torque=True takes the efforts of the robot.

    Returns a Motion, of zero length where the start is the goal; falsy, with reason, where no way was found
    or the limits cannot be kept. Raises as plan and time_parametrize do.
    """
    bounded_number(deviation, "deviation", 0.0, "it must be 0 or more")
    for name in options.keys() & OF_OTHERS.keys():
        raise InputTypeError(f"move has no {name}=; {OF_OTHERS[name]}")
    if not isinstance(start, str) and (are_names(start) or len(shape_of(start, "start")) > 1):
        raise InputError(
            f"start has shape {shape_of(start, 'start')}; give one configuration (dof,) or named pose: plan"
            " chooses among several, and time_plan times its answer"
        )
    found = plan(robot, start, goal, scene, planner=planner, margin=margin, rng=rng, **options)
    limits: dict[str, Any] = {
        "velocity": velocity,
        "acceleration": acceleration,
        "jerk": jerk,
        "torque": torque,
        "speed": speed,
        "turn_rate": turn_rate,
    }
    return time_plan(robot, found, scene, deviation=deviation, margin=margin, **limits)


def time_plan(
    robot: Robot,
    found: Plan,
    scene: Scene | None = None,
    *,
    deviation: float = 0.2,
    margin: float = 0.0,
    **limits: Any,
) -> Motion:
    """The motion along a plan: what move does after planning.

    found: of this robot, scene and margin. deviation: as of move. limits: as of time_parametrize.
    """
    allowed = bounded_number(deviation, "deviation", 0.0, "it must be 0 or more")
    if not found:
        return _refuse(robot, found, found.reason)
    if len(found.path) < 2 or found.cost == 0.0:
        return _refuse(robot, found, "")  # the start is the goal: a motion of zero length
    path, deviations = round_corners(robot, found.path, scene, margin, allowed)
    timed = time_parametrize(path, robot, positions=False, **limits)
    if not timed:
        return Motion(timed, found, deviations, 0)
    checked, fault = check_once_more(robot, timed, scene, limits)
    if fault:
        return _refuse(robot, found, fault)
    return Motion(timed, found, deviations, checked)


def round_corners(
    robot: Robot, corners: Array, scene: Scene | None, margin: float, deviation: float
) -> tuple[Path, Array]:
    """The path with rounded corners that are proved free, and the deviation of each (k,)."""
    allowed = np.full(len(corners), deviation)
    space: ArmSpace = space_of_curves(robot, scene, margin)
    checked: set[tuple[int, float]] = set()
    while True:
        path = blend(corners, allowed)
        curved = bound_bends(path) > PATH_CURVED
        nearest = _corner_of_pieces(path, corners)
        for k in np.flatnonzero(curved):
            curved[k] = (int(nearest[k]), float(allowed[nearest[k]])) not in checked
        touches = {touch.piece for touch in find_touches(space, path, curved)}
        if not touches:
            return path, allowed
        for k in np.flatnonzero(curved):
            i = int(nearest[k])
            if k in touches:
                allowed[i] = 0.5 * allowed[i] if allowed[i] > 2.0 * LEAST_DEVIATION else 0.0
            else:
                checked.add((i, float(allowed[i])))


def _corner_of_pieces(path: Path, corners: Array) -> Any:
    """The number (k,) of the inner corner that is nearest to the middle of each piece."""
    middle = path.evaluate_pieces(np.arange(len(path)), np.full(len(path), 0.5))
    if len(corners) < 3:
        return np.zeros(len(path), dtype=int)
    gaps = np.linalg.norm(middle[:, None] - corners[None, 1:-1], axis=2)
    return 1 + np.argmin(gaps, axis=1)


def check_once_more(
    robot: Robot, timed: TimedPath, scene: Scene | None, limits: dict[str, Any]
) -> tuple[int, str]:
    """How many times of a motion were checked for contacts and limits, and what is wrong, if anything.

    limits: as of time_parametrize, by name.
    """
    count = int(np.clip(np.ceil(timed.duration / MOTION_CHECK_STEP), 1, MOST_CHECKED)) + 1
    t = np.linspace(0.0, timed.duration, count)
    q = timed(t)
    touching = np.flatnonzero(collides(robot, q, scene))
    if touching.size:
        return (
            count,
            f"the motion touches something at {t[touching[0]]:.6g} s, though its parts were proved free",
        )
    return count, find_excess(robot, timed, t, q, limits)


def find_excess(robot: Robot, timed: TimedPath, t: Array, q: Array, limits: dict[str, Any]) -> str:
    """The first limit that a motion exceeds at times t (k,), where it is at q (k, dof), in words.

    limits: as of check_once_more. What they limit is computed anew, by derivatives and the robot's model.
    """
    for name, share in _shares_of_limits(robot, timed, t, q, limits):
        exceeded = np.argwhere(share > 1.0 + MOTION_CHECK_EXCESS)
        if exceeded.size:
            i, j = exceeded[0]
            joint = robot.joint_names[j] if share.shape[1] == robot.dof else "the tip"
            return f"{joint} exceeds its {name} limit at {t[i]:.6g} s, {share[i, j]:.6g} times, by a check"
    return ""


def _shares_of_limits(
    robot: Robot, timed: TimedPath, t: Array, q: Array, limits: dict[str, Any]
) -> Iterator[tuple[str, Array]]:
    """Name and shares (k, n) of every limit, of the joints or the tip."""
    own = robot.limits
    yield "position", 1.0 + np.maximum(q - own.upper, own.lower - q)
    rates = {1: timed(t, 1), 2: timed(t, 2)}
    for order, name in enumerate(("velocity", "acceleration", "jerk"), start=1):
        given = limits.get(name)
        if name == "jerk" and (given is None or given is False):
            continue
        limit = getattr(own, name) if given is None or given is True else np.broadcast_to(given, robot.dof)
        values = np.abs(rates[order] if order in rates else timed(t, order))
        yield name, _divide(values, limit)
    torque, speeds = limits.get("torque"), (limits.get("speed"), limits.get("turn_rate"))
    if torque is not None and torque is not False:
        tau = np.abs(robot.inverse_dynamics(q, rates[1], rates[2]))
        yield "torque", _divide(tau, own.effort if torque is True else np.broadcast_to(torque, robot.dof))
    if any(speed is not None for speed in speeds):
        twist = np.einsum("kij,kj->ki", robot.jacobian(q), rates[1])
        for name, limit, part in zip(("speed", "turn_rate"), speeds, (slice(3), slice(3, 6)), strict=True):
            if limit is not None:
                yield name, np.linalg.norm(twist[:, part], axis=1)[:, None] / float(limit)


def _divide(values: Array, limit: Any) -> Array:
    """Shares (k, n) of limits (n,); where they are zero time_parametrize lets nothing move."""
    shares: Array = np.where(limit == 0.0, 0.0, values) / np.where(limit == 0.0, 1.0, limit)
    return shares


def _refuse(robot: Robot, found: Plan, reason: str) -> Motion:
    """No motion: it stays at the start."""
    q = found.path[0] if len(found.path) else np.zeros(robot.dof)
    timed = stand_still(q, 1.0, reason, np.nan, robot.joint_names)
    return Motion(timed, found, np.zeros(len(found.path)), 0)
