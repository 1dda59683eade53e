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

    # Four cases: two elbows, one when stretched, none beyond, and infinitely many at the base.
    for point in (p, [2.0, 0.0], [3.0, 0.0], [0.0, 0.0]):
        print(np.round(point, 3), arm.ik(position=point).reason)
    elbows = arm.ik(position=p)
    assert np.allclose(arm.fk(elbows.q)[:, :2, 3], p)
    assert np.allclose(elbows.nearest(q).q[0], q)

    plot.save(plot.solutions(arm, elbows, p), folder / "two_elbows.png")
    plot.save(plot.workspace(arm), folder / "workspace.png")
    plot.save(plot.manipulability(arm, q), folder / "manipulability.png")


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else tempfile.mkdtemp()))
