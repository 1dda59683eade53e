"""Shapes for tests: one of each kind, placed at random, and the meshes of boxes."""

from __future__ import annotations

import itertools

import numpy as np

import cspace as cs
from cspace import shapes


def box_mesh(size):
    """Vertices (8, 3) and outward triangles (12, 3) of a box centred at the origin."""
    vertices = np.array(list(itertools.product(*[(-s / 2, s / 2) for s in size])))
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    return vertices, np.array([t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))])


def every_shape(rng):
    """One shape of each kind, somewhere."""
    T = cs.random_pose(9, rng=rng)
    return [
        shapes.Box([0.4, 1.0, 0.2], T[0]),
        shapes.Sphere(0.3, T[1]),
        shapes.Capsule(0.2, 0.7, T[2]),
        shapes.Cylinder(0.3, 0.5, T[3]),
        shapes.HalfSpace([1.0, 2.0, -1.0], 0.3, T[4]),
        shapes.Hull(rng.normal(size=(20, 3)), T[5]),
        shapes.Mesh(*box_mesh([0.4, 0.5, 0.6]), T[6]),
        shapes.HeightField(rng.uniform(size=(4, 6)), [1.0, 0.8], T[7]),
        shapes.PointCloud(rng.normal(size=(30, 3)), T[8], radius=0.1),
    ]


KINDS = [type(shape).__name__ for shape in every_shape(np.random.default_rng(0))]
