"""How well scans fit a map along their rays: likelihood fields see the ends of beams alone."""

from __future__ import annotations

from typing import Any, Final, NamedTuple

import numpy as np
import numpy.typing as npt

from cspace.arrays import Array
from cspace.maps import ByteField, OccupancyGrid, cast_rays
from cspace.spatial import rotation_2d

NEW_SCORE: Final = 0.5
"""The score (0 … 1) below which an end in an unknown cell belongs to no known wall. It is also what such an
end counts where places are compared: a wall is as likely there as not."""
WALL_SLACK: Final = 0.3
"""How far before an end [m] a wall may stand that it does not lie behind of: errors of pose and map."""


def open_unknown(field: ByteField, known: npt.NDArray[np.bool_] | None) -> ByteField:
    """A field in which ends in unknown cells count NEW_SCORE, unless a known wall is near them. Known cells
    are those of a mask, all if it is None.

    Where they count as little as ends in free cells, poses are preferred that turn what the map does not know
    towards known walls: particles drift there, and a search finds such places alone.
    """
    if known is None:
        return field
    new = round(255 * NEW_SCORE)
    scores = np.where(known, field.scores, np.maximum(field.scores, new)).astype(np.uint8)
    return ByteField(scores, field.resolution, field.origin, outside=max(new, field.outside))


class Evidence(NamedTuple):
    """What the rays of a scan say of poses (k,). score (0 … 1): the mean of the field at the ends of those
    beams that the map can judge. unknown: the share of the others, which end in unknown cells and cross no
    wall. whole: the mean of all beams, NEW_SCORE for those, zero for beams through walls. ends: that of all
    ends, as if no beam crossed a wall."""

    score: Array
    unknown: Array
    whole: Array
    ends: Array


class RayJudge:
    """Compares scans with a map along their rays.

    A robot that drives off its map sees what the map does not know; one that is somewhere else sees through
    walls, and no walls where there are some.
    """

    def __init__(self, field: ByteField, walls: OccupancyGrid | None, known: Any) -> None:
        self.field, self.walls, self.known = field, walls, known

    def look(self, ends: Array, laser: Array, poses: Array) -> Evidence:
        """The evidence of beams that end at points (m, 2) in base and begin at a point (2,), from poses
        (k, 3)."""
        R = rotation_2d(poses[:, 2])
        p = np.einsum("kij,mj->kmi", R, ends) + poses[:, None, :2]
        scores, is_new = self._read_cells(p)
        crossing = np.zeros(scores.shape, dtype=bool)
        if self.walls is not None:
            origin = (R @ laser + poses[:, :2])[:, None]
            away = p - origin
            far = np.hypot(away[..., 0], away[..., 1])
            reach = cast_rays(self.walls, origin, np.arctan2(away[..., 1], away[..., 0]))
            crossing = reach < far - WALL_SLACK
        unknown = np.logical_and(is_new, ~crossing)
        counted = np.maximum((~unknown).sum(axis=1), 1)
        return Evidence(
            np.where(unknown, 0.0, scores).sum(axis=1) / counted,
            unknown.mean(axis=1),
            np.where(unknown, NEW_SCORE, np.where(crossing, 0.0, scores)).mean(axis=1),
            np.where(is_new, NEW_SCORE, scores).mean(axis=1),
        )

    def _read_cells(self, points: Array) -> tuple[Array, npt.NDArray[np.bool_]]:
        """The scores (0 … 1) at points (k, m, 2), and which lie in unknown cells at no known wall."""
        field = self.field
        cells = np.floor((points - field.origin) / field.resolution).astype(int)
        inside = np.asarray(((cells >= 0) & (cells < field.scores.shape[::-1])).all(axis=-1))
        columns, rows = np.moveaxis(np.where(inside[..., None], cells, 0), -1, 0)
        scores = np.where(inside, field.scores[rows, columns], field.outside) / 255.0
        if self.known is None:
            return scores, np.zeros(scores.shape, dtype=bool)
        is_new = np.logical_not(inside & self.known[rows, columns])
        return scores, np.asarray(is_new & (scores < NEW_SCORE))
