"""What is no question about navigation is refused by name; what is asked at once by many is answered."""

from __future__ import annotations

import copy
import pickle
import threading

import numpy as np
import pytest

import cspace as cs
from cspace.errors import CspaceError, InputError, InputTypeError

nav = cs.navigation
DIAGONAL = np.eye(3, dtype=bool)
SHED = cs.PolygonWorld([[(2, 2), (5, 2), (5, 5), (2, 5)]], (0, 0, 10, 10))


@pytest.mark.parametrize("resolution", [1e154, 1e300, 1e-300, 5e-324, 1e15])
def test_cells_of_absurd_sizes_are_refused(resolution):
    with pytest.raises(InputError, match="resolution"):
        cs.OccupancyGrid(DIAGONAL, resolution=resolution)


@pytest.mark.parametrize("resolution", [1e-29, 1e-12, 1e14])
@pytest.mark.parametrize("planner", ["bug_1", "any_angle", "potential_field", "voronoi", "a_star"])
def test_cells_of_odd_sizes_make_the_same_world(resolution, planner):
    ends = np.array([(0.5, 2.5), (1.5, 2.5)])
    plain = cs.navigate(cs.OccupancyGrid(DIAGONAL), *ends, planner)
    sized = cs.navigate(cs.OccupancyGrid(DIAGONAL, resolution), *(resolution * ends), planner)
    assert sized.status == plain.status
    assert sized.length == pytest.approx(resolution * plain.length, rel=1e-9)


@pytest.mark.parametrize("made", [nav.visibility_graph, nav.voronoi_diagram, nav.approximate_cells])
@pytest.mark.parametrize("world", [None, [1, 2], cs.OccupancyGrid(DIAGONAL)])
def test_a_diagram_of_no_polygons_is_refused(made, world):
    with pytest.raises(InputTypeError, match="give a PolygonWorld"):
        made(world)


@pytest.mark.parametrize(
    ("ask", "named"),
    [
        (lambda: SHED.offset([1]), "radius has shape"),
        (lambda: SHED.inflate([1, 2]), "radius has shape"),
        (lambda: cs.OccupancyGrid(DIAGONAL).inflate([]), "radius has shape"),
        (lambda: cs.PolygonWorld.from_discs([(0, 0)], 1.0, (-2, -2, 2, 2), sides=[8]), "sides has shape"),
        (lambda: nav.navigation_function([[0, 0, 10], [1e300, 3, 1]], (-5, 0)), "world"),
        (lambda: nav.navigation_function([[1e14, 0, 1e-3]], (1e14, 0)), "radius 0.001"),
        (lambda: cs.navigate(SHED, (1, 1), (9, 9), "potential_field", rho_0=1e300), "rho_0 is 1e.300"),
        (lambda: nav.follow([(0, 0), (3, 0)], time_step=1e-12), "time_step is 1e-12"),
        (lambda: nav.follow([(0, 0), (3, 0)], time_step=1e-320), "time_step"),
        (lambda: nav.follow([(0, 0), (3, 0)], controller=np.array([1.0, 2.0])), "controller"),
        (lambda: nav.hybrid_a_star(cs.OccupancyGrid(DIAGONAL), (0, 0, 0), (0, 0, 0), reverse=[1, 2]), "rev"),
    ],
)
def test_what_is_no_number_of_the_right_size_is_named(ask, named):
    with pytest.raises(CspaceError, match=named):
        ask()


def test_a_disc_too_large_has_no_room():
    for radius in (11.0, 1e155, 1e308):
        assert SHED.offset(radius).curves == []


@pytest.mark.parametrize("planner", nav.PLANNERS)
def test_routes_are_copied_and_pickled(planner):
    route = cs.navigate(SHED, (1, 1), (9, 9), planner)
    for same in (copy.copy(route), copy.deepcopy(route), pickle.loads(pickle.dumps(route))):
        assert (same.status, same.length, same.reason, same.stats) == (
            *(route.status, route.length, route.reason),
            route.stats,
        )
        np.testing.assert_array_equal(same.path, route.path)
        assert len(same.trace) == len(route.trace)


def test_edits_of_a_replanner_from_many_threads_are_made_one_by_one():
    planner = nav.DStarLite(cs.OccupancyGrid(np.zeros((60, 60), bool)), (0.5, 0.5), (59.5, 59.5))
    cells = np.stack(np.meshgrid(np.arange(5, 55), np.arange(5, 55, 3)), axis=-1).reshape(-1, 2)

    def edit(mine):
        for cell in mine:
            planner.set_blocked([tuple(map(int, cell))])
            assert planner.route

    threads = [threading.Thread(target=edit, args=(cells[k::4],)) for k in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    blocked = np.zeros((60, 60), bool)
    blocked[cells[:, 0], cells[:, 1]] = True
    fresh = cs.navigate(cs.OccupancyGrid(blocked), (0.5, 0.5), (59.5, 59.5), "a_star")
    assert planner.route.length == pytest.approx(fresh.length, rel=1e-12)
