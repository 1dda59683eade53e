"""Draws the figures of the page on the way from a pose to a motion: `python docs/figures/motion.py`."""

from __future__ import annotations

from pathlib import Path

import matplotlib

matplotlib.use("Agg")

import matplotlib.pyplot as plt
import numpy as np

import cspace as cs
from cspace import plot

HERE = Path(__file__).parent


def main() -> None:
    robot = cs.load_robot("panda")
    start = robot.named_poses["ready"]
    wall = cs.Box((0.4, 0.04, 0.5), (0.4, 0.15, 0.25), name="wall")
    lamp = cs.Sphere(0.12, (0.3, 0.3, 0.9), name="lamp")
    goal = cs.pose((0.45, 0.4, 0.25), rpy=(np.pi, 0, 0))
    scene = cs.Scene([wall, lamp])
    motion = cs.move(robot, start, goal, scene, jerk=True)
    figure = plt.figure(figsize=(10.5, 5.2), layout="constrained")
    grid = figure.add_gridspec(2, 4, width_ratios=(1.6, 0.05, 1, 1))
    plot.plan(motion.plan, poses=6, ax=figure.add_subplot(grid[:, 0], projection="3d"))
    panels = [figure.add_subplot(grid[k // 2, 2 + k % 2]) for k in range(4)]
    plot.trajectory(motion, limits=robot, axes=panels)
    panels[0].get_legend().remove()  # seven names are wider than a panel
    plot.save(figure, HERE / "motion.png", dpi=75)
    film = plt.figure(figsize=(4.6, 4.4), layout="constrained").add_subplot(projection="3d")
    plot.save(plot.animation(motion, robot=robot, scene=scene, ax=film), HERE / "motion.gif", dpi=60)


if __name__ == "__main__":
    main()
