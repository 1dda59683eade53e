"""The pictures of arms among obstacles on the pages: python docs/figures/planning.py [FOLDER] writes them."""

from __future__ import annotations

import sys
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np

import cspace as cs
from cspace import plot

DPI = 80
TOUCHED = ("wrist_1_link", "wrist_2_link", "wrist_3_link")


def plan_around_a_wall() -> Sequence[Any]:
    """The example of the page on planning."""
    robot = cs.load_robot("ur5e", geometry="skeleton")
    scene = cs.Scene(
        [
            cs.Box([0.1, 0.6, 0.5], [0.55, 0.0, 0.35], name="wall"),
            cs.HalfSpace(offset=-0.25, name="floor"),
        ]
    )
    start, goal = np.radians([-60, -80, 90, -100, -90, 0]), np.radians([60, -80, 90, -100, -90, 0])
    return plot.plan(cs.plan(robot, start, goal, scene), title="ur5e: around a wall, every motion proved")


def spheres_of_an_arm() -> Sequence[Any]:
    """What collision checks use of a UR5e, and the scene of the page on collision."""
    robot = cs.load_robot("ur5e", geometry="skeleton")
    scene = cs.Scene(
        [
            cs.Box([0.8, 1.2, 0.04], [0.6, 0.0, -0.1], name="table"),
            cs.Sphere(0.1, [0.4, 0.3, 0.4], name="ball"),
        ]
    )
    q = np.radians([0, -120, 60, -90, -90, 0])
    return plot.spheres(robot, q, scene, title="ur5e: the spheres of its links, a table and a ball")


def plan_with_a_bottle() -> Sequence[Any]:
    """A bottle is carried over a divider."""
    robot = cs.load_robot("ur5e", geometry="skeleton")
    scene = cs.Scene(
        [
            cs.Box([0.9, 1.4, 0.04], [0.4, 0.0, -0.05], name="table"),
            cs.Box([0.5, 0.04, 0.25], [0.55, 0.0, 0.095], name="divider"),
            cs.Capsule(0.04, 0.12, [0.45, -0.4, 0.07], name="bottle"),
            cs.HalfSpace(offset=-0.6, name="floor"),
        ]
    ).attach("bottle", "tool0", cs.pose([0.0, 0.0, 0.13]), touch=TOUCHED)
    ends = [cs.pose([0.45, y, 0.25], rpy=[np.pi, 0.0, 0.0]) for y in (-0.4, 0.4)]
    start = next(q for q in robot.ik(ends[0]).within().q if not robot.collides(q, scene))
    return plot.plan(cs.plan(robot, start, ends[1], scene), title="ur5e: a bottle is carried over a divider")


PICTURES: tuple[Callable[[], Sequence[Any]], ...] = (
    plan_around_a_wall,
    spheres_of_an_arm,
    plan_with_a_bottle,
)


def main(folder: Path) -> None:
    """Write every picture into a folder."""
    for picture in PICTURES:
        plot.save(picture(), folder / f"{picture.__name__}.png", dpi=DPI)


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).parent)
