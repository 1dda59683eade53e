"""The planar arm of every first lecture: its workspace, its ellipse of velocities, its two elbows."""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path

import numpy as np

import cspace as cs
from cspace import plot


def main(folder: Path) -> None:
    arm = cs.load_robot("planar_2r")
    q = np.array([0.4, 1.2])

    # By hand: p = (l1 c1 + l2 c12, l1 s1 + l2 s12), and det J = l1 l2 s2 for l1 = l2 = 1.
    angles = np.cumsum(q)
    p = np.array([np.cos(angles).sum(), np.sin(angles).sum()])
    J = arm.jacobian(q)[:2]
    print("tip", np.round(p, 6), " det J", round(float(np.linalg.det(J)), 6))
    assert np.allclose(arm.fk(q)[:2, 3], p)
    assert np.isclose(np.linalg.det(J), np.sin(q[1]))

    # The other elbow: the triangle of the two links, mirrored at the line from the base to the tip.
    bearing = np.arctan2(p[1], p[0])
    mirrored = np.array([2 * bearing - q[0], -q[1]])
    assert np.allclose(arm.fk(mirrored)[:2, 3], p)

    both = plot.solutions(arm, [q, mirrored], p, labels=["elbow down", "elbow up"])
    plot.save(both, folder / "two_elbows.png")
    plot.save(plot.workspace(arm), folder / "workspace.png")
    plot.save(plot.manipulability(arm, q), folder / "manipulability.png")


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else tempfile.mkdtemp()))
