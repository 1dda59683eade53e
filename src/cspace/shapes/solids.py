"""Solids of a few numbers: box, sphere, capsule, cylinder and half space."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from cspace.arrays import Array, one_array, one_number, positive_number
from cspace.errors import InputError
from cspace.shapes.shape import IDENTITY, ORIGIN, Shape, find_bounds
from cspace.tables import shown
from cspace.tolerances import AXIS_LENGTH, LARGEST_NUMBER, ROUNDED_UNIT


@dataclass(frozen=True, eq=False, repr=False)
class Box(Shape):
    """A box centred at its frame.

    size (3,): its sides [m] along x, y and z, all positive. pose (4, 4), or its position (3,) [m]. name: its
    name in a scene.

    Signed distance at y, with s = |y| − size / 2: ‖max(s, 0)‖ outside, max s inside.
    Raises InputError for a side that is not positive, and for an invalid pose.
    """

    kind: ClassVar[str] = "box"
    size: Any
    pose: Any = ORIGIN
    name: str = ""

    def __post_init__(self) -> None:
        size = np.array(
            one_array(self.size, "size of a box", (3,), "sides x, y, z [m]", largest=LARGEST_NUMBER)
        )
        if (size <= 0.0).any():
            raise InputError(f"size of a box is {size.tolist()}; each side must be positive (make it thin)")
        self._store(size=size)
        self._place()

    @property
    def bounds(self) -> Array:
        """The axis-aligned bounding box (2, 3) [m], lower corner first."""
        reach = np.abs(self.pose[:3, :3]) @ self.size / 2.0
        return np.array([self.pose[:3, 3] - reach, self.pose[:3, 3] + reach])

    def _measure(self, local: Array) -> tuple[Array, Array]:
        return measure_slabs(np.abs(local) - self.size / 2.0, sign_of(local))

    def _sizes(self) -> str:
        return " × ".join(map(shown, self.size)) + " m"


@dataclass(frozen=True, eq=False, repr=False)
class Sphere(Shape):
    """A ball: radius [m], positive; pose (4, 4) or its centre (3,) [m]; name.

    Raises InputError for a radius that is not positive, and for an invalid pose.
    """

    kind: ClassVar[str] = "sphere"
    radius: float
    pose: Any = ORIGIN
    name: str = ""

    def __post_init__(self) -> None:
        self._store(radius=check_length(self.radius, "radius of a sphere"))
        self._place()

    @property
    def bounds(self) -> Array:
        """The axis-aligned bounding box (2, 3) [m], lower corner first."""
        return find_bounds(self.pose[None, :3, 3], self.radius)

    def _measure(self, local: Array) -> tuple[Array, Array]:
        distance, gradient = measure_points(local)
        return distance - self.radius, gradient

    def _sizes(self) -> str:
        return f"radius {shown(self.radius)} m"


@dataclass(frozen=True, eq=False, repr=False)
class Capsule(Shape):
    """All points within `radius` of a segment of the z axis, centred at the frame.

    radius [m], positive; length [m] of the segment, not negative: the capsule is length + 2 radius long.
    pose (4, 4) or its centre (3,) [m]; name.
    Raises InputError for other sizes, and for an invalid pose.
    """

    kind: ClassVar[str] = "capsule"
    radius: float
    length: float
    pose: Any = ORIGIN
    name: str = ""

    def __post_init__(self) -> None:
        length = one_number(self.length, "length of a capsule", largest=LARGEST_NUMBER)
        if length < 0.0:
            raise InputError(f"length of a capsule is {length:g} m; it must not be negative")
        self._store(radius=check_length(self.radius, "radius of a capsule"), length=length)
        self._place()

    @property
    def ends(self) -> Array:
        """The two ends (2, 3) [m] of the segment, the lower one first."""
        half = self.length / 2.0 * self.pose[:3, 2]
        return np.array([self.pose[:3, 3] - half, self.pose[:3, 3] + half])

    @property
    def bounds(self) -> Array:
        """The axis-aligned bounding box (2, 3) [m], lower corner first."""
        return find_bounds(self.ends, self.radius)

    def _measure(self, local: Array) -> tuple[Array, Array]:
        offset = local.copy()
        offset[:, 2] -= np.clip(local[:, 2], -self.length / 2.0, self.length / 2.0)
        distance, gradient = measure_points(offset, np.array([1.0, 0.0, 0.0]))
        return distance - self.radius, gradient

    def _sizes(self) -> str:
        return f"radius {shown(self.radius)} m, length {shown(self.length)} m"


@dataclass(frozen=True, eq=False, repr=False)
class Cylinder(Shape):
    """A cylinder with flat ends along z, centred at its frame.

    radius, length [m], both positive; pose (4, 4) or its centre (3,) [m]; name.
    Raises InputError for other sizes, and for an invalid pose.
    """

    kind: ClassVar[str] = "cylinder"
    radius: float
    length: float
    pose: Any = ORIGIN
    name: str = ""

    def __post_init__(self) -> None:
        radius, length = (check_length(getattr(self, k), f"{k} of a cylinder") for k in ("radius", "length"))
        self._store(radius=radius, length=length)
        self._place()

    @property
    def bounds(self) -> Array:
        """The axis-aligned bounding box (2, 3) [m], lower corner first."""
        axis = self.pose[:3, 2]
        across = np.sqrt(np.maximum(1.0 - axis**2, 0.0))
        reach = np.abs(axis) * self.length / 2.0 + across * self.radius
        return np.array([self.pose[:3, 3] - reach, self.pose[:3, 3] + reach])

    def _measure(self, local: Array) -> tuple[Array, Array]:
        off_axis = local * [1.0, 1.0, 0.0]
        rho, radial = measure_points(off_axis, np.array([1.0, 0.0, 0.0]))
        slabs = np.stack([rho - self.radius, np.abs(local[:, 2]) - self.length / 2.0], axis=-1)
        distance, flat = measure_slabs(slabs, np.stack([np.ones(len(local)), sign_of(local[:, 2])], axis=-1))
        gradient = flat[:, :1] * radial
        gradient[:, 2] = flat[:, 1]
        return distance, gradient

    def _sizes(self) -> str:
        return f"radius {shown(self.radius)} m, length {shown(self.length)} m"


@dataclass(frozen=True, eq=False, repr=False)
class HalfSpace(Shape):
    """Everything on one side of a plane: the points x with normal · x ≤ offset, such as a floor.

    normal (3,): outward, of any length but zero; it is stored with length one. offset [m]: of the plane
    along the unit normal. pose (4, 4): the frame of normal and offset; name.
    Raises InputError for a zero normal, and for an invalid pose.
    """

    kind: ClassVar[str] = "half_space"
    normal: Any = (0.0, 0.0, 1.0)
    offset: float = 0.0
    pose: Any = ORIGIN
    name: str = ""

    def __post_init__(self) -> None:
        normal = np.array(one_array(self.normal, "normal of a half space", (3,), largest=LARGEST_NUMBER))
        length = math.hypot(*normal.tolist())
        if length < AXIS_LENGTH:
            raise InputError(f"normal of a half space is {normal.tolist()}; it must not be zero")
        offset = one_number(self.offset, "offset of a half space", largest=LARGEST_NUMBER)
        if abs(length - 1.0) > ROUNDED_UNIT:  # a unit vector stays as it is, bit for bit
            normal /= length
        self._store(normal=normal, offset=offset)
        self._place()

    @property
    def plane(self) -> Array:
        """Unit normal and offset (4,) in the frame where the half space is placed: normal · x ≤ offset."""
        normal = self.pose[:3, :3] @ self.normal
        return np.append(normal, self.offset + normal @ self.pose[:3, 3])

    @property
    def bounds(self) -> Array:
        """The bounding box (2, 3) [m]: infinite but for the side of a plane normal to an axis."""
        normal, offset = self.plane[:3], self.plane[3]
        box = np.array([np.full(3, -np.inf), np.full(3, np.inf)])
        for k in range(3):
            if np.count_nonzero(normal) == 1 and normal[k]:
                box[int(normal[k] > 0.0), k] = offset * normal[k]
        return box

    def _measure(self, local: Array) -> tuple[Array, Array]:
        return local @ self.normal - self.offset, np.tile(self.normal, (len(local), 1))

    def _sizes(self) -> str:
        return f"normal ({', '.join(map(shown, self.normal))}), offset {shown(self.offset)} m"


def check_length(value: Any, subject: str) -> float:
    """A positive length [m]; InputError for zero, NaN and anything else."""
    return positive_number(value, subject, "it must be one positive number [m]", largest=LARGEST_NUMBER)


def sign_of(values: Array) -> Array:
    """The signs of values, +1 for zero."""
    return np.where(values < 0.0, -1.0, 1.0)


def measure_slabs(s: Array, signs: Array) -> tuple[Array, Array]:
    """Signed distance (n,) and gradient (n, k) of an intersection of orthogonal slabs.

    s (n, k): how far a point is beyond each slab, negative inside. signs (n, k): of its coordinates.
    """
    beyond = np.maximum(s, 0.0)
    outside = np.linalg.norm(beyond, axis=-1)
    deepest = s.argmax(axis=-1)
    distance = np.where(outside > 0.0, outside, s.max(axis=-1))
    with np.errstate(invalid="ignore", divide="ignore"):
        gradient = beyond / outside[:, None]
    inside = outside <= 0.0
    gradient[inside] = np.eye(s.shape[-1])[deepest[inside]]
    return distance, gradient * signs


def measure_points(offset: Array, direction: Array | None = None) -> tuple[Array, Array]:
    """Lengths (n,) and directions (n, 3) of vectors (n, 3); a zero vector gets `direction`, or z."""
    distance = np.linalg.norm(offset, axis=-1)
    with np.errstate(invalid="ignore", divide="ignore"):
        gradient = offset / distance[:, None]
    gradient[distance == 0.0] = IDENTITY[2, :3] if direction is None else direction
    return distance, gradient
