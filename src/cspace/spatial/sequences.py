"""Rotations as three rotations about coordinate axes: the 12 Euler and the 12 fixed-axis sequences.

Euler "ZYX" with angles (a, b, c) turns about the moving z, then the moving y, then the moving x:
R = Rz(a) Ry(b) Rx(c). Fixed "XYZ" with angles (c, b, a) turns about the axes that stand still, x first:
R = Rz(a) Ry(b) Rx(c), the same rotation. A fixed sequence is the Euler sequence in reverse order.
"""

from __future__ import annotations

from math import atan2, cos, hypot, pi, sin
from typing import Any, Final

import numpy as np

from cspace import tolerances
from cspace.arrays import Array
from cspace.errors import InputTypeError, UnknownNameError, suggest
from cspace.spatial import single
from cspace.spatial.checks import RotationLike, as_rotation

SEQUENCES: Final[tuple[str, ...]] = tuple(
    i + j + k for i in "XYZ" for j in "XYZ" for k in "XYZ" if i != j and j != k
)
"""The twelve sequences, in which no axis occurs twice in a row, for moving and for fixed axes."""


def to_euler(R: RotationLike, sequence: str) -> Array:
    """The angles of a rotation or pose as rotations about moving axes, R = R_i(a) R_j(b) R_k(c).

    The middle angle lies in [−π/2, π/2] if i, j, k differ and in [0, π] if i = k, the others in (−π, π].
    Where the middle angle puts the outer axes on one line (gimbal lock), the last angle is zero; the angles
    reproduce R to rounding there as everywhere.

    R: (..., 3, 3) or (..., 4, 4). sequence: one of SEQUENCES, such as "ZYX" → (..., 3) [rad].
    Raises UnknownNameError for another sequence. Source: Craig 2005, section 2.8.
    """
    return euler_angles(as_rotation(R), axes_of(sequence), middle=1.0)


def to_fixed(R: RotationLike, sequence: str) -> Array:
    """The angles of a rotation or pose as rotations about fixed axes, the first listed applied first.

    R = R_k(c) R_j(b) R_i(a). Ranges and gimbal lock as in to_euler: the last angle listed is zero there.

    R: (..., 3, 3) or (..., 4, 4). sequence: one of SEQUENCES, such as "XYZ" → (..., 3) [rad].
    Raises UnknownNameError for another sequence. Source: Craig 2005, section 2.8.
    """
    return fixed_angles(as_rotation(R), axes_of(sequence))


def to_rpy(R: RotationLike) -> Array:
    """Roll, pitch and yaw of a rotation or pose: fixed axes x, y, z, as in URDF.

    R = Rz(yaw) Ry(pitch) Rx(roll), pitch in [−π/2, π/2]; at pitch = ±π/2 the yaw is zero.

    R: (..., 3, 3) or (..., 4, 4) → (..., 3) [rad].
    """
    return fixed_angles(as_rotation(R), (0, 1, 2))


def axes_of(sequence: str) -> tuple[int, int, int]:
    """The axis numbers of a name, "ZYX" → (2, 1, 0); an unknown name is refused with the nearest ones."""
    if not isinstance(sequence, str):
        raise InputTypeError(
            f"a sequence of axes is a string such as 'ZYX', got {type(sequence).__name__}; "
            "euler= and fixed= take a pair (sequence, angles)"
        )
    if sequence in SEQUENCES:
        i, j, k = ("XYZ".index(letter) for letter in sequence)
        return i, j, k
    if sequence.upper() in SEQUENCES:
        raise UnknownNameError(
            f"no sequence {sequence!r}: axes are written in capitals, {sequence.upper()!r}; the "
            "keyword is euler= for moving axes and fixed= for fixed axes (lower case means fixed in scipy)"
        )
    raise suggest("sequence", sequence, SEQUENCES)


def matrix_of_euler(axes: tuple[int, int, int], angles: Array) -> Array:
    """R_i(a) R_j(b) R_k(c) for angles (..., 3)."""
    if angles.ndim == 1:
        return single.matrix(single.euler(axes, angles.tolist()))
    R = np.zeros((*angles.shape[:-1], 3, 3))
    cos, sin = np.cos(angles), np.sin(angles)
    i = axes[0]
    u, v = (i + 1) % 3, (i + 2) % 3
    R[..., i, i] = 1.0
    R[..., u, u] = R[..., v, v] = cos[..., 0]
    R[..., u, v], R[..., v, u] = -sin[..., 0], sin[..., 0]
    for n in (1, 2):
        _turn_about(R, axes[n], cos[..., n, None], sin[..., n, None])
    return R


def matrix_of_fixed(axes: tuple[int, int, int], angles: Array) -> Array:
    """R_k(c) R_j(b) R_i(a) for angles (..., 3): the Euler sequence in reverse order."""
    return matrix_of_euler((axes[2], axes[1], axes[0]), angles[..., ::-1])


def _turn_about(R: Array, axis: int, cos: Array, sin: Array) -> None:
    """R ← R R_axis: the two columns across the axis mix, in place."""
    u, v = (axis + 1) % 3, (axis + 2) % 3
    first, second = R[..., :, u].copy(), R[..., :, v].copy()
    R[..., :, u] = cos * first + sin * second
    R[..., :, v] = cos * second - sin * first


def fixed_angles(R: Array, axes: tuple[int, int, int]) -> Array:
    """to_fixed without checks: Rᵀ is the Euler sequence of the same order with the angles negated."""
    return _half_open(-euler_angles(np.swapaxes(R, -1, -2), axes, middle=-1.0))


def euler_angles(R: Array, axes: tuple[int, int, int], *, middle: float) -> Array:
    """to_euler without checks; where i = k, `middle` is the sign of the middle angle.

    The row i of R holds only the middle and the last angle. The first is then read from R R_k(−c), whose
    column j it alone turns: so it makes up for any noise in c, and the angles reproduce R near gimbal lock.
    """
    if R.ndim == 2:
        found = _angles(R.tolist(), axes, middle, hypot, atan2, cos, sin)
        return np.array([pi if x == -pi else x + 0.0 for x in found])
    rows = np.moveaxis(R, (-2, -1), (0, 1))
    return _half_open(np.stack(_angles(rows, axes, middle, np.hypot, np.arctan2, np.cos, np.sin), axis=-1))


def _angles(
    rows: Any, axes: tuple[int, int, int], middle: float, hypot: Any, atan2: Any, cos: Any, sin: Any
) -> tuple[Any, Any, Any]:
    """The angles of a matrix whose entries are numbers or arrays, by functions of these."""
    i, j, k = axes
    third = 3 - i - j
    parity = 1.0 if (j - i) % 3 == 1 else -1.0
    row = rows[i]
    if i == k:
        far = hypot(row[j], row[third])
        b, c = atan2(middle * far, row[i]), atan2(middle * row[j], middle * parity * row[third])
        other, turn = third, -parity
    else:
        far = hypot(row[i], row[j])
        b, c = atan2(parity * row[k], far), atan2(-parity * row[j], row[i])
        other, turn = i, parity
    c = c * (far > tolerances.GIMBAL_LOCK)
    cos_c, sin_c = cos(c), turn * sin(c)
    across = cos_c * rows[third][j] + sin_c * rows[third][other]
    along = cos_c * rows[j][j] + sin_c * rows[j][other]
    return atan2(parity * across, along), b, c


def _half_open(angles: Array) -> Array:
    """−π becomes π and −0 becomes 0."""
    return np.where(angles == -np.pi, np.pi, angles) + 0.0
