"""Whether a joint path touches something: its pieces, divided until they are nearly straight, proved free."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from cspace.arrays import Array
from cspace.kinematics import KinematicModel
from cspace.planning import ArmSpace
from cspace.trajectory.path import Path

if TYPE_CHECKING:
    from cspace.collision import Scene

STRAIGHT: Final = 3e-4
"""[rad or m] Distance of the curve from a straight motion of the joints, at most, summed over the joints."""

MOST_PARTS: Final = 1 << 12
"""Of a piece."""


@dataclass(frozen=True)
class Touch:
    """Where a path touches something, and what."""

    s: float
    text: str


def check_path(robot: KinematicModel, path: Path, scene: Scene | None, margin: float = 0.0) -> Touch | None:
    """The first motion of a joint path that is not proved free, or None if all of it is free.

    The curve is replaced by straight motions of the joints; what lies between is covered by a margin: the
    distance of the joints times the reach of the arm.
    """
    own: Any = robot
    bare = ArmSpace(own, scene, margin)
    space = ArmSpace(own, scene, margin + STRAIGHT * max(1.0, bare.reach))
    s = straight_parts(path)
    q = path(s)
    for k in range(len(s) - 1):
        found = space.edge(q[k], q[k + 1])
        if not found:
            return Touch(float(s[k]), found.reason)
    return None


def straight_parts(path: Path) -> Array:
    """Parameters (n,) of a path between which its curve is nearly a straight motion of the joints.

    A curve leaves its chord by at most h²/8 of its largest second derivative.
    """
    bend = np.abs(path._derivatives[2]).max(axis=1).sum(axis=1) if path.degree > 1 else np.zeros(len(path))
    parts = np.ceil(path.lengths * np.sqrt(bend / (8.0 * STRAIGHT)))
    counts = np.clip(parts, 1, MOST_PARTS).astype(int)
    inner = [
        np.linspace(a, b, n, endpoint=False)
        for a, b, n in zip(path.breaks[:-1], path.breaks[1:], counts, strict=True)
    ]
    return np.append(np.concatenate(inner), path.length)
