"""Discs as obstacles."""

from __future__ import annotations

import math

import numpy as np
import pytest

import cspace as cs
from cspace.errors import InputError


def test_polygons_hold_their_discs_and_little_more():
    rng = np.random.default_rng(41)
    centers, radii = rng.uniform(1, 9, (12, 2)), rng.uniform(0.1, 1, 12)
    world = cs.PolygonWorld.from_discs(centers, radii, (0, 0, 10, 10))
    points = rng.uniform(0, 10, (3000, 2))
    apart = np.hypot(*(points[:, None] - centers).transpose(2, 0, 1))
    free = world.is_free(points)
    assert not np.any(free & np.any(apart < radii, axis=1))
    assert np.all(free[np.all(apart > radii / math.cos(math.pi / 64), axis=1)])


def test_the_way_around_a_disc():
    exact = 2 * math.sqrt(24) + (math.pi - 2 * math.acos(1 / 5))
    way = cs.navigate(cs.PolygonWorld.from_discs([(5, 5)], 1, (0, 0, 10, 10), sides=512), (0, 5), (10, 5))
    assert exact < way.length < exact * (1 + 1e-4)
    assert cs.PolygonWorld.from_discs(np.empty((0, 2)), 1).components == 1


@pytest.mark.parametrize(
    ("given", "word"),
    [
        (((1, 2), 1), "centers"),
        (([(1, 2)], [1, 2]), "radii"),
        (([(1, 2)], 0), "radii"),
        (([(1, 2)], np.nan), "radii"),
        (([(1, 2, 3)], 1), "centers"),
    ],
)
def test_discs_that_are_none(given, word):
    with pytest.raises(InputError, match=word):
        cs.PolygonWorld.from_discs(*given)
    with pytest.raises(InputError, match="sides"):
        cs.PolygonWorld.from_discs([(1, 2)], 1, sides=3)
