"""Region: a set of poses of the tip as a goal, its position in a box and its orientation within an angle."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Final

import numpy as np
import numpy.typing as npt
from numpy.typing import ArrayLike

from cspace.arrays import Array, as_floats, bounded_number, one_array
from cspace.errors import InputError, InputTypeError
from cspace.search.halton import halton_points
from cspace.spatial import as_pose, as_rotation, exp_so3, pose, rotation_distance
from cspace.spatial.checks import one_pose
from cspace.spatial.poses import assemble, invert_pose, transform_points
from cspace.spatial.vectors import AXES, Z, frame_along, length_and_direction
from cspace.tables import one_line, tabulate
from cspace.tolerances import FARTHEST, IN_REGION, LARGEST_NUMBER, SMALL_TURN

HALVINGS: Final = 53
"""Bisections after which an angle has all bits of a double."""

WITHIN: Final = "it must be an angle [rad], 0 to π"

DIMENSIONS: Final = 6
"""Of the samples of a region: three for the position and three for the orientation."""


@tabulate()
@dataclass(frozen=True, eq=False)
class Region:
    """A set of poses of the tip: a goal of `cs.plan`.

    box: (size (3,) [m], T_world_box), the edges of a box and the pose (4, 4) or position (3,) of its middle,
    in which the tip lies; None: anywhere. direction: where an axis of the tip points in the world, (3,) or a
    name such as "-z". axis: that axis, "x", "-z" or (3,) in the tip. within [rad]: by how much it may
    deviate. rotation (3, 3): instead of a direction, the whole orientation, which deviates by a turn of at
    most `within`. Without direction and rotation the tip may be turned in any way. A size of zero fixes the
    position, within=0 the direction or orientation.

    Raises InputError for a region without any part, sizes that are negative, a direction that is zero, and
    an angle outside 0 to π; InputTypeError for parts that do not go together.
    """

    box: Any = None
    axis: Any = "z"
    direction: Any = None
    rotation: Any = None
    within: float = 0.0

    def __post_init__(self) -> None:
        angle = bounded_number(self.within, "within", 0.0, WITHIN, LARGEST_NUMBER)
        if angle > np.pi:
            raise InputError(f"within is {angle:g}; {WITHIN}")
        if self.direction is not None and self.rotation is not None:
            raise InputTypeError("a Region takes a direction or a rotation, not both")
        has_axis = not isinstance(self.axis, str) or self.axis != "z"
        if has_axis and self.direction is None:
            raise InputTypeError("axis= of a Region needs direction=: where the axis points")
        if angle and self.direction is None and self.rotation is None:
            raise InputTypeError("within= of a Region needs direction= or rotation=: what deviates")
        if self.box is None and self.direction is None and self.rotation is None:
            raise InputTypeError("a Region needs a box=, a direction= or a rotation=")
        read = {
            "box": None if self.box is None else read_box(self.box),
            "axis": read_direction(self.axis, "axis"),
            "direction": None if self.direction is None else read_direction(self.direction, "direction"),
            "rotation": None if self.rotation is None else as_rotation(self.rotation, "rotation"),
            "within": angle,
        }
        for name, value in read.items():
            object.__setattr__(self, name, value)

    @property
    def is_exact(self) -> bool:
        """Whether nothing of what is given leaves room: the region is a pose or a partial goal."""
        return (self.box is None or not self.box[0].any()) and self.within == 0.0

    @property
    def goal(self) -> Any:
        """The pose (4, 4), or the keywords of robot.ik, that an exact region is."""
        position = None if self.box is None else self.box[1][:3, 3]
        if position is not None and self.rotation is not None:
            return assemble(self.rotation, position)
        parts = {"position": position, "rotation": self.rotation, "direction": self.direction}
        axis = {} if self.direction is None else {"tool_axis": self.axis}
        return {name: value for name, value in parts.items() if value is not None} | axis

    def contains(self, T: ArrayLike) -> npt.NDArray[np.bool_]:
        """Whether poses T (..., 4, 4) lie in the region (...,), up to rounding (IN_REGION [m, rad])."""
        poses = as_pose(T, "T")
        inside = np.ones(poses.shape[:-2], dtype=bool)
        if self.box is not None:
            size, T_world_box = self.box
            p = transform_points(invert_pose(T_world_box), poses[..., :3, 3])
            inside &= (np.abs(p) <= size / 2.0 + IN_REGION).all(axis=-1)
        if self.direction is not None:
            inside &= angle_between(poses[..., :3, :3] @ self.axis, self.direction) <= self.within + IN_REGION
        if self.rotation is not None:
            inside &= rotation_distance(poses[..., :3, :3], self.rotation) <= self.within + IN_REGION
        return np.asarray(inside)

    def sample(self, first: int, count: int, anywhere: Array | None = None) -> Array:
        """Poses first … first + count − 1 of a sequence that fills the region evenly (count, 4, 4).

        anywhere (count, 3): the positions [m] where the region has no box.
        """
        u = halton_points(first, count, DIMENSIONS)
        if self.box is None:
            p = np.zeros((count, 3)) if anywhere is None else anywhere
        else:
            size, T_world_box = self.box
            p = transform_points(T_world_box, size * (u[:, :3] - 0.5))
        return assemble(self._sample_rotations(u[:, 3:]), p)

    def _sample_rotations(self, u: Array) -> Array:
        """Rotations (n, 3, 3) of the region from points of the unit cube (n, 3)."""
        if self.rotation is not None:
            turns = rotations_within(u, self.within)
            return np.asarray(self.rotation @ turns)
        if self.direction is None:
            return rotations_within(u, np.pi)
        turned = tilts_within(u[:, :2], self.within) @ turns_about_z(u[:, 2])
        return np.asarray(frame_along(self.direction) @ turned @ frame_along(self.axis).T)

    def __repr__(self) -> str:
        parts = []
        if self.box is not None:
            parts.append("box of " + " × ".join(f"{edge:g}" for edge in self.box[0]) + " m")
        if self.direction is not None:
            parts.append(f"axis {shown_vector(self.axis)} along {shown_vector(self.direction)}")
        if self.rotation is not None:
            parts.append("rotation")
        if self.direction is not None or self.rotation is not None:
            parts[-1] += f" within {self.within:g} rad"
        return one_line("Region", ", ".join(parts))


def read_box(box: Any) -> tuple[Array, Array]:
    """The size (3,) and the pose (4, 4) of a box as callers give it."""
    if not isinstance(box, (tuple, list)) or len(box) != 2:
        raise InputTypeError(
            f"box is {type(box).__name__}; it must be a pair: its size (3,) [m], and the pose (4, 4) or the"
            " position (3,) of its middle"
        )
    size = one_array(box[0], "size of the box", (3,), "[m]", largest=FARTHEST)
    if (size < 0.0).any():
        raise InputError(f"size of the box is {size.tolist()}; no edge may be negative")
    if np.shape(box[1]) == (3,):
        return size, pose(as_floats(box[1], "position of the box", largest=FARTHEST))
    return size, one_pose(box[1], "pose of the box")


def read_direction(value: Any, subject: str) -> Array:
    """A unit vector (3,) as callers give it: a name such as "z" or "-x", or any length."""
    if isinstance(value, str):
        if value not in AXES:
            raise InputError(f"{subject} is {value!r}; it must be x, y, z, -x, -y, -z or numbers (3,)")
        return AXES[value]
    length, unit = length_and_direction(one_array(value, subject, (3,)))
    if length == 0.0:
        raise InputError(f"{subject} is zero and has no direction")
    return unit


def shown_vector(v: Array) -> str:
    """A vector (3,) in words."""
    return "(" + ", ".join(f"{x:g}" for x in v) + ")"


def angle_between(a: Array, b: Array) -> Array:
    """The angle [rad] between unit vectors (..., 3), accurate near 0 and π (Kahan 2006)."""
    return np.asarray(2.0 * np.arctan2(np.linalg.norm(a - b, axis=-1), np.linalg.norm(a + b, axis=-1)))


def tilts_within(u: Array, angle: float) -> Array:
    """Rotations (n, 3, 3) about axes normal to z that tilt it, from points of the unit square (n, 2).

    The tilted z is uniform over the cone of an angle about z.
    """
    height = np.sin(angle / 2.0) * np.sqrt(u[:, 0])  # sine of half the tilt
    turn = 2.0 * np.pi * u[:, 1]
    axes = np.stack([-np.sin(turn), np.cos(turn), np.zeros(len(u))], axis=-1)
    return exp_so3(2.0 * np.arcsin(height)[:, None] * axes)


def turns_about_z(u: Array) -> Array:
    """Rotations (n, 3, 3) about z, by whole circles times u (n,)."""
    return exp_so3(2.0 * np.pi * u[:, None] * Z)


def rotations_within(u: Array, angle: float) -> Array:
    """Rotations (n, 3, 3), uniform over turns of at most an angle, from points of the unit cube (n, 3)."""
    axes = tilts_within(u[:, :2], np.pi) @ Z
    return exp_so3(axes * turn_angles(u[:, 2], angle)[:, None])


def turn_angles(u: Array, most: float) -> Array:
    """Angles (n,) up to `most` of uniformly distributed rotations: (a − sin a) / (most − sin most) = u."""
    if most < SMALL_TURN:
        return np.asarray(most * np.cbrt(u))
    low, high = np.zeros(len(u)), np.full(len(u), most)
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        is_low = middle - np.sin(middle) < u * (most - np.sin(most))
        low, high = np.where(is_low, middle, low), np.where(is_low, high, middle)
    return low
