"""What a route without a way holds: walkers their finite walk, the others no path and an infinite length."""

from __future__ import annotations

import numpy as np
import pytest

import cspace as cs

YARD = [np.array([(3, 3), (7, 3), (7, 7), (3, 7)]), np.array([(4, 4), (6, 4), (6, 6), (4, 6)])]
POLYGONS = cs.PolygonWorld([YARD], bounds=(0, 0, 10, 10))
FEW = {"prm": {"samples": 50}, "rrt": {"samples": 50}, "rrt_star": {"samples": 50}}


@pytest.mark.parametrize("planner", sorted(cs.navigation.PLANNERS))
def test_a_length_is_that_of_the_path_or_infinite(planner):
    kind = cs.navigation.PLANNERS[planner].world
    world = POLYGONS if kind == "polygons" else POLYGONS.to_grid(0.25)
    try:
        route = cs.navigate(world, (1.1, 5.1), (5.1, 5.1), planner=planner, **FEW.get(planner, {}))
    except cs.CspaceError:  # worlds that a planner does not take
        assert planner == "rimon_koditschek"
        return
    assert not route
    if len(route.path):
        assert np.isclose(route.length, np.linalg.norm(np.diff(route.path, axis=0), axis=1).sum())
        assert cs.navigation.PLANNERS[planner].sensing != "map" or route.status == "local_minimum"
    else:
        assert route.length == np.inf
        assert cs.navigation.PLANNERS[planner].sensing == "map"
