"""Coverage: what is swept is what a bar carried along the path comes over, and nothing in reach is left."""

from itertools import pairwise

import numpy as np
import pytest

import cspace as cs
from cspace.errors import InputError, InputTypeError, UnknownNameError

nav = cs.navigation


def grid_of(blocked, resolution=1.0, origin=(0.0, 0.0)):
    return cs.OccupancyGrid(np.asarray(blocked, dtype=bool), resolution=resolution, origin=origin)


def cells_of(route, resolution=1.0, origin=(0.0, 0.0)):
    """The path cell by cell: rows (n, 2) of row and column."""
    corners = np.rint((route.path - origin) / resolution - 0.5).astype(int)[:, ::-1]
    way = [corners[0]]
    for a, b in pairwise(corners):
        assert (a == b).sum() == 1, "a move along or across the lines"
        n = np.abs(b - a).max()
        way += [a + (b - a) // n * k for k in range(1, n + 1)]
    return np.array(way)


def bar(blocked, row, column, half, along):
    """The cells under the bar: across the lines, up to the walls."""
    under = [(row, column)]
    for sign in (1, -1):
        for k in range(1, half + 1):
            r, c = (row, column + sign * k) if along == "y" else (row + sign * k, column)
            if not (0 <= r < blocked.shape[0] and 0 <= c < blocked.shape[1]) or blocked[r, c]:
                break
            under.append((r, c))
    return set(under)


def swept(blocked, way, half, along):
    """Passes over each cell, from the path alone."""
    passes, before = np.zeros(blocked.shape, int), set()
    for row, column in way:
        under = bar(blocked, row, column, half, along)
        for cell in under - before:
            passes[cell] += 1
        before = under
    return passes


def in_reach(blocked, start):
    """The free cells reached by moves along rows and columns."""
    reach = np.zeros(blocked.shape, bool)
    reach[start] = True
    while True:
        grown = reach.copy()
        grown[1:] |= reach[:-1]
        grown[:-1] |= reach[1:]
        grown[:, 1:] |= reach[:, :-1]
        grown[:, :-1] |= reach[:, 1:]
        grown &= ~blocked
        if (grown == reach).all():
            return reach
        reach = grown


def check(blocked, start, width, along=None):
    route = nav.coverage(grid_of(blocked), (start[1] + 0.5, start[0] + 0.5), width, along=along)
    way = cells_of(route)
    reach = in_reach(blocked, start)
    assert not blocked[way[:, 0], way[:, 1]].any()
    assert (way[0] == start).all()
    half = round((route.width - 1) / 2)
    passes = swept(blocked, way, half, route.along)
    np.testing.assert_array_equal(passes, route.passes)
    assert (passes[reach] > 0).all()
    assert route.reached == reach.sum()
    assert route.free == (~blocked).sum()
    assert bool(route) == (reach.sum() == (~blocked).sum())
    assert ((route.regions >= 0) == reach).all()
    assert sorted(route.order) == list(range(route.regions.max() + 1))
    assert route.overlap == pytest.approx(passes[reach].mean() - 1)
    assert route.length == len(way) - 1
    return route


@pytest.mark.parametrize("width", [1, 3, 5])
@pytest.mark.parametrize("density", [0.0, 0.05, 0.2, 0.4])
def test_every_cell_in_reach_is_swept(width, density):
    rng = np.random.default_rng(int(100 * density) + width)
    for along in ("x", "y", None):
        blocked = rng.random((rng.integers(1, 40), rng.integers(1, 40))) < density
        blocked[0, 0] = False
        check(blocked, (0, 0), width, along)


def test_rooms_with_thick_walls():
    rng = np.random.default_rng(3)
    for _ in range(20):
        blocked = np.zeros((60, 80), bool)
        for _ in range(8):
            r, c = rng.integers(0, 55), rng.integers(0, 70)
            blocked[r : r + rng.integers(1, 20), c : c + rng.integers(1, 20)] = True
        start = tuple(np.argwhere(~blocked)[rng.integers((~blocked).sum())])
        route = check(blocked, start, 5)
        assert route.overlap < 0.5


@pytest.mark.parametrize("width", [1, 3, 7])
def test_an_empty_room_is_swept_once(width):
    route = check(np.zeros((21, 42), bool), (0, 0 if width == 1 else width // 2), width, "y")
    assert route.lanes == 42 // width
    assert len(route.order) == 1
    # Only the ways from line to line come over what is swept.
    assert route.overlap <= (42 / width) * width * width / 2 / (21 * 42) + 0.01
    assert route.leftover == 0
    if width == 1:
        assert route.overlap == 0
        assert route.length == 21 * 42 - 1


def test_an_obstacle_in_the_middle_makes_four_regions():
    blocked = np.zeros((30, 30), bool)
    blocked[10:20, 10:20] = True
    route = check(blocked, (0, 0), 1, "y")
    assert len(route.order) == 4
    assert len({route.regions[0, 0], route.regions[0, 15], route.regions[29, 15], route.regions[0, 29]}) == 4


def test_the_axis_with_the_shorter_way_is_taken():
    blocked = np.zeros((5, 40), bool)
    one, other = (nav.coverage(grid_of(blocked), (0.5, 0.5), 3, along=a).length for a in ("x", "y"))
    assert nav.coverage(grid_of(blocked), (0.5, 0.5), 3).length == min(one, other)


def test_what_cannot_be_reached_is_told():
    blocked = np.zeros((5, 9), bool)
    blocked[:, 4] = True
    route = check(blocked, (2, 1), 1)
    assert not route
    assert "20 of 40 free cells cannot be reached" in route.reason
    corner = np.array([[0, 1], [1, 0]], bool)  # two cells that touch in a corner
    assert check(corner, (0, 0), 1).reached == 1


def test_the_frame_of_the_world_is_kept():
    blocked = np.zeros((4, 6), bool)
    route = nav.coverage(grid_of(blocked, 0.5, (10.0, -3.0)), (10.1, -2.9), 0.5)
    np.testing.assert_allclose(route.path[0], [10.25, -2.75])
    assert route.length == pytest.approx(0.5 * 23)
    assert "swept" in route.reason


@pytest.mark.parametrize("resolution", [0.5, 1.0, 1e-3])
@pytest.mark.parametrize("width", [1e6, 1e300, 1e308])
def test_a_bar_wider_than_the_map_sweeps_it(resolution, width):
    grid = cs.OccupancyGrid(np.zeros((20, 30), bool), resolution)
    route = nav.coverage(grid, (3.5 * resolution, 4.5 * resolution), width)
    assert route
    assert route.length == nav.coverage(grid, route.path[0], 100 * resolution).length


def test_what_is_no_question_is_refused():
    grid = grid_of([[0, 1], [0, 0]])
    with pytest.raises(InputError, match="blocked"):
        nav.coverage(grid, (1.5, 0.5))
    with pytest.raises(InputError, match="outside"):
        nav.coverage(grid, (5, 5))
    with pytest.raises(InputError, match="width"):
        nav.coverage(grid, (0.5, 0.5), 0.5)
    with pytest.raises(UnknownNameError, match="axis"):
        nav.coverage(grid, (0.5, 0.5), along="z")
    with pytest.raises(InputTypeError, match="OccupancyGrid"):
        nav.coverage(np.zeros((3, 3)), (0.5, 0.5))
