"""Rays against solids: what is met lies on the surface, nothing lies before it, misses are misses."""

from __future__ import annotations

import numpy as np
import pytest

from cspace.plot.solids import Solid, arrow, meet

GREY = np.full(3, 0.5)


def rays(rng: np.random.Generator, n: int = 4000) -> tuple[np.ndarray, np.ndarray]:
    """Rays from a far sphere toward a box about the origin."""
    out = rng.normal(size=(n, 3))
    origins = 5.0 * out / np.linalg.norm(out, axis=1, keepdims=True)
    ways = rng.uniform(-0.7, 0.7, size=(n, 3)) - origins
    return origins, ways / np.linalg.norm(ways, axis=1, keepdims=True)


def signed_distance(solid: Solid, x: np.ndarray) -> np.ndarray:
    """How far points are from a tapered capsule or a cylinder, negative inside: slow, by sampling its spheres
    or by its definition."""
    axis = solid.b - solid.a
    length = np.linalg.norm(axis)
    if solid.round:
        share = np.linspace(0, 1, 2001)[:, None]
        centers = solid.a + share * axis
        radii = solid.radius_a + share[:, 0] * (solid.radius_b - solid.radius_a)
        return np.array([(np.linalg.norm(p - centers, axis=1) - radii).min() for p in x])
    u = axis / length
    y = (x - solid.a) @ u
    around = np.linalg.norm(x - solid.a - y[:, None] * u, axis=1)
    radius = solid.radius_a + y / length * (solid.radius_b - solid.radius_a)
    return np.maximum.reduce([around - radius, -y, y - length])


SOLIDS = {
    "capsule": Solid(np.array([-0.4, 0.1, 0]), np.array([0.5, -0.2, 0.3]), 0.2, 0.2, GREY),
    "tapered": Solid(np.array([-0.4, 0.1, 0]), np.array([0.5, -0.2, 0.3]), 0.3, 0.1, GREY),
    "growing": Solid(np.array([-0.4, 0.1, 0]), np.array([0.5, -0.2, 0.3]), 0.1, 0.3, GREY),
    "sphere": Solid(np.zeros(3), np.zeros(3), 0.4, 0.4, GREY),
    "swallowed": Solid(np.zeros(3), np.array([0.1, 0, 0]), 0.4, 0.1, GREY),
    "cylinder": Solid(np.array([0, 0, -0.3]), np.array([0.1, 0.2, 0.4]), 0.25, 0.25, GREY, round=False),
    "cone": Solid(np.array([0, 0, -0.3]), np.array([0.1, 0.2, 0.4]), 0.25, 0.0, GREY, round=False),
}


@pytest.mark.parametrize("name", SOLIDS)
def test_the_first_meeting_lies_on_the_surface(name):
    solid = SOLIDS[name]
    origins, ways = rays(np.random.default_rng(3))
    distance, normals = meet(solid, origins, ways)
    hit = np.isfinite(distance)
    assert 0.05 < hit.mean() < 0.95
    points = origins[hit] + distance[hit, None] * ways[hit]
    some = slice(0, 300)
    allowed = 1e-3 if solid.round else 1e-9  # a capsule's distance is sampled
    assert np.abs(signed_distance(solid, points[some])).max() < allowed
    before = points[some] - 0.01 * ways[hit][some]
    assert (signed_distance(solid, before) > -1e-4).all(), "nothing of the solid lies before the meeting"
    np.testing.assert_allclose(np.linalg.norm(normals[hit], axis=1), 1.0, atol=1e-9)
    assert (np.einsum("ij,ij->i", normals[hit], ways[hit]) < 1e-9).all(), "normals face the ray"


@pytest.mark.parametrize("name", SOLIDS)
def test_rays_that_miss_stay_outside(name):
    solid = SOLIDS[name]
    origins, ways = rays(np.random.default_rng(4), 400)
    distance, _ = meet(solid, origins, ways)
    missed = np.flatnonzero(~np.isfinite(distance))[:40]
    for i in missed:
        along = origins[i] + np.linspace(3, 7, 200)[:, None] * ways[i]
        assert signed_distance(solid, along).min() > -1e-4


def test_an_arrow_ends_where_it_points():
    pieces = arrow(np.array([0.1, 0.2, 0.3]), np.array([0.0, 0.0, 0.5]), 0.02, GREY)
    np.testing.assert_allclose(pieces[-1].b, [0.1, 0.2, 0.8], atol=1e-15)
    np.testing.assert_allclose(pieces[0].b, pieces[-1].a, atol=1e-15)
