"""Durations beside toppra and copp-py: equal on fine grids, on which only theirs exceed limits."""

import numpy as np
import pytest

import cspace as cs
from oracles.path_timing import copp_call, duration, excess, toppra_call

pytestmark = pytest.mark.oracle
INTERVALS = 4000


def splines():
    rng = np.random.default_rng(31)
    for count in (2, 3, 5, 12, 30):
        yield cs.spline(rng.uniform(-1.5, 1.5, (count, 6))), rng.uniform(1, 3, 6), rng.uniform(4, 12, 6)


@pytest.mark.parametrize("peer", ["toppra", "copp_py"])
def test_durations_are_those_of_the_peers(peer):
    pytest.importorskip(peer)
    make = toppra_call if peer == "toppra" else copp_call
    for path, v, a in splines():
        timed = cs.time_parametrize(path, velocity=v, acceleration=a, grid=INTERVALS)
        call = make(path, v, a, timed.grid)
        x = call()
        assert timed.duration == pytest.approx(duration(timed.grid, x), rel=5e-4)
        ours = excess(path, timed.grid, timed.squared_speed, v, a)
        theirs = excess(path, timed.grid, x, v, a)
        assert max(ours) <= 1e-9
        assert max(ours) <= max(theirs)
