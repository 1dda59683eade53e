"""Every joint configuration that reaches a pose: which are within limits, which is nearest, and a picture."""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path

import numpy as np

import cspace as cs
from cspace import plot


def main(folder: Path) -> None:
    robot = cs.load_robot("kr6_r900")
    T_base_tip = cs.pose([0.4, 0.1, 0.5], rpy=[0.0, np.pi, 0.0])

    solutions = robot.ik(T_base_tip)
    print(solutions.reason)
    for q, branch, residual in zip(solutions.q, solutions.branch, solutions.residual, strict=True):
        print(np.round(np.degrees(q), 1), branch, f"residual {residual:.0e}")

    within = solutions.within(robot.limits)
    print(f"{len(within)} of {len(solutions)} within limits")

    q_now = np.array([0.0, -1.6, 1.6, 0.0, 0.0, 0.0])
    nearest = within.nearest(q_now).q[0]
    print("nearest to where the arm is:", np.round(np.degrees(nearest), 1))
    assert np.allclose(robot.fk(nearest), T_base_tip)

    # No solution is an answer too: it is false, and it says why.
    far = robot.ik(cs.pose([2.0, 0.0, 0.5]))
    assert not far
    print(far.reason)

    plot.save(plot.solutions(robot, solutions, T_base_tip, near=q_now), folder / "every_ik_solution.png")


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else tempfile.mkdtemp()))
