"""What a configuration space answers: curves of its boundary, free components, connections."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Final

import numpy as np

from cspace.arrays import Array
from cspace.tables import show_fields

KINDS: Final = ("side on corner", "tip on corner", "tip on side", "link 1", "limit")
"""The kinds of contact on the boundary, as the core numbers them."""

NO_PATH: Array = np.empty((0, 2))
NO_PATH.setflags(write=False)


@show_fields
@dataclass(frozen=True, eq=False)
class BoundaryCurve:
    """A curve of the boundary of free space, on which one contact stays.

    points (k, 2): configurations (q1, q2) [rad] on it, exact up to rounding. q1 lies within its range; q2
    changes without jumps, so the curve of a joint without limits may leave [−π, π]. kind: "side on corner"
    (of link 2 on a corner of the obstacle), "tip on corner", "tip on side", "link 1" (it touches, whatever
    q2 is) or "limit". obstacle: its name, "" at a limit.
    """

    points: Array
    kind: str
    obstacle: str


@show_fields
@dataclass(frozen=True, eq=False)
class FreeComponent:
    """A connected component of free space.

    area [rad²], and area_bounds (2,), between which it is proved to lie. point (2,): a configuration inside.
    region: components of different regions are proved to be separate. proved: whether the component has its
    region alone; else a passage too narrow to be resolved may connect it with the others there.
    """

    area: float
    area_bounds: tuple[float, float]
    point: Array
    region: int
    proved: bool


@show_fields
@dataclass(frozen=True, eq=False)
class Connection:
    """Whether two configurations are connected: true if they are.

    status: "connected" (proved), "separate" (proved), "undetermined", or "blocked" for a goal that is not
    free. reason: a sentence. path (m, 2):
    configurations [rad] that straight lines connect, all free, if it was asked for; else empty.
    """

    status: str
    reason: str
    path: Array = field(default_factory=lambda: NO_PATH)

    def __bool__(self) -> bool:
        return self.status == "connected"

    @property
    def length(self) -> float:
        """The length of the path [rad]."""
        return float(np.linalg.norm(np.diff(self.path, axis=0), axis=1).sum())
