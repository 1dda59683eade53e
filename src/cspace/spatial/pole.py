"""The pole: every displacement of the plane is one translation or one rotation about a point."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from cspace import tolerances
from cspace.arrays import Array
from cspace.spatial.checks import as_pose_2d
from cspace.spatial.planar import angle_of


@dataclass(frozen=True, eq=False)
class Pole:
    """The point that a planar displacement leaves in place, if there is one.

    exists: (...) bool. point: (..., 2) [m], NaN where there is no pole. angle: the turn about it (...) in
    (−π, π] [rad], 0 for a pure translation. translation: (..., 2) [m], what a displacement without a pole
    moves by, and zero where there is a pole. False as a condition if no displacement has a pole.
    """

    exists: np.ndarray[tuple[int, ...], np.dtype[np.bool_]]
    point: Array
    angle: Array
    translation: Array

    def __bool__(self) -> bool:
        return bool(np.any(self.exists))

    @property
    def reason(self) -> str:
        """Why there is no pole; empty if every displacement has one."""
        if np.all(self.exists):
            return ""
        if np.ndim(self.exists) == 0:
            x, y = self.translation
            return f"a pure translation by ({x:g}, {y:g}) has no fixed point"
        missing = int(np.sum(~self.exists))
        return f"{missing} of {np.size(self.exists)} displacements are pure translations and have no pole"


def pole_of(T: Any) -> Pole:
    """The pole of a planar displacement: the point c with R c + t = c, so that T rotates the plane about c.

    c = (t + cot(θ/2) t⊥)/2 with t⊥ = (−t_y, t_x). A turn up to tolerances.PURE_TRANSLATION_ANGLE counts as
    none: a pure translation has no pole, which is an answer (falsy, with `reason`), not an error. The
    identity leaves every point in place: a translation by zero, and no single pole.

    T: (..., 3, 3).
    """
    T = as_pose_2d(T)
    x, y, angle = T[..., 0, 2], T[..., 1, 2], angle_of(T[..., :2, :2])
    exists = np.abs(angle) > tolerances.PURE_TRANSLATION_ANGLE
    cot = 1.0 / np.tan(0.5 * np.where(exists, angle, 1.0))
    point = 0.5 * np.stack([x - cot * y, y + cot * x], axis=-1)
    return Pole(
        exists=np.asarray(exists)[()],
        point=np.where(exists[..., None], point, np.nan),
        angle=np.where(exists, angle, 0.0)[()],
        translation=np.where(exists[..., None], 0.0, T[..., :2, 2]),
    )
