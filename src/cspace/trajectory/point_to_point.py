"""Point to point: the motion of a robot from one configuration to another."""

from __future__ import annotations

from typing import Any, Final

import numpy as np
from numpy.typing import ArrayLike

from cspace.arrays import Array, one_number
from cspace.errors import InputError, InputTypeError, check_known
from cspace.kinematics import KinematicModel, require_limits
from cspace.kinematics.batch import check_robot, find_pose, limits_of
from cspace.model import Limits
from cspace.trajectory.limit_check import Violation
from cspace.trajectory.polynomials import PolynomialTrajectory
from cspace.trajectory.state_to_state import (
    SYNCHRONIZE,
    TrajectoryBatch,
    move_plain_states,
    state_to_state,
)
from cspace.trajectory.states import read_duration, read_states
from cspace.trajectory.time_scaling import BOUNDARY_ORDERS, connect_states, find_duration

PROFILES: Final = ("double_s", "trapezoidal", *BOUNDARY_ORDERS)
"""The laws of motion of `move_to`."""


def move_to(
    robot: KinematicModel,
    q_goal: ArrayLike,
    *,
    start: ArrayLike,
    profile: str = "double_s",
    duration: float | None = None,
    cycle: float | None = None,
    velocity: ArrayLike | None = None,
    acceleration: ArrayLike | None = None,
    jerk: ArrayLike | None = None,
    start_velocity: ArrayLike | None = None,
    start_acceleration: ArrayLike | None = None,
    goal_velocity: ArrayLike | None = None,
    goal_acceleration: ArrayLike | None = None,
    synchronize: str = "time",
    limits: bool | Limits = True,
) -> PolynomialTrajectory:
    """The motion from one configuration to another, in the shortest time that a profile allows.

    q_goal, start (n,): configurations [rad or m], or named poses; revolute joints are not moved by multiples
    of 2π. profile: "double_s" (limited jerk, see state_to_state), "trapezoidal" (limited acceleration), or
    one polynomial per joint: "cubic", "quintic" or "minimum_jerk", "septic". duration [s]: in place of the
    shortest. cycle [s]: of which the duration is to be a multiple. velocity, acceleration, jerk () or (n,):
    in place of the limits of the robot; polynomials need no jerk limit, and with a duration none at all.
    start_velocity, start_acceleration, goal_velocity, goal_acceleration (n,): zero unless given; trapezoidal
    and cubic motions attain no accelerations. synchronize: as in state_to_state. limits: of position, True
    for those of the robot, False for none, or Limits.

    Returns a PolynomialTrajectory. It is falsy, with a reason, where the motion leaves the limits of
    position, where a polynomial exceeds a limit in the duration that was asked for or in every duration, and
    where double-S or trapezoidal motions do not exist in that duration; the motion then has the next possible
    one. Raises InputError for limits that are missing, by name, and as state_to_state.

    Biagiotti and Melchiorri 2008, chapters 2 and 3.
    """
    check_robot(robot)
    start, q_goal = find_pose(robot, start), find_pose(robot, q_goal)
    check_known("profile", profile, PROFILES)
    check_known("synchronize", synchronize, SYNCHRONIZE)
    kept = limits_of(robot.limits, limits, robot.name)
    given = {"velocity": velocity, "acceleration": acceleration, "jerk": jerk}
    if profile == "double_s" and synchronize == "time" and duration is cycle is None:
        most = tuple(_choose_limit(robot, kind, value) for kind, value in given.items())
        made = move_plain_states(
            (start, start_velocity, start_acceleration, q_goal, goal_velocity, goal_acceleration),
            most,
            robot.joint_names,
            (kept.lower, kept.upper),
        )
        if made is not None:
            if not made[1]:
                made[0].reason = find_position_violation(made[0], kept)
            return made[0]
    n = len(robot.joint_names)
    first = read_states(start, start_velocity, start_acceleration, "start", n)
    last = read_states(q_goal, goal_velocity, goal_acceleration, "goal", n)
    if first.ndim != 2 or last.ndim != 2:
        raise InputError("move_to makes one motion; trajectory.state_to_state takes batches of states")
    if profile in BOUNDARY_ORDERS:
        if synchronize != "time":
            raise InputTypeError(
                f"synchronize={synchronize!r} does not go with {profile}; use profile='double_s'"
            )
        motion = fit_polynomials(robot, first, last, profile, given, duration, cycle)
    else:
        motion = fit_phases(robot, first, last, profile, given, duration, cycle, synchronize)
    if motion:
        motion.reason = find_position_violation(motion, kept)
    return motion


def _choose_limit(robot: KinematicModel, kind: str, given: Any) -> Any:
    """A limit that is given, or that of the robot."""
    own = getattr(robot.limits, kind) if given is None else given
    return require_limits(robot, kind) if given is None and own.max() == np.inf else own


def fit_phases(
    robot: KinematicModel,
    first: Array,
    last: Array,
    profile: str,
    given: dict[str, Any],
    duration: float | None,
    cycle: float | None,
    synchronize: str,
) -> PolynomialTrajectory:
    """A double-S or trapezoidal motion between states (3, n)."""
    kinds: tuple[str, ...] = ("velocity", "acceleration", "jerk")
    if profile == "trapezoidal":
        if given["jerk"] is not None:
            raise InputTypeError("jerk= does not go with trapezoidal; use profile='double_s'")
        if first[2].any() or last[2].any():
            raise InputTypeError("accelerations at the ends do not go with trapezoidal; use 'double_s'")
        kinds = kinds[:2]
    most: dict[str, Any] = {kind: require_limits(robot, kind, given[kind]) for kind in kinds}
    motion = state_to_state(
        first[0],
        last[0],
        start_velocity=first[1],
        start_acceleration=first[2],
        goal_velocity=last[1],
        goal_acceleration=last[2],
        duration=duration,
        cycle=cycle,
        synchronize=synchronize,
        joint_names=robot.joint_names,
        **most,
    )
    if isinstance(motion, TrajectoryBatch):
        raise InputError("duration must be one number")
    return motion


def fit_polynomials(
    robot: KinematicModel,
    first: Array,
    last: Array,
    profile: str,
    given: dict[str, Any],
    duration: float | None,
    cycle: float | None,
) -> PolynomialTrajectory:
    """One polynomial per joint between states (3, n)."""
    if duration is not None and cycle is not None:
        raise InputTypeError("duration= and cycle= do not go together; give one of them")
    m, names = BOUNDARY_ORDERS[profile], robot.joint_names
    if m == 2 and (first[2].any() or last[2].any()):
        raise InputTypeError("accelerations at the ends do not go with cubic; use profile='quintic'")
    states = np.zeros((2, m, first.shape[1]))
    states[0, :3], states[1, :3] = first[:m], last[:m]
    bounds = gather_limits(robot, given, duration is None)
    if duration is not None:
        moves = bool((states[0] != states[1]).any() or states[:, 1:].any())
        is_nothing = one_number(duration, "duration") == 0.0 and not moves
        h = 0.0 if is_nothing else read_duration(duration, "duration") or 0.0
        possible = True
    else:
        h, possible = find_duration(profile, states, bounds, names, read_duration(cycle, "cycle"))
    motion = connect_states(states, h, names)
    motion.reason = motion.check(bounds).reason
    if not possible:
        motion.reason = (
            f"no {profile} motion between these states keeps the limits, whatever its duration:"
            f" in {h:.6g} s {motion.reason}; use profile='double_s'"
        )
    return motion


def gather_limits(robot: KinematicModel, given: dict[str, Any], required: bool) -> Limits:
    """Limits without those of position: given ones, else those of the robot; required: of velocity and
    acceleration."""
    most = {
        kind: require_limits(robot, kind, value)
        if value is not None or (required and kind != "jerk")
        else getattr(robot.limits, kind)
        for kind, value in given.items()
    }
    free = np.full(len(robot.joint_names), np.inf)
    return Limits(-free, free, **most)


def find_position_violation(motion: PolynomialTrajectory, limits: Limits) -> str:
    """The first limit of position that a motion leaves, in words; empty if none."""
    check = motion.check(Limits(limits.lower, limits.upper))
    violations: tuple[Violation, ...] = check.violations
    return str(violations[0]) if violations else ""
