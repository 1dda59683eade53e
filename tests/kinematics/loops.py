"""Robots with closed loops that tests share."""

import numpy as np

from cspace.model import Description, Inertial, Joint, Link, Loop, Mimic
from cspace.robot import Robot
from cspace.spatial.poses import invert_pose
from model.random_robots import random_pose

TYPES = (
    "spherical",
    "revolute",
    "continuous",
    "prismatic",
    "universal",
    "cylindrical",
    "planar",
    "fixed",
    "distance",
)
ROWS = dict(zip(TYPES, (3, 5, 5, 5, 4, 4, 3, 6, 1), strict=True))


def random_mass(rng):
    """The mass properties of a random cloud of points."""
    masses, points = rng.uniform(0.1, 1.0, 6), rng.normal(size=(6, 3)) * 0.2
    com = masses @ points / masses.sum()
    away = points - com
    inertia = sum(m * (d @ d * np.eye(3) - np.outer(d, d)) for m, d in zip(masses, away, strict=True))
    return Inertial(masses.sum(), com, inertia)


def random_tree(rng, n=8, *, planar=False, mimic=True):
    """A tree of n joints with random axes, one that follows another, and perhaps a planar one."""
    names, joints = ["base"], []
    links = [Link("base")]
    for i in range(n):
        parent, child = names[rng.integers(len(names))], f"link_{i}"
        names.append(child)
        links.append(Link(child, random_mass(rng)))
        kind = "planar" if planar and i == 3 else "prismatic" if i % 3 == 2 else "revolute"
        follows = Mimic("joint_0", 0.7, 0.1) if mimic and i == 4 else None
        joints.append(
            Joint(f"joint_{i}", kind, parent, child, random_pose(rng), rng.normal(size=3), mimic=follows)
        )
    return Description("tree", tuple(links), tuple(joints))


def random_loop(rng, kind, parent, child, name=None):
    return Loop(
        name or kind,
        kind,
        parent,
        child,
        random_pose(rng),
        random_pose(rng),
        rng.normal(size=3),
        rng.normal(size=3) if kind == "universal" else None,
        rng.uniform(0.5, 2.0) if kind == "distance" else None,
    )


def closing_loop(robot, q, kind, parent, child, name, rng):
    """A loop of a type, spherical, fixed, revolute or distance, that is closed at q."""
    origin = random_pose(rng)
    at, other = robot.fk(q, parent) @ origin, robot.fk(q, child)
    if kind == "distance":
        far = random_pose(rng)
        return Loop(name, kind, parent, child, origin, far, length=np.linalg.norm((other @ far - at)[:3, 3]))
    return Loop(name, kind, parent, child, origin, invert_pose(other) @ at, rng.normal(size=3))


def bennett(a=1.0, b=0.7, alpha=0.9, masses=None):
    """A Bennett linkage: four revolute joints in space, mobile though the formula of mobility says −2.

    Opposite sides are equal, and sin α / a = sin β / b.
    """
    beta = np.arcsin(b * np.sin(alpha) / a)
    rng = np.random.default_rng(7)
    links = [Link("ground"), *(Link(f"bar_{i}", random_mass(rng)) for i in range(3))]
    sides = [(a, alpha), (b, beta), (a, alpha), (b, beta)]
    ends = []
    for length, twist in sides:
        T = np.eye(4)
        c, s = np.cos(twist), np.sin(twist)
        T[:3, :3], T[0, 3] = [[1, 0, 0], [0, c, -s], [0, s, c]], length
        ends.append(T)
    names = [link.name for link in links]
    joints = [Joint(f"pin_{i}", "continuous", names[i], names[i + 1], ends[i], (0, 0, 1)) for i in range(3)]
    loop = Loop("pin_3", "revolute", "bar_2", "ground", ends[3], axis=(0, 0, 1))
    return Robot(Description("bennett", tuple(links), tuple(joints), (loop,)))
