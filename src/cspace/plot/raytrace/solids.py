"""Tapered capsules and cylinders: what a picture of a robot is made of, as pieces that rays meet exactly.

Matplotlib sorts faces by their centres, which leaves teeth where bodies meet and seams where they are
transparent. There are few bodies and few kinds of them, so each pixel's ray is met with each exactly.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from cspace.arrays import Array
from cspace.plot.raytrace.quadrics import Disc, Piece, make_side, make_sphere
from cspace.tolerances import LEAST_DIVISOR


@dataclass(frozen=True)
class Solid:
    """A body between the points a and b (3,) [m] with the radii at both [m].

    round: the hull of two spheres (a tapered capsule); else a cone or cylinder with flat ends.
    """

    a: Array
    b: Array
    radius_a: float
    radius_b: float
    color: Array
    round: bool = True

    def lowest(self) -> float:
        """The height of its lowest point [m]."""
        way = self.b - self.a
        upright = 0.0 if self.round else way[2] / max(float(np.linalg.norm(way)), LEAST_DIVISOR)
        down = np.sqrt(max(0.0, 1.0 - upright**2))
        return float(min(self.a[2] - down * self.radius_a, self.b[2] - down * self.radius_b))


def make_cylinder(center: Array, axis: Array, radius: float, half: float, color: Array) -> Solid:
    """A cylinder about a unit axis."""
    return Solid(center - half * axis, center + half * axis, radius, radius, color, round=False)


def make_arrow(origin: Array, way: Array, thickness: float, color: Array) -> list[Solid]:
    """An arrow from `origin` along `way` (3,) [m]: a shaft and a head."""
    length = float(np.linalg.norm(way))
    head = min(0.34 * length, 5.5 * thickness)
    neck = origin + way * (1.0 - head / length)
    return [
        Solid(origin, neck, thickness, thickness, color, round=True),
        Solid(neck, origin + way, 2.3 * thickness, 0.0, color, round=False),
    ]


def bounding_pieces(solid: Solid) -> list[Piece]:
    """The surfaces that bound a solid."""
    way = solid.b - solid.a
    length = float(np.linalg.norm(way))
    slope = (solid.radius_a - solid.radius_b) / max(length, LEAST_DIVISOR)
    if solid.round:
        if length < LEAST_DIVISOR or abs(slope) >= 1.0:  # one sphere holds the other
            larger = solid.a if solid.radius_a >= solid.radius_b else solid.b
            return [make_sphere(larger, max(solid.radius_a, solid.radius_b))]
        ends = slope * solid.radius_a, length + slope * solid.radius_b
        cosine = float(np.sqrt(1.0 - slope * slope))
        side = make_side(solid.a, way / length, solid.radius_a / cosine, slope / cosine, ends)
        return [side, make_sphere(solid.a, solid.radius_a), make_sphere(solid.b, solid.radius_b)]
    axis = way / length
    caps = (Disc(solid.a, -axis, solid.radius_a), Disc(solid.b, axis, solid.radius_b))
    side = make_side(solid.a, axis, solid.radius_a, slope, (0.0, length))
    return [side, *(cap for cap in caps if cap.radius > 0.0)]
