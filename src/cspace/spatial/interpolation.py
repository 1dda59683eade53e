"""Interpolation between two poses: along their screw, or of rotation and translation independently."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import numpy.typing as npt

from cspace.arrays import Array, as_floats, leading_axes
from cspace.errors import InputError
from cspace.spatial import planar_twists, twists
from cspace.spatial.checks import PoseLike, RotationLike, as_pose, as_pose_2d, as_rotation
from cspace.spatial.poses import assemble, invert_pose
from cspace.spatial.rotations import matrix_of_rotvec, rotvec_of_matrix


def interpolate(T_start: PoseLike, T_end: PoseLike, t: npt.ArrayLike) -> Array:
    """The pose at the fraction t of the screw motion from start to end: a helix at a constant twist.

    T(t) = T_start exp(t log(T_start⁻¹ T_end)), the shortest way round. It does not depend on the base frame.
    If the two are 180° apart, both directions are equally short: the rule of log_so3 applies.

    T_start, T_end: (..., 4, 4). t: (...), 0 at start, 1 at end, beyond them the motion goes on. All leading
    axes broadcast: one pair and t of shape (m,) give (m, 4, 4); for n pairs at m fractions pass T[:, None].
    """
    start, end = _spatial(as_pose, T_start, "start pose"), _spatial(as_pose, T_end, "end pose")
    step, t = _fractions(twists.logarithm_se3(_relative(start, end)), t)
    return np.asarray(start @ twists.exponential_se3(step * t))


def slerp(R_start: RotationLike, R_end: RotationLike, t: npt.ArrayLike) -> Array:
    """The rotation at the fraction t of the shortest way from start to end, at constant angular velocity.

    R(t) = R_start exp(t log(R_startᵀ R_end)); shapes and half turns as in interpolate. Source: Shoemake 1985.

    R_start, R_end: (..., 3, 3) or poses, of which the rotation counts. Returns (..., 3, 3).
    """
    start, end = (
        _spatial(as_rotation, R_start, "start rotation"),
        _spatial(as_rotation, R_end, "end rotation"),
    )
    return _slerp(start, end, t)


def interpolate_decoupled(T_start: PoseLike, T_end: PoseLike, t: npt.ArrayLike) -> Array:
    """The pose at the fraction t with the origin on a straight line and the rotation by slerp.

    Which point moves on a straight line depends on the choice of the moving frame, unlike in interpolate.

    Shapes and half turns as in interpolate. Returns (..., 4, 4).
    """
    start, end = _spatial(as_pose, T_start, "start pose"), _spatial(as_pose, T_end, "end pose")
    p_start, p_end = start[..., :3, 3], end[..., :3, 3]
    R = _slerp(start[..., :3, :3], end[..., :3, :3], t)
    way, fraction = _fractions(p_end - p_start, t)
    return assemble(R, p_start + fraction * way)


def interpolate_2d(T_start: Any, T_end: Any, t: npt.ArrayLike) -> Array:
    """The planar pose at the fraction t of the rotation about the pole, or the translation, between two.

    Shapes as in interpolate, with (..., 3, 3); a half turn goes counter-clockwise.
    """
    start, end = as_pose_2d(T_start, "start pose"), as_pose_2d(T_end, "end pose")
    step, t = _fractions(planar_twists.logarithm_se2(_relative(start, end)), t)
    return np.asarray(start @ planar_twists.exponential_se2(step * t))


def _spatial(check: Callable[[Any, str], Array], value: Any, subject: str) -> Array:
    """check(value, subject); a planar pose is refused with the functions that take it."""
    try:
        return check(value, subject)
    except InputError:
        if not _is_planar(value):
            raise
        raise InputError(
            f"{subject} looks like a planar pose: cspace.interpolate_2d interpolates planar"
            " poses, cspace.embed_pose_2d(T) converts one into a spatial pose, and cspace.pose(matrix=R)"
            " converts a rotation into a pose"
        ) from None


def _is_planar(value: Any) -> bool:
    try:
        as_pose_2d(value)
    except InputError:
        return False
    return True


def _relative(start: Array, end: Array) -> Array:
    leading_axes(start=start.shape[:-2], end=end.shape[:-2])
    return np.asarray(invert_pose(start) @ end)


def _fractions(step: Array, t: npt.ArrayLike) -> tuple[Array, Array]:
    """The step (..., k) and the fractions (..., 1), known to broadcast."""
    fractions = as_floats(t, "t")
    leading_axes(**{"start and end": step.shape[:-1], "t": fractions.shape})
    return step, fractions[..., None]


def _slerp(start: Array, end: Array, t: npt.ArrayLike) -> Array:
    leading_axes(start=start.shape[:-2], end=end.shape[:-2])
    step, fractions = _fractions(rotvec_of_matrix(np.swapaxes(start, -1, -2) @ end), t)
    return np.asarray(start @ matrix_of_rotvec(step * fractions, "t times the angle"))
