"""The solutions of an arm made from another one are the other's, mapped: every word of turns and slides.

Scaled, mirrored, read from the tip, with another zero, on another base and with another tool, drawn with
other points and directions: each changes the numbers that the solver sees and none changes what is reached.
"""

from itertools import product

import numpy as np
import pytest
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st

from ik.likenesses import LIKENESSES, MAKERS, arm_of, gap, random_configurations, size_of, slides_of, weakest

WORDS = ["".join(word) for n in range(1, 7) for word in product("RP", repeat=n)]
CLEAR = 1e-2
"""Smallest singular value of the Jacobian at the configurations that make the goals."""
FAR = 4.0
"""Lengths of the arm and of the way to its goal. Slides that are parallel but for a little meet somewhere far
away as well; what lies there is not compared."""


def solve(robot, T):
    """The answer, checked for itself."""
    found = robot.ik(T)
    assert (found.status == "unreachable") == (len(found) == 0)
    assert found.residual.max(initial=0) <= 1e-9 * max(1.0, size_of(robot))
    rows = near_rows(found)
    for k, row in enumerate(rows[:-1]):
        assert gap(robot, rows[k + 1 :], row, size_of(robot)).min() > 1e-8
    return found


def near_rows(found):
    """The configurations that do not slide out of sight."""
    robot = found.solver
    way = size_of(robot) + np.linalg.norm(found.goal[:3, 3] - robot.chain.points[0])
    return found.q[np.abs(found.q[:, slides_of(robot)]).max(axis=1, initial=0) < FAR * way]


def expect_the_same(robot, likeness, q):
    """Both answers, None next to singularities, where rounding of the goal makes and unmakes solutions."""
    T, like = robot.fk(q), likeness.robot
    T_like = likeness.to_goal(T)
    size = max(1.0, np.abs(T_like[:3, 3]).max())
    assert np.abs(like.fk(likeness.to_q(q)) - T_like).max() < 1e-10 * size
    found, other = solve(robot, T), solve(like, T_like)
    assert gap(robot, found.q, q).min() < 1e-6
    if weakest(robot, near_rows(found)).min() < 1e-3 or weakest(like, near_rows(other)).min() < 1e-3:
        return None
    mapped = likeness.to_q(found.q)
    for row in likeness.to_q(near_rows(found)):
        assert gap(like, other.q, row, size_of(like)).min() < 1e-6
    for row in near_rows(other):
        assert gap(like, mapped, row, size_of(like)).min() < 1e-6
    assert found.status == other.status
    return found, other


def random_case(word, kind, seed):
    rng = np.random.default_rng([1, seed])
    robot = arm_of(word, *MAKERS[kind](word, rng))
    q = random_configurations(robot, rng, 8)
    q = q[weakest(robot, q) > CLEAR][:3]
    assume(len(q))
    robot.ik(robot.fk(q[0]))
    assume(not robot.solver.is_redundant)
    return robot, q, rng


@pytest.mark.slow
@pytest.mark.parametrize("name", LIKENESSES)
@settings(max_examples=60, deadline=None, suppress_health_check=[HealthCheck.filter_too_much])
@given(word=st.sampled_from(WORDS), kind=st.sampled_from(list(MAKERS)), seed=st.integers(0, 10**6))
def test_a_likeness_has_the_same_solutions(name, word, kind, seed):
    robot, q, rng = random_case(word, kind, seed)
    likeness = LIKENESSES[name](robot, rng)
    for row in q:
        expect_the_same(robot, likeness, row)


@pytest.mark.slow
@pytest.mark.parametrize("name", LIKENESSES)
@pytest.mark.parametrize("word", ["RRRRRR", "RRPRRR", "RPRRPR", "PRRPRP"])
def test_a_likeness_has_the_same_certificate(name, word):
    """In general position and away from singularities every list is certified, whatever the numbers."""
    rng = np.random.default_rng([2, *map(ord, word + name)])
    certified = asked = 0
    for _ in range(8):
        robot = arm_of(word, *MAKERS["general"](word, rng))
        likeness = LIKENESSES[name](robot, rng)
        q = random_configurations(robot, rng, 12)
        for row in q[weakest(robot, q) > CLEAR][:4]:
            both = expect_the_same(robot, likeness, row)
            if both:
                certified += both[0].complete and both[1].complete
                asked += 1
    assert asked >= 10
    assert certified >= 0.97 * asked


@pytest.mark.parametrize("word", ["RPRRPR", "PRRPRR"])
def test_a_certified_list_lacks_nothing_that_the_arm_read_from_its_tip_finds(word):
    """Slides parallel but for a calibration: solutions may lie a thousand lengths away, and they count."""
    compared = 0
    for seed in range(60):
        rng = np.random.default_rng([9, seed])
        robot = arm_of(word, *MAKERS["calibrated"](word, rng))
        likeness = LIKENESSES["reversed"](robot, rng)
        for q in random_configurations(robot, rng, 3):
            T = robot.fk(q)
            found, other = robot.ik(T), likeness.robot.ik(likeness.to_goal(T))
            if robot.solver.is_redundant or likeness.robot.solver.is_redundant:
                break
            assert gap(robot, found.q, q).min(initial=np.inf) < 1e-4 or not found.complete
            for row in other.q[:, ::-1] if found.complete else ():
                compared += 1
                assert gap(robot, found.q, row).min(initial=np.inf) < 1e-4 * (1 + np.abs(row).max())
    assert compared > 100


@pytest.mark.parametrize("half", ["RRR", "PRR", "RPR", "RRP"])
def test_a_symmetric_arm_read_from_its_tip_is_itself(half):
    """Axes laid symmetrically about a half turn: the arm and its reverse are one, and so are their answers to
    a goal and to its inverse.
    """
    rng = np.random.default_rng([3, *map(ord, half)])
    axes, points, _ = MAKERS["general"](half, rng)
    turn = np.diag([-1.0, -1.0, 1.0])  # a half turn about z, through the middle of the arm
    word = half + half[::-1]
    robot = arm_of(
        word, np.vstack([axes, -(axes @ turn)[::-1]]), np.vstack([points, (points @ turn)[::-1]]), np.eye(4)
    )
    S = np.eye(4)
    S[:3, :3] = turn
    checked = 0
    for q in random_configurations(robot, rng, 6):
        T = robot.fk(q)
        # The half turn exchanges base and tip, and each joint with its counterpart.
        assert np.abs(robot.fk(q[::-1]) - S @ np.linalg.inv(T) @ S).max() < 1e-12
        found, other = robot.ik(T), robot.ik(S @ np.linalg.inv(T) @ S)
        assert gap(robot, found.q, q).min() < 1e-6
        if weakest(robot, found.q).min() > 1e-3:
            assert len(found) == len(other)
            assert max(gap(robot, other.q, row[::-1]).min() for row in found.q) < 1e-6
            checked += 1
    assert checked
