"""Measurements of a pose: the value, its noise, what a pose predicts, and the derivative by its disturbance.

The derivative is by ξ of T exp ξ. A fixed point of the map that lies at q in base moves there by
[−I, (q_y, −q_x)ᵀ] ξ, so that neither a sine nor a coordinate of the map enters.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
import numpy.typing as npt

from cspace import tolerances
from cspace.arrays import Array
from cspace.localization.sensors import RangeBearing
from cspace.spatial import rotation_2d

Columns = npt.NDArray[np.bool_]


class Measurement(Protocol):
    """Numbers (d,) that a pose predicts."""

    @property
    def value(self) -> Array:
        """The numbers (d,)."""

    @property
    def angular(self) -> Columns:
        """Which of the numbers are angles, (d,): their differences are wrapped."""

    def predict(self, poses: Array) -> Array:
        """What poses (..., 3) would make the sensor read, (..., d)."""

    def linearize(self, pose: Array) -> tuple[Array, Array]:
        """The derivative H (d, 3) at a pose (3,), and the covariance of the noise there (d, d)."""


@dataclass(frozen=True, eq=False)
class LandmarkReading:
    """Range and bearing of a known landmark, or one of them."""

    value: Array
    angular: Columns
    used: npt.NDArray[np.intp]
    sensor: RangeBearing
    point: Array
    spread: Array | None

    def predict(self, poses: Array) -> Array:
        """Range and bearing from poses (..., 3), those that were measured: (..., d)."""
        p = see_point(self.point, poses, self.sensor.mount)
        both = np.stack([np.hypot(p[..., 0], p[..., 1]), np.arctan2(p[..., 1], p[..., 0])], axis=-1)
        return np.asarray(both[..., self.used])

    def linearize(self, pose: Array) -> tuple[Array, Array]:
        """H (d, 3) and the covariance (d, d), with that of the landmark."""
        by_point, H, noise = linearize_points(self.point[None], pose, self.sensor)
        R = noise
        if self.spread is not None:
            turned = by_point[0] @ rotation_2d(pose[2] + self.sensor.mount[2]).T
            R = R + turned @ self.spread @ turned.T
        return H[0][self.used], R[np.ix_(self.used, self.used)]


def see_point(point: Array, poses: Array, mount: tuple[float, float, float]) -> Array:
    """Points (..., 2) of the map in the frame of a sensor on base at poses (..., 3)."""
    c, s = np.cos(poses[..., 2]), np.sin(poses[..., 2])
    dx, dy = point[..., 0] - poses[..., 0], point[..., 1] - poses[..., 1]
    x, y = c * dx + s * dy - mount[0], c * dy - s * dx - mount[1]
    c, s = np.cos(mount[2]), np.sin(mount[2])
    return np.stack([c * x + s * y, c * y - s * x], axis=-1)


def linearize_points(points: Array, pose: Array, sensor: RangeBearing) -> tuple[Array, Array, Array]:
    """Derivatives of range and bearing of points (m, 2): by the point in the sensor's axes (m, 2, 2), by the
    disturbance of the pose (m, 2, 3), and the covariance of the sensor (2, 2)."""
    p = see_point(points, pose, sensor.mount)
    square = np.maximum((p**2).sum(axis=-1), tolerances.CLOSEST_LANDMARK**2)
    r = np.sqrt(square)
    along, across = p / r[:, None], np.stack([-p[:, 1], p[:, 0]], axis=-1) / square[:, None]
    by_point = np.stack([along, across], axis=-2)
    to_sensor = rotation_2d(-sensor.mount[2])
    q = p @ to_sensor + np.array(sensor.mount[:2])
    by_pose = np.empty((len(points), 2, 3))
    by_pose[:, :, :2] = -np.eye(2)
    by_pose[:, 0, 2], by_pose[:, 1, 2] = q[:, 1], -q[:, 0]
    noise = np.diag([sensor.range_sigma**2, sensor.bearing_sigma**2])
    return by_point, by_point @ to_sensor @ by_pose, noise


@dataclass(frozen=True, eq=False)
class CompassReading:
    """The heading, less its bias."""

    value: Array
    sigma: float
    angular: Columns

    def predict(self, poses: Array) -> Array:
        """θ of poses (..., 3) as (..., 1)."""
        return poses[..., 2:]

    def linearize(self, pose: Array) -> tuple[Array, Array]:
        """H = (0, 0, 1) and the variance, at any pose (3,): (1, 3), (1, 1)."""
        return np.array([[0.0, 0.0, 1.0]]), np.array([[self.sigma**2]])


@dataclass(frozen=True, eq=False)
class PositionReading:
    """The position of an antenna on a lever."""

    value: Array
    sigma: float
    lever: tuple[float, float]
    angular: Columns

    def predict(self, poses: Array) -> Array:
        """Where the antenna is at poses (..., 3), (..., 2)."""
        c, s = np.cos(poses[..., 2]), np.sin(poses[..., 2])
        x, y = self.lever
        return np.stack([poses[..., 0] + c * x - s * y, poses[..., 1] + s * x + c * y], axis=-1)

    def linearize(self, pose: Array) -> tuple[Array, Array]:
        """H = R [I, (−lever_y, lever_x)ᵀ] at a pose (3,), and the covariance: (2, 3), (2, 2)."""
        x, y = self.lever
        H = rotation_2d(pose[2]) @ np.array([[1.0, 0.0, -y], [0.0, 1.0, x]])
        return H, self.sigma**2 * np.eye(2)
