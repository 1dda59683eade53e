"""Obstacles touch the bounds, or each other, where a path begins or ends: no path passes through them."""

from __future__ import annotations

from functools import cache
from typing import Any, Final

import numpy as np
import pytest

import cspace as cs
from claims.families import Question
from claims.judge import enters_wall
from oracles.segments import enters
from touching_worlds import diamond_on_border, slanted_touch

PLANNERS: Final = [row.name for row in cs.navigation.PLANNERS.values() if row.world == "polygons"]
DRAWN: Final = {"prm": 100, "rrt": 100, "rrt_star": 100}
"""Planners that draw samples, with few of them: what is found must be free."""
SIDE: Final = 10


def at_border(seed: int) -> tuple[list[Any], Any, Any]:
    """A diamond that touches the border, turned by quarters; the point where it does, and a free point."""
    rng = np.random.default_rng([1, seed])
    while True:
        obstacles, corner = diamond_on_border(rng, SIDE)
        for _ in range(rng.integers(4)):
            *obstacles, corner = (
                np.stack([SIDE - p[..., 1], p[..., 0]], axis=-1) for p in (*obstacles, corner)
            )
        other = rng.integers(0, SIDE + 1, 2)
        if are_ends(obstacles, corner, other):
            return obstacles, corner, other


def at_edge(seed: int) -> tuple[list[Any], Any, Any]:
    """A corner of obstacles that touch on a slanted edge, and a free point."""
    rng = np.random.default_rng([2, seed])
    while True:
        obstacles = slanted_touch(rng, SIDE)
        corner, other = rng.permutation(np.vstack(obstacles))[0], rng.integers(0, SIDE + 1, 2)
        if are_ends(obstacles, corner, other):
            return obstacles, corner, other


def are_ends(obstacles: list[Any], *points: Any) -> bool:
    world = cs.PolygonWorld(obstacles, (0, 0, SIDE, SIDE))
    return not np.array_equal(*points) and all(world.is_free(p) for p in points)


@cache
def asked(family: Any, seed: int) -> Question:
    obstacles, corner, other = family(seed)
    rings = [[ring] for ring in obstacles]
    return Question(family.__name__, SIDE, seed, False, rings, (0, 0, SIDE, SIDE), corner, other)


@pytest.mark.slow
@pytest.mark.parametrize("family", [at_border, at_edge])
@pytest.mark.parametrize("planner", PLANNERS)
def test_paths_from_and_to_touching_corners_are_free(family, planner):
    options = {"rng": 1, "samples": DRAWN[planner]} if planner in DRAWN else {}
    for question in (asked(family, seed) for seed in range(25)):
        for start, goal in (ends := (question.start, question.goal), ends[::-1]):
            route = cs.navigate(question.world, start, goal, planner, **options)
            assert not len(route.path) or enters_wall(route.path, question) is None, question.name
            assert not (route and question.length == np.inf)
            assert not (route.status == "unreachable" and question.length < np.inf)


@pytest.mark.parametrize("goal", [(7, 4), (1, 1), (9, 9), (2, 7), (2, 1)])
def test_a_descent_leaves_a_corner_by_a_free_sector(goal):
    world = cs.PolygonWorld([[(2, 8), (3, 9), (2, 10), (1, 9)]], (0, 0, 10, 10))
    route = cs.navigate(world, (2, 10), goal, "potential_field")
    assert route
    assert enters(route.path, world.obstacles, world.bounds) is None
