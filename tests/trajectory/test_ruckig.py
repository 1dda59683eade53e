"""Motions from state to state against Ruckig (Berscheid and Kröger 2021)."""

import numpy as np
import pytest

from cspace.trajectory import state_to_state
from trajectory.problems import MAGNITUDES, random_problem

pytestmark = pytest.mark.oracle

PARTS = ("position", "velocity", "acceleration")


def ruckig_duration(problem, **settings):
    """Ruckig's duration, None where it finds no motion."""
    ruckig = pytest.importorskip("ruckig")
    n = len(problem["start"])
    task = ruckig.InputParameter(n)
    for end, theirs in (("start", "current"), ("goal", "target")):
        for part in PARTS:
            key = end if part == "position" else f"{end}_{part}"
            setattr(task, f"{theirs}_{part}", problem[key].tolist())
    for name in MAGNITUDES:
        setattr(task, f"max_{name}", problem[name].tolist())
    for name, value in settings.items():
        setattr(task, name, value)
    motion = ruckig.Trajectory(n)
    try:
        result = ruckig.Ruckig(n).calculate(task, motion)
    except Exception:
        return None
    return motion.duration if result in (ruckig.Result.Working, ruckig.Result.Finished) else None


def stands_still(problem):
    """Goal = start, moving: the shortest motion takes no time; Ruckig makes a loop."""
    names = ("", "_velocity", "_acceleration")
    return any(
        all(problem["start" + name][j] == problem["goal" + name][j] for name in names)
        for j in range(len(problem["start"]))
    )


def is_motion_of(motion, problem):
    """Ruckig misses a few motions of small numbers, at the edge of an interval of durations."""
    for order, name in enumerate(("", "_velocity", "_acceleration")):
        assert (motion(0.0, order) == problem["start" + name]).all()
        assert (motion(motion.duration, order) == problem["goal" + name]).all()
    assert motion.continuity >= 2
    assert motion.extremes(3).highest.max() <= problem["jerk"].max() * (1 + 1e-9)


@pytest.mark.parametrize("kind", ["any", "rest", "steps"])
@pytest.mark.parametrize("dof", [1, 3])
def test_shortest_times_are_those_of_ruckig(kind, dof):
    rng = np.random.default_rng(31)
    compared = shorter = 0
    for _ in range(1500):
        problem = random_problem(rng, dof, kind)
        theirs = None if stands_still(problem) else ruckig_duration(problem)
        if theirs is None:
            continue
        compared += 1
        ours = state_to_state(**problem)
        if ours.duration < theirs * (1 - 1e-9):
            shorter += 1
            is_motion_of(ours, problem)
        else:
            assert ours.duration == pytest.approx(theirs, rel=1e-9, abs=1e-9), problem
    assert compared > 1200
    assert shorter <= (3 if kind == "steps" else 0)


def test_prescribed_durations_are_those_of_ruckig():
    rng = np.random.default_rng(32)
    compared = 0
    for _ in range(1000):
        problem = random_problem(rng, 2, "any")
        asked = state_to_state(**problem).duration * rng.uniform(1.0, 3.0)
        theirs = ruckig_duration(problem, minimum_duration=asked)
        if theirs is None:
            continue
        compared += 1
        ours = state_to_state(**problem, duration=asked).duration
        assert ours == pytest.approx(theirs, rel=1e-9, abs=1e-9), problem
    assert compared > 900
