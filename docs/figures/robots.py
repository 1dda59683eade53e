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
    T = cs.pose([0.4, 0.1, 0.5], rpy=[0.0, np.pi, 0.0])
    return plot.solutions(
        robot, robot.ik(T), T, near=[0, -1.6, 1.6, 0, 0, 0], title="kr6_r900: every way to one pose"
    )


def jaco2_solutions() -> Sequence[Any]:
    """The same of an arm in general position, at a pose with many of them."""
    robot = cs.load_robot("jaco2")
    poses = robot.fk(robot.random_configuration(300, rng=1))
    answers = [robot.ik(T) for T in poses if T[2, 3] > 0.2]
    most = max(answers, key=len)
    return plot.solutions(robot, most, most.goal, title=f"jaco2: all {len(most)} ways to one pose")


def torch_turns() -> Sequence[Any]:
    """A place and a direction, at eight turns about the direction."""
    robot = cs.load_robot("ur5e").with_tool(cs.pose([0.0, 0.08, 0.1], rpy=[-np.pi / 4, 0.0, 0.0]))
    point, middle = [0.5, 0.0, 0.15], [0, -1.2, 1.6, -2, -1.57, 0]
    found = robot.ik(position=point, direction=[0, 0, -1], samples=8)
    x = robot.fk(found.q)[:, :3, 0]
    turns = np.degrees(np.arctan2(x[:, 1], x[:, 0])).round(1)
    away = np.linalg.norm(np.sin((found.q - middle) / 2), axis=1)
    each = [int(np.argmin(np.where(turns == turn, away, np.inf))) for turn in np.unique(turns)]
    labels = [f"turned {turns[k]:.0f}°" for k in each]
    title = "ur5e with a torch: one place, one direction"
    return plot.solutions(robot, found.q[each], point, near=found.q[each[3]], labels=labels, title=title)


def iiwa14_swivel() -> Sequence[Any]:
    """The self-motion of an arm of seven joints: one elbow, at nine swivels."""
    robot = cs.load_robot("iiwa14")
    T = cs.pose([0.5, 0.0, 0.45], rpy=[0.0, np.pi, 0.0])
    angles = np.radians(np.linspace(-90, 90, 9))
    start = robot.ik(T, swivel=0.0).within().nearest(np.zeros(7))[0]
    q = np.array([robot.ik(T, swivel=angle).nearest(start)[0] for angle in angles])
    labels = [f"swivel {np.degrees(angle):.1f}°" for angle in angles]
    title = "iiwa14: the elbow swings, the tip stays"
    return plot.solutions(robot, q, T, near=start, labels=labels, title=title)


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
    jaco2_solutions,
    torch_turns,
    iiwa14_swivel,
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
