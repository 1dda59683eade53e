"""The histogram filter: equal to a slow one in plain numpy, cell by cell."""

from __future__ import annotations

import numpy as np
import pytest

import cspace as cs
from cspace import _core
from cspace.localization import HistogramFilter
from cspace.localization.particles import histogram
from localization.test_particles import CLEAN, WAY, building, route

rng_of = np.random.default_rng


def shift(values, by, axis, wraps):
    whole = int(np.floor(by))
    part = by - whole
    return (1 - part) * roll(values, whole, axis, wraps) + part * roll(values, whole + 1, axis, wraps)


def roll(values, by, axis, wraps):
    """Values moved by whole cells; zeros come in, or the others end."""
    if wraps:
        return np.roll(values, by, axis=axis)
    moved = np.zeros_like(values)
    n = values.shape[axis]
    if abs(by) < n:
        to, of = [slice(None)] * values.ndim, [slice(None)] * values.ndim
        to[axis], of[axis] = slice(max(by, 0), n + min(by, 0)), slice(max(-by, 0), n + min(-by, 0))
        moved[tuple(to)] = values[tuple(of)]
    return moved


def blur(values, sigma, axis, wraps):
    """A normal distribution cut off at three deviations; none below 0.3 cells."""
    if not sigma > 0.3:
        return values
    reach = int(np.ceil(3 * sigma))
    weights = np.exp(-0.5 * (np.arange(-reach, reach + 1) / sigma) ** 2)
    weights /= weights.sum()
    return sum(w * roll(values, k - reach, axis, wraps) for k, w in enumerate(weights))


def move_slowly(belief, steps, turn, turn_sigma):
    moved = np.empty_like(belief)
    for k, (dy, dx, sigma_y, sigma_x) in enumerate(steps):
        plane = shift(shift(belief[k], dy, 0, False), dx, 1, False)
        moved[k] = blur(blur(plane, sigma_y, 0, False), sigma_x, 1, False)
    return blur(shift(moved, turn, 0, True), turn_sigma, 0, True)


@pytest.mark.parametrize("threads", [1, 3])
@pytest.mark.parametrize("seed", range(12))
def test_steps_move_and_blur_as_in_numpy(seed, threads):
    rng = rng_of(seed)
    sectors, rows, columns = rng.integers([8, 1, 1], [20, 40, 70])
    belief = rng.random((sectors, rows, columns)) * (rng.random((sectors, rows, columns)) < 0.3)
    belief[:, : rows // 3] = 0
    steps = np.concatenate(
        [rng.normal(size=(sectors, 2)) * [[3], [60]][seed % 2], rng.exponential(1.0, (sectors, 2))], axis=1
    )
    turn, turn_sigma = rng.normal() * 8, rng.exponential(2.0)
    found = np.full(belief.size, np.nan)
    is_left = _core.move_belief(
        belief.ravel(), sectors, rows, columns, steps, turn, turn_sigma, threads, found
    )
    expected = move_slowly(belief, steps, turn, turn_sigma)
    assert is_left == (expected.sum() > 0)
    expected /= expected.sum() or 1.0
    assert np.allclose(found.reshape(belief.shape), expected, rtol=1e-12, atol=1e-300)


@pytest.mark.parametrize("threads", [1, 3])
@pytest.mark.parametrize("seed", range(12))
def test_scores_of_a_lattice_are_those_of_its_cells(seed, threads):
    rng = rng_of(seed)
    field = rng.integers(0, 256, size=rng.integers(1, 60, 2), dtype=np.uint8)
    rows, columns = (int(n) for n in rng.integers(1, 40, 2))
    step, outside = int(rng.integers(1, 7)), int(rng.integers(0, 256))
    first, ends = rng.uniform(-40, 40, 2), rng.normal(size=(int(rng.integers(1, 258)), 2)) * 40
    angles = rng.uniform(-np.pi, np.pi, 9)
    headings = np.stack([np.cos(angles), np.sin(angles)], axis=-1)
    lattice = _core.LatticeScores(field, outside, step, first, rows, columns, headings)
    found = np.full((9, rows, columns), -1, np.int32)
    lattice.sum(ends, threads, found.ravel())
    i, j = np.mgrid[:rows, :columns]
    for k, (c, s) in enumerate(headings):
        x = np.floor(first[0] + c * ends[:, 0] - s * ends[:, 1]).astype(int) + step * j[..., None]
        y = np.floor(first[1] + (s * ends[:, 0] + c * ends[:, 1])).astype(int) + step * i[..., None]
        inside = (x >= 0) & (x < field.shape[1]) & (y >= 0) & (y < field.shape[0])
        scores = np.where(inside, field[np.where(inside, y, 0), np.where(inside, x, 0)].astype(int), outside)
        assert np.array_equal(found[k], scores.sum(axis=-1))


def weigh_slowly(belief, sums, free, unit, share):
    prior = (1 - share) * belief + share * free / (free.sum() * len(belief))
    expected = prior * np.exp(unit * (sums - sums.max())) * np.where(free, 1.0, share)
    return expected / expected.sum(), sums[:, free > 0].max()


@pytest.mark.parametrize("seed", range(6))
def test_weights_are_those_of_bayes(seed):
    rng = rng_of(seed)
    shape = (int(rng.integers(8, 20)), *(int(n) for n in rng.integers(2, 30, 2)))
    belief = rng.random(shape) * (rng.random(shape) < 0.5)
    belief /= belief.sum()
    free = (rng.random(shape[1:]) < 0.6).astype(np.uint8)
    free[0, 0] = 1
    sums = rng.integers(0, 15300, shape, dtype=np.int32)
    found = np.full(belief.size, np.nan)
    best = _core.weigh_belief(belief.ravel(), *shape, sums.ravel(), free.ravel(), 2e-3, 1e-4, 2, found)
    expected, most = weigh_slowly(belief, sums, free, 2e-3, 1e-4)
    assert np.allclose(found.reshape(shape), expected, rtol=1e-12, atol=1e-29)
    assert best == most


class SlowCore:
    """The compiled functions of the filter, in numpy."""

    LatticeScores, ParticleCloud, ScoreMap = _core.LatticeScores, _core.ParticleCloud, _core.ScoreMap

    @staticmethod
    def move_belief(belief, *rest):
        *shape, steps, turn, turn_sigma, _, out = rest
        moved = move_slowly(belief.reshape(shape), steps, turn, turn_sigma)
        out[:] = moved.ravel() / (moved.sum() or 1.0)
        return moved.sum() > 0

    @staticmethod
    def weigh_belief(belief, *rest):
        *shape, sums, free, unit, share, _, out = rest
        free, sums = free.reshape(shape[1:]), sums.reshape(shape)
        found, best = weigh_slowly(belief.reshape(shape), sums, free, unit, share)
        out[:] = found.ravel()
        return int(best)


@pytest.mark.slow
@pytest.mark.parametrize("start", [None, (2.0, 2.0, 0.0)])
def test_a_drive_is_localised_as_by_the_slow_filter(monkeypatch, start):
    grid = building()
    log = cs.localization.simulate(route(WAY[:4]), grid, CLEAN, rng=3)
    fast = cs.localize(log, grid, filter="histogram", sensor=CLEAN, start=start)
    monkeypatch.setattr(histogram, "_core", SlowCore)
    slow = cs.localize(log, grid, filter="histogram", sensor=CLEAN, start=start)
    assert np.allclose(fast.poses, slow.poses, atol=1e-9)
    assert np.allclose(fast.covariances, slow.covariances, atol=1e-9)
    assert np.array_equal(fast.scores, slow.scores)
    assert np.array_equal(fast.ambiguous, slow.ambiguous)
    assert fast


def test_cells_that_are_no_whole_cells_of_the_map_are_scored_one_by_one():
    """The sums of the lattice and those of single poses differ where an end lies on the edge of a cell."""
    grid = building()
    log = cs.localization.simulate(route(WAY[:2]), grid, CLEAN, rng=3)
    whole, broken = (HistogramFilter(grid, resolution=r, headings=24, sensor=CLEAN) for r in (0.2, 0.27))
    assert whole._lattice is not None
    assert broken._lattice is None
    ends, _ = whole.model.choose_ends(whole.model.read_ends(log.scans[3]))
    fast = whole._sum_scores(ends).copy()
    whole._lattice = None
    slow = whole._sum_scores(ends)
    assert (fast != slow).mean() < 0.01
    for each in (whole, broken):
        each.update(log.scans[3])
        assert each.score > 0.5


def test_wrong_sizes_are_refused():
    with pytest.raises(ValueError, match="a number per cell"):
        _core.move_belief(np.ones(5), 2, 2, 2, np.zeros((2, 4)), 0.0, 0.0, 1, np.ones(5))
    with pytest.raises(ValueError, match="a number per cell"):
        _core.weigh_belief(
            np.ones(8), 2, 2, 2, np.zeros(8, np.int32), np.ones(3, np.uint8), 1.0, 0.1, 1, np.ones(8)
        )
    lattice = _core.LatticeScores(np.zeros((3, 3), np.uint8), 0, 1, (0.0, 0.0), 2, 2, np.ones((1, 2)))
    with pytest.raises(ValueError, match="more beams"):
        lattice.sum(np.zeros((258, 2)), 1, np.zeros(4, np.int32))
    with pytest.raises(ValueError, match="too far"):
        lattice.sum(np.array([[1e300, 0.0]]), 1, np.zeros(4, np.int32))
    with pytest.raises(ValueError, match="a number per cell"):
        lattice.sum(np.zeros((1, 2)), 1, np.zeros(3, np.int32))
