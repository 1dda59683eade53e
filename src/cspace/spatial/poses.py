"""Rotations and poses of space made from numbers, inverted, and applied to points."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any

import numpy as np
import numpy.typing as npt

from cspace.arrays import Array, as_floats, leading_axes, warn_of_degrees
from cspace.errors import InputTypeError
from cspace.spatial import single
from cspace.spatial.checks import PoseLike, RotationLike, as_pose, as_rotation
from cspace.spatial.quaternions import matrix_of_quaternion
from cspace.spatial.rotations import matrix_of_axis_angle, matrix_of_rotvec
from cspace.spatial.sequences import axes_of, matrix_of_euler, matrix_of_fixed
from cspace.tolerances import DEGREE_ANGLES


def pose(
    xyz: npt.ArrayLike | None = None,
    *,
    wxyz: npt.ArrayLike | None = None,
    xyzw: npt.ArrayLike | None = None,
    rpy: npt.ArrayLike | None = None,
    rotvec: npt.ArrayLike | None = None,
    axis_angle: tuple[npt.ArrayLike, npt.ArrayLike] | None = None,
    euler: tuple[str, npt.ArrayLike] | None = None,
    fixed: tuple[str, npt.ArrayLike] | None = None,
    matrix: RotationLike | None = None,
) -> Array:
    """Poses from a translation and one form of the rotation, T = [[R, xyz], [0, 1]].

    xyz: (..., 3) [m], zero if left out. The rotation, the identity if left out, in one of the forms of
    `rotation`: wxyz, xyzw, rpy, rotvec, axis_angle, euler, fixed, matrix. Leading axes broadcast.
    Returns (..., 4, 4). Angles of more than a turn, which look like degrees, cause a warning. Raises
    InputError if a matrix is not a rotation, InputTypeError if nothing is given or the rotation is given
    twice.
    """
    given = _given(wxyz, xyzw, rpy, rotvec, axis_angle, euler, fixed, matrix)
    if not given and xyz is None:
        raise InputTypeError(f"pose() needs xyz= or one of {_names(_FORMS)}; the identity is numpy.eye(4)")
    R = _rotation_of(given, "pose()") if given else np.eye(3)
    p = np.zeros(3) if xyz is None else as_floats(xyz, "xyz", last=(3,))
    return assemble(R, p)


def rotation(
    *,
    wxyz: npt.ArrayLike | None = None,
    xyzw: npt.ArrayLike | None = None,
    rpy: npt.ArrayLike | None = None,
    rotvec: npt.ArrayLike | None = None,
    axis_angle: tuple[npt.ArrayLike, npt.ArrayLike] | None = None,
    euler: tuple[str, npt.ArrayLike] | None = None,
    fixed: tuple[str, npt.ArrayLike] | None = None,
    matrix: RotationLike | None = None,
) -> Array:
    """Rotation matrices from exactly one form.

    wxyz, xyzw: quaternions (..., 4) of any length but zero. rpy: roll, pitch, yaw (..., 3) [rad] about the
    fixed x, y, z. rotvec: axis times angle (..., 3) [rad]. axis_angle: (axis (..., 3) of any length but zero,
    angle (...) [rad]). euler, fixed: (sequence, angles (..., 3) [rad]), such as ("ZYX", angles).
    matrix: (..., 3, 3), checked. Returns (..., 3, 3). Angles of more than a turn cause a warning, as of pose.
    Raises InputError if a matrix is not a rotation, InputTypeError if no form or more than one is given.
    """
    given = _given(wxyz, xyzw, rpy, rotvec, axis_angle, euler, fixed, matrix)
    if not given:
        raise InputTypeError(f"rotation() needs one of {_names(_FORMS)}; the identity is numpy.eye(3)")
    return _rotation_of(given, "rotation()")


def inverse_pose(T: PoseLike) -> Array:
    """The inverse of poses by transposition, [[Rᵀ, −Rᵀ p], [0, 1]]: faster and more exact than elimination.

    T: T_a_b (..., 4, 4) → T_b_a (..., 4, 4).
    """
    return invert_pose(as_pose(T))


def transform_points(T: PoseLike, points: npt.ArrayLike) -> Array:
    """Points turned and moved, p_a = R p_b + t.

    T: T_a_b (..., 4, 4). points: p_b (..., 3) [m]. Leading axes broadcast: one pose and many points, many
    poses and one point, or pairs. Returns p_a (..., 3).
    """
    T = as_pose(T)
    points = as_floats(points, "points", last=(3,))
    return np.asarray(turn_vectors(T[..., :3, :3], points) + T[..., :3, 3])


def transform_directions(T: PoseLike, directions: npt.ArrayLike) -> Array:
    """Directions turned but not moved, d_a = R d_b.

    T: T_a_b (..., 4, 4) or rotations (..., 3, 3). directions: d_b (..., 3). Leading axes broadcast.
    Returns d_a (..., 3).
    """
    return turn_vectors(as_rotation(T), as_floats(directions, "directions", last=(3,)))


def to_xyz(T: PoseLike) -> Array:
    """The translation of poses, a copy: (..., 4, 4) → (..., 3) [m]."""
    return as_pose(T)[..., :3, 3].copy()


def assemble(R: Array, p: Array) -> Array:
    """Poses from rotations (..., n, n) and translations (..., n), broadcast, for n = 2 or 3."""
    n = p.shape[-1]
    T = np.zeros((*leading_axes(rotation=R.shape[:-2], translation=p.shape[:-1]), n + 1, n + 1))
    T[..., :n, :n] = R
    T[..., :n, n] = p
    T[..., n, n] = 1.0
    return T


def invert_pose(T: Array) -> Array:
    """inverse_pose and inverse_pose_2d without checks."""
    if T.shape == (4, 4):
        return single.inverse(T)
    n = T.shape[-1] - 1
    R_inverse = np.swapaxes(T[..., :n, :n], -1, -2)
    return assemble(R_inverse, -turn_vectors(R_inverse, T[..., :n, n]))


def turn_vectors(R: Array, v: Array) -> Array:
    """R v for (..., n, n) and (..., n), broadcast."""
    leading_axes(pose=R.shape[:-2], vector=v.shape[:-1])
    return np.asarray(np.einsum("...ij,...j->...i", R, v))


def _given(*values: Any) -> dict[str, Any]:
    """Those of the forms of a rotation, in the order of _FORMS, that are not None."""
    return {name: value for name, value in zip(_FORMS, values, strict=True) if value is not None}


def _names(forms: Iterable[str]) -> str:
    return ", ".join(f"{name}=" for name in forms)


def _rotation_of(given: dict[str, Any], caller: str) -> Array:
    if len(given) > 1:
        raise InputTypeError(f"{caller} got the rotation {len(given)} times: {_names(given)}; give one")
    ((name, value),) = given.items()
    R = _FORMS[name](value)
    if name in _ANGLES:
        angles = np.asarray(value if name == "rpy" else value[1], dtype=np.float64)
        warn_of_degrees(f"{name}=", angles, DEGREE_ANGLES, "np.radians converts them")
    return R


def _from_axis_angle(value: Any) -> Array:
    axis, angle = _pair(value, "axis_angle", "(axis, angle)")
    axis, angle = as_floats(axis, "axis", last=(3,)), as_floats(angle, "angle")
    leading_axes(axis=axis.shape[:-1], angle=angle.shape)
    return matrix_of_axis_angle(axis, angle)


def _from_euler(value: Any) -> Array:
    sequence, angles = _pair(value, "euler", "(sequence, angles)")
    return matrix_of_euler(axes_of(sequence), as_floats(angles, "Euler angles", last=(3,)))


def _from_fixed(value: Any) -> Array:
    sequence, angles = _pair(value, "fixed", "(sequence, angles)")
    return matrix_of_fixed(axes_of(sequence), as_floats(angles, "fixed angles", last=(3,)))


def _pair(value: Any, name: str, form: str) -> tuple[Any, Any]:
    if not isinstance(value, (tuple, list)) or len(value) != 2:
        raise InputTypeError(f"{name}= takes a pair {form}, got {type(value).__name__}")
    return value[0], value[1]


_ANGLES = ("rpy", "axis_angle", "euler", "fixed")
"""The forms with angles that people type."""

_FORMS: dict[str, Callable[[Any], Array]] = {
    "wxyz": lambda q: matrix_of_quaternion(q, "wxyz"),
    "xyzw": lambda q: matrix_of_quaternion(q, "xyzw", scalar_last=True),
    "rpy": lambda angles: matrix_of_fixed((0, 1, 2), as_floats(angles, "rpy", last=(3,))),
    "rotvec": lambda w: matrix_of_rotvec(as_floats(w, "rotvec", last=(3,)), "rotvec"),
    "axis_angle": _from_axis_angle,
    "euler": _from_euler,
    "fixed": _from_fixed,
    "matrix": lambda R: as_rotation(R, "matrix").copy(),
}
