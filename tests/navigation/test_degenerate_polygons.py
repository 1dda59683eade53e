"""Three hundred degenerate worlds of polygons: what is true of them, by an exact oracle, and what planners
say."""

from __future__ import annotations

import math
from collections import Counter
from typing import Any, Final

import numpy as np
import pytest

import cspace as cs
from cspace.errors import InputError
from oracles.segments import enters
from oracles.shortest import BLOCKED, shortest_length
from polygon_cases import Case, polygon_cases

CASES: Final = polygon_cases("found", "unreachable")
SHORTEST: Final = ("any_angle", "visibility_graph")
CERTAIN: Final = (*SHORTEST, "exact_cells", "bug_1", "bug_2", "tangent_bug")
"""Those whose verdict is never open."""
PLANNERS: Final = [row.name for row in cs.navigation.PLANNERS.values() if row.world == "polygons"]
DRAWN: Final = {"prm", "rrt", "rrt_star"}
HAIR: Final = 1e-30
"""How far beside a path its sides are looked at where gaps are as narrow as one rounding."""


def named(case: Case) -> str:
    return case.shows.replace(" ", "-")


def ask(world: cs.PolygonWorld, case: Case, planner: str) -> Any:
    assert case.start is not None
    assert case.goal is not None
    return cs.navigate(world, case.start, case.goal, planner, **({"rng": 1} if planner in DRAWN else {}))


def keeps_out(route: Any, world: cs.PolygonWorld) -> bool:
    """Whether no leg is longer in an obstacle than rounding moves its ends."""
    given = route.path, world.obstacles, world.bounds
    slack = 1e-11 * max(world.bounds[2] - world.bounds[0], world.bounds[3] - world.bounds[1])
    return any(enters(*given, beside=beside, slack=slack) is None for beside in (HAIR, 1e-12))


def test_there_are_many_and_each_is_told_apart():
    every = polygon_cases()
    assert len(every) >= 300
    assert len({case.shows for case in every}) == len(every)
    assert Counter(case.verdict for case in every).keys() == {"found", "unreachable", "error"}


@pytest.mark.parametrize("case", CASES, ids=named)
def test_the_files_tell_the_truth(case):
    length = shortest_length(case.obstacles, case.bounds, case.start, case.goal)
    assert length != BLOCKED
    assert length == pytest.approx(case.length, rel=1e-15, abs=0)


@pytest.mark.slow
@pytest.mark.parametrize("case", CASES, ids=named)
def test_every_planner_on_every_world(case):
    world = case.world()
    assert len(world.repairs) == len(case.says)
    assert all(words in said for words, said in zip(case.says, world.repairs, strict=True))
    for planner in PLANNERS:
        route = ask(world, case, planner)
        if planner in CERTAIN or route.status not in {"undetermined", "local_minimum"}:
            assert route.status == case.verdict, planner
        if route and planner in SHORTEST:
            assert route.length == pytest.approx(case.length, rel=1e-12, abs=0), planner
        if route:
            assert route.length >= case.length * (1 - 1e-12) - 1e-15, planner
            assert keeps_out(route, world), planner


@pytest.mark.parametrize("case", polygon_cases("error"), ids=named)
def test_faults_are_named(case):
    with pytest.raises(InputError) as raised:
        ask(case.world(), case, "any_angle")
    assert all(words in str(raised.value) for words in case.says)


TURNS: Final = [
    np.array(m) for m in ([[1, 0], [0, 1]], [[0, -1], [1, 0]], [[-1, 0], [0, -1]], [[0, 1], [-1, 0]])
]
MAPS: Final = [turn @ np.diag([flip, 1]) for turn in TURNS for flip in (1, -1)]


def moved(case: Case, by: Any, rng: np.random.Generator) -> Case:
    """The case turned, reflected and scaled by a matrix, its obstacles and corners in another order."""
    obstacles = []
    for rings in case.obstacles:
        turned = [np.roll(np.array(ring, float) @ by.T, rng.integers(len(ring)), axis=0) for ring in rings]
        obstacles.append([ring[:: rng.choice([-1, 1])].tolist() for ring in turned])
    rng.shuffle(obstacles)
    assert case.bounds is not None
    corners = np.array(case.bounds, float).reshape(2, 2) @ by.T
    bounds = [*corners.min(axis=0), *corners.max(axis=0)]
    start, goal = ((by @ np.array(p, float)).tolist() for p in (case.start, case.goal))
    length = case.length * math.sqrt(abs(np.linalg.det(by)))
    return Case(case.shows, obstacles, case.verdict, bounds, start, goal, case.repair, (), length)


@pytest.mark.parametrize("case", CASES, ids=named)
def test_turned_reflected_scaled_and_shuffled_nothing_changes(case):
    rng = np.random.default_rng(11)
    largest = np.abs(case.bounds).max()
    for k, turn in enumerate(MAPS):
        scale = 2.0 ** (0 if k == 0 or largest > 1e9 else rng.integers(-20, 20))
        variant = moved(case, scale * turn, rng)
        world = variant.world()
        for planner in CERTAIN:
            route = ask(world, variant, planner)
            assert route.status == case.verdict, (planner, k)
            if route and planner in SHORTEST:
                assert route.length == pytest.approx(variant.length, rel=1e-12, abs=0), (planner, k)
