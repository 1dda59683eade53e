"""Random robots made of spheres in random scenes of every primitive."""

import numpy as np

import cspace as cs
from model.random_robots import random_pose, random_tree


def random_robot(seed, n=6, spheres=4, **options):
    """A random arm with up to `spheres` spheres on each link."""
    rng = np.random.default_rng(seed)
    tree = random_tree(rng, n=n, branch=0.2)
    tip = str(rng.choice(tree.leaves))
    rows = {
        link.name: np.column_stack([rng.uniform(-0.2, 0.2, (k, 3)), rng.uniform(0.02, 0.12, k)])
        for link in tree.links
        if (k := int(rng.integers(0, spheres + 1)))
    }
    rows.setdefault(tip, [[0.0, 0.0, 0.1, 0.05]])
    return cs.Robot(tree, tip=tip, **options).with_spheres(rows)


def random_scene(rng, n=8, reach=1.5):
    """A scene of n shapes of every kind that checks read."""
    makers = (
        lambda T: cs.Box(rng.uniform(0.05, 0.5, 3), T),
        lambda T: cs.Sphere(rng.uniform(0.05, 0.3), T),
        lambda T: cs.Capsule(rng.uniform(0.02, 0.2), rng.uniform(0.1, 0.6), T),
        lambda T: cs.Cylinder(rng.uniform(0.02, 0.3), rng.uniform(0.1, 0.6), T),
        lambda T: cs.PointCloud(rng.uniform(-0.2, 0.2, (5, 3)), pose=T, radius=0.02),
    )
    shapes = [makers[k % len(makers)](random_pose(rng, reach)) for k in range(n)]
    return cs.Scene([*shapes, cs.HalfSpace(rng.normal(size=3), -2.0)])
