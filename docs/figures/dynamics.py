"""Draws the figures of the page on dynamics: `python docs/figures/dynamics.py` writes them here."""

from __future__ import annotations

from pathlib import Path

import matplotlib

matplotlib.use("Agg")

import cspace as cs

HERE = Path(__file__).parent


def main() -> None:
    """The torques of a Panda that swings its arm, with a push at the tip, split by their causes."""
    robot = cs.load_robot("panda")
    q = robot.named_poses["ready"]
    qd, qdd = [1.0, 1.0, 0.5, -1.0, 0.0, 1.0, 0.0], [5.0, 8.0, 0.0, 10.0, 0.0, 0.0, 0.0]
    push = {robot.tip: (0, 0, 20, 0, 0, 0)}
    cs.plot.save(cs.plot.torques(robot, q, qd, qdd, wrenches=push), HERE / "torques.png", dpi=110)


if __name__ == "__main__":
    main()
