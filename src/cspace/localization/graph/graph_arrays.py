"""The arrays of a pose graph: poses and landmarks as unknowns, and what was measured between them."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any, TypeVar

import numpy as np
import numpy.typing as npt

from cspace._core import find_graph_parts
from cspace.arrays import Array, any_array, as_floats, one_array
from cspace.errors import InputError
from cspace.localization.graph.checks import (
    Ids,
    Mask,
    Rows,
    check_points,
    freeze_array,
    read_ids,
    read_information,
    read_pairs,
    read_poses,
    read_rows,
)
from cspace.tables import count_things, one_line
from cspace.tolerances import LARGEST_IN_GRAPH

Graph = TypeVar("Graph", bound="GraphArrays")


@dataclass(frozen=True, eq=False, repr=False)
class GraphArrays:
    """The data of a PoseGraph, which says what they are; its arrays cannot be changed."""

    poses: Array
    edges: Rows
    motions: Array
    information: Array
    landmarks: Array = field(default_factory=lambda: np.zeros((0, 0)))
    sightings: Rows = field(default_factory=lambda: np.zeros((0, 2), np.int32))
    points: Array = field(default_factory=lambda: np.zeros((0, 0)))
    point_information: Array = field(default_factory=lambda: np.zeros((0, 0, 0)))
    ranged: Mask = field(default_factory=lambda: np.zeros(0, bool))
    fixed: npt.NDArray[np.intp] = field(default_factory=lambda: np.zeros(1, np.intp))
    fixed_landmarks: npt.NDArray[np.intp] = field(default_factory=lambda: np.zeros(0, np.intp))
    ids: Ids = field(default_factory=lambda: np.zeros(0, np.int64))
    landmark_ids: Ids = field(default_factory=lambda: np.zeros(0, np.int64))
    start_given: bool = True
    notes: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        self._set("poses", read_poses(self.poses, "poses"))
        n = len(self.poses)
        if n == 0:
            raise InputError("poses has no rows; a graph has one pose at least")
        self._set("edges", read_pairs(self.edges, "edges", n, n, "rows of two poses"))
        own = np.flatnonzero(self.edges[:, 0] == self.edges[:, 1])
        if len(own):
            raise InputError(
                f"edges joins pose {self.edges[own[0], 0]} to itself at row {own[0]}; leave it out"
            )
        size = 6 if self.is_spatial else 3
        self._set("motions", self._read_motions())
        self._set("information", read_information(self.information, "information", len(self.edges), size))
        self._read_sightings()
        self._set("fixed", read_rows(self.fixed, "fixed", n))
        self._set("fixed_landmarks", read_rows(self.fixed_landmarks, "fixed_landmarks", len(self.landmarks)))
        self._set("ids", read_ids(self.ids if any_array(self.ids, "ids").size else np.arange(n), "ids", n))
        m, first = len(self.landmarks), int(self.ids.max()) + 1
        given = any_array(self.landmark_ids, "landmark_ids")
        names = given if given.size else np.arange(first, first + m)
        self._set("landmark_ids", read_ids(names, "landmark_ids", m))

    def _set(self, name: str, array: Any) -> None:
        object.__setattr__(self, name, freeze_array(array))

    def _read_motions(self) -> Array:
        if not len(self.edges):
            return np.zeros((0, *self.poses.shape[1:]))
        motions = read_poses(self.motions, "motions")
        if motions.shape != (len(self.edges), *self.poses.shape[1:]):
            raise InputError(
                f"motions has shape {motions.shape}, expected {(len(self.edges), *self.poses.shape[1:])}: one"
                " per edge, of the kind of the poses"
            )
        return motions

    def _read_sightings(self) -> None:
        d = self.dimension
        places = as_floats(self.landmarks, "landmarks", largest=LARGEST_IN_GRAPH)
        places = places if places.size else np.zeros((0, d))
        self._set("landmarks", np.array(one_array(places, "landmarks", (None, d))))
        rows = read_pairs(
            self.sightings, "sightings", len(self.poses), len(self.landmarks), "rows of a pose and a landmark"
        )
        self._set("sightings", rows)
        points = as_floats(self.points, "points", finite=False) if len(rows) else np.zeros((0, d))
        if points.shape != (len(rows), d):
            raise InputError(f"points has shape {points.shape}, expected {(len(rows), d)}: one per sighting")
        ranged = np.zeros(len(rows), bool)
        given = any_array(self.ranged, "ranged")
        if given.size:
            ranged = given.astype(bool) if given.dtype.kind in "biu" else given
        if ranged.dtype != np.bool_:
            raise InputError(f"ranged is {ranged.dtype}; give a truth value per sighting")
        if ranged.shape != (len(rows),):
            raise InputError(f"ranged has shape {ranged.shape}, expected ({len(rows)},): one per sighting")
        check_points(points, ranged, "points")
        self._set("points", np.array(points))
        self._set("ranged", ranged)
        information = self.point_information if len(rows) else np.zeros((0, d, d))
        self._set("point_information", read_information(information, "point_information", len(rows), d))

    @property
    def is_spatial(self) -> bool:
        """Whether the poses are those of space."""
        return self.poses.ndim == 3

    @property
    def dimension(self) -> int:
        """2 in the plane, 3 in space."""
        return 3 if self.is_spatial else 2

    @cached_property
    def measured(self) -> Mask:
        """Which coordinates of the sightings were measured, (s, 2) or (s, 3)."""
        return np.asarray(~np.isnan(self.points))

    @property
    def dof(self) -> int:
        """Measured numbers minus unknown ones: the degrees of freedom of χ²."""
        size = 6 if self.is_spatial else 3
        unknown = size * (len(self.poses) - len(self.fixed))
        unknown += self.dimension * (len(self.landmarks) - len(self.fixed_landmarks))
        return size * len(self.edges) + int(self.measured.sum()) - unknown

    @cached_property
    def parts(self) -> npt.NDArray[np.intp]:
        """The connected part of each pose, then of each landmark, numbered from 0: (n + m,)."""
        found = find_graph_parts(len(self.poses), len(self.landmarks), self.edges, self.sightings)
        return np.array(found, dtype=np.intp)

    @property
    def consecutive(self) -> Mask:
        """Which edges join neighbouring rows, as odometry does: (k,)."""
        return np.asarray(np.abs(self.edges[:, 1] - self.edges[:, 0]) == 1)

    def with_poses(self: Graph, poses: Any, landmarks: Any = None) -> Graph:
        """The graph with another start: poses (n, 3) or (n, 4, 4), and landmarks (m, 2) or (m, 3)."""
        changed = replace(
            self, poses=poses, landmarks=self.landmarks if landmarks is None else landmarks, start_given=True
        )
        if changed.poses.shape != self.poses.shape or changed.landmarks.shape != self.landmarks.shape:
            raise InputError(
                f"poses has shape {changed.poses.shape} and landmarks {changed.landmarks.shape}; the"
                " graph has"
                f" {self.poses.shape} and {self.landmarks.shape}"
            )
        return changed

    def __repr__(self) -> str:
        text = f"{count_things(len(self.poses), 'pose')}, {count_things(len(self.edges), 'edge')}"
        if len(self.landmarks):
            text += f", {count_things(len(self.landmarks), 'landmark')}"
            text += f", {count_things(len(self.sightings), 'sighting')}"
        return one_line("PoseGraph", text + (" in space" if self.is_spatial else " in the plane"))
