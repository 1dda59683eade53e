"""Screws: every displacement of space is a rotation about an axis and a translation along it (Chasles)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from cspace import tolerances
from cspace.arrays import Array, as_floats, leading_axes
from cspace.errors import InputError
from cspace.spatial.checks import PoseLike, as_pose
from cspace.spatial.twists import exponential_se3, logarithm_se3
from cspace.spatial.vectors import cross, length_and_direction
from cspace.tables import show_fields


@show_fields
@dataclass(frozen=True, eq=False)
class Screw:
    """A screw motion: a line, a pitch and how far.

    axis: direction of the line (..., 3), made a unit vector. point: a point of the line (..., 3) [m].
    pitch: slide per turn angle (...) [m/rad], inf for a pure translation. magnitude: the turn angle
    (...) [rad]; for a pure translation the distance [m].

    Screws made by the library give the point nearest the origin and a magnitude ≥ 0. A pure translation has
    the pitch inf, the axis along the translation and the point 0; the identity counts as a translation by
    zero, with the axis z.
    Raises InputError on a zero axis, NaN, an infinite magnitude or leading axes that do not broadcast.
    """

    axis: Array
    point: Array
    pitch: Array
    magnitude: Array

    def __post_init__(self) -> None:
        length, axis = length_and_direction(as_floats(self.axis, "screw axis", last=(3,)))
        if not (length > 0.0).all():
            raise InputError("screw axis is zero; it needs a direction")
        point = as_floats(self.point, "screw point", last=(3,))
        pitch = as_floats(self.pitch, "pitch", finite=False)
        if np.isnan(pitch).any() or (pitch == -np.inf).any():
            raise InputError("pitch is NaN or -inf; it is a number [m/rad], or inf for a pure translation")
        magnitude = as_floats(self.magnitude, "magnitude")
        shapes = {"axis": length.shape, "point": point.shape[:-1]}
        batch = leading_axes(**shapes, pitch=pitch.shape, magnitude=magnitude.shape)
        object.__setattr__(self, "axis", np.broadcast_to(axis, (*batch, 3)))
        object.__setattr__(self, "point", np.broadcast_to(point, (*batch, 3)))
        object.__setattr__(self, "pitch", np.broadcast_to(pitch, batch)[()])
        object.__setattr__(self, "magnitude", np.broadcast_to(magnitude, batch)[()])

    @property
    def is_translation(self) -> np.ndarray[tuple[int, ...], np.dtype[np.bool_]]:
        """True where the motion has no rotation: pitch inf, or nothing moves at all."""
        return np.asarray(np.isinf(self.pitch))[()]

    @property
    def twist(self) -> Array:
        """The twist [v; ω] (..., 6) whose exponential is the motion (see screw_to_twist)."""
        return screw_to_twist(self)

    def pose(self, fraction: npt.ArrayLike = 1.0) -> Array:
        """The displacement (..., 4, 4) after a fraction of the motion, broadcast over the leading axes."""
        return exponential_se3(screw_to_twist(self) * as_floats(fraction, "fraction")[..., None])


def screw_of(T: PoseLike) -> Screw:
    """The screw of a displacement: its invariant axis, the rotation about it and the translation along it.

    T = Screw.pose(). The angle lies in [0, π]; up to tolerances.PURE_TRANSLATION_ANGLE it counts as zero.

    T: (..., 4, 4). Source: Chasles 1830; Murray, Li and Sastry 1994, prop. 2.10.
    """
    return _screw_of_twist(logarithm_se3(as_pose(T)), tolerances.PURE_TRANSLATION_ANGLE)


def twist_to_screw(twist: npt.ArrayLike) -> Screw:
    """The screw of a twist.

    axis ω/|ω|, point ω × v/|ω|², pitch ω·v/|ω|², magnitude |ω|; without rotation: axis v/|v|, pitch inf,
    magnitude |v|. A rotation so small that the pitch or the point overflows counts as none.

    twist: [v; ω] (..., 6). Source: Murray, Li and Sastry 1994, section 2.3.3.
    """
    return _screw_of_twist(as_floats(twist, "twist", last=(6,)), 0.0)


def screw_to_twist(screw: Screw) -> Array:
    """The twist of a screw: ω = M u, v = M (q × u + h u); for a pure translation v = M u, ω = 0.

    u axis, q point, h pitch, M magnitude. Returns [v; ω] (..., 6).
    """
    translating = np.isinf(screw.pitch)
    pitch = np.where(translating, 0.0, screw.pitch)[..., None]
    moment = cross(screw.point, screw.axis) + pitch * screw.axis
    v = np.where(translating[..., None], screw.axis, moment)
    w = np.where(translating[..., None], 0.0, screw.axis)
    return np.concatenate([v, w], axis=-1) * np.asarray(screw.magnitude)[..., None]


def _screw_of_twist(xi: Array, smallest_angle: float) -> Screw:
    distance, direction = length_and_direction(xi[..., :3])
    angle, axis = length_and_direction(xi[..., 3:])
    with np.errstate(over="ignore", invalid="ignore", divide="ignore"):
        per_angle = xi[..., :3] / angle[..., None]
        point, pitch = cross(axis, per_angle), np.sum(axis * per_angle, axis=-1)
        turning = (angle > smallest_angle) & np.isfinite(pitch) & np.isfinite(point).all(axis=-1)
    direction = np.where((distance == 0.0)[..., None], np.array([0.0, 0.0, 1.0]), direction)
    return Screw(
        axis=np.where(turning[..., None], axis, direction),
        point=np.where(turning[..., None], point, 0.0),
        pitch=np.where(turning, pitch, np.inf),
        magnitude=np.where(turning, angle, distance),
    )
