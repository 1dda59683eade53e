"""The way out of a collision: along the gradient of the clearance."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import ArrayLike

from cspace.arrays import Array, bounded_number, positive_number
from cspace.collision.checks import HasGeometry, clearance, one_configuration, read_geometry
from cspace.collision.scene import Scene
from cspace.tables import one_line, shown, tabulate
from cspace.tolerances import BEYOND_MARGIN, FLAT_CLEARANCE, LARGEST_NUMBER

LONGEST_STEP: Final = 0.02
"""Of one step [L2 norm of the joints]: the nearest pair is looked up anew so often."""


@tabulate()
@dataclass(frozen=True, eq=False)
class Escape:
    """A way out of a collision; truthy if it ends free.

    q (dof,): where it ends. path (m, dof): the steps, from the given configuration to q. distance [m]: the
    least distance at q. reason: in words.
    """

    q: Array
    path: Array
    distance: float
    reason: str
    free: bool

    def __bool__(self) -> bool:
        return self.free

    def __repr__(self) -> str:
        return one_line("Escape", self.reason)


def escape(
    robot: HasGeometry,
    q: ArrayLike,
    scene: Scene | None = None,
    *,
    margin: float = 0.0,
    most: float = 1.0,
) -> Escape:
    """Leads a robot that touches something to a configuration that keeps `margin` [m] from everything.

    It follows the gradient of the clearance in small steps within the limits: dq = n (d* − d) / |∇d| with
    n = ∇d / |∇d|. It gives up after a motion of the length `most` [L2 norm of the joints], and where the
    gradient vanishes. The way begins in collision, so it is not checked. q (dof,).

    Raises InputError for a robot without collision geometry, a wrong shape, NaN and a negative margin.
    """
    geometry = read_geometry(robot)
    at = one_configuration(geometry, q, "q").copy()
    gap = bounded_number(margin, "margin", 0.0, "it must be a length [m], 0 or more", largest=LARGEST_NUMBER)
    left = positive_number(most, "most", "it must be one positive number", largest=LARGEST_NUMBER)
    rows = [at]
    while True:
        nearest = clearance(geometry, at, scene)
        if nearest.distance > gap + BEYOND_MARGIN / 2.0:
            way = f"moved by {shown(most - left)}; the least distance is {1000 * nearest.distance:.3g} mm"
            return Escape(at, np.array(rows), nearest.distance, way, True)
        slope = float(np.linalg.norm(nearest.gradient))
        if slope <= FLAT_CLEARANCE or left <= 0.0:
            cause = (
                "no direction leads out"
                if slope <= FLAT_CLEARANCE
                else f"it is not free after a motion of {most:g}"
            )
            pair = " and ".join(nearest.pair or ())
            return Escape(at, np.array(rows), nearest.distance, f"{cause}: {pair} still touch", False)
        step = min((gap + BEYOND_MARGIN - nearest.distance) / slope, LONGEST_STEP, left)
        to = np.clip(at + step / slope * nearest.gradient, geometry.lower, geometry.upper)
        moved = float(np.linalg.norm(to - at))
        left = left - moved if moved > 0.0 else 0.0
        at = to
        rows.append(at)
