"""What every shape has: a pose, a name, bounds, and the signed distance of points with its gradient."""

from __future__ import annotations

from dataclasses import replace
from typing import Any, ClassVar, TypeVar

import numpy as np
import numpy.typing as npt
from numpy.typing import ArrayLike

from cspace.arrays import Array, as_floats, one_array, shape_of
from cspace.errors import InputError, InputTypeError, name_type
from cspace.spatial.checks import as_pose
from cspace.tables import one_line, shown, tabulate
from cspace.tolerances import LARGEST_NUMBER

IDENTITY: Array = np.eye(4)
"""The pose of a shape that is not moved."""
IDENTITY.setflags(write=False)

ORIGIN = (0.0, 0.0, 0.0)
"""The position of a shape that is not moved."""

S = TypeVar("S", bound="Shape")


@tabulate("kind", "name", "pose", "bounds")
class Shape:
    """A solid at a place: the base of all shapes.

    pose (4, 4): the frame of the shape in the frame where it is placed (a world, a link). name: its name, ""
    without one. kind: the name of its class in lower case with underscores, as files have it.
    """

    kind: ClassVar[str]
    pose: Any
    name: str

    def _place(self) -> None:
        """Check pose and name; every shape calls it last."""
        object.__setattr__(self, "pose", check_place(self.pose, f"pose of a {self.title}"))
        if not isinstance(self.name, str):
            raise InputTypeError(f"the name of a {self.title} is {name_type(self.name)}; give a string")

    def _store(self, **values: Any) -> None:
        """Set fields of the frozen object; arrays become read-only."""
        for name, value in values.items():
            if isinstance(value, np.ndarray):
                value.setflags(write=False)
            object.__setattr__(self, name, value)

    @property
    def title(self) -> str:
        """The kind as words of a message, such as "half space"."""
        return self.kind.replace("_", " ")

    @property
    def bounds(self) -> Array:
        """The axis-aligned bounding box (2, 3) [m], lower corner first; infinite for half spaces."""
        raise NotImplementedError

    def distance(self, points: ArrayLike) -> Any:
        """The signed distance [m] of points (..., 3) from the surface: (...), negative inside."""
        return self._evaluate(points)[0]

    def gradient(self, points: ArrayLike) -> Array:
        """The unit gradient of the signed distance at points (..., 3): (..., 3).

        It points away from the nearest surface point outside, and towards it inside. Where several surface
        points are nearest (on the axis of a cylinder) it belongs to one of them.
        """
        return self._evaluate(points)[1]

    def contains(self, points: ArrayLike) -> Any:
        """Whether points (..., 3) [m] are inside or on the surface: (...) of bool."""
        inside = np.asarray(self.distance(points)) <= 0.0
        return inside if inside.ndim else bool(inside)

    def moved(self: S, T: Any) -> S:
        """The same shape moved by T (4, 4), or a translation (3,) [m], in the frame where it is placed."""
        return replace(self, pose=check_place(T, "T") @ self.pose)  # type: ignore[type-var]

    def placed(self: S, pose: Any) -> S:
        """The same shape at another pose (4, 4) or position (3,)."""
        return replace(self, pose=pose)  # type: ignore[type-var]

    def renamed(self: S, name: str) -> S:
        """The same shape under another name."""
        return replace(self, name=name)  # type: ignore[type-var]

    def _evaluate(self, points: ArrayLike) -> tuple[Any, Array]:
        """Signed distance (...) and gradient (..., 3) at points (..., 3)."""
        given = as_floats(points, "points", last=(3,))
        R, t = self.pose[:3, :3], self.pose[:3, 3]
        distance, gradient = self._measure((given.reshape(-1, 3) - t) @ R)
        turned: Array = (gradient @ R.T).reshape(given.shape)
        return (distance.reshape(given.shape[:-1]) if given.ndim > 1 else float(distance[0])), turned

    def _measure(self, local: Array) -> tuple[Array, Array]:
        """Signed distance (n,) and unit gradient (n, 3) at points (n, 3) of the shape frame."""
        raise NotImplementedError

    def _surface(self) -> tuple[Array, npt.NDArray[np.intp], bool] | None:
        """Vertices (k, 3) and triangles (m, 3) in the shape frame, and whether they enclose a solid."""
        return None

    def _sizes(self) -> str:
        """The sizes as text."""
        raise NotImplementedError

    def __repr__(self) -> str:
        named = f"{self.name!r}, " if self.name else ""
        where = ", ".join(shown(x) for x in self.pose[:3, 3])
        return one_line(type(self).__name__, f"{named}{self._sizes()}, at ({where})")


def check_place(value: Any, subject: str) -> Array:
    """A read-only pose (4, 4) from a pose or a position (3,) [m]; InputError as of spatial.as_pose."""
    if value is IDENTITY or value is ORIGIN:
        return IDENTITY
    shape = shape_of(value, subject)
    if len(shape) == 1 and shape != (3,):
        raise InputError(f"{subject} has shape {shape}; it must be one pose (4, 4) or position (3,)")
    if shape == (3,):
        T = np.eye(4)
        T[:3, 3] = one_array(value, subject.replace("pose", "position"), (3,), largest=LARGEST_NUMBER)
    else:
        T = as_pose(value, subject).copy()
        if T.shape != (4, 4):
            raise InputError(f"{subject} has shape {T.shape}; it must be one pose (4, 4) or position (3,)")
        one_array(T, subject, (4, 4), largest=LARGEST_NUMBER)
        T[3] = IDENTITY[3]
    T.setflags(write=False)
    return T


def check_points(value: Any, subject: str, least: int, rule: str) -> Array:
    """A copy of points (n, 3) [m], at least so many; InputError names the first that is not finite."""
    points = np.array(one_array(value, subject, (None, 3), "points x, y, z [m]", largest=LARGEST_NUMBER))
    if len(points) < least:
        raise InputError(f"{subject} holds {len(points)} points; {rule}")
    return points


def find_bounds(points: Array, margin: float = 0.0) -> Array:
    """The bounding box (2, 3) of points (n, 3), grown by a margin."""
    return np.array([points.min(axis=0) - margin, points.max(axis=0) + margin])
