"""Where particles are put: around poses, and anywhere on the free cells of a map."""

from __future__ import annotations

from typing import Any, Final

import numpy as np
import numpy.typing as npt

from cspace import _core
from cspace.arrays import Array
from cspace.errors import InputError
from cspace.localization.filters.rows import move_pose
from cspace.localization.log import Landmarks
from cspace.maps import ByteField

START_SLACK: Final = 0.3
"""How far from the free cells a start may lie [m]: the thickness of a wall drawn too thick."""
LANDMARK_REACH: Final = 10.0
"""How far around landmarks particles are put [m] where the range of the sensor is not limited."""

BLOCK: Final = 1 << 16
"""Poses that are made at once: their intermediate numbers take a tenth of the memory of a million poses."""

LEAST_WEIGHT: Final = 2.0**-32
"""The unit of weights, over the greatest."""


class FreePlaces:
    """The places where a robot may be."""

    def __init__(self, grid: Any, reach: float) -> None:
        self.blocked: npt.NDArray[np.bool_] | None = None
        if isinstance(grid, Landmarks):
            far = reach if np.isfinite(reach) else LANDMARK_REACH
            self.low, self.high = grid.points.min(axis=0) - far, grid.points.max(axis=0) + far
            return
        if isinstance(grid, ByteField):
            self.blocked = np.zeros(grid.scores.shape, dtype=bool)
            self.side, self.low = grid.resolution, np.asarray(grid.origin)
        else:
            cells = grid.to_grid()
            self.blocked, self.side, self.low = cells.blocked, cells.resolution, cells.origin
        if self.blocked.all():
            raise InputError("the map has no free cells; a robot can be nowhere on it")
        rows, columns = self.blocked.shape
        self.high = self.low + self.side * np.array([columns, rows])

    def draw(self, count: int, rng: np.random.Generator) -> Array:
        """Poses (count, 3) anywhere, with any heading."""
        free = None if self.blocked is None else np.flatnonzero(~self.blocked.ravel())
        poses = np.empty((count, 3))
        for begin in range(0, count, BLOCK):
            block = poses[begin : begin + BLOCK]
            block[:, :2] = self._draw_points(free, len(block), rng)
            block[:, 2] = rng.uniform(-np.pi, np.pi, len(block))
        return poses

    def _draw_points(self, free: npt.NDArray[np.intp] | None, count: int, rng: np.random.Generator) -> Array:
        """Points (count, 2) in the cells of numbers `free` (k,), or between the bounds."""
        if self.blocked is None or free is None:
            return rng.uniform(self.low, self.high, (count, 2))
        rows, columns = np.divmod(free[rng.integers(len(free), size=count)], self.blocked.shape[1])
        return np.asarray(self.low + self.side * (np.stack([columns, rows], -1) + rng.random((count, 2))))

    def are_free(self, points: Array) -> npt.NDArray[np.bool_]:
        """Whether points (k, 2) lie in free cells: (k,)."""
        if self.blocked is None:
            return np.ones(len(points), dtype=bool)
        cells = np.floor((points - self.low) / self.side)[:, ::-1]
        inside = ((cells >= 0) & (cells < self.blocked.shape)).all(axis=1)
        rows, columns = np.where(inside[:, None], cells, 0).astype(int).T
        free: npt.NDArray[np.bool_] = inside & ~self.blocked[rows, columns]
        return free

    def find_coarse_cells(self, side: float, shape: tuple[int, int]) -> npt.NDArray[np.bool_]:
        """Which larger cells of a side [m], from the same corner, hold a free cell: (rows, columns)."""
        assert self.blocked is not None
        rows, columns = np.nonzero(~self.blocked)
        coarse = np.zeros(shape, dtype=bool)
        at = [
            np.minimum(((k + 0.5) * self.side / side).astype(int), n - 1)
            for k, n in zip((rows, columns), shape, strict=True)
        ]
        coarse[at[0], at[1]] = True
        return coarse

    def check_start(self, pose: Array) -> None:
        """InputError for a start off the map, or deep in a wall."""
        x, y = pose[:2]
        if self.blocked is None:
            return
        if not ((pose[:2] >= self.low) & (pose[:2] <= self.high)).all():
            spans = f"x {self.low[0]:g} … {self.high[0]:g}, y {self.low[1]:g} … {self.high[1]:g} [m]"
            raise InputError(
                f"start ({x:g}, {y:g}) is off the map, which spans {spans}; give start=None to search"
            )
        reach = np.arange(-START_SLACK, START_SLACK + self.side, min(self.side, START_SLACK))
        around = np.stack(np.meshgrid(reach, reach), axis=-1).reshape(-1, 2)
        near = pose[:2] + around[np.hypot(*around.T) <= START_SLACK]
        if not self.are_free(np.concatenate([pose[None, :2], near])).any():
            raise InputError(
                f"start ({x:g}, {y:g}) lies in a wall, {START_SLACK:g} m or more from free cells; move it,"
                " or give start=None to search"
            )


def spread_poses(
    cloud: _core.ParticleCloud, centers: Array, covariance: Array, places: FreePlaces, count: int
) -> Array:
    """Poses (count, 3) around centers (k, 3) in turn, T exp(w) with w normal; in walls the center instead."""
    poses = np.empty((count, 3))
    values, vectors = np.linalg.eigh(covariance)
    for begin in range(0, count, BLOCK):
        block = poses[begin : begin + BLOCK]
        around = centers[np.arange(begin, begin + len(block)) % len(centers)]
        w = cloud.draw_normals(len(block)) * np.sqrt(np.maximum(values, 0.0)) @ vectors.T
        moved = move_pose(around, w)
        block[:] = np.where(places.are_free(moved[:, :2])[:, None], moved, around)
    return poses


def lift_share(cloud: _core.ParticleCloud, count: int, least: float) -> None:
    """Gives the first particles so much more weight that their share of it is at least so large."""
    first = np.arange(len(cloud)) < count
    for _ in range(2):  # weights below 2⁻³² are zero until the first
        share = float(cloud.weights()[:count].sum())
        if share >= least:
            return
        share = max(share, LEAST_WEIGHT)
        lift = np.log(least / (1 - least)) - np.log(share / (1 - share))
        cloud.add_logs(np.where(first, lift, 0.0))
