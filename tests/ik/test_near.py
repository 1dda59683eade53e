"""near=: of everything that reaches a goal the one configuration nearest to a seed."""

from __future__ import annotations

import numpy as np
import pytest

import cspace as cs
from cspace.model import from_screws
from ik.arms import load
from ik.likenesses import gap, random_configurations

X, Y, Z = np.eye(3)


@pytest.mark.parametrize("name", ["ur5e", "jaco2", "puma560", "scara", "z1"])
def test_asking_again_answers_as_the_first_time_and_as_the_list(name):
    robot, rng = cs.load_robot(name), np.random.default_rng(3)
    for q, seed in zip(
        random_configurations(robot, rng, 40), rng.uniform(-4, 4, (40, robot.dof)), strict=True
    ):
        goal = robot.fk(q)
        listed = robot.ik(goal).within().nearest(seed)
        for _ in range(2):
            found = robot.ik(goal, near=seed)
            np.testing.assert_allclose(found.q, listed.q, atol=1e-9)
            for field in ("status", "complete", "branch", "reason"):
                assert getattr(found, field) == getattr(listed, field)


@pytest.mark.slow
@pytest.mark.parametrize("name", ["ur5e", "ur5_dh", "ur10e", "puma560", "viperx300s"])
@pytest.mark.parametrize("q5", [0.0, np.pi, -np.pi])
def test_a_seed_that_is_a_solution_is_the_answer(name, q5):
    """Also as a member of a family. The limits leave half a turn either way: every seed is inside."""
    arm, rng = cs.load_robot(name), np.random.default_rng(11)
    lower, upper = np.minimum(arm.limits.lower, -np.pi), np.maximum(arm.limits.upper, np.pi)
    c = arm.chain
    robot = cs.Robot.from_screws(c.axes, c.points, c.T_zero, lower=lower, upper=upper)
    for q in rng.uniform(-3, 3, (12, 6)):
        q[4] = q5
        found = robot.ik(robot.fk(q), near=q)
        assert gap(robot, found.q, q).min() < 1e-6


@pytest.mark.slow
@pytest.mark.parametrize("name", ["puma560", "ur5e", "irb120", "kr6_r900", "crx10ia", "scara"])
def test_a_batch_at_singular_poses_answers_as_single_calls(name):
    robot, rng = cs.load_robot(name), np.random.default_rng(13)
    q = random_configurations(robot, rng, 40)
    q[np.arange(40), rng.integers(robot.dof, size=40)] = 0.0
    q[::2, max(robot.dof - 2, 0)] = 0.0  # of a wrist, the joint that makes it singular
    T = robot.fk(q)
    for goals in (T, T[:2], T[:1], np.repeat(T[:1], 9, axis=0)):
        seeds = q[: len(goals)] if len(goals) != 9 else q[0]
        batch = robot.ik(goals, near=seeds)
        for k, goal in enumerate(goals):
            single = robot.ik(goal, near=seeds if seeds.ndim == 1 else seeds[k])
            assert len(batch[k]) == len(single)
            np.testing.assert_allclose(batch[k].q, single.q, atol=1e-9)


@pytest.mark.parametrize("end", [np.pi, -np.pi])
def test_a_whole_turn_may_end_on_a_limit(end):
    """Not a whole turn away from the seed because rounding takes the joint past its limit of half a turn."""
    robot, rng = cs.load_robot("ur5_dh"), np.random.default_rng(12)
    assert (robot.limits.lower[4], robot.limits.upper[4]) == (-np.pi, np.pi)
    for q in rng.uniform(-3, 3, (20, 6)):
        q[4] = end
        found = robot.ik(robot.fk(q), near=q)
        np.testing.assert_allclose(found.q[0], q, atol=1e-6)
        assert -np.pi <= found.q[0, 4] <= np.pi


def two_joints(kinds, axes, points=None):
    tip = cs.pose([0.3, 0.2, 0.1])
    return cs.Robot(from_screws(axes, points or [[0, 0, 0]] * len(axes), tip, joint_types=kinds, name=kinds))


@pytest.mark.parametrize(
    "robot",
    [
        two_joints("PP", [X, X]),
        two_joints("RR", [Z, Z]),
        two_joints("RRR", [Z, Z, Z], [[0, 0, 0], [0.4, 0, 0], [0.7, 0, 0]]),
        two_joints("RPP", [Z, X, X]),
    ],
    ids=lambda robot: robot.name,
)
def test_short_arms_with_freedom_come_as_near_as_they_can(robot):
    rng = np.random.default_rng(5)
    for q in rng.uniform(-1, 1, (8, robot.dof)):
        p = robot.fk(q)[:3, 3]
        np.testing.assert_allclose(robot.ik(position=p, near=q).q[0], q, atol=1e-6)
        seed = q + rng.normal(scale=0.5, size=robot.dof)
        found = robot.ik(position=p, near=seed)
        np.testing.assert_allclose(robot.fk(found.q[0])[:3, 3], p, atol=1e-9)
        here = gap(robot, found.q[0], seed)
        assert np.linalg.norm(found.q[0] - seed) <= np.linalg.norm(q - seed) + 1e-6, here


@pytest.mark.parametrize(
    ("name", "q"),
    [("puma560", [0.3, -0.5, 0.9, 0.4, 0.0, 0.2]), ("crx10ia", [0.3, -0.5, -np.pi / 2, 0.4, 0.7, 0.2])],
)
def test_a_family_has_a_member_nearest_to_each_seed(name, q):
    robot, rng = load(name), np.random.default_rng(7)
    T = robot.fk(np.array(q))
    self_motions = robot.ik(T).self_motions
    assert min(gap(robot, self_motion.nearest(np.array(q)), q) for self_motion in self_motions) < 1e-6
    for self_motion in self_motions:
        for seed in rng.uniform(-1, 1, (5, robot.dof)):
            best = self_motion.nearest(seed)
            np.testing.assert_allclose(robot.fk(best), T, atol=1e-9)
            others = self_motion.sample(200)
            d = np.linalg.norm((others - seed + np.pi) % (2 * np.pi) - np.pi, axis=1)
            here = np.linalg.norm((best - seed + np.pi) % (2 * np.pi) - np.pi)
            assert here <= d.min(initial=np.inf) + 1e-6
