"""The configurations of goals: every IK solution within limits, the nearest multiples of 2π, samples."""

import numpy as np
import pytest

import cspace as cs
from cspace.errors import InputError, InputTypeError, UnknownNameError
from cspace.ik.near_rows import sort_near
from cspace.plan_motion.find import find_goals
from cspace.planning import ArmSpace

SEEDS = range(8)


def arm(name):
    return cs.load_robot(name, geometry="skeleton")


@pytest.mark.parametrize("seed", SEEDS)
def test_rows_of_a_pose_are_all_solutions_at_their_nearest_multiples(seed):
    robot = arm("ur5e")
    start, q = robot.random_configuration(2, rng=seed)
    T = robot.fk(q)
    goals = find_goals(robot, ArmSpace(robot), start[None], T)
    assert goals.is_whole
    distances = np.linalg.norm(goals.rows - start, axis=1)
    assert (np.diff(distances) >= 0).all()
    np.testing.assert_allclose(robot.fk(goals.rows), np.broadcast_to(T, (len(goals.rows), 4, 4)), atol=1e-9)
    every = robot.ik(T).within(robot.limits, windings=True).q  # all copies within limits, one by one
    groups = np.round(np.mod(every, 2 * np.pi), 6) % round(2 * np.pi, 6)
    nearest = {}
    for key, row in zip(map(tuple, groups), every, strict=True):
        nearest[key] = min(nearest.get(key, np.inf), np.linalg.norm(row - start))
    np.testing.assert_allclose(distances, np.sort(list(nearest.values())), atol=1e-5)


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("name", ["panda", "fetch"])
def test_rows_of_a_redundant_arm_reach_the_pose_within_limits(name, seed):
    robot = arm(name)
    start, q = robot.random_configuration(2, rng=seed)
    T = robot.fk(q)
    goals = find_goals(robot, ArmSpace(robot), start[None], T)
    assert not goals.is_whole
    assert len(goals.rows)
    np.testing.assert_allclose(robot.fk(goals.rows), np.broadcast_to(T, (len(goals.rows), 4, 4)), atol=1e-9)
    assert ((goals.rows >= robot.limits.lower) & (goals.rows <= robot.limits.upper)).all()
    assert (np.diff(np.linalg.norm(goals.rows - start, axis=1)) >= 0).all()
    if goals.find_more is not None:
        assert len(goals.find_more().rows) > len(goals.rows)


@pytest.mark.parametrize("name", ["ur5e", "panda", "planar_3r"])
def test_several_poses_have_the_rows_of_each(name):
    robot = arm(name)
    space = ArmSpace(robot)
    start, *q = robot.random_configuration(4, rng=3)
    poses = robot.fk(np.array(q))
    goals = find_goals(robot, space, start[None], poses)
    each = [find_goals(robot, space, start[None], T) for T in poses]
    rows = np.concatenate([part.rows for part in each])
    order = np.argsort(np.linalg.norm(rows - start, axis=1), kind="stable")
    np.testing.assert_allclose(goals.rows, rows[order], atol=1e-12)
    assert goals.is_whole == all(part.is_whole for part in each)
    assert (goals.find_more is None) == all(part.find_more is None for part in each)
    if goals.find_more is not None:
        assert len(goals.find_more().rows) > len(goals.rows)
    far = robot.fk(q[0]) + np.array([[0, 0, 0, 9.0], [0] * 4, [0] * 4, [0] * 4])
    np.testing.assert_array_equal(
        find_goals(robot, space, start[None], [far, poses[0]]).rows, each[0].rows[: len(each[0].rows)]
    )
    none = cs.plan(robot, start, [far] * 5)
    assert none.status == "unreachable"
    assert none.reason.startswith("pose 0: no IK solution")
    assert "and 2 more" in none.reason


def test_rows_outside_limits_and_rows_of_nan_are_left_out():
    robot = arm("ur5e")
    rows = np.array([[0.1] * 6, [np.nan] * 6, [7.0, 0, 0, 0, 0, 0], [0, 0, 2 * np.pi + 0.1, 0, 0, 0]])
    kept = sort_near(robot.solver, rows, robot.limits, np.zeros(6))
    expected = np.array([[0.0, 0, 0.1, 0, 0, 0], [0.1] * 6, [7.0 - 2 * np.pi, 0, 0, 0, 0, 0]])
    np.testing.assert_allclose(kept, expected, atol=1e-12)
    narrow = cs.Limits(lower=np.full(6, -0.05), upper=np.full(6, 0.2))
    np.testing.assert_allclose(sort_near(robot.solver, rows, narrow, np.zeros(6)), expected[:2], atol=1e-12)


def test_farther_goals_are_reached_where_the_nearest_ones_are_walled_in():
    rows = [[x, 0, 0, 0.05] for x in np.linspace(0, 1, 21)]
    robot = cs.load_robot("planar_2r").with_spheres({"link_1": rows, "link_2": rows})
    cage = cs.Scene([cs.Sphere(0.02, [0.5 * np.cos(t), 0.5 * np.sin(t), 0]) for t in (0.5, 1.5)])
    near = [[0.2, 0.0], [1.8, 0.0], [0.1, 0.0], [1.9, 0.1]]
    plan = cs.plan(robot, [1.0, 0.0], [*near, [1.1, 1.9]], cage)
    assert plan
    assert plan.goal == 4
    assert plan.stats["edges"] > 2048
    np.testing.assert_array_equal(plan.path[-1], [1.1, 1.9])
    shut = cs.planning.RRTConnect(edges=4000).plan(ArmSpace(robot, cage), [1.0, 0.0], near)
    assert shut.status == "undetermined"
    assert shut.stats["edges"] == 4000


def test_the_nearest_goals_are_preferred():
    robot = arm("ur5e")
    start = np.radians([-60, -80, 90, -100, -90, 0])
    goals = start + np.linspace(0.1, 1.0, 20)[:, None] * np.ones(6)
    assert cs.plan(robot, start, goals[::-1].copy()).goal == 19


def test_a_pose_that_few_samples_miss_is_sampled_densely():
    robot = arm("panda")
    balls = np.random.default_rng(3).uniform([-0.7, -0.7, -0.2], [0.7, 0.7, 1.2], (60, 3))
    scene = cs.Scene([cs.Sphere(0.03, p) for p in balls if np.linalg.norm(p[:2]) > 0.3])
    q = robot.random_configuration(3000, rng=5)
    start, *free = q[~robot.collides(q, scene)]
    space = ArmSpace(robot, scene)
    missed = found = 0
    for row in free[:400]:
        few = find_goals(robot, space, start[None], robot.fk(row))
        if few.find_more is not None and robot.collides(few.rows, scene).all():
            missed += 1
            more = few.find_more()
            found += not robot.collides(more.rows, scene).all()
            plan = cs.plan(robot, start, robot.fk(row), scene, edges=1)
            assert plan or "sampled IK solutions touch" in plan.reason or "used up" in plan.reason
    assert 0 < missed < 20
    assert found > 0.5 * missed


class Held:
    """An object with a 4×4 `.A`, as poses of other packages have."""

    def __init__(self, T):
        self.A = T


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("name", ["ur5e", "panda"])
def test_an_object_that_holds_a_pose_is_a_goal_like_the_pose(name, seed):
    robot = arm(name)
    start, q = robot.random_configuration(2, rng=seed)
    T = robot.fk(q)
    rows = [find_goals(robot, ArmSpace(robot), start[None], goal).rows for goal in (T, Held(T))]
    np.testing.assert_array_equal(*rows)


def test_named_poses_are_starts_and_goals():
    robot = cs.load_robot("ur5e")
    poses = robot.named_poses
    plan = cs.plan(robot, "home", "up")
    np.testing.assert_array_equal(plan.path[[0, -1]], [poses["home"], poses["up"]])
    either = cs.plan(robot, ["home"], ["up", "home"])
    np.testing.assert_array_equal(either.path[-1], poses["home"])
    many = cs.plan_many(robot, "home", ["up", poses["up"]])
    np.testing.assert_array_equal(many[0].path, many[1].path)
    with pytest.raises(UnknownNameError, match="did you mean 'home'"):
        cs.plan(robot, "hoem", "up")
    with pytest.raises(InputTypeError, match="RobotGeometry has no named poses"):
        ArmSpace(robot.collision).as_rows("home", "start")


def test_a_direction_has_a_name_in_every_goal():
    robot = cs.load_robot("ur5e")
    by_name, by_numbers = (
        robot.ik(position=[0.4, 0.2, 0.3], direction=direction, near=robot.named_poses["up"])
        for direction in ("-z", [0, 0, -1])
    )
    np.testing.assert_array_equal(by_name.q, by_numbers.q)
    assert cs.plan(robot, "up", {"position": [0.4, 0.2, 0.3], "direction": "-z"})
    with pytest.raises(InputError, match="'down' is unknown, expected x, y, z"):
        robot.ik(position=[0.4, 0.2, 0.3], direction="down")


CORNER = np.array([0.0003, -1.4065, 1.0655, 1.5639, -1.3644, -3.0855, 2.157, -1.4692])
"""A configuration of Fetch near three limits; 4096 values of two redundant joints have none of its pose."""


@pytest.mark.parametrize("seed", SEEDS)
def test_a_pose_whose_solutions_fill_a_corner_of_the_limits_is_reached(seed):
    robot = arm("fetch_torso")
    rng = np.random.default_rng(seed)
    low, high = (np.clip(side, -np.pi, np.pi) for side in (robot.limits.lower, robot.limits.upper))
    parts = np.abs((rng.random((5, robot.dof)) < 0.5) - 0.02 * rng.random((5, robot.dof)))
    for q in [CORNER, *(low + (high - low) * parts)]:
        goals = find_goals(robot, ArmSpace(robot), q[None], robot.fk(q))
        assert len(goals.rows)
        assert np.abs(robot.fk(goals.rows) - robot.fk(q)).max() < 1e-8
