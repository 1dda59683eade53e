"""Discs among polygons: they go exactly where they fit."""

from __future__ import annotations

import numpy as np
import pytest

import cspace as cs
from cspace.errors import InputError


def gate(width, angle):
    """Two obstacles whose corners leave a gap in a direction, from side to side of the world."""
    along = np.array([np.cos(angle), np.sin(angle)])
    across = np.array([-along[1], along[0]])
    one, other = -width / 2 * along, width / 2 * along
    left = [one, one - 40 * along + 9 * across, one - 40 * along - 9 * across]
    right = [other, other + 40 * along - 9 * across, other + 40 * along + 9 * across]
    return cs.PolygonWorld([left, right], (-6, -6, 6, 6)), 3 * across


@pytest.mark.parametrize("planner", ["any_angle", "visibility_graph", "exact_cells", "bug_1"])
@pytest.mark.parametrize("angle", [0, np.pi / 32, 0.1, 0.777, 2.5])
def test_a_gap_between_corners_is_open_exactly_if_the_disc_fits(planner, angle):
    for excess in (1e-2, 1e-3, 1e-6, 1e-9):
        world, aside = gate(1 + excess, angle)
        route = cs.navigate(world, aside, -aside, planner, radius=0.5)
        assert route.status == "found", excess
        world, aside = gate(1 - excess, angle)
        assert cs.navigate(world, aside, -aside, planner, radius=0.5).status == "unreachable", excess


@pytest.mark.parametrize("angle", [0, 0.1, 0.777])
def test_a_gap_between_a_corner_and_a_slanted_wall(angle):
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    for width, status in ((1 + 1e-8, "found"), (1 - 1e-8, "unreachable")):
        wall = np.array([(-20, -20), (20, -20), (20, 0), (-20, 0)]) @ turn.T
        tooth = np.array([(0, width), (9, 30), (-9, 30)]) @ turn.T
        world = cs.PolygonWorld([wall, tooth], (-8, -8, 8, 8))
        ends = np.array([(-3, 1), (3, 1)]) @ turn.T
        assert cs.navigate(world, *ends, radius=0.5).status == status


def worlds(rng, count):
    for k in range(count):
        rings = [rng.uniform(0, 12, 2) + rng.uniform(-2, 2, (rng.integers(3, 6), 2)) for _ in range(6)]
        if k % 2:
            rings = [rng.integers(0, 13, (4, 2)) for _ in range(6)]
        rings = [ring for ring in rings if len(np.unique(ring, axis=0)) > 2]
        yield cs.PolygonWorld(rings, (0, 0, 12, 12), repair=True)


@pytest.mark.slow
def test_the_widest_way_and_the_grown_world_agree():
    """A disc a billionth smaller than the widest way goes through, one a billionth larger does not."""
    rng = np.random.default_rng(21)
    seen = set()
    for world in worlds(rng, 40):
        for start, goal in rng.uniform(0, 12, (4, 2, 2)):
            if not (world.is_free(start) and world.is_free(goal)):
                continue
            widest = cs.navigate(world, start, goal, "voronoi")
            if widest.status != "found" or widest.evidence.least_clearance < 0.02:
                continue
            clearance = widest.evidence.least_clearance
            for share in (1 - 1e-3, 1 - 1e-9):
                assert cs.navigate(world, start, goal, radius=share * clearance), (share, clearance)
            for share in (1 + 1e-3, 1 + 1e-9):
                radius = share * clearance
                if min(widest.evidence.at_start, widest.evidence.at_goal) < radius:
                    with pytest.raises(InputError, match="does not fit there"):
                        cs.navigate(world, start, goal, radius=radius)
                    seen.add("ends")
                else:
                    status = cs.navigate(world, start, goal, radius=radius).status
                    assert status == "unreachable"
                    seen.add(status)
    assert seen == {"ends", "unreachable"}


def test_paths_of_discs_keep_the_radius():
    rng = np.random.default_rng(22)
    for world in worlds(rng, 12):
        grown = world.inflate(0.3)
        points = [p for p in rng.uniform(0.3, 11.7, (40, 2)) if grown.is_free(p)]
        for start, goal in zip(points[::2], points[1::2], strict=False):
            route = cs.navigate(world, start, goal, radius=0.3)
            legs = zip(route.path, route.path[1:], strict=False)
            dense = [np.linspace(a, b, 50) for a, b in legs]
            assert not route or world.clearance(np.vstack(dense)).min() >= 0.3 - 1e-11


def test_errors_of_discs_speak_of_the_world_that_was_given():
    world = cs.PolygonWorld([[(4, 4), (6, 4), (6, 6), (4, 6)]], (0, 0, 10, 10))
    with pytest.raises(InputError, match=r"start \(3.9, 5\) is 0.1 m from a wall.*radius 0.5"):
        cs.navigate(world, (3.9, 5), (1, 1), radius=0.5)
    with pytest.raises(InputError, match=r"goal .* inside obstacle 0, 1 m deep"):
        cs.navigate(world, (1, 1), (5, 5), radius=0.5)
    with pytest.raises(InputError, match="start"):
        cs.navigate(world, (1, np.nan), (5, 5), radius=0.5)


def test_a_place_beside_a_corner_is_kept():
    world = cs.PolygonWorld([[(4, 4), (6, 4), (6, 6), (4, 6)]], (0, 0, 10, 10))
    beside = np.array([4, 4]) - 0.5000001 * np.array([np.cos(0.6), np.sin(0.6)])
    assert not world.inflate(0.5).is_free(beside)
    assert world.inflate(0.5, keep=beside).is_free(beside)
    assert world.inflate(0.5, sides=5, keep=[beside, (1, 1)]).is_free(beside)
    route = cs.navigate(world, beside, (9, 9), radius=0.5)
    assert route
    np.testing.assert_array_equal(route.start, beside)


@pytest.mark.parametrize("radius", [0.05, 0.2, 0.3])
def test_a_descent_rests_at_no_side_of_a_polygon_around_an_arc(radius):
    """Before a round corner the pull across it is stronger than what the wall's bend takes: no minimum."""
    shed = cs.PolygonWorld([[(2, 2), (5, 2), (5, 5), (2, 5)]], (0, 0, 10, 10))
    assert cs.navigate(shed, (1, 1), (9, 9), "potential_field", radius=radius)
    flat = cs.PolygonWorld([[(2, -3), (5, -3), (5, 5), (2, 5)]], (0, -4, 10, 10))
    assert cs.navigate(flat, (1, 1), (9, 1), "potential_field", radius=radius).status == "local_minimum"


@pytest.mark.parametrize("prefer", ["clearance", "length"])
@pytest.mark.parametrize("share", 10.0 ** np.arange(-13, -4))
def test_a_tiny_disc_takes_about_the_way_of_a_point_on_the_voronoi_diagram(share, prefer):
    corners = np.array([(0.3, 0.3), (0.7, 0.35), (0.7, 0.7), (0.3, 0.7)])
    world = cs.PolygonWorld([corners + np.array([i, j]) for i in range(5) for j in range(5)], (-1, -1, 6, 6))
    radius, ends = 7 * share, [(-0.5, -0.5), (5.5, 5.5)]
    point, disc = (cs.navigate(world, *ends, "voronoi", prefer=prefer, radius=r) for r in (0, radius))
    assert disc.status == "found"
    assert disc.length == pytest.approx(point.length, rel=1e-3)
    assert disc.clearance > radius
    lost = point.evidence.least_clearance - disc.evidence.least_clearance
    assert lost == pytest.approx(radius, rel=0.02, abs=1e-11)


@pytest.mark.parametrize("share", [1e-7, 1e-9])
def test_a_tiny_disc_is_stopped_by_a_gap_as_tiny(share):
    for excess, status in ((0.1, "found"), (-0.1, "unreachable")):
        world, aside = gate(24 * share * (1 + excess), 0.777)
        route = cs.navigate(world, aside, -aside, "voronoi", radius=12 * share)
        assert route.status in (status, "undetermined")
