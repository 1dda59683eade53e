"""A hair out of reach, and a thousand lengths: no answer is false, and the reason says what is missing."""

import numpy as np
import pytest

from cspace.spatial import pose
from ik.arms import load
from ik.geometries import random_direction
from ik.likenesses import MAKERS, arm_of, random_configurations, scaled, size_of, weakest

ARMS = ["ur5e", "puma560", "kr6_r900", "z1", "romeo_left_leg", "jaco2", "crx10ia", "xarm6", "piper", "m1013"]
WORDS = ["RRRRRR", "RRPRRR", "PRRRRR", "RRRRPR", "RRRRR", "RRRR", "RRPR"]


def named(name):
    if name in ARMS:
        return load(name)
    rng = np.random.default_rng([9, *map(ord, name)])
    return arm_of(name, *MAKERS["general"](name, rng))


def moved(T, way):
    out = T.copy()
    out[:3, 3] += way
    return out


def expect_empty(robot, found):
    assert not found
    assert len(found) == 0
    assert found.status == "unreachable"
    assert found.q.shape == (0, robot.dof)
    assert found.self_motions == found.branch == ()
    assert found.residual.shape == (0,)
    assert found.out_of_reach > 0
    assert found.reason


def border(robot, rng):
    """A pose on the border of the reach along a straight way with one orientation, and that way's direction:
    by halving, from a pose that is reached to one that is not.
    """
    reach = size_of(robot) * robot.dof
    T = robot.fk(random_configurations(robot, rng, 1)[0])
    way = 3 * reach * random_direction(rng)
    low, high = 0.0, 1.0
    assert robot.ik(T)
    expect_empty(robot, robot.ik(moved(T, way)))
    while high - low > 1e-15:
        middle = 0.5 * (low + high)
        low, high = (middle, high) if robot.ik(moved(T, middle * way)) else (low, middle)
        if middle in (low, high) and high - low < 4e-16:
            break
    return moved(T, low * way), way / np.linalg.norm(way)


@pytest.mark.parametrize("name", [*ARMS, "RRRRRR"])
def test_a_hair_out_of_reach(name):
    robot = named(name)
    rng = np.random.default_rng([1, *map(ord, name)])
    for _ in range(3):
        T, way = border(robot, rng)
        for hair in (1e-8, 1e-7, 1e-6, 1e-5, 1e-4):
            inside, outside = robot.ik(moved(T, -hair * way)), robot.ik(moved(T, hair * way))
            assert inside
            assert inside.residual.max() <= 1e-9
            if hair <= 1e-6:  # farther out another part of the reach may begin
                expect_empty(robot, outside)
                # The way back is one way; a shorter one may lead across. Beside a fold the descent that
                # looks for it stops a little early.
                assert 0 < outside.out_of_reach <= 1.001 * hair + 3e-7


@pytest.mark.parametrize("lengths", [2.0, 30.0, 1e3, 1e6])
@pytest.mark.parametrize("name", [*ARMS, *(word for word in WORDS if "P" not in word)])
def test_far_out_of_reach(name, lengths):
    robot = named(name)
    rng = np.random.default_rng([2, *map(ord, name)])
    chain = robot.chain
    reach = np.linalg.norm(np.diff(np.vstack([chain.points, chain.T_zero[:3, 3]]), axis=0), axis=1).sum()
    for T in robot.fk(random_configurations(robot, rng, 4)):
        away = 2 * lengths * reach
        goal = T.copy()
        goal[:3, 3] = chain.points[0] + away * random_direction(rng)
        found = robot.ik(goal)
        expect_empty(robot, found)
        assert found.complete
        if robot.dof == 6:  # what a string of the arm's length would lack, or more
            assert (1 - 1e-9) * (away - reach) <= found.out_of_reach <= (1 + 1e-9) * (away + reach)
        assert len(robot.ik(goal, least_squares=True)) == 1


@pytest.mark.parametrize("factor", [1e-3, 1e3])
@pytest.mark.parametrize("name", ["ur5e", "puma560", "jaco2", "piper", "RRRRRR", "RRRRR"])
def test_what_is_missing_grows_with_the_arm(name, factor):
    robot = named(name)
    rng = np.random.default_rng([3, *map(ord, name)])
    like = scaled(robot, factor)
    for T in robot.fk(random_configurations(robot, rng, 4)):
        goal = moved(T, 3 * robot.dof * size_of(robot) * random_direction(rng))
        one, other = robot.ik(goal), like.robot.ik(like.to_goal(goal))
        expect_empty(robot, one)
        expect_empty(like.robot, other)
        assert other.out_of_reach == pytest.approx(factor * one.out_of_reach, rel=1e-6)


@pytest.mark.parametrize("word", WORDS)
def test_goals_that_nobody_made_are_met_or_not(word):
    """Random poses: every answer reaches its goal, and near a regular answer the goal may move."""
    robot = named(word)
    rng = np.random.default_rng([4, *map(ord, word)])
    turns = robot.fk(random_configurations(robot, rng, 40))[:, :3, :3]
    goals = np.array(robot.fk(random_configurations(robot, rng, 40)))
    goals[:, :3, :3] = turns
    batch = robot.ik(goals)
    assert np.nanmax(batch.residual, initial=0) <= 1e-9
    met = np.flatnonzero(batch.count)
    assert ((batch.status == "unreachable") == (batch.count == 0)).all()
    if robot.dof < 6:
        assert len(met) == 0  # fewer joints than a pose asks for
    for i in met[:20]:
        if weakest(robot, batch[i].q).min() > 1e-2:
            assert len(robot.ik(moved(goals[i], 1e-7 * random_direction(rng)))) == len(batch[i])


def test_a_miss_that_rounded_numbers_may_cause_says_what_to_ask():
    """The tool axis of the arm is its last joint's, which leaves the plane of the others by 6e-6 rad."""
    robot = load("so101_rounded")
    goal = {"position": [0.2, 0.05, 0.1], "direction": [0, 0, -1]}
    found = robot.ik(**goal)
    expect_empty(robot, found)
    assert "rounded robot data" in found.reason
    assert found.reason.endswith("least_squares=True returns the nearest configuration")
    nearest = robot.ik(**goal, least_squares=True)
    assert len(nearest) == 1
    assert nearest.residual[0] < 1e-5
    T = robot.fk([0.3, -0.4, 0.5, 0.6, 0.7])
    for turn in np.eye(3):
        found = robot.ik(T @ pose([0, 0, 0], rpy=1e-6 * turn))
        assert found or "rounded robot data" in found.reason
    assert "rounded robot data" not in robot.ik(position=[0.6, 0.05, 0.1], direction=[0, 0, -1]).reason


@pytest.mark.parametrize("name", [*ARMS, *(word for word in WORDS if "P" not in word)])
def test_a_goal_in_millimetres_is_noticed_and_one_in_metres_is_not(name):
    robot = named(name)
    for q in random_configurations(robot, np.random.default_rng(5), 4):
        T = robot.fk(q)
        far = T.copy()
        far[:3, 3] *= 1000.0
        remark = "is the goal in millimetres?"
        for goal, doubted in ((far, True), (T, False), (moved(T, 3.0 * size_of(robot)), False)):
            assert (remark in robot.ik(goal).reason) == doubted
            assert (remark in robot.ik(position=goal[:3, 3]).reason) == doubted
