"""Triangles as arrays: the nearest point, the winding number, volume and open edges."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from cspace.arrays import Array

Faces = npt.NDArray[np.intp]

MOST_PAIRS = 1 << 20
"""Pairs of a point and a triangle that are evaluated at once."""


def nearest_on_triangles(points: Array, triangles: Array) -> tuple[Array, Faces]:
    """The nearest point (n, 3) on triangles (m, 3, 3) for each of points (n, 3), and its triangle (n,).

    Only triangles whose bounding ball may hold the nearest point are evaluated: the centroid of a triangle is
    one of its points, so the least distance to a centroid is an upper bound.
    """
    nearest, which = np.empty_like(points), np.empty(len(points), dtype=np.intp)
    center = triangles.mean(axis=1)
    radius = np.linalg.norm(triangles - center[:, None], axis=-1).max(axis=1)
    step = max(1, MOST_PAIRS // max(1, len(triangles)))
    for first in range(0, len(points), step):
        some = points[first : first + step]
        apart = np.linalg.norm(some[:, None] - center, axis=-1)
        rows, columns = np.nonzero(apart - radius <= apart.min(axis=1, keepdims=True))
        found = nearest_of_pairs(some[rows], triangles[columns])
        distance = np.linalg.norm(some[rows] - found, axis=-1)
        order = np.lexsort((distance, rows))
        best = order[np.searchsorted(rows[order], np.arange(len(some)))]
        nearest[first : first + step], which[first : first + step] = found[best], columns[best]
    return nearest, which


def nearest_of_pairs(points: Array, triangles: Array) -> Array:
    """The nearest point (n, 3) of one triangle (n, 3, 3) for each point (n, 3).

    The foot on the plane where it is inside the triangle, else the nearest of the feet on the three sides.
    """
    corner, sides = triangles[:, 0], np.roll(triangles, -1, axis=1) - triangles
    normal = np.cross(sides[:, 0], sides[:, 1])
    with np.errstate(invalid="ignore", divide="ignore"):
        height = row_dots(points - corner, normal) / row_dots(normal, normal)
        foot = points - height[:, None] * normal
        inward = np.cross(normal[:, None], sides)
        inside = np.all(row_dots(foot[:, None] - triangles, inward) >= 0.0, axis=1)
        along = row_dots(points[:, None] - triangles, sides) / row_dots(sides, sides)
    along = np.clip(np.nan_to_num(along), 0.0, 1.0)
    feet = triangles + along[..., None] * sides
    best = np.linalg.norm(points[:, None] - feet, axis=-1).argmin(axis=1)
    return np.where(inside[:, None], foot, feet[np.arange(len(points)), best])


def row_dots(a: Array, b: Array) -> Array:
    """The scalar products of the rows of two arrays."""
    products: Array = np.einsum("...i,...i->...", a, b)
    return products


def winding_numbers(points: Array, triangles: Array) -> Array:
    """How often triangles (m, 3, 3) wind around each of points (n, 3): (n,).

    The sum of the signed solid angles over 4π (van Oosterom and Strackee 1983); 1 inside and 0 outside a
    closed surface whose normals point outward.
    """
    total = np.zeros(len(points))
    step = max(1, MOST_PAIRS // max(1, len(triangles)))
    for first in range(0, len(points), step):
        a, b, c = np.moveaxis(triangles[None] - points[first : first + step, None, None], -2, 0)
        la, lb, lc = (np.linalg.norm(v, axis=-1) for v in (a, b, c))
        volume = row_dots(a, np.cross(b, c))
        rest = la * lb * lc + row_dots(a, b) * lc + row_dots(b, c) * la + row_dots(c, a) * lb
        total[first : first + step] = np.arctan2(volume, rest).sum(axis=-1) / (2.0 * np.pi)
    return total


def signed_volume(triangles: Array) -> float:
    """The volume [m³] that triangles (m, 3, 3) enclose, negative where their normals point inward."""
    a, b, c = np.moveaxis(triangles - triangles.reshape(-1, 3).mean(axis=0), -2, 0)
    return float(row_dots(a, np.cross(b, c)).sum() / 6.0)


def count_open_edges(faces: Faces) -> int:
    """How many sides of triangles (m, 3) of vertex numbers have no opposite side of another triangle."""
    return len(find_open_edges(faces))


def find_open_edges(faces: Faces) -> Faces:
    """The sides (k, 2), from vertex to vertex, of triangles (m, 3) without an opposite one of another."""
    edges = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    size = int(faces.max(initial=0)) + 1
    forward, counts = np.unique(edges[:, 0] * size + edges[:, 1], return_counts=True)
    backward, others = np.unique(edges[:, 1] * size + edges[:, 0], return_counts=True)
    place = np.searchsorted(backward, forward)
    opposite = np.append(backward, -1)[place] == forward
    missing = counts - np.where(opposite, np.append(others, 0)[place], 0)
    keys = np.repeat(forward, np.maximum(missing, 0))
    return np.stack([keys // size, keys % size], axis=1)


def fill_holes(vertices: Array, faces: Faces) -> tuple[Array, Faces]:
    """Vertices (k, 3) and triangles (m, 3) with a fan of triangles in each connected rim of open edges."""
    edges = find_open_edges(faces)
    label = np.arange(len(vertices))
    while True:  # every vertex of a rim takes the least label of its neighbours
        least = label.copy()
        np.minimum.at(least, edges[:, 0], label[edges[:, 1]])
        np.minimum.at(least, edges[:, 1], label[edges[:, 0]])
        least = least[least]
        if np.array_equal(least, label):
            break
        label = least
    rims, rim = np.unique(label[edges[:, 0]], return_inverse=True)
    middles = np.zeros((len(rims), 3))
    np.add.at(middles, rim, vertices[edges].mean(axis=1))
    middles /= np.bincount(rim, minlength=len(rims))[:, None]
    fans = np.column_stack([edges[:, ::-1], len(vertices) + rim])
    return np.concatenate([vertices, middles]), np.concatenate([faces, fans])


def merge_vertices(vertices: Array, faces: Faces) -> tuple[Array, Faces]:
    """Vertices (k, 3) without repetitions, in the order of their first use, and faces with their numbers.

    Triangles that use a vertex twice are left out.
    """
    _, first, inverse = np.unique(vertices + 0.0, axis=0, return_index=True, return_inverse=True)
    order = np.argsort(first)
    rank = np.empty_like(order)
    rank[order] = np.arange(len(order))
    renumbered = rank[inverse.reshape(-1)][faces]
    a, b, c = renumbered.T
    return vertices[first[order]], renumbered[(a != b) & (b != c) & (c != a)]
