"""The room of a disc's centre: by formulas where there are some, by fine polygons elsewhere."""

from __future__ import annotations

import math

import numpy as np
import pytest

import cspace as cs
from cspace.errors import InputError
from cspace.maps import Offset, OffsetCurve

BOX = [(4, 4), (6, 4), (6, 6), (4, 6)]


def area_inside(rings):
    return sum(0.5 * float(np.sum(x * np.roll(y, -1) - y * np.roll(x, -1))) for x, y in (r.T for r in rings))


def random_worlds(rng, count):
    for k in range(count):
        rings = [rng.uniform(0, 12, 2) + rng.uniform(-2, 2, (rng.integers(3, 6), 2)) for _ in range(6)]
        if k % 2:
            rings = [rng.integers(0, 13, (4, 2)) for _ in range(6)]
        rings = [ring for ring in rings if len(np.unique(ring, axis=0)) > 2]
        yield cs.PolygonWorld(rings, (0, 0, 12, 12), repair=True)


def test_around_a_convex_obstacle_it_is_steiners_formula():
    for ring, area, around in ((BOX, 4, 8), ([(4, 4), (7, 4), (4, 8)], 6, 12)):
        room = cs.PolygonWorld([ring], (0, 0, 12, 12)).offset(0.5)
        assert isinstance(room, Offset)
        assert all(isinstance(curve, OffsetCurve) for curve in room.curves)
        assert room.radius == 0.5
        assert len(room.curves) == 2
        assert room.area == pytest.approx(11**2 - (area + around / 2 + math.pi / 4), rel=1e-13)
        assert room.length == pytest.approx(44 + around + math.pi, rel=1e-13)


def test_a_wall_without_thickness_and_an_empty_world():
    wall = cs.PolygonWorld([[(4, 5), (6, 5)]], (0, 0, 10, 10), repair=True).offset(1)
    assert wall.area == pytest.approx(64 - 4 - math.pi, rel=1e-13)
    assert wall.length == pytest.approx(32 + 4 + 2 * math.pi, rel=1e-13)
    assert cs.PolygonWorld([], (0, 0, 10, 10)).offset(1).area == pytest.approx(64)
    assert cs.PolygonWorld([], (0, 0, 10, 10)).offset(6).curves == []


def test_two_corners_that_a_disc_does_not_pass_between():
    world = cs.PolygonWorld([[(1, 5), (4.6, 4), (4.6, 6)], [(9, 5), (5.4, 4), (5.4, 6)]], (0, 0, 10, 10))
    assert len(world.offset(0.3).curves) == 3
    assert len(world.offset(0.5).curves) == 2


@pytest.mark.slow
def test_fine_polygons_come_as_near_as_they_should():
    rng = np.random.default_rng(31)
    for world in random_worlds(rng, 16):
        for radius in (0.05, 0.3, 0.8):
            room = world.offset(radius)
            grown = world.inflate(radius, sides=400)
            off = radius * (1 / math.cos(math.pi / 400) - 1)
            less = room.area - area_inside(grown.walls)
            assert -1e-9 <= less <= 1.01 * off * room.length + 1e-9


def test_every_point_of_it_is_at_the_radius_and_curves_are_closed():
    rng = np.random.default_rng(32)
    for world in random_worlds(rng, 16):
        room = world.offset(0.4)
        for curve in room.curves:
            np.testing.assert_allclose(curve.end, np.roll(curve.start, -1, axis=0), atol=1e-9)
            arcs = ~np.isnan(curve.angles[:, 0])
            begin, end = curve.angles[arcs].T
            assert np.all(begin > end)
            for ends, angle in ((curve.start[arcs], begin), (curve.end[arcs], end)):
                at = curve.center[arcs] + 0.4 * np.stack([np.cos(angle), np.sin(angle)], axis=1)
                np.testing.assert_allclose(ends, at, atol=1e-12)
            np.testing.assert_allclose(world.clearance(curve.points(1e-3)), 0.4, atol=1e-9)


@pytest.mark.parametrize("radius", [0, -1, np.nan])
def test_a_radius_must_be_positive(radius):
    with pytest.raises(InputError, match="radius"):
        cs.PolygonWorld([BOX], (0, 0, 10, 10)).offset(radius)
