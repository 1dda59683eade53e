"""Draws the figure of docs/trajectory.md."""

from pathlib import Path

import matplotlib as mpl

mpl.use("Agg")

import numpy as np

import cspace as cs
from cspace import plot

HERE = Path(__file__).resolve().parent


def main() -> None:
    robot = cs.load_robot("panda")
    start = np.array([0, -0.7, 0, -2.0, 0, 1.5, 0.7])
    goal = start + np.array([1.5, 0.3, -0.4, 0.9, 0, 0.1, -0.6])
    motion = robot.move_to(goal, start=start, jerk=200)
    own = robot.limits
    limits = cs.Limits(own.lower, own.upper, own.velocity, own.acceleration, np.full(7, 150.0))
    plot.save(plot.trajectory(motion, limits=limits, robot=robot, speed=0.9), HERE / "trajectory.png")


if __name__ == "__main__":
    main()
