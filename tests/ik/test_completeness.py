"""All solutions, not only the one that was asked for: against many numeric starts and published sets."""

import os

import numpy as np
import pytest

from data import shared_data
from ik.arms import ALL, has_closed_form, load, robot_from_chain, shared_chains
from ik.geometries import CLASSES, angle_gap, random_arm, random_q
from oracles.ik_many_starts import all_solutions

THOROUGH = os.environ.get("CSPACE_THOROUGH") == "1"
POSES, STARTS = (10, 600) if THOROUGH else (2, 150)


def expect_complete(robot, rng):
    c = robot.chain
    goals = robot.fk(random_q(rng, POSES, robot.dof))
    oracle = all_solutions(c.axes, c.points, c.T_zero, goals, starts=STARTS, steps=40, rng=rng)
    for T, expected in zip(goals, oracle, strict=True):
        found = robot.ik(T)
        for q in expected:
            assert angle_gap(found.q, q).min() < 1e-5, f"{robot.name} misses {q.tolist()}"
        # What the oracle's starts did not find must reach the goal too, and be one more.
        assert found.residual.max() < 1e-9
        for row, q in enumerate(found.q):
            assert len(found) == 1 or angle_gap(np.delete(found.q, row, axis=0), q).min() > 1e-6


@pytest.mark.parametrize("name", CLASSES)
def test_random_geometries_against_many_starts(name):
    rng = np.random.default_rng([11, *map(ord, name)])
    for square in (False, True):
        expect_complete(random_arm(CLASSES[name], rng, square=square), rng)


@pytest.mark.parametrize("name", ALL if THOROUGH else ["ur5e", "puma560", "kr6_r900", "icub_left_leg", "yam"])
def test_named_arms_against_many_starts(name):
    expect_complete(load(name), np.random.default_rng([12, *map(ord, name)]))


@pytest.mark.data
def test_the_published_solution_sets_and_nothing_else():
    """Every listed solution of the revolute arms of these families, and no configuration beside them."""
    folder = shared_data() / "arms"
    sets = np.load(folder / "solutions.npz")
    checked = 0
    for name in sorted({key.split("/")[0] for key in sets.files}):
        robot = robot_from_chain(shared_chains()[name])
        if robot is None or robot.dof > 6 or not has_closed_form(robot):
            continue
        checked += 1
        for T, Q, n in zip(sets[f"{name}/T"], sets[f"{name}/Q"], sets[f"{name}/nsol"], strict=True):
            found = robot.ik(T)
            assert len(found) == n, f"{name}: {len(found)} of {n}"
            for q in Q[:n]:
                assert angle_gap(found.q, q).min() < 1e-7
    assert checked >= 5
