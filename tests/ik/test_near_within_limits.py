"""near= keeps limits: of all configurations within limits that reach a goal the nearest to a seed."""

import numpy as np
import pytest

import cspace as cs
from cspace.model import Limits
from ik.likenesses import random_configurations

X, Y, Z = np.eye(3)
ROUNDING = 1e-9


def is_inside(q, limits):
    return bool(((q >= limits.lower) & (q <= limits.upper)).all())


def drawn(robot, rng, n):
    """Configurations within limits that make goals, and as many seeds."""
    return robot.random_configuration(n, rng=rng, reach=1), robot.random_configuration(n, rng=rng, reach=1)


def redundant_by_one(name):
    robot = cs.load_robot(name)
    return robot.solver.is_redundant and robot.solver.redundancy_degree() == 1


REDUNDANT = [name for name in cs.robots.names() if len(cs.load_robot(name).joint_names) == 7]
GOALS = {
    "pose": lambda T: {"goal": T},
    "position": lambda T: {"position": T[..., :3, 3]},
    "direction": lambda T: {"direction": T[..., :3, 2]},
    "position and direction": lambda T: {"position": T[..., :3, 3], "direction": T[..., :3, 2]},
    "look_at": lambda T: {"look_at": T[..., :3, 3] + 0.3 * T[..., :3, 2]},
}


def check_against_samples(robot, rng, n, samples=800):
    """No sample of the self-motion within limits is nearer, and the answer is one."""
    joint = robot.solver.redundant_joints[0]
    lower, upper = max(robot.limits.lower[joint], -np.pi), min(robot.limits.upper[joint], np.pi)
    for q, seed in zip(*drawn(robot, rng, n), strict=True):
        T = robot.fk(q)
        found = robot.ik(T, near=seed)
        assert len(found) == 1
        assert is_inside(found.q[0], robot.limits)
        assert found.residual[0] < ROUNDING
        listed = robot.ik(T, locked={joint: np.linspace(lower, upper, samples)}).within()
        seeds = np.broadcast_to(seed, (samples, robot.dof))
        best = np.nanmin(np.linalg.norm(listed.nearest(seeds) - seed, axis=-1), initial=np.inf)
        distance = np.linalg.norm(found.q[0] - seed)
        assert distance <= min(best, np.linalg.norm(q - seed)) + ROUNDING


@pytest.mark.parametrize("name", REDUNDANT)
def test_no_sample_within_limits_is_nearer(name):
    if not redundant_by_one(name):
        pytest.skip("not redundant by one joint")
    check_against_samples(cs.load_robot(name), np.random.default_rng(0), 4)


@pytest.mark.slow
@pytest.mark.parametrize("name", ["panda", "iiwa7", "iiwa14", "lwr4", "pr2_right", "baxter_left", "gen3"])
def test_no_sample_of_many_goals_is_nearer(name):
    check_against_samples(cs.load_robot(name), np.random.default_rng(1), 60, 2000)


@pytest.mark.parametrize("seed", range(6))
def test_no_sample_of_a_random_arm_is_nearer(seed):
    rng = np.random.default_rng(seed)
    T_zero = np.eye(4)
    T_zero[:3, 3] = rng.uniform(-0.5, 0.5, 3)
    robot = cs.Robot.from_screws(
        rng.normal(size=(7, 3)),
        rng.uniform(-0.5, 0.5, (7, 3)),
        T_zero,
        lower=-rng.uniform(0.5, 3.5, 7),
        upper=rng.uniform(0.5, 3.5, 7),
    )
    check_against_samples(robot, rng, 4)


@pytest.mark.parametrize("name", ["ur5e", "puma560", "kr6_r900", "xarm6", "scara", "panda"])
@pytest.mark.parametrize("kind", GOALS)
def test_every_kind_of_goal_keeps_limits(name, kind):
    robot, rng = cs.load_robot(name), np.random.default_rng(5)
    for q, seed in zip(*drawn(robot, rng, 6), strict=True):
        goal = GOALS[kind](robot.fk(q))
        found = robot.ik(**goal, near=seed)
        assert len(found) == 1
        assert is_inside(found.q[0], robot.limits)
        assert found.residual[0] < ROUNDING
        assert np.linalg.norm(found.q[0] - seed) <= np.linalg.norm(q - seed) + ROUNDING
        free = robot.ik(**goal, near=seed, limits=False)
        if is_inside(free.q[0], robot.limits):
            gap = np.linalg.norm(found.q[0] - seed) - np.linalg.norm(free.q[0] - seed)
            assert gap <= ROUNDING


@pytest.mark.slow
@pytest.mark.parametrize("name", ["ur5e", "puma560", "panda", "planar_3r"])
@pytest.mark.parametrize("kind", GOALS)
def test_a_batch_answers_like_single_goals(name, kind):
    robot, rng = cs.load_robot(name), np.random.default_rng(6)
    if name == "planar_3r" and kind not in ("pose", "position"):
        pytest.skip("the arm moves in the plane")
    q, seeds = drawn(robot, rng, 8)
    seeds = seeds[:, : robot.dof]
    limits = Limits(robot.limits.lower, np.minimum(robot.limits.upper, 0.5))  # not every goal is reached
    goals = GOALS[kind](robot.fk(q))
    for options in ({}, {"limits": limits}, {"limits": False}):
        batch = robot.ik(**goals, near=seeds, **options)
        for i, seed in enumerate(seeds):
            one = robot.ik(**{key: value[i] for key, value in goals.items()}, near=seed, **options)
            assert batch.count[i] == len(one) == len(batch[i])
            assert batch[i].reason == one.reason
            if one:
                np.testing.assert_allclose(batch.q[i, 0], one.q[0], atol=1e-9)


@pytest.mark.parametrize("name", ["puma560", "kr6_r900", "irb120", "scara"])
def test_without_redundancy_it_is_the_nearest_of_the_list_within_limits(name):
    robot, rng = cs.load_robot(name), np.random.default_rng(7)
    goals = random_configurations(robot, rng, 30)
    for q, seed in zip(goals, drawn(robot, rng, 30)[1], strict=True):
        T = robot.fk(q)
        listed, found = robot.ik(T).within().nearest(seed), robot.ik(T, near=seed)
        np.testing.assert_allclose(found.q, listed.q, atol=1e-9)
        assert found.reason == listed.reason
        free = robot.ik(T, near=seed, limits=False)
        assert len(free) == 1
        gaps = np.abs(np.sin((robot.ik(T).q - free.q) / 2)).max(axis=1)
        assert gaps.min() < ROUNDING


@pytest.mark.parametrize("name", ["panda", "gen3", "iiwa14"])
def test_where_nothing_is_within_limits_the_reason_names_the_joint(name):
    robot, rng = cs.load_robot(name), np.random.default_rng(8)
    q, seeds = drawn(robot, rng, 4)
    tight = Limits(q[0] - 1e-3, q[0] + 1e-3)
    for i in range(4):
        found = robot.ik(robot.fk(q[i]), near=seeds[i], limits=tight)
        if i == 0:
            assert np.abs(found.q[0] - q[0]).max() <= 1e-3
            continue
        assert not found
        assert "within limits" in found.reason
        assert any(f"{joint} out by" in found.reason for joint in robot.joint_names)
        assert not robot.redundancy(robot.fk(q[i])).solver.limited(tight).solve(robot.fk(q[i])).within(tight)


def test_multiples_of_a_turn_count_by_the_way_within_limits():
    """A joint with limits of ±350° stands at 340°; the solution at −15° is 355° away, not 5°."""
    limit = np.radians(350)
    arm = cs.Robot.from_screws([Z], [[0, 0, 0]], cs.pose([1, 0, 0]), lower=[-limit], upper=[limit])
    found = arm.ik(arm.fk([np.radians(-15)]), near=[np.radians(340)])
    np.testing.assert_allclose(np.degrees(found.q), [[345]])
    found = arm.ik(arm.fk([np.radians(-5)]), near=[np.radians(340)])
    np.testing.assert_allclose(np.degrees(found.q), [[-5]])


@pytest.mark.parametrize("name", ["puma560", "kr6_r900"])
def test_a_singular_pose_is_answered_within_limits(name):
    """The straight wrist turns about one line: the sum of its angles counts, and either may be at a limit."""
    robot, rng = cs.load_robot(name), np.random.default_rng(9)
    tight = Limits(np.full(6, -2.0), np.full(6, 2.0))
    for q, seed in zip(rng.uniform(-1.9, 1.9, (20, 6)), rng.uniform(-3, 3, (20, 6)), strict=True):
        q[4] = 0
        T = robot.fk(q)
        found = robot.ik(T, near=seed, limits=tight)
        assert len(found) == 1
        assert is_inside(found.q[0], tight)
        assert found.residual[0] < ROUNDING


def test_limits_go_with_near_alone():
    robot = cs.load_robot("panda")
    with pytest.raises(cs.errors.InputTypeError, match="near="):
        robot.ik(robot.fk(np.zeros(7)), limits=False)
    with pytest.raises(cs.errors.InputTypeError, match="Limits"):
        robot.ik(robot.fk(np.zeros(7)), near=np.zeros(7), limits=3)
