"""Poses, covariances and maps as they are given: checked, or refused with a remedy."""

from __future__ import annotations

import os
from typing import Any, ClassVar

import numpy as np
import numpy.typing as npt

from cspace import tolerances
from cspace.arrays import Array, as_floats, one_array
from cspace.errors import InputError, InputTypeError, name_type
from cspace.spatial import as_pose_2d, to_xytheta
from cspace.tolerances import FARTHEST_POINT


def read_pose(pose: npt.ArrayLike, subject: str = "start") -> Array:
    """A pose (3,), given as x, y, θ (3,) or (3, 3)."""
    if isinstance(pose, np.ndarray) and pose.shape == (3, 3):
        return np.ascontiguousarray(to_xytheta(as_pose_2d(pose, subject)))
    row = as_floats(pose, subject, largest=FARTHEST_POINT)
    if row.shape == (3, 3):
        return np.ascontiguousarray(to_xytheta(as_pose_2d(row, subject)))
    return one_array(row, subject, (3,), "x, y [m], θ [rad]")


def read_covariance(covariance: npt.ArrayLike, subject: str = "start_covariance") -> Array:
    """A covariance (3, 3) of a pose, symmetrised; InputError for one that is none."""
    rule = "variances on the diagonal, np.diag(...)"
    P = one_array(covariance, subject, (3, 3), rule, largest=tolerances.LARGEST_VARIANCE)
    least = float(np.linalg.eigvalsh(P)[0])
    if (
        np.abs(P - P.T).max() > tolerances.COVARIANCE_SYMMETRY * max(1.0, np.abs(P).max())
        or least < -abs(P).max() * tolerances.COVARIANCE_SYMMETRY
    ):
        raise InputError(
            f"{subject} is not symmetric and positive semi-definite (least eigenvalue {least:.3g});"
            " give variances on the diagonal, np.diag(...)"
        )
    return 0.5 * (P + P.T)


class Running:
    """Something that runs and changes: neither copied nor pickled, since a copy would share its state."""

    _instead: ClassVar[str]
    """What to keep in place of it."""

    def __reduce_ex__(self, protocol: Any) -> Any:
        raise InputTypeError(f"{name_type(self)} is neither copied nor pickled; {self._instead}")


def suggest_map(value: object) -> str:
    """What to do about an object that is no map, as the end of a message."""
    if isinstance(value, (str, os.PathLike)):
        return "read a ROS map with cspace.maps.EvidenceGrid.from_ros(path)"
    return "give an EvidenceGrid, an OccupancyGrid, or cspace.localization.Landmarks(names, points)"
