"""Every scenario line of every MovingAI map: the exact length, and the file's to its last printed digit."""

from __future__ import annotations

import os

import numpy as np
import pytest

import cspace as cs
from data import shared_data
from oracles import grids

MAPS = (
    *("64room_000", "AcrosstheCape", "Berlin_1_256", "arena", "brc202d", "den520d", "maze-100-1"),
    *("maze-400-4", "random-400-33", "room-400-40"),
)


def folder():
    return shared_data() / "navigation/grid"


def printed_lengths(path):
    """The lengths of a scenario file as written."""
    lines = path.read_text().split("\n")[1:]
    return [line.split()[-1] for line in lines if line.strip()]


def half_digit(text):
    """Half a unit of the last of its digits (six, or more where they are written), and as much as sums of
    single precision, from which files are printed, are off."""
    whole, _, decimals = text.partition(".")
    return 0.5 * 10.0 ** -max(len(decimals), 6 - len(whole)) + float(text) * 2.0**-23


def cells_of(grid, route):
    return [grid.cell_of(point) for point in route.path]


@pytest.mark.slow
@pytest.mark.parametrize("name", MAPS)
def test_every_line_has_the_length_that_the_file_prints(name):
    grid = cs.OccupancyGrid.from_movingai(folder() / f"{name}.map")
    path = folder() / f"{name}.map.scen"
    lines = cs.maps.read_scenarios(path)
    printed = printed_lengths(path)
    assert len(printed) == len(lines.length) > 0
    blocked = grid.blocked
    for number, text in enumerate(printed):
        route = cs.navigate(grid, *lines.ends(number, grid), planner="jump_point_search")
        assert route, f"line {number}: {route.reason}"
        assert abs(route.length - float(text)) <= half_digit(text), f"line {number}"
        if number % 10 == 0:
            assert abs(grids.walked(blocked, cells_of(grid, route)) - route.length) <= 1e-9


@pytest.mark.slow
def test_lines_equal_an_independent_dijkstra():
    """By default some lines of each map; all of them, which takes long, with CSPACE_ALL_LINES=1."""
    share = 1 if os.environ.get("CSPACE_ALL_LINES") else 150
    worst, count = 0.0, 0
    for name in MAPS:
        grid = cs.OccupancyGrid.from_movingai(folder() / f"{name}.map")
        lines = cs.maps.read_scenarios(folder() / f"{name}.map.scen")
        steps = grids.graph(grid.blocked)
        chosen = np.arange(len(lines.length))[share // 2 :: share]
        for goal in np.unique(lines.goal[chosen], axis=0):
            asked = [k for k in chosen if (lines.goal[k] == goal).all()]
            limit = lines.length[asked].max() * (1 + 1e-5) + 1e-3
            truth = grids.distances(steps, (goal[1], goal[0]), grid.columns, limit)
            for k in asked:
                x, y = lines.start[k]
                ends = tuple(lines.start[k] + 0.5), tuple(goal + 0.5)
                for planner in ("jump_point_search", "a_star"):
                    route = cs.navigate(grid, *ends, planner=planner)
                    worst = max(worst, abs(route.length - truth[y * grid.columns + x]))
                count += 1
    assert count > 100
    assert worst <= 1e-9
