"""Robots with scenes at random, from the catalogue and made up."""

import numpy as np

import cspace as cs
from collision.cells import random_robot, random_scene

CATALOGUE = ("panda", "ur5e", "fetch", "ur5", "planar_3r")


def draw_case(seed):
    """A robot, a scene of every kind of shape, two joints, and a configuration within the limits."""
    rng = np.random.default_rng(seed)
    if seed % 2:
        robot = cs.load_robot(CATALOGUE[seed // 2 % len(CATALOGUE)])
        scene = random_scene(rng, n=6, reach=0.9)
        base = [s.name for s in scene.obstacles if robot.collides(robot.random_configuration(rng=1), scene)]
        scene = scene if len(base) < 3 else scene.remove(base[0])
    else:
        robot, scene = random_robot(seed, n=6), random_scene(rng, n=5)
    space = cs.planning.JointSpace(robot, scene, margin=0.01 if seed % 3 == 0 else 0.0)
    first, second = rng.permutation(space.dof)[:2] if space.dof > 1 else (0, 0)
    at = rng.uniform(space.lower, space.upper)
    return robot, scene, space, (int(first), int(second)), at, rng


def many_joints(seeds):
    """The seeds whose robot has two joints or more."""
    return [seed for seed in seeds if seed % 2 or random_robot(seed, n=6).dof > 1]


def gantry(radius, travel=1.0):
    """Three prismatic joints along x, y and z that carry one ball."""
    robot = cs.Robot.from_screws(
        np.eye(3), np.zeros((3, 3)), np.eye(4), joint_types="PPP", lower=[-travel] * 3, upper=[travel] * 3
    )
    return robot.with_spheres({robot.tip: [[0.0, 0.0, 0.0, radius]]})
