"""Convex hulls against Qhull, and points that are coplanar, collinear or repeated."""

from __future__ import annotations

import numpy as np
import pytest

import cspace as cs
from cspace import shapes


def clouds():
    rng = np.random.default_rng(0)
    ball = rng.normal(size=(300, 3))
    ball /= np.linalg.norm(ball, axis=1)[:, None]
    grid = np.stack(np.meshgrid(*[np.arange(5.0)] * 3), -1).reshape(-1, 3)
    flat = rng.uniform(size=(200, 3)) * [1, 1, 0]
    return {
        "random": rng.normal(size=(200, 3)),
        "ball": ball,
        "grid": grid,
        "two plates": np.concatenate([flat, np.add(flat[:120], [0, 0, 1e-3])]),
        "repeated": np.repeat(rng.normal(size=(10, 3)), 5, axis=0),
        "far away": rng.normal(size=(50, 3)) + 1e5,
        "cone": np.concatenate([flat, [[0.5, 0.5, 1.0]], [[0.5, 0.5, 0.5]]]),
    }


@pytest.mark.parametrize("name", clouds())
@pytest.mark.parametrize("turned", [False, True])
def test_hulls_are_those_of_qhull(name, turned):
    spatial = pytest.importorskip("scipy.spatial")
    points = clouds()[name]
    if turned:
        points = points @ cs.random_rotation(rng=1).T
    hull, other = shapes.Hull(points), spatial.ConvexHull(points)
    extent = np.ptp(points, axis=0).max()
    assert hull.volume == pytest.approx(other.volume, rel=1e-7, abs=1e-9 * extent**3)
    assert len(hull.vertices) == len(np.unique(points[other.vertices], axis=0))
    sides = np.unique(other.equations.round(6), axis=0)
    assert len(hull.planes) <= len(sides)
    assert (points @ hull.planes[:, :3].T - hull.planes[:, 3]).max() <= 1e-9 * extent
    corners = hull.vertices[hull.facets]
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    assert (np.einsum("fi,fi->f", normal, corners[:, 0] - hull.vertices.mean(axis=0)) > 0.0).all()


def test_a_rotated_box_has_eight_corners_and_six_sides():
    points = clouds()["grid"] @ cs.random_rotation(rng=2).T
    hull = shapes.Hull(points)
    assert (len(hull.vertices), len(hull.planes)) == (8, 6)


@pytest.mark.parametrize(
    ("points", "text"),
    [
        (np.eye(3), "holds 3 points; a hull needs at least four"),
        (np.random.default_rng(0).normal(size=(9, 3)) * [1, 1, 0], "lie in a plane"),
        (np.linspace([0, 0, 0], [1, 2, 3], 9), "lie in a line"),
        (np.zeros((6, 3)), "lie in a line"),
        ([[np.nan, 0, 0]] * 4, "nan"),
    ],
)
def test_a_hull_without_volume_is_refused(points, text):
    with pytest.raises(cs.errors.InputError, match=text):
        shapes.Hull(points)
