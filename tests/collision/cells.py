"""Random robots made of spheres in random scenes of every primitive."""

import numpy as np

import cspace as cs
from model.random_robots import random_pose, random_tree
from shapes.solids import box_mesh


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


def random_star(rng, T, solid=True):
    """A mesh of spikes and dents around its frame: a hull whose corners moved in."""
    hull = cs.Hull(rng.normal(size=(20, 3)))
    out = hull.vertices / np.linalg.norm(hull.vertices, axis=1)[:, None]
    return cs.Mesh(out * rng.uniform(0.05, 0.5, (len(out), 1)), hull.facets, T, solid=solid)


def hollow_box(rng, T):
    """A solid with a hollow inside: a mesh of two closed surfaces."""
    outer, faces = box_mesh(rng.uniform(0.3, 0.6, 3))
    inner = outer * rng.uniform(0.5, 0.9)
    return cs.Mesh(np.concatenate([outer, inner]), np.concatenate([faces, faces[:, ::-1] + len(outer)]), T)


def random_scene(rng, n=12, reach=1.5):
    """A scene of n shapes of every kind that checks read."""
    makers = (
        lambda T: cs.Box(rng.uniform(0.05, 0.5, 3), T),
        lambda T: cs.Sphere(rng.uniform(0.05, 0.3), T),
        lambda T: cs.Capsule(rng.uniform(0.02, 0.2), rng.uniform(0.1, 0.6), T),
        lambda T: cs.Cylinder(rng.uniform(0.02, 0.3), rng.uniform(0.1, 0.6), T),
        lambda T: cs.PointCloud(rng.uniform(-0.2, 0.2, (5, 3)), pose=T, radius=0.02),
        lambda T: cs.Hull(rng.uniform(-0.2, 0.2, (12, 3)), T),
        lambda T: random_star(rng, T),
        lambda T: cs.HeightField(rng.uniform(0.0, 0.3, (4, 5)), rng.uniform(0.3, 1.0, 2), T, bottom=-0.2),
        lambda T: random_star(rng, T, solid=False),
        lambda T: hollow_box(rng, T),
    )
    shapes = [makers[k](random_pose(rng, reach)) for k in rng.permutation(np.arange(n) % len(makers))]
    return cs.Scene([*shapes, cs.HalfSpace(rng.normal(size=3), -2.0)])
