"""Calls leave nothing behind: memory stays flat, references are given back."""

import gc
import sys

import numpy as np
import pytest

from ik.arms import load


def resident_kib():
    with open("/proc/self/statm", encoding="ascii") as status:
        return int(status.read().split()[1]) * 4


@pytest.mark.slow
@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="reads the memory in use from /proc")
@pytest.mark.parametrize("kind", ["single", "singular", "filters", "batch", "refused"])
def test_memory_stays_flat(kind):
    robot = load("puma560")
    T = robot.fk(np.full(6, 0.4))
    at_singularity = robot.fk(np.array([0.3, -0.4, 0.7, 0.5, 0.0, 0.2]))
    goals, bad = np.stack([T] * 50), np.full((4, 4), np.nan)

    def refused():
        try:
            robot.ik(bad)
        except ValueError:
            return None

    call, times = {
        "single": (lambda: robot.ik(T).q, 50_000),
        "singular": (lambda: robot.ik(at_singularity), 2_000),
        "filters": (lambda: robot.ik(T).within().wrapped().nearest(np.zeros(6)).branch, 500),
        "batch": (lambda: robot.ik(goals, threads=2), 1_000),
        "refused": (refused, 5_000),
    }[kind]
    for _ in range(times // 5):
        call()
    gc.collect()
    before = resident_kib()
    for _ in range(times):
        call()
    gc.collect()
    assert resident_kib() - before < 1024


def test_references_are_given_back():
    robot = load("puma560")
    T = robot.fk(np.full(6, 0.4))
    kind = type(robot.ik(T))
    watched = (robot, robot.solver, kind, T)
    before = [sys.getrefcount(each) for each in watched]
    results = [robot.ik(T) for _ in range(100)]
    assert sys.getrefcount(robot.solver) == before[1] + 100
    del results
    assert [sys.getrefcount(each) for each in watched] == before
