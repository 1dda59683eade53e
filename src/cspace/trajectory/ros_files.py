"""JointTrajectory messages of ROS as YAML: samples of trajectories, written and read."""

from __future__ import annotations

import json
import math
import os
from typing import Any, Final, TypeGuard

import numpy as np

from cspace.arrays import Array
from cspace.errors import DescriptionError, InputError
from cspace.files import name_file, path_of, read_text, write_text
from cspace.model.values import read_joint_names
from cspace.trajectory.message_yaml import read_documents
from cspace.trajectory.polynomials import PolynomialTrajectory
from cspace.trajectory.time_scaling import connect_samples
from cspace.trajectory.trajectory import Trajectory, check_trajectory

STATES: Final = ("positions", "velocities", "accelerations")
"""What a point says of the joints, in the order of derivatives."""

OUTER: Final = ("goal", "trajectory", "joint_trajectory")
"""Fields of other messages that hold the trajectory, such as goals of FollowJointTrajectory."""

SECONDS: Final = ("sec", "secs")
FRACTIONS: Final = ("nanosec", "nsecs")
"""Fields of times, of ROS 2 and ROS 1."""

LARGEST_FILE: Final = 2_000_000_000
"""Bytes of a file that is read."""

NANOSECONDS: Final = 1_000_000_000
"""In a second."""


def to_ros(trajectory: Trajectory, path: str | os.PathLike[str], *, rate: float) -> None:
    """Write samples as a message trajectory_msgs/JointTrajectory of ROS 2, in YAML.

    Times are seconds and nanoseconds that strictly increase. rate [Hz]: of the points; the end is among them.
    The file is complete or untouched.
    Raises InputError for a trajectory without names of joints, for one with a reason (which is not what was
    asked for), and where the file cannot be written.
    """
    check_trajectory(trajectory)
    if trajectory.joint_names is None:
        raise InputError("the trajectory has no names of joints, which ROS needs; pass joint_names=")
    samples = trajectory.samples_to_write(rate)
    ticks = np.rint(samples.times * NANOSECONDS).astype(np.int64)
    kept = np.append(np.diff(ticks) > 0, True)  # the end replaces a point within the same nanosecond
    lines = [f"joint_names: [{', '.join(json.dumps(n, ensure_ascii=False) for n in trajectory.joint_names)}]"]
    lines.append("points:")
    for i in np.flatnonzero(kept):
        second, nanosecond = divmod(int(ticks[i]), NANOSECONDS)
        for key, values in zip(STATES, (samples.q, samples.qd, samples.qdd), strict=True):
            mark = "  - " if key == "positions" else "    "
            lines.append(f"{mark}{key}: [{', '.join(map(_yaml_number, values[i].tolist()))}]")
        lines.append(f"    time_from_start: {{sec: {second}, nanosec: {nanosecond}}}")
    write_text(path_of(path), "\n".join(lines) + "\n")


def _yaml_number(value: float) -> str:
    """A number as readers of YAML 1.1 take it: with a point before an exponent."""
    digits, sign, exponent = repr(value).partition("e")
    return digits + (".0" if sign and "." not in digits else "") + sign + exponent


def from_ros(path: str | os.PathLike[str]) -> PolynomialTrajectory:
    """The trajectory through the points of a message trajectory_msgs/JointTrajectory of ROS 1 or 2, in YAML.

    The inverse of to_ros; also what `ros2 topic echo` prints, and goals that hold such a message. Between
    points it is the quintic polynomial through positions, velocities and accelerations, the cubic one where
    there are no accelerations, and a straight line where there are positions alone, as ROS follows them.
    Needs PyYAML (`pip install 'cspace[ros]'`).

    Returns a PolynomialTrajectory. Raises DescriptionError with the file, and the line or the point, for
    other contents, several messages, numbers that are missing or not finite, and times that do not increase
    from zero.
    """
    name = path_of(path)
    documents = read_documents(read_text(name, "ROS message", LARGEST_FILE, DescriptionError), name)
    if len(documents) != 1:
        raise DescriptionError(
            f"the file has {len(documents)} messages; leave one JointTrajectory in it", path=name
        )
    message = _find_message(documents[0], name)
    names, points = message.get("joint_names"), message.get("points")
    if not isinstance(names, list) or not names or not all(isinstance(each, str) for each in names):
        raise DescriptionError("joint_names must be a list of names; quote those that are numbers", path=name)
    with name_file(name):
        read_joint_names(names)
    if not isinstance(points, list) or not points:
        raise DescriptionError("the message has no points", path=name)
    times = np.array([_read_time(point, k, name) for k, point in enumerate(points)])
    bad = np.flatnonzero(np.diff(times) <= 0.0)
    if bad.size:
        raise DescriptionError(f"time_from_start of point {bad[0] + 1} does not increase", path=name)
    if times[0] != 0.0:
        text = f"time_from_start of point 0 is {times[0]:g} s; begin with the point of the time 0"
        raise DescriptionError(f"{text}, where the arm starts", path=name)
    states = _read_states(points, len(names), name)
    with name_file(name):
        return connect_samples(times, states, names)


def _find_message(value: Any, path: str) -> dict[str, Any]:
    """The mapping with points, which may lie in a field of another message."""
    for _ in range(len(OUTER) + 1):  # a message may refer to itself
        if not isinstance(value, dict):
            break
        if "points" in value:
            return value
        value = next((value[field] for field in OUTER if field in value), None)
    raise DescriptionError("the file has no field points:; it holds no JointTrajectory", path=path)


def _read_time(point: Any, k: int, path: str) -> float:
    """The time of a point [s]: a number, or whole seconds and nanoseconds."""
    given = point.get("time_from_start") if isinstance(point, dict) else None
    if isinstance(given, dict) and set(given) <= {*SECONDS, *FRACTIONS}:
        parts = [next((given[f] for f in fields if f in given), 0) for fields in (SECONDS, FRACTIONS)]
        known = any(field in given for field in (*SECONDS, *FRACTIONS))
        if known and all(_is_number(part) for part in parts):
            seconds, fraction = parts
            whole = seconds == int(seconds) and fraction == int(fraction)
            ticks = int(seconds) * NANOSECONDS + int(fraction)
            return ticks / NANOSECONDS if whole else seconds + fraction / NANOSECONDS
    elif _is_number(given):
        return float(given)
    raise DescriptionError(f"time_from_start of point {k} must be sec and nanosec, or seconds", path=path)


def _is_number(value: Any) -> TypeGuard[float]:
    """Whether a value is a finite number."""
    if isinstance(value, bool) or not isinstance(value, int | float):
        return False
    try:
        return math.isfinite(value)
    except OverflowError:  # a whole number beyond all floats
        return False


def _read_states(points: list[Any], dof: int, path: str) -> Array:
    """Positions, and velocities and accelerations where the points have them (k, m, dof)."""
    kinds = [kind for kind in STATES if points[0].get(kind)]
    if kinds != list(STATES[: len(kinds)]) or not kinds:
        text = f"point 0 has {' and '.join(kinds) or 'nothing'}; accelerations need velocities"
        raise DescriptionError(f"{text}, and these positions", path=path)
    states = np.empty((len(points), len(kinds), dof))
    for k, point in enumerate(points):
        for order, kind in enumerate(STATES):
            values = point.get(kind) or []
            expected = dof if kind in kinds else 0
            if not isinstance(values, list) or len(values) != expected:
                size = len(values) if isinstance(values, list) else type(values).__name__
                text = f"{kind} of point {k}: {size}; expected {expected}, as point 0 and joint_names have"
                raise DescriptionError(text, path=path)
            if not all(map(_is_number, values)):
                raise DescriptionError(f"{kind} of point {k} must be finite numbers", path=path)
            if expected:
                states[k, order] = values
    return states
