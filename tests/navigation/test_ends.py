"""Start and goal the same point, or nearly: one answer, of whichever planner; ends in cells."""

from __future__ import annotations

import numpy as np
import pytest

import cspace as cs
from cspace.errors import InputError

SHEDS = [
    [(2, 2), (5, 2), (5, 5), (2, 5)],
    [(6, 1), (8.5, 1.5), (7, 4)],
    [(1, 6.5), (7.5, 6), (7.5, 7), (1.5, 8)],
]


@pytest.fixture(scope="module")
def world():
    return cs.PolygonWorld(SHEDS, bounds=(0, 0, 10, 10))


PLACES = {
    "free": (1, 1),
    "on a wall": (2, 3),
    "at a corner": (5, 5),
    "in a corner": (0, 0),
    "on the bounds": (10, 4),
}


@pytest.mark.parametrize("planner", cs.navigation.PLANNERS)
@pytest.mark.parametrize("place", PLACES)
def test_who_is_there_stays(world, planner, place):
    at = np.array(PLACES[place], float)
    for where in (world, world.to_grid(0.25)):
        if not where.is_free(at):
            continue  # nothing is free in cells that reach into an obstacle
        route = cs.navigate(where, at, at, planner)
        assert route
        assert route.status == "found"
        assert route.path.shape == (1, 2)
        assert np.array_equal(route.path[0], at)
        assert route.length == 0
        assert route.reason == "start and goal are the same point"
        assert len(route.trace) >= 0


@pytest.mark.parametrize("planner", cs.navigation.PLANNERS)
@pytest.mark.parametrize("near", [1e-13, 1e-7])
def test_a_goal_a_hair_away_is_reached(world, planner, near):
    start, goal = np.array([1.0, 1.0]), np.array([1.0, 1.0 + near])
    route = cs.navigate(world, start, goal, planner)
    assert route
    assert np.array_equal(route.path[[0, -1]], [start, goal])
    assert goal[1] - start[1] <= route.length <= 3 * near


def test_polygons_that_became_cells_are_told_with_their_size(world):
    route = cs.navigate(world, (1, 1), (9, 9), "a_star")
    assert route.reason.endswith("; polygons became cells of 0.05 m")
    assert "polygons became" not in cs.navigate(world.to_grid(), (1, 1), (9, 9), "a_star").reason
    assert "polygons became" not in cs.navigate(world, (1, 1), (9, 9)).reason
    with pytest.raises(InputError, match=r"polygons became cells of 1 m, give a smaller resolution="):
        cs.navigate(world, (1, 1), (1.9, 6.4), "a_star", resolution=1)
