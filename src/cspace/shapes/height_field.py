"""Height fields: terrain as heights over a grid."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any, ClassVar

import numpy as np

from cspace.arrays import Array, one_array, one_number
from cspace.errors import InputError
from cspace.shapes.mesh import Mesh, measure_mesh
from cspace.shapes.shape import IDENTITY, ORIGIN, Shape, find_bounds
from cspace.shapes.triangles import Faces
from cspace.spatial.poses import transform_points
from cspace.tables import shown
from cspace.tolerances import LARGEST_NUMBER


@dataclass(frozen=True, eq=False, repr=False)
class HeightField(Shape):
    """The solid between a bottom and a surface of heights over a rectangle, centred at the frame in x and y.

    heights (rows, columns) [m]: z over a grid of points; row i is y = −size[1] / 2 + i size[1] / (rows − 1),
    column j likewise in x. Each cell is two triangles, divided from its lower left to its upper right point.
    size (2,): its extents [m] along x and y. pose (4, 4) or position (3,); name. bottom [m]: z of the bottom,
    below all heights; one metre below the lowest unless given.

    Raises InputError for fewer than two rows or columns, a bottom that is not below the heights, and NaN.
    """

    kind: ClassVar[str] = "height_field"
    heights: Any
    size: Any
    pose: Any = ORIGIN
    name: str = ""
    bottom: float | None = None

    def __post_init__(self) -> None:
        subject = "heights of a height field"
        heights = np.array(
            one_array(self.heights, subject, (None, None), "rows of z [m]", largest=LARGEST_NUMBER)
        )
        size = np.array(
            one_array(self.size, "size of a height field", (2,), "extents x, y", largest=LARGEST_NUMBER)
        )
        if min(heights.shape) < 2:
            raise InputError(
                f"{subject} has shape {heights.shape}; at least two rows and two columns are needed"
            )
        if (size <= 0.0).any():
            raise InputError(f"size of a height field is {size.tolist()}; both extents must be positive")
        lowest = float(heights.min())
        bottom = lowest - 1.0 if self.bottom is None else one_number(self.bottom, "bottom of a height field")
        if bottom >= lowest:
            raise InputError(f"bottom of a height field is {bottom:g} m; the lowest height is {lowest:g} m")
        self._store(heights=heights, size=size, bottom=bottom)
        self._place()

    @cached_property
    def triangles(self) -> Array:
        """The closed surface (m, 3, 3) [m] in the shape frame: the field, its four sides and the bottom."""
        return self.surface(IDENTITY)

    def surface(self, T: Array) -> Array:
        """The closed surface (m, 3, 3) [m] moved by T (4, 4): corners that meet are equal bit for bit."""
        rows, columns = self.heights.shape
        x, y = (np.linspace(-s / 2.0, s / 2.0, n) for s, n in zip(self.size, (columns, rows), strict=True))
        top = np.stack([*np.meshgrid(x, y), self.heights], axis=-1)
        floor = top.copy()
        floor[..., 2] = self.bottom
        top, floor = transform_points(T, top), transform_points(T, floor)
        parts = [cut_cells(top), cut_cells(floor)[:, ::-1]]
        for side in (np.s_[0], np.s_[:, -1], np.s_[-1, ::-1], np.s_[::-1, 0]):
            parts.append(cut_cells(np.stack([floor[side], top[side]])))
        return np.concatenate(parts)

    @property
    def bounds(self) -> Array:
        """The axis-aligned bounding box (2, 3) [m], lower corner first."""
        return find_bounds(transform_points(self.pose, self.triangles.reshape(-1, 3)))

    def to_mesh(self) -> Mesh:
        """The closed surface as a mesh with the same pose and name."""
        corners = self.triangles.reshape(-1, 3)
        return Mesh(corners, np.arange(len(corners)).reshape(-1, 3), self.pose, self.name)

    def _measure(self, local: Array) -> tuple[Array, Array]:
        return measure_mesh(local, self.triangles, True)

    def _surface(self) -> tuple[Array, Faces, bool]:
        corners = self.triangles.reshape(-1, 3)
        return corners, np.arange(len(corners)).reshape(-1, 3), True

    def _sizes(self) -> str:
        rows, columns = self.heights.shape
        return f"{rows} × {columns} heights, {shown(self.size[0])} × {shown(self.size[1])} m"


def cut_cells(points: Array) -> Array:
    """The triangles (m, 3, 3) of a grid of points (rows, columns, 3), two per cell, counter-clockwise."""
    a, b, c, d = points[:-1, :-1], points[:-1, 1:], points[1:, 1:], points[1:, :-1]
    return np.stack([np.stack([a, b, c], axis=-2), np.stack([a, c, d], axis=-2)]).reshape(-1, 3, 3)
