"""Point clouds: measured points, each with a radius around it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from cspace.arrays import Array, bounded_number
from cspace.shapes.shape import ORIGIN, Shape, check_points, find_bounds
from cspace.shapes.solids import measure_points
from cspace.shapes.triangles import MOST_PAIRS
from cspace.spatial.poses import transform_points
from cspace.tables import shown
from cspace.tolerances import LARGEST_NUMBER


@dataclass(frozen=True, eq=False, repr=False)
class PointCloud(Shape):
    """The union of balls around points.

    points (n, 3) [m], at least one. pose (4, 4) or position (3,); name. radius [m] of every ball, zero unless
    given.
    Raises InputError for an empty cloud, NaN (with its place), and a negative radius.
    """

    kind: ClassVar[str] = "point_cloud"
    points: Any
    pose: Any = ORIGIN
    name: str = ""
    radius: float = 0.0

    def __post_init__(self) -> None:
        rule = "a cloud without points is no obstacle; leave it out"
        points = check_points(self.points, "points of a point cloud", 1, rule)
        subject, positive = "radius of a point cloud", "it must not be negative [m]"
        radius = bounded_number(self.radius, subject, 0.0, positive, LARGEST_NUMBER)
        self._store(points=points, radius=radius)
        self._place()

    @property
    def bounds(self) -> Array:
        """The axis-aligned bounding box (2, 3) [m], lower corner first."""
        return find_bounds(transform_points(self.pose, self.points), self.radius)

    def _measure(self, local: Array) -> tuple[Array, Array]:
        nearest = np.empty(len(local), dtype=np.intp)
        step = max(1, MOST_PAIRS // len(self.points))
        for first in range(0, len(local), step):
            some = local[first : first + step]
            nearest[first : first + step] = ((some[:, None] - self.points) ** 2).sum(axis=-1).argmin(axis=1)
        distance, gradient = measure_points(local - self.points[nearest])
        return distance - self.radius, gradient

    def _sizes(self) -> str:
        thick = f", radius {shown(self.radius)} m" if self.radius else ""
        return f"{len(self.points)} point{'' if len(self.points) == 1 else 's'}{thick}"
