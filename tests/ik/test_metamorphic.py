"""Metamorphic laws at round configurations: an arm and its likeness list the same solutions.

Robots rest at multiples of 30, 45 and 90 degrees, where coefficients vanish that are never zero at random.
"""

from itertools import product

import numpy as np
import pytest

import cspace as cs
from ik.likenesses import (
    LIKENESSES,
    MAKERS,
    arm_of,
    gap,
    random_configurations,
    round_configurations,
    size_of,
    slides_of,
    weakest,
)

FIRST = ["".join(word) for word in product("RP", repeat=3)]
CASES = [("wrist", first) for first in FIRST] + [("planar", first) for first in FIRST[1:-1]]
WORDS = ["".join(word) for n in range(3, 7) for word in product("RP", repeat=n)]
SHORT = [name for name in cs.robots.names() if cs.load_robot(name).dof <= 6]
REGULAR = 1e-3
"""Smallest singular value of the Jacobian at the solutions that are compared."""
FAR = 4.0
"""Slides that are nearly parallel meet lengths away from the arm; what lies beyond this is not compared."""


def regular_rows(robot, goal, q):
    """The solutions away from singularities that do not slide out of sight."""
    way = size_of(robot) + np.linalg.norm(goal[:3, 3] - robot.chain.points[0])
    near = np.abs(q[:, slides_of(robot)]).max(axis=1, initial=0) < FAR * way
    return q[near & (weakest(robot, q) > REGULAR)] if len(q) else q


def expect_all(robot, found, rows):
    """A certified list holds every regular one of rows."""
    if found.complete:
        for row in regular_rows(robot, found.goal, rows):
            assert gap(robot, found.q, row, size_of(robot)).min(initial=np.inf) < 1e-6, row


def expect_the_same_list(robot, likeness, q):
    """Both lists hold q and each other's solutions; whether both, or neither, are certified."""
    like, T = likeness.robot, robot.fk(q)
    found, other = robot.ik(T), like.ik(likeness.to_goal(T))
    for answer in (found, other):
        assert answer.residual.max(initial=0) <= 1e-9 * max(1.0, size_of(answer.solver))
    expect_all(robot, found, q[None])
    expect_all(robot, found, likeness.from_q(other.q))
    expect_all(like, other, likeness.to_q(np.vstack([q, found.q])))
    return found.complete == other.complete


def configurations(robot, rng, n):
    """Mostly round ones, away from singularities."""
    q = np.vstack([round_configurations(robot, rng, 3 * n), random_configurations(robot, rng, n // 3)])
    return rng.permutation(q[weakest(robot, q) > 10 * REGULAR])[:n]


def compare_arms(words, kinds, rng, arms, goals):
    """Random arms of these words and kinds beside every likeness: certificates that agree, goals asked."""
    same = []
    for name in LIKENESSES:
        for _ in range(arms):
            word, kind = rng.choice(words), rng.choice(kinds)
            robot = arm_of(word, *MAKERS[kind](word, rng))
            q = configurations(robot, rng, goals)
            likeness = LIKENESSES[name](robot, rng)
            for row in q:
                if not robot.ik(robot.fk(row)).freedom:
                    same.append(expect_the_same_list(robot, likeness, row))
    return np.mean(same), len(same)


@pytest.mark.slow
@pytest.mark.parametrize(("kind", "first"), CASES)
def test_three_joints_and_a_wrist(kind, first):
    rng = np.random.default_rng([1, *map(ord, first + kind)])
    words = [first + "R" * k for k in (1, 1, 2, 3)]
    agreed, asked = compare_arms(words, [kind], rng, 3 if kind == "planar" else 1, 24)
    assert asked > 20
    assert agreed > 0.95


@pytest.mark.slow
@pytest.mark.parametrize("kind", MAKERS)
@pytest.mark.parametrize("seed", range(4))
def test_every_word(kind, seed):
    rng = np.random.default_rng([2, seed, *map(ord, kind)])
    agreed, asked = compare_arms(WORDS, [kind], rng, 60, 8)
    assert asked > (300 if kind == "planar" else 500)  # planar arms have more round goals that leave freedom
    assert agreed > 0.97


def expect_catalogue(name, goals):
    robot, rng = cs.load_robot(name), np.random.default_rng([3, *map(ord, name)])
    for make in LIKENESSES.values():
        likeness = make(robot, rng)
        for q in configurations(robot, rng, goals):
            expect_the_same_list(robot, likeness, q)


@pytest.mark.parametrize("name", SHORT)
def test_arms_of_the_catalogue(name):
    expect_catalogue(name, 3)


@pytest.mark.slow
@pytest.mark.parametrize("name", SHORT)
def test_many_poses_of_the_catalogue(name):
    expect_catalogue(name, 100)
