"""The pictures of robots on the pages: python docs/figures/robots.py [FOLDER] writes them."""

from __future__ import annotations

import sys
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np

import cspace as cs
from cspace import plot

DPI = 80


def ur5e_solutions() -> Sequence[Any]:
    """Every configuration of a UR5e that reaches one pose."""
    robot = cs.load_robot("ur5e")
    T = cs.pose([0.45, -0.2, 0.35], rpy=[np.pi, 0.0, 0.6])
    return plot.solutions(robot, robot.ik(T), T, title="ur5e: every way to one pose")


def kr6_r900_solutions() -> Sequence[Any]:
    """The same of a KUKA KR 6."""
    robot = cs.load_robot("kr6_r900")
    T = cs.pose([0.4, 0.1, 0.5], rpy=[0.0, np.pi / 2, 0.0])
    return plot.solutions(
        robot, robot.ik(T), T, near=[0, -1.6, 1.6, 0, 0, 0], title="kr6_r900: every way to one pose"
    )


def panda() -> Sequence[Any]:
    """A Franka Panda ready to work."""
    robot = cs.load_robot("panda")
    q = np.radians([0, -45, 0, -135, 0, 90, 45])
    return plot.robot(robot, q, title="panda")


def scara() -> Sequence[Any]:
    """A SCARA arm."""
    return plot.robot(cs.load_robot("scara"), [0.5, 0.9, 0.1, 0.0], title="scara")


def frames() -> Sequence[Any]:
    """Three frames."""
    T_base_tip = cs.pose([0.4, 0.1, 0.3], rpy=[0.3, 0.6, 1.0])
    T_base_camera = cs.pose([-0.1, 0.5, 0.4], rpy=[0.0, 2.4, 0.2])
    return plot.frames([np.eye(4), T_base_tip, T_base_camera], names=["base", "tip", "camera"])


def planar_2r_solutions() -> Sequence[Any]:
    """Both ways of a planar arm to a point."""
    robot = cs.load_robot("planar_2r")
    point = [1.2, 0.7]
    return plot.solutions(robot, robot.ik(position=point), point, labels=["elbow down", "elbow up"])


def workspace() -> Sequence[Any]:
    """Where the tip of a planar arm can be, and how well it moves there."""
    lengths, limit = [0.5, 0.35], [2.6, 2.4]
    description = cs.model.from_screws(
        [[0, 0, 1], [0, 0, 1]],
        [[0, 0, 0], [lengths[0], 0, 0]],
        cs.pose([sum(lengths), 0, 0]),
        lower=np.negative(limit),
        upper=limit,
    )
    return plot.workspace(cs.Robot(description), title="l = 0.5, 0.35 m; |q1| ≤ 2.6, |q2| ≤ 2.4 rad")


def manipulability() -> Sequence[Any]:
    """The velocities that unit joint rates make at the tip."""
    return plot.manipulability(cs.load_robot("planar_2r"), [0.4, 1.3])


PICTURES: tuple[Callable[[], Sequence[Any]], ...] = (
    ur5e_solutions,
    kr6_r900_solutions,
    panda,
    scara,
    frames,
    planar_2r_solutions,
    workspace,
    manipulability,
)


def main(folder: Path) -> None:
    """Write every picture into a folder."""
    for picture in PICTURES:
        plot.save(picture(), folder / f"{picture.__name__}.png", dpi=DPI)


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).parent)
