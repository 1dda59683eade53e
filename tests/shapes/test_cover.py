"""Covers by spheres: every point of the shape is inside one, and none sticks out by more than stated."""

from __future__ import annotations

import numpy as np
import pytest

import cspace as cs
from cspace import shapes
from shapes.solids import KINDS, every_shape


@pytest.mark.slow
@pytest.mark.parametrize("kind", [kind for kind in KINDS if kind != "HalfSpace"])
@pytest.mark.parametrize("excess", [0.15, 0.08])
def test_covers_hold_the_shape_and_stick_out_no_farther_than_stated(kind, excess):
    rng = np.random.default_rng(4)
    shape = every_shape(rng)[KINDS.index(kind)]
    cover = shapes.cover_shape(shape, excess)
    assert 0.0 <= cover.excess <= excess
    points = rng.uniform(*shape.bounds, (4000, 3))
    points -= np.maximum(shape.distance(points), 0.0)[:, None] * shape.gradient(points)
    centers, radii = cover.spheres[:, :3], cover.spheres[:, 3]
    apart = (np.linalg.norm(points[:, None] - centers, axis=-1) - radii).min(axis=1)
    assert apart.max() < 1e-9
    directions = rng.normal(size=(40, 3))
    directions /= np.linalg.norm(directions, axis=1)[:, None]
    rim = (centers[:, None] + radii[:, None, None] * directions).reshape(-1, 3)
    assert shape.distance(rim).max() <= cover.excess + 1e-9


def test_primitives_have_the_balls_of_the_rule():
    assert np.array_equal(shapes.cover_shape(shapes.Sphere(0.2, [1, 2, 3])).spheres, [[1, 2, 3, 0.2]])
    cylinder = shapes.cover_shape(shapes.Cylinder(0.1, 0.2), 0.1).spheres
    assert np.allclose(cylinder, [[0, 0, 0, np.hypot(0.1, 0.1)]])
    capsule = shapes.cover_shape(shapes.Capsule(0.1, 0.2), 0.05).spheres
    assert np.allclose(capsule, [[0, 0, -0.1, np.hypot(0.1, 0.1)], [0, 0, 0.1, np.hypot(0.1, 0.1)]])


def test_a_half_space_and_too_fine_a_cover_are_refused():
    with pytest.raises(cs.errors.InputError, match="unbounded"):
        shapes.cover_shape(shapes.HalfSpace())
    with pytest.raises(cs.errors.InputError, match="use a larger one"):
        shapes.cover_shape(shapes.Box([1, 1, 1]), 1e-6)
    with pytest.raises(cs.errors.InputError, match="excess is 0"):
        shapes.cover_shape(shapes.Box([1, 1, 1]), 0.0)
