"""Right angles of a robot made exact, where its file rounds them to 1.5708 or 3.1416."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from cspace.arrays import Array, positive_number
from cspace.errors import InputError
from cspace.model.description import Description
from cspace.model.joint import Joint, Loop
from cspace.model.values import IDENTITY, freeze_array
from cspace.tolerances import LARGEST_RIGHT_ANGLE, RIGHT_ANGLE

SUBJECT = "right_angles"
RULE = f"it is how far the file rounds right angles [rad], above zero and at most {LARGEST_RIGHT_ANGLE:g}"


def with_right_angles(description: Description, tolerance: float = RIGHT_ANGLE) -> Description:
    """The robot with exact right angles where its file rounds them, by `tolerance` [rad] at most.

    An axis of a joint frame within `tolerance` of an axis of the parent link is put on it, and the rotation
    about it is kept; so is a joint axis within `tolerance` of an axis of its own frame. Frames keep their
    places in their parent links, and angles that are not right keep their digits, so that each joint turns
    what it carries by 2 tolerance at most.
    Files print π/2 as 1.5708, which is 3.7e-6 off. Axes that should be parallel or meet then almost do, and
    poses at which this decides about solutions are slow and cannot be certified.
    Raises InputError for a tolerance that is not positive, and above tolerances.LARGEST_RIGHT_ANGLE.
    """
    most = positive_number(tolerance, SUBJECT, RULE)
    if most > LARGEST_RIGHT_ANGLE:
        raise InputError(f"{SUBJECT} is {most:g}; {RULE}")
    joints = tuple(square_joint(joint, most) for joint in description.joints)
    loops = tuple(square_loop(loop, most) for loop in description.loops)
    return replace(description, joints=joints, loops=loops)


def square_rotation(R: Array, tolerance: float) -> Array:
    """The rotation (3, 3) whose axes within `tolerance` [rad] of a coordinate axis are put on it.

    One such axis is enough: the rotation about it is kept, or made a quarter turn where it is within
    `tolerance` of one. A rotation without such an axis is returned as it is.
    """
    i, j = divmod(int(np.argmax(np.abs(R))), 3)
    if math.hypot(*np.delete(R[:, j], i)) > math.sin(tolerance):
        return R
    rows, columns = ([k for k in range(3) if k != kept] for kept in (i, j))
    (a, b), (c, d) = R[np.ix_(rows, columns)].tolist()
    handed = 1.0 if a * d > b * c else -1.0
    cosine, sine = square_direction(a + handed * d, c - handed * b, tolerance)
    squared = np.zeros((3, 3))
    squared[i, j] = math.copysign(1.0, R[i, j])
    squared[np.ix_(rows, columns)] = [[cosine, -handed * sine], [sine, handed * cosine]]
    return squared


def square_axis(axis: Array, tolerance: float) -> Array:
    """The coordinate axis that a unit vector (3,) is within `tolerance` [rad] of, or the vector itself."""
    i = int(np.argmax(np.abs(axis)))
    if math.hypot(*np.delete(axis, i)) > math.sin(tolerance):
        return axis
    squared = np.zeros(3)
    squared[i] = math.copysign(1.0, axis[i])
    return squared


def square_direction(x: float, y: float, tolerance: float) -> tuple[float, float]:
    """The cosine and sine of the direction (x, y), those of a quarter turn if it is within `tolerance`."""
    length = math.hypot(x, y)
    if min(abs(x), abs(y)) > length * math.sin(tolerance):
        return x / length, y / length
    along = abs(x) > abs(y)
    return (math.copysign(1.0, x), 0.0) if along else (0.0, math.copysign(1.0, y))


def square_joint(joint: Joint, tolerance: float) -> Joint:
    return replace(
        joint, origin=square_frame(joint.origin, tolerance), axis=square_axis(joint.axis, tolerance)
    )


def square_loop(loop: Loop, tolerance: float) -> Loop:
    second = loop.second_axis
    return replace(
        loop,
        origin=square_frame(loop.origin, tolerance),
        child_origin=square_frame(loop.child_origin, tolerance),
        axis=square_axis(loop.axis, tolerance),
        second_axis=None if second is None else square_axis(second, tolerance),
    )


def square_frame(origin: Array, tolerance: float) -> Array:
    """A joint frame (4, 4) with exact right angles, at the same place."""
    if origin is IDENTITY:
        return IDENTITY
    placed = origin.copy()
    placed[:3, :3] = square_rotation(origin[:3, :3], tolerance)
    return freeze_array(placed)
