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
LINK_RADIUS = 0.04
"""Of the links of planar_2r in its picture [m]."""
LEVELS_TO = 2.5
"""The highest band of a potential: beyond it, at obstacles, it rises without bound."""


def plan_around_a_wall() -> Sequence[Any]:
    """The example of the page on planning."""
    robot = cs.load_robot("ur5e")
    scene = cs.Scene(
        [
            cs.Box([0.1, 0.6, 0.5], [0.55, 0.0, 0.35], name="wall"),
            cs.HalfSpace(offset=-0.25, name="floor"),
        ]
    )
    start, goal = np.radians([-60, -80, 90, -100, -90, 0]), np.radians([60, -80, 90, -100, -90, 0])
    return plot.plan(cs.plan(robot, start, goal, scene), title="ur5e: around a wall, every motion proved")


def shapes_of_an_arm() -> Sequence[Any]:
    """What collision checks use of a UR5e, and the scene of the page on collision."""
    robot = cs.load_robot("ur5e")
    scene = cs.Scene(
        [
            cs.Box([0.8, 1.2, 0.04], [0.6, 0.0, -0.1], name="table"),
            cs.Sphere(0.1, [0.4, 0.3, 0.4], name="ball"),
        ]
    )
    q = np.radians([0, -120, 60, -90, -90, 0])
    return plot.collision(robot, q, scene, title="ur5e: the capsules of its links, a table and a ball")


def plan_with_a_bottle() -> Sequence[Any]:
    """A bottle is carried over a divider."""
    robot = cs.load_robot("ur5e")
    scene = cs.Scene(
        [
            cs.Box([0.9, 1.4, 0.04], [0.4, 0.0, -0.05], name="table"),
            cs.Box([0.5, 0.04, 0.25], [0.55, 0.0, 0.095], name="divider"),
            cs.Capsule(0.04, 0.12, [0.45, -0.4, 0.07], name="bottle"),
            cs.HalfSpace(offset=-0.6, name="floor"),
        ]
    ).attach("bottle", "tool0", cs.pose([0.0, 0.0, 0.13]), touch=["wrist_3_link"])
    ends = [cs.pose([0.45, y, 0.25], rpy=[np.pi, 0.0, 0.0]) for y in (-0.4, 0.4)]
    start = next(q for q in robot.ik(ends[0]).within().q if not robot.collides(q, scene))
    return plot.plan(cs.plan(robot, start, ends[1], scene), title="ur5e: a bottle is carried over a divider")


def potential_of_two_joints() -> Sequence[Any]:
    """The example of the page: bands of the potential, a descent that stops, and the path of A*."""
    from matplotlib import pyplot as plt

    from cspace.planning import ArmSpace, GridSearch, PotentialField, potential

    robot = cs.load_robot("planar_2r")
    scene = cs.Scene(
        [
            cs.Box([0.5, 0.5, 0.5], [1.2, 1.3, 0], name="box"),
            cs.Sphere(0.3, [-1.4, 0.6, 0], name="ball"),
        ]
    )
    start, goal = np.array([0.2, 0.3]), np.array([1.8, 0.8])
    space = ArmSpace(robot, scene)
    path = GridSearch(step=0.05).plan(space, start, goal).path
    rest = PotentialField().plan(space, start, goal).stats["rest"]
    exact = cs.configuration_space(robot, scene, link_radius=LINK_RADIUS)
    _, axes = plt.subplots(1, 2, figsize=(10, 5), layout="constrained")
    artists = plot.configuration_space(exact, start=start, goals=goal, path=path, ax=axes)
    cells = np.linspace(-np.pi, np.pi, 241)
    q = np.stack(np.meshgrid(cells, cells, indexing="ij"), axis=-1)
    values = potential(space, goal, q).value.T
    levels = np.linspace(0.0, LEVELS_TO, 24)
    artists.append(axes[1].contour(cells, cells, values, levels=levels, cmap="Blues_r", linewidths=0.7))
    artists += axes[1].plot(*rest.path.T, color="#1b7837", linewidth=2.0)
    artists += axes[1].plot(*rest.q, "X", color="#1b7837", markersize=9)
    return artists


def caught_arm() -> Sequence[Any]:
    """A descent of the lectures that stops before a box."""
    spheres = [[x, 0, 0, 0.05] for x in (0.25, 0.5, 0.75, 1.0)]
    robot = cs.load_robot("planar_2r").with_spheres({"link_1": spheres, "link_2": spheres})
    scene = cs.Scene(
        [
            cs.Box([0.5, 0.5, 0.5], [1.2, 1.3, 0], name="box"),
            cs.Sphere(0.3, [-1.4, 0.6, 0], name="ball"),
        ]
    )
    field = {"planner": "potential_field", "k_r": 0.001, "rho_0": 0.3}
    caught = cs.plan(robot, [0.2, 0.3], [1.8, 0.8], scene, **field)
    return plot.plan(caught, title="the descent stops before the box")


PICTURES: tuple[Callable[[], Sequence[Any]], ...] = (
    plan_around_a_wall,
    shapes_of_an_arm,
    plan_with_a_bottle,
    potential_of_two_joints,
    caught_arm,
)


def main(folder: Path) -> None:
    """Write every picture into a folder."""
    for picture in PICTURES:
        plot.save(picture(), folder / f"{picture.__name__}.png", dpi=DPI)


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).parent)
