"""Bodies and robots that the tests of this folder share."""

import numpy as np

from cspace.model import Description, Inertial, Joint, Link, Mimic
from model.random_robots import random_pose


def random_body(rng, size=0.1):
    """The mass properties of a cloud of mass points, as every real body has them."""
    masses, points = rng.uniform(0.1, 1.0, 8), rng.normal(size=(8, 3)) * size
    com = masses @ points / masses.sum()
    away = points - com
    inertia = sum(m * (d @ d * np.eye(3) - np.outer(d, d)) for m, d in zip(masses, away, strict=True))
    return Inertial(masses.sum(), com, inertia)


def hand_arm(rng, n=3, finger=None):
    """An arm whose hand carries two prismatic fingers, of which the second follows the first."""
    names = [f"link_{i}" for i in range(n + 1)]
    links = [Link(name, random_body(rng)) for name in names]
    joints = [
        Joint(f"joint_{i}", "revolute", names[i], names[i + 1], random_pose(rng), rng.normal(size=3))
        for i in range(n)
    ]
    finger = finger or random_body(rng)
    links += [Link("hand", random_body(rng)), Link("left", finger), Link("right", finger), Link("tcp")]
    joints += [
        Joint("wrist", "continuous", names[-1], "hand", random_pose(rng), (0, 0, 1)),
        Joint("open", "prismatic", "hand", "left", axis=(0, 1, 0)),
        Joint("follow", "prismatic", "hand", "right", axis=(0, 1, 0), mimic=Mimic("open", -0.5, 0.01)),
        Joint("flange", "fixed", "hand", "tcp", random_pose(rng)),
    ]
    return Description("hand arm", tuple(links), tuple(joints))
