"""The table of claims: every planner has its row, each cell is what is claimed or has a note that says why
not, and a planner broken on purpose changes its cell."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

from claims import broken, cells, scaling, suite
from claims.families import FAMILIES, question
from claims.notes import NOTES
from claims.rows import KEPT, NO, ROWS, SHORTEST, YES
from cspace.navigation import PLANNERS
from navigation.bugs.worlds import FAMILIES as CELL_FAMILIES
from navigation.bugs.worlds import questions as questions_of_cells
from oracles.plane import shortest
from oracles.shortest import shortest_length


@cache
def asked():
    return suite.questions((2, 4), 1)


@cache
def seen():
    return suite.questions_of_sight(2)


def found(row, navigate=None, sizes=()):
    return suite.findings(ROWS[row], asked(), seen(), sizes, *([navigate] if navigate else []))[0]


def test_every_planner_has_a_row():
    assert {row.planner for row in ROWS.values()} == set(PLANNERS)


@pytest.mark.slow
@pytest.mark.parametrize("name", ROWS)
def test_each_cell_is_what_is_claimed_or_has_a_note(name):
    row, told = ROWS[name], found(name)
    differ = set(suite.disagreements(row, told)) - {"cost"}
    assert differ == {column for label, column in NOTES if label == name} - {"cost"}, {
        c: told[c] for c in differ
    }
    assert cells.WRONG not in {finding.word for finding in told.values()}


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "navigate", "column", "word"),
    [
        ("bug_2", broken.gives_up_at_the_second_hit, "complete", cells.WRONG),
        ("bug_1", broken.walks_to_and_fro, "bound", cells.WRONG),
        ("bug_2", broken.walks_to_and_fro, "bound", cells.WRONG),
        ("bug_2", broken.peeks, "map", YES),
        ("bug_2", broken.peeks, "shortest", SHORTEST),
        ("tangent_bug", broken.peeks, "map", YES),
        ("potential_field", broken.takes_rest_for_arrival, "complete", cells.WRONG),
        ("potential_field", broken.jumps_to_the_goal, "complete", cells.WRONG),
        ("visibility_graph", broken.walks_to_and_fro, "shortest", NO),
        ("any_angle", broken.cuts_through, "complete", cells.WRONG),
        ("exact_cells", broken.denies_what_is_far, "complete", cells.WRONG),
        ("approximate_cells", broken.denies_what_is_undetermined, "complete", cells.WRONG),
        ("a_star", broken.denies_what_is_far, "complete", cells.WRONG),
        ("a_star", broken.walks_to_and_fro, "shortest", NO),
        ("weighted_a_star", broken.walks_to_and_fro, "shortest", NO),
        ("voronoi", broken.peeks, "clearance", NO),
        ("brushfire", broken.peeks, "clearance", NO),
        ("prm", broken.stays_poor, "complete", "to resolution"),
        ("any_angle", broken.refuses_walls, "complete", cells.WRONG),
        ("bug_1", broken.refuses_walls, "complete", cells.WRONG),
        ("voronoi", broken.refuses_walls, "complete", cells.WRONG),
        ("weighted_a_star", broken.hurries, "shortest", NO),
        ("focal_search", broken.hurries, "shortest", NO),
        ("brushfire", broken.prefers_length, "clearance", KEPT),
    ],
)
def test_a_broken_planner_changes_its_cell(name, navigate, column, word):
    whole, flawed = found(name)[column].word, found(name, navigate)[column].word
    assert flawed == word != whole


def test_a_planner_that_slows_down_changes_its_cell():
    words = []
    for power in (1.0, 2.0):
        slow = broken.Slow(power)
        points = scaling.measure(ROWS["dijkstra"], (2, 3, 4, 5, 6, 8), navigate=slow, clock=slow.clock)
        assert scaling.fit(points, "nodes").exponent == pytest.approx(power, abs=0.01)
        words.append(scaling.cost(ROWS["dijkstra"], points).word)
    assert words[0] == ROWS["dijkstra"].claim.cost
    assert words[1].startswith("n^2.00")


def test_a_growth_is_fitted_with_its_uncertainty():
    rng = np.random.default_rng(1)
    n = np.repeat(2.0 ** np.arange(6, 13), 3)
    points = [{"n": k, "size": k, "seconds": k**1.5 * np.exp(rng.normal(0, 0.1))} for k in n]
    growth = scaling.fit(points, "seconds")
    assert abs(growth.exponent - 1.5) < growth.within < 0.1
    assert scaling.fit(points[:15], "seconds") is None


@pytest.mark.slow
@pytest.mark.parametrize("family", CELL_FAMILIES, ids=lambda f: f.__name__)
def test_the_oracle_agrees_with_counted_cells(family):
    for world, start, goal in questions_of_cells(9, 15, family, largest=6):
        part = world.parts()
        reachable = bool(world.parts_at(start, part) & world.parts_at(goal, part))
        every = np.vstack(world.polygons())
        bounds = (*every.min(axis=0), *every.max(axis=0))
        ends = [world.place(*map(float, point)) for point in (start, goal)]
        length = shortest([[ring] for ring in world.polygons()], bounds, *ends)
        assert (length < np.inf) == reachable, (world, start, goal)


@pytest.mark.slow
def test_two_oracles_agree_on_degenerate_worlds():
    for seed in range(12):
        q = question("degenerate", 1 + seed % 3, seed, bool(seed % 2))
        other = shortest_length(q.obstacles, q.bounds, q.start, q.goal)
        assert q.length == pytest.approx(other, rel=1e-12)


def test_the_oracle_on_ways_that_are_known():
    square, bounds = [np.array([(4, 4), (6, 4), (6, 6), (4, 6)])], (0, 0, 10, 10)
    assert shortest([square], bounds, (4, 5), (6, 5)) == pytest.approx(4)
    assert shortest([square], bounds, (0, 4), (10, 4)) == 10
    assert shortest([square], bounds, (2, 5), (8, 5)) == pytest.approx(2 * (np.sqrt(5) + 1))
    halves = [[np.array([(0, 0), (5, 0), (5, 5), (0, 5)])], [np.array([(5, 5), (10, 5), (10, 10), (5, 10)])]]
    assert shortest(halves, bounds, (3, 7), (7, 3)) == np.inf
    assert shortest(halves, bounds, (5, 5), (7, 3)) == pytest.approx(np.sqrt(8))
    crossed = [[np.array([(2, 0), (3, 0), (9, 10), (8, 10)])], [np.array([(0, 6), (10, 5), (10, 7), (0, 7)])]]
    assert shortest(crossed, bounds, (1, 1), (9.5, 1)) == np.inf


@pytest.mark.parametrize("family", FAMILIES)
def test_goals_are_shut_in_where_a_family_says_so(family):
    for shut in (False, True):
        for size in (2, 3):
            assert (question(family, size, 7, shut).length == np.inf) == shut
