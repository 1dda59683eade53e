"""Searches that run long heed signals: Ctrl-C ends them, and a handler may ask for routes itself."""

from __future__ import annotations

import signal
import sys
import time

import numpy as np
import pytest

import cspace as cs

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="no timer signals there")

PLANNERS = ("dijkstra", "jump_point_search", "any_angle")
SIDE = 1500


@pytest.fixture(scope="module")
def large():
    """A grid over which a search takes a good part of a second, and two points far from each other."""
    blocked = np.random.default_rng(7).random((SIDE, SIDE)) < 0.33
    blocked[:3] = blocked[-3:] = False
    return cs.OccupancyGrid(blocked), (0.5, 0.5), (SIDE - 0.5, SIDE - 0.5)


@pytest.fixture
def alarm():
    """Sets a handler that is called every so many seconds [s]."""
    before = signal.getsignal(signal.SIGALRM)

    def sound(handler, seconds):
        signal.signal(signal.SIGALRM, handler)
        signal.setitimer(signal.ITIMER_REAL, seconds, seconds)

    yield sound
    signal.setitimer(signal.ITIMER_REAL, 0)
    signal.signal(signal.SIGALRM, before)


@pytest.mark.parametrize("planner", PLANNERS)
def test_an_interrupt_ends_a_search(large, alarm, planner):
    grid, start, goal = large
    began = time.perf_counter()
    whole = cs.navigate(grid, start, goal, planner)
    took = time.perf_counter() - began

    def interrupt(*_):
        raise KeyboardInterrupt

    def again():
        while True:
            cs.navigate(grid, start, goal, planner)

    alarm(interrupt, took / 4)
    with pytest.raises(KeyboardInterrupt):
        again()
    signal.setitimer(signal.ITIMER_REAL, 0)
    assert cs.navigate(grid, start, goal, planner).length == whole.length


@pytest.mark.parametrize("planner", PLANNERS)
def test_a_handler_may_search_amid_a_search(large, alarm, planner):
    grid, start, goal = large
    alone = cs.navigate(grid, start, goal, planner)
    near = cs.navigate(grid, start, (40.5, 2.5), planner)
    asked = []
    alarm(lambda *_: asked.append(cs.navigate(grid, start, (40.5, 2.5), planner)), 0.02)
    amid = cs.navigate(grid, start, goal, planner)
    signal.setitimer(signal.ITIMER_REAL, 0)
    np.testing.assert_array_equal(amid.path, alone.path)
    assert asked
    assert {route.length for route in asked} == {near.length}
