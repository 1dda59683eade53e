"""Whether a joint path touches something: its pieces, divided until they are nearly straight, proved free."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from cspace.arrays import Array
from cspace.collision import Edge, Scene
from cspace.collision.checks import HasGeometry
from cspace.planning import ArmSpace
from cspace.tolerances import NEARLY_STRAIGHT, SHORTEST_MARGIN
from cspace.trajectory.path import Path

MOST_PARTS: Final = 1 << 12
"""Of a piece."""


HALVINGS: Final = 8
"""Of a part that touches something: joints move by some hundredths of a rad on it at most."""


@dataclass(frozen=True)
class Touch:
    """The piece of a path that is not proved free, up to which s it is, and what it touches."""

    piece: int
    s: float
    text: str


def space_of_curves(robot: HasGeometry, scene: Scene | None, margin: float) -> ArmSpace:
    """The space in which straight motions stand for curves that leave them by NEARLY_STRAIGHT.

    A point moves by the sum of the distances of the joints times the reach of the arm, at most: that much is
    added to the margin.
    """
    reach = ArmSpace(robot, scene, margin).reach
    return ArmSpace(robot, scene, margin + _spare_of(reach))


def _spare_of(reach: float) -> float:
    return NEARLY_STRAIGHT * max(1.0, reach)


def find_touches(
    space: ArmSpace, path: Path, pieces: NDArray[np.bool_] | None = None, *, first: bool = False
) -> list[Touch]:
    """The pieces of a joint path that are not proved free; only the first of them if that is enough.

    pieces (k,): which to look at; all, unless given.
    """
    touches = []
    counts = straight_parts(path)
    for k in range(len(path)):
        if pieces is not None and not pieces[k]:
            continue
        s = np.linspace(path.breaks[k], path.breaks[k + 1], counts[k] + 1)
        q = path.evaluate_pieces(np.full(len(s), k), np.linspace(0.0, 1.0, len(s)))
        for i in range(counts[k]):
            found = space.edge(q[i], q[i + 1])
            if not found:
                free = _free_share(space, q[i], q[i + 1])
                touches.append(Touch(k, float(s[i] + free * (s[i + 1] - s[i])), _explain(space, found)))
                break
        if touches and first:
            break
    return touches


def _free_share(space: ArmSpace, a: Array, b: Array) -> float:
    """The share of a motion from a to b, which touches something, that is proved free."""
    free, blocked = 0.0, 1.0
    for _ in range(HALVINGS):
        middle = 0.5 * (free + blocked)
        if space.edge(a, a + middle * (b - a)):
            free = middle
        else:
            blocked = middle
    return free


def _explain(space: ArmSpace, found: Edge) -> str:
    if found.pair is None:
        return found.reason
    a, b = found.pair
    if (margin := space.margin - _spare_of(space.reach)) > SHORTEST_MARGIN:
        return f"{a} is closer to {b} than the margin of {1000 * margin:.3g} mm"
    return f"{a} touches {b}"


def straight_parts(path: Path) -> NDArray[np.intp]:
    """Parts (k,) of each piece in which its curve is nearly a straight motion of the joints.

    A curve leaves its chord by at most h²/8 of its largest second derivative.
    """
    parts = np.ceil(path.lengths * np.sqrt(bound_bends(path) / (8.0 * NEARLY_STRAIGHT)))
    return np.clip(parts, 1, MOST_PARTS).astype(np.intp)


def bound_bends(path: Path) -> Array:
    """A bound (k,) of the second derivative on each piece, summed over the joints."""
    return np.asarray(np.abs(path._derivatives[2]).max(axis=1).sum(axis=1))
