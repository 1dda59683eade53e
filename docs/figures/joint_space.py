"""Draws the figures of the page on the C-space of any robot: python docs/figures/joint_space.py [FOLDER]."""

from __future__ import annotations

import sys
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import matplotlib

matplotlib.use("Agg")

import matplotlib.pyplot as plt

import cspace as cs
from cspace import plot

DPI = 80
SCENE = cs.Scene(
    [
        cs.Box([0.1, 0.6, 0.5], [0.55, 0.0, 0.35], name="wall"),
        cs.Cylinder(0.06, 0.7, [-0.1, 0.45, 0.35], name="post"),
        cs.HalfSpace(offset=-0.1, name="floor"),
    ]
)


def joint_space_slice() -> Sequence[Any]:
    """A Panda before a wall, and two of its joints while the others are held."""
    robot = cs.load_robot("panda")
    at = robot.named_poses["ready"]
    figure = plt.figure(figsize=(12.0, 5.2), layout="constrained")
    first = figure.add_subplot(1, 2, 1, projection="3d")
    plot.scene(SCENE, robot, at, ax=first, title="panda: ready, before a wall")
    part = cs.configuration_space(robot, SCENE).slice((1, 3), at=at, size=400)
    return plot.space_slice(part, ax=figure.add_subplot(1, 2, 2))


def joint_space_projection() -> Sequence[Any]:
    """The projection of the same space, over a thousand samples of the other five joints."""
    robot = cs.load_robot("panda")
    space = cs.configuration_space(robot, SCENE)
    part = space.project((1, 3), size=100, samples=1000, including=robot.named_poses["ready"])
    return plot.space_projection(part, q=robot.named_poses["ready"])


PICTURES: tuple[Callable[[], Sequence[Any]], ...] = (joint_space_slice, joint_space_projection)


def main(folder: Path) -> None:
    """Write every picture into a folder."""
    for picture in PICTURES:
        plot.save(picture(), folder / f"{picture.__name__}.png", dpi=DPI)


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).parent)
