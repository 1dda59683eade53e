"""Writes pose graphs as g2o files."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING

import numpy as np

from cspace.arrays import Array
from cspace.errors import InputError
from cspace.files import write_text
from cspace.spatial import to_xyzw

if TYPE_CHECKING:
    from cspace.localization.graph.graph_arrays import GraphArrays


def write_g2o(graph: GraphArrays, path: str | os.PathLike[str]) -> None:
    """See PoseGraph.to_g2o."""
    check_writable(graph)
    write_text(path, "".join(line + "\n" for line in list_lines(graph)))


def check_writable(graph: GraphArrays) -> None:
    """InputError for what g2o has no record for."""
    shared = np.intersect1d(graph.ids, graph.landmark_ids)
    if len(shared):
        raise InputError(
            f"id {shared[0]} names a pose and a landmark; g2o numbers both together: change landmark_ids"
        )
    if (np.concatenate([graph.ids, graph.landmark_ids]) < 0).any():
        raise InputError("ids has a negative number; g2o numbers vertices from 0")
    ranges = np.flatnonzero(graph.ranged & graph.measured[:, 0])
    if len(ranges):
        raise InputError(
            f"sighting {ranges[0]} is a range; g2o has records for points and bearings alone: give"
            " points (x, y)"
            " instead of ranges"
        )


def list_lines(graph: GraphArrays) -> Iterator[str]:
    """The records: vertices, what is fixed, edges, sightings."""
    kind = "SE3:QUAT" if graph.is_spatial else "SE2"
    for name, row in zip(graph.ids, flatten_poses(graph.poses), strict=True):
        yield f"VERTEX_{kind} {name} {join_numbers(row)}"
    for name, row in zip(graph.landmark_ids, graph.landmarks, strict=True):
        yield f"VERTEX_{'TRACKXYZ' if graph.is_spatial else 'XY'} {name} {join_numbers(row)}"
    if graph.is_spatial and len(graph.sightings):
        yield "PARAMS_SE3OFFSET 0 0 0 0 0 0 0 1"
    for name in [*graph.ids[graph.fixed], *graph.landmark_ids[graph.fixed_landmarks]]:
        yield f"FIX {name}"
    upper = np.triu_indices(graph.information.shape[-1])
    for (i, j), motion, W in zip(
        graph.ids[graph.edges], flatten_poses(graph.motions), graph.information, strict=True
    ):
        yield f"EDGE_{kind} {i} {j} {join_numbers(motion)} {join_numbers(W[upper])}"
    yield from list_sightings(graph)


def list_sightings(graph: GraphArrays) -> Iterator[str]:
    """The records of the sightings."""
    upper = np.triu_indices(graph.dimension)
    for k, (row, landmark) in enumerate(graph.sightings):
        ends = f"{graph.ids[row]} {graph.landmark_ids[landmark]}"
        point, W = graph.points[k], graph.point_information[k]
        if graph.is_spatial:
            yield f"EDGE_SE3_TRACKXYZ {ends} 0 {join_numbers(point)} {join_numbers(W[upper])}"
        elif graph.ranged[k]:
            yield f"EDGE_BEARING_SE2_XY {ends} {join_numbers([point[1], W[1, 1]])}"
        else:
            yield f"EDGE_SE2_XY {ends} {join_numbers(point)} {join_numbers(W[upper])}"


def flatten_poses(poses: Array) -> Array:
    """Rows x, y, θ, or x, y, z and the quaternion x, y, z, w."""
    if poses.ndim == 2:
        return poses
    return np.concatenate([poses[:, :3, 3], to_xyzw(poses[:, :3, :3])], axis=1)


def join_numbers(row: Iterable[float]) -> str:
    """Numbers with all their digits."""
    return " ".join(f"{float(x):.17g}" for x in row)
