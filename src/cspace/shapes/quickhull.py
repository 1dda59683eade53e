"""Convex hulls of points: quickhull with exact orientation tests on a fine grid.

The points are rounded to integers of 2⁻⁴⁰ of their extent. Orientations are determinants of these integers,
evaluated in floating point with an error bound and exactly where the bound leaves the sign open. Therefore
coplanar and collinear points need no special treatment (Barber, Dobkin and Huhdanpaa 1996).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from cspace.arrays import Array
from cspace.errors import InputError
from cspace.shapes.triangles import Faces
from cspace.tolerances import HULL_DETERMINANT, HULL_FLAT

Integers = npt.NDArray[np.int64]

GRID_BITS = 40
"""Bits of a coordinate on the grid: differences are exact in float64."""


@dataclass
class Facets:
    """The triangles of a hull under construction.

    faces (m, 3): vertex numbers, counter-clockwise from outside. normal, spread (m, 3): the cross product of
    two sides, and the sums of the absolute products in it, for the error bound.
    """

    grid: Integers
    faces: Faces
    normal: Array
    spread: Array

    @classmethod
    def of(cls, grid: Integers, faces: Faces) -> Facets:
        """The triangles `faces` of points on the grid."""
        corner = grid[faces].astype(np.float64)
        a, b = corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0]
        products = [(a[:, i] * b[:, j], a[:, j] * b[:, i]) for i, j in ((1, 2), (2, 0), (0, 1))]
        normal = np.stack([p - q for p, q in products], axis=-1)
        spread = np.stack([np.abs(p) + np.abs(q) for p, q in products], axis=-1)
        return cls(grid, faces, normal, spread)

    def replace(self, removed: npt.NDArray[np.bool_], new: Facets) -> Facets:
        """The facets without the removed ones, followed by new ones."""
        kept = ~removed
        pairs = [(a[kept], b) for a, b in zip(self.arrays, new.arrays, strict=True)]
        faces, normal, spread = (np.concatenate(pair) for pair in pairs)
        return Facets(self.grid, faces.astype(np.intp), normal, spread)

    @property
    def arrays(self) -> tuple[Faces, Array, Array]:
        """What one facet has one row of."""
        return self.faces, self.normal, self.spread

    def heights(self, points: npt.NDArray[np.intp]) -> Array:
        """Six times the volume over each facet of each point: (points, facets), with the exact sign."""
        offset = (self.grid[points][:, None] - self.grid[self.faces[:, 0]]).astype(np.float64)
        height = np.einsum("pfi,fi->pf", offset, self.normal)
        bound = HULL_DETERMINANT * np.einsum("pfi,fi->pf", np.abs(offset), self.spread)
        rows, columns = np.nonzero(np.abs(height) <= bound)
        if len(rows):
            height[rows, columns] = self.exact_heights(points[rows], columns)
        return np.asarray(height)

    def exact_heights(self, points: npt.NDArray[np.intp], facets: npt.NDArray[np.intp]) -> Array:
        """The determinants of pairs of a point and a facet in integers of any size, rounded to float64."""
        corner = self.grid[self.faces[facets]].astype(object)
        a, b = corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0]
        c = self.grid[points].astype(object) - corner[:, 0]
        total = sum(
            c[:, i] * (a[:, j] * b[:, k] - a[:, k] * b[:, j]) for i, j, k in ((0, 1, 2), (1, 2, 0), (2, 0, 1))
        )
        return np.asarray(total).astype(np.float64)


def find_hull(points: Array, subject: str) -> tuple[Faces, Array]:
    """The triangles (m, 3) of the convex hull of points (n, 3), counter-clockwise from outside, and vectors
    (m, 3) along their outward normals, as long as the triangles are large.

    Raises InputError where all points lie in a plane to within tolerances.HULL_FLAT of their extent.
    """
    low, extent = points.min(axis=0), float(np.ptp(points, axis=0).max())
    scale = 2.0**GRID_BITS / extent if extent > 0.0 else 1.0
    grid = np.rint((points - low) * scale).astype(np.int64)
    facets = Facets.of(grid, first_tetrahedron(points, grid, extent, subject))
    outside, owner, far = assign_points(facets, np.arange(len(points), dtype=np.intp), 0)
    while len(outside):
        chosen = int(outside[far.argmax()])
        removed = facets.heights(np.array([chosen], dtype=np.intp))[0] >= 0.0
        new = Facets.of(grid, fan_faces(facets.faces[removed], chosen))
        stays = ~removed[owner]
        moved = outside[~stays & (outside != chosen)]
        added = assign_points(new, moved, int((~removed).sum()))
        numbers = np.cumsum(~removed) - 1
        facets = facets.replace(removed, new)
        outside = np.concatenate([outside[stays], added[0]])
        owner = np.concatenate([numbers[owner[stays]], added[1]])
        far = np.concatenate([far[stays], added[2]])
    return facets.faces, facets.normal / scale**2


def assign_points(facets: Facets, points: Faces, first: int) -> tuple[Faces, Faces, Array]:
    """The points outside of the facets, for each the facet it is farthest from, counted from `first`, and
    how far that is on the grid."""
    height = facets.heights(points)
    outside = (height > 0.0).any(axis=1)
    far = height[outside] / np.linalg.norm(facets.normal, axis=-1)
    owner = far.argmax(axis=1)
    return points[outside], owner + first, far[np.arange(len(owner)), owner]


def fan_faces(removed: Faces, point: int) -> Faces:
    """The triangles (m, 3) between a point and the edges around the removed triangles (k, 3)."""
    edges = removed[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)
    size = int(edges.max()) + 1
    rim = edges[~np.isin(edges @ [size, 1], edges @ [1, size])]
    return np.column_stack([rim, np.full(len(rim), point, dtype=np.intp)])


def first_tetrahedron(points: Array, grid: Integers, extent: float, subject: str) -> Faces:
    """The faces (4, 3) of a tetrahedron of four of the points, far apart from each other."""
    axis = int(np.ptp(points, axis=0).argmax())
    a, b = int(points[:, axis].argmin()), int(points[:, axis].argmax())
    along = points[b] - points[a]
    off_line = np.linalg.norm(np.cross(points - points[a], along), axis=-1)
    c = int(off_line.argmax())
    normal = np.cross(along, points[c] - points[a])
    height = (points - points[a]) @ normal
    d = int(np.abs(height).argmax())
    length = float(np.linalg.norm(normal))
    if length <= HULL_FLAT * extent**2 or abs(height[d]) <= HULL_FLAT * extent * length:
        what = "a line" if length <= HULL_FLAT * extent**2 else "a plane"
        raise InputError(
            f"{subject} lie in {what}; a convex hull needs points in three dimensions (a flat obstacle is a"
            " thin box)"
        )
    if Facets.of(grid, np.array([[a, b, c]], dtype=np.intp)).heights(np.array([d]))[0, 0] > 0.0:
        b, c = c, b
    return np.array([[a, b, c], [a, d, b], [b, d, c], [c, d, a]], dtype=np.intp)
