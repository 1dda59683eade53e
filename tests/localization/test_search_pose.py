"""The search of whole maps against trying every pose."""

import time

import numpy as np
import pytest

import cspace as cs
from cspace.errors import InputError, InputTypeError, TimeLimitError
from cspace.localization import search_pose


def all_scores(points, field, headings):
    """The sum of scores of every pose, (headings, rows, columns), and the headings."""
    rows, columns = field.scores.shape
    sums = np.zeros((headings, rows, columns), int)
    turns = 2 * np.pi * np.arange(headings) / headings
    turns[turns > np.pi] -= 2 * np.pi
    for k, turn in enumerate(turns):
        c, s = np.cos(turn) / field.resolution, np.sin(turn) / field.resolution
        across = np.floor(c * points[:, 0] - s * points[:, 1] + 0.5).astype(int)
        up = np.floor(s * points[:, 0] + c * points[:, 1] + 0.5).astype(int)
        for i, j in zip(up, across, strict=True):
            row, column = np.arange(rows)[:, None] + i, np.arange(columns) + j
            inside = (row >= 0) & (row < rows) & (column >= 0) & (column < columns)
            there = field.scores[np.clip(row, 0, rows - 1), np.clip(column, 0, columns - 1)]
            sums[k] += np.where(inside, there, field.outside)
    return sums, turns


def best_poses(points, field, headings, most, least, margin, apart, free):
    """The best separate poses: all poses in order of their scores, each against those taken."""
    sums, turns = all_scores(points, field, headings)
    sums = np.where(free, sums, -1)
    taken = []
    for at in np.lexsort((np.arange(sums.size), -sums.ravel())):
        score = sums.flat[at] / (255 * len(points))
        least = max(least, taken[0][3] - margin if taken else 0)
        if score < least - 1e-12 or len(taken) == most:
            break
        k, row, column = np.unravel_index(at, sums.shape)
        x, y = field.origin + field.resolution * (np.array([column, row]) + 0.5)
        near = [
            np.hypot(x - p[0], y - p[1]) <= apart[0]
            and abs((turns[k] - p[2] + np.pi) % (2 * np.pi) - np.pi) <= apart[1]
            for p in taken
        ]
        if not any(near):
            taken.append((x, y, turns[k], score))
    return np.array(taken).reshape(-1, 4)


@pytest.mark.parametrize("seed", range(24))
def test_the_search_is_that_of_all_poses(seed):
    rng = np.random.default_rng(seed)
    shape = rng.integers(1, 45, 2)
    blocked = rng.random(shape) < rng.choice([0.01, 0.05, 0.3])
    resolution = rng.uniform(0.03, 0.4)
    smooth = cs.OccupancyGrid(blocked, resolution, rng.uniform(-5, 5, 2)).likelihood_field(2 * resolution)
    outside = int(rng.choice([0, 0, 40, 255]))
    field = cs.maps.ByteField(smooth.scores, resolution, smooth.origin, outside)
    points = rng.uniform(-1, 1, (rng.integers(1, 30), 2)) * max(shape) * resolution * rng.choice([0.3, 1.0])
    free = rng.random(shape) < rng.choice([0.2, 1.0])
    headings, least = int(rng.integers(1, 40)), rng.choice([0.0, 0.3])
    apart = (rng.uniform(0, 8) * resolution, rng.uniform(0, 1.0))
    margin = rng.choice([0.1, 1.0])
    wanted = best_poses(points, field, headings, 4, least, margin, apart, free)
    step = 2 * np.pi / headings * (1 + 1e-12)
    found = search_pose(
        points, field, most=4, least_score=least, margin=margin, heading_step=step, apart=apart, free=free
    )
    np.testing.assert_allclose(found.poses, wanted[:, :3], atol=1e-12)
    np.testing.assert_allclose(found.scores, wanted[:, 3], atol=1e-12)
    assert bool(found) == (len(wanted) > 0)


def room(rng, size=160):
    """A grid of a room with pillars, 5 cm cells."""
    blocked = np.zeros((size, size + 40), bool)
    blocked[[0, -1]] = blocked[:, [0, -1]] = True
    for _ in range(12):
        i, j = rng.integers(0, size - 15, 2)
        blocked[i : i + rng.integers(2, 15), j : j + rng.integers(2, 15)] = True
    return cs.OccupancyGrid(blocked, 0.05, (-2.0, 1.0))


@pytest.mark.parametrize("seed", range(4))
def test_the_pose_of_a_scan_is_found(seed):
    rng = np.random.default_rng(seed)
    grid = room(rng)
    where = grid.center_of(rng.choice(np.argwhere(~grid.inflate(0.3).blocked)))
    turn = rng.uniform(-np.pi, np.pi)
    angles = np.linspace(-np.pi / 2, np.pi / 2, 121)
    ranges = cs.maps.cast_rays(grid, where, turn + angles) + rng.normal(0, 0.02, len(angles))
    points = ranges[:, None] * np.stack([np.cos(angles), np.sin(angles)], axis=-1)
    found = search_pose(points, grid.likelihood_field(), free=~grid.blocked)
    assert np.hypot(*(found.poses[0, :2] - where)) < 0.15
    assert abs((found.poses[0, 2] - turn + np.pi) % (2 * np.pi) - np.pi) < 0.05
    assert found.scores[0] > 0.7
    poses, scores = found
    assert (np.diff(scores) <= 0).all()
    assert len(poses) <= 3


def test_symmetric_maps_have_as_many_best_poses():
    blocked = np.zeros((80, 80), bool)
    blocked[[0, -1]] = blocked[:, [0, -1]] = True
    field = cs.OccupancyGrid(blocked, 0.05).likelihood_field()
    angles = np.linspace(-np.pi, np.pi, 90, endpoint=False)
    ranges = cs.maps.cast_rays(cs.OccupancyGrid(blocked, 0.05), (1.0, 1.4), angles)
    points = ranges[:, None] * np.stack([np.cos(angles), np.sin(angles)], axis=-1)
    found = search_pose(points, field, most=4, heading_step=np.pi / 180)
    assert len(found.scores) == 4
    assert np.ptp(found.scores) < 0.02


def test_what_cannot_be_searched_is_refused():
    field = cs.OccupancyGrid(np.eye(9, dtype=bool)).likelihood_field(0.5)
    some = np.ones((3, 2))
    with pytest.raises(InputTypeError, match="likelihood_field"):
        search_pose(some, cs.OccupancyGrid(np.eye(3, dtype=bool)))
    with pytest.raises(InputError, match="no points"):
        search_pose(np.empty((0, 2)), field)
    with pytest.raises(InputError, match="2000"):
        search_pose(np.ones((2001, 2)), field)
    with pytest.raises(InputError, match="reach"):
        search_pose(some * 1e12, field)
    with pytest.raises(InputError, match="least_score"):
        search_pose(some, field, least_score=2)
    with pytest.raises(InputError, match="heading_step"):
        search_pose(some, field, heading_step=1e-9)
    with pytest.raises(InputError, match="free"):
        search_pose(some, field, free=np.ones((3, 3), bool))
    with pytest.raises(InputError, match="apart"):
        search_pose(some, field, apart=(-1, 0))
    assert not search_pose(some * 1e6, field)


def test_a_time_limit_ends_the_search_or_changes_nothing():
    rng = np.random.default_rng(3)
    field = cs.OccupancyGrid(rng.random((1500, 1500)) < 0.01, 0.05).likelihood_field(0.1)
    points = rng.uniform(-8, 8, (150, 2))
    for limit in (0.01, 0.1):
        begin = time.perf_counter()
        with pytest.raises(TimeLimitError, match="time_limit"):
            search_pose(points, field, heading_step=0.002, least_score=0.0, margin=1.0, time_limit=limit)
        assert time.perf_counter() - begin < limit + 1.0
    small = cs.OccupancyGrid(rng.random((40, 40)) < 0.05, 0.1).likelihood_field(0.2)
    free = search_pose(points[:20] / 4, small, least_score=0.0)
    timed = search_pose(points[:20] / 4, small, least_score=0.0, time_limit=60)
    assert np.array_equal(free.poses, timed.poses)
    with pytest.raises(InputError, match="time_limit"):
        search_pose(points, field, time_limit=-1.0)
