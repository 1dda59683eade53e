"""Waypoints: what the makers of paths are given."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from cspace.arrays import Array, as_floats
from cspace.errors import InputError
from cspace.tables import count_things
from cspace.tolerances import FARTHEST_WAYPOINT, SAME_WAYPOINT, SHORTEST_PIECE


class Waypoints(NamedTuple):
    """Waypoints q (k, dof) of which no neighbours are the same, the distances between them (k − 1,), and how
    many were merged."""

    q: Array
    distances: Array
    merged: int

    @property
    def remarks(self) -> list[str]:
        """What became of waypoints that are the same."""
        if not self.merged:
            return []
        return [f"{count_things(self.merged, 'waypoint')} merged with the one before"]


def read_waypoints(waypoints: ArrayLike) -> Waypoints:
    """Waypoints (k, dof) without those that are the same as the one before; both ends are kept as given.

    Raises InputError for another shape, NaN, and waypoints that are all the same.
    """
    given = as_floats(waypoints, "waypoints", largest=FARTHEST_WAYPOINT)
    if given.ndim != 2 or len(given) < 2 or given.shape[1] == 0:
        raise InputError(f"waypoints has shape {given.shape}, expected (k, dof) with k ≥ 2 and dof ≥ 1")
    least = SAME_WAYPOINT * float(np.linalg.norm(np.diff(given, axis=0), axis=1).sum())
    kept = [0]
    for i in range(1, len(given)):
        if np.linalg.norm(given[i] - given[kept[-1]]) > least:
            kept.append(i)
    while len(kept) > 1 and np.linalg.norm(given[-1] - given[kept[-1]]) <= least:
        kept.pop()
    if kept[-1] != len(given) - 1:
        kept.append(len(given) - 1)
    q = given[kept]
    distances = np.linalg.norm(np.diff(q, axis=0), axis=1)
    if len(q) < 2 or not distances.any():
        raise InputError("the waypoints are all the same; a path needs two that differ")
    if distances.min() < SHORTEST_PIECE:
        raise InputError(
            f"waypoints {distances.min():g} apart are too close; the least distance is {SHORTEST_PIECE:g}"
        )
    return Waypoints(q, distances, len(given) - len(kept))
