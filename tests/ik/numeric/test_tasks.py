"""Several tasks at once: gradients against differences, limits, optima against another solver."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import least_squares

import cspace as cs
from cspace.errors import InputError, InputTypeError, UnknownNameError
from cspace.robot import Robot
from kinematics.robots import tree
from model.random_robots import random_tree


def humanoid(seed: int) -> Robot:
    rng = np.random.default_rng(seed)
    while True:
        robot = Robot(random_tree(rng), floating=True)
        if robot.tip is None and robot.mass > 0:
            return robot


def weighted_errors(robot, tasks, q, T_world_base=None):
    """W e of all tasks, from forward kinematics alone."""
    out = []
    for task in tasks:
        if isinstance(task, cs.PostureTask):
            out.append(np.broadcast_to(task.weight, np.shape(task.q)) * (np.asarray(task.q) - q))
            continue
        if isinstance(task, cs.CenterOfMassTask):
            c = robot.center_of_mass(q, T_world_base=T_world_base)
            out.append(np.broadcast_to(task.weight, 3) * (np.asarray(task.p) - c))
            continue
        T = robot.fk(q, task.frame, T_world_base=T_world_base)
        if isinstance(task, cs.PositionTask):
            p = T[:3, :3] @ np.asarray(task.point) + T[:3, 3]
            out.append(np.broadcast_to(task.weight, 3) * (np.asarray(task.p) - p))
        elif isinstance(task, cs.DirectionTask):
            a = T[:3, :3] @ np.asarray(task.axis) / np.linalg.norm(task.axis)
            d = np.asarray(task.direction) / np.linalg.norm(task.direction)
            out.append([task.weight * np.arctan2(np.linalg.norm(np.cross(a, d)), a @ d)])
        else:
            goal = np.asarray(task.T)
            miss = np.concatenate(
                [goal[:3, :3].T @ (goal[:3, 3] - T[:3, 3]), cs.to_rotvec(T[:3, :3].T @ goal[:3, :3])]
            )
            out.append(np.broadcast_to(task.weight, 6) * miss)
    return np.concatenate(out)


def cost(robot, tasks, q, T_world_base=None):
    return 0.5 * float((weighted_errors(robot, tasks, q, T_world_base) ** 2).sum())


def some_tasks(robot, rng, q, T_world_base=None):
    """One task of every kind, on frames of several branches, near what q gives."""
    frames = rng.choice(robot.frames, 4)
    T = [robot.fk(q, f, T_world_base=T_world_base) for f in frames]
    return [
        cs.PoseTask(frames[0], T[0], weight=rng.uniform(0.2, 2, 6)),
        cs.PoseTask(frames[1], T[1], weight=0.7),
        cs.PositionTask(
            frames[2], T[2][:3, 3] + rng.normal(size=3) * 0.1, weight=[1, 0, 2], point=[0.1, 0.2, 0]
        ),
        cs.DirectionTask(frames[3], rng.normal(size=3), rng.normal(size=3), weight=0.5),
        cs.CenterOfMassTask(rng.normal(size=3), weight=[1, 2, 0.5]),
        cs.PostureTask(rng.normal(size=len(robot.joint_names)), weight=0.3),
    ]


@pytest.mark.parametrize("floating", [False, True])
def test_the_step_follows_the_gradient_of_the_cost(floating):
    # With a damping far above all curvature the step is −gradient / damping.
    rng, heavy, h = np.random.default_rng(1), 1e8, 1e-6
    for seed in range(8):
        robot = humanoid(seed) if floating else tree(seed)
        if robot.mass == 0:
            continue
        n = len(robot.joint_names)
        base = cs.random_pose(rng=rng) if floating else None
        q, there = rng.uniform(-1, 1, (2, n))
        tasks = some_tasks(robot, rng, there, base)
        qd = robot.task_velocity(
            q, tasks, 1.0, limits=False, velocity=False, damping=heavy, T_world_base=base
        )
        gradient = []
        for j in range(robot.dof):
            values = []
            for sign in (h, -h):
                moved, T = q.copy(), None if base is None else base.copy()
                if floating and j < 3:
                    T[j, 3] += sign
                elif floating and j < 6:
                    T[:3, :3] = cs.exp_so3(sign * np.eye(3)[j - 3]) @ T[:3, :3]
                else:
                    moved[j - (6 if floating else 0)] += sign
                values.append(cost(robot, tasks, moved, T))
            gradient.append((values[0] - values[1]) / (2 * h))
        np.testing.assert_allclose(-qd * heavy, gradient, rtol=2e-5, atol=2e-6 * (1 + np.abs(gradient).max()))


def test_one_task_without_limits_is_damped_least_squares():
    robot, rng = cs.load_robot("panda"), np.random.default_rng(2)
    q, there = robot.random_configuration(2, rng=rng)
    task = cs.PositionTask(None, robot.fk(there)[:3, 3], gain=0.5)
    qd = robot.task_velocity(q, task, 0.02, limits=False, velocity=False, damping=1e-3)
    J, e = robot.jacobian(q)[:3], robot.fk(there)[:3, 3] - robot.fk(q)[:3, 3]
    expected = np.linalg.solve(J.T @ J + 1e-3 * np.eye(7), J.T @ e * 0.5) / 0.02
    np.testing.assert_allclose(qd, expected, atol=1e-9)


@pytest.mark.parametrize("name", ["panda", "ur5e", "iiwa14"])
def test_steps_keep_all_limits_and_lead_to_the_goal(name):
    robot, rng, dt = cs.load_robot(name), np.random.default_rng(3), 0.02
    lower, upper = robot.limits.lower, robot.limits.upper
    speed = np.full(robot.dof, 1.5)
    arrived = 0
    for _ in range(10):
        there = robot.random_configuration(rng=rng)
        q = np.clip(there + rng.normal(size=robot.dof) * 0.5, lower, upper)
        tasks = [cs.PoseTask(None, robot.fk(there), gain=0.3), cs.PostureTask(there, weight=1e-3)]
        for _ in range(300):
            qd = robot.task_velocity(q, tasks, dt, velocity=speed)
            assert (np.abs(qd) <= speed * (1 + 1e-12)).all()
            q = q + qd * dt
            assert ((q >= lower) & (q <= upper)).all()
        arrived += cs.translation_distance(robot.fk(q), robot.fk(there)) < 1e-4
    assert arrived >= 8


def test_from_outside_the_limits_the_velocity_leads_back():
    robot = cs.load_robot("panda")
    q = robot.limits.upper + 0.1
    qd = robot.task_velocity(q, cs.PostureTask(q + 1), 0.01, velocity=np.full(7, 0.5))
    np.testing.assert_allclose(qd, -0.5)


@pytest.mark.parametrize("seed", range(6))
def test_tasks_of_a_tree_that_can_be_done_are_done(seed):
    robot, rng = tree(seed), np.random.default_rng(seed)
    n = len(robot.joint_names)
    truth = rng.uniform(-1, 1, n)
    tasks = [cs.PoseTask(leaf, robot.fk(truth, leaf)) for leaf in robot.leaves]
    if robot.mass > 0:
        tasks.append(cs.CenterOfMassTask(robot.center_of_mass(truth)))
    found = robot.ik_tasks(tasks, truth + rng.normal(size=n) * 0.1, limits=False)
    assert found, found.reason
    for leaf in robot.leaves:
        np.testing.assert_allclose(robot.fk(found.q, leaf), robot.fk(truth, leaf), atol=3e-6)
    assert "all tasks are done" in found.reason
    assert found.position_error.shape == (len(tasks),)


@pytest.mark.parametrize("seed", range(4))
def test_a_floating_base_moves_to_do_its_tasks(seed):
    robot, rng = humanoid(seed), np.random.default_rng(seed)
    n = len(robot.joint_names)
    truth, base = rng.uniform(-1, 1, n), cs.random_pose(rng=rng)
    tasks = [cs.PoseTask(leaf, robot.fk(truth, leaf, T_world_base=base)) for leaf in robot.leaves]
    tasks.append(cs.CenterOfMassTask(robot.center_of_mass(truth, T_world_base=base)))
    start = base.copy()
    start[:3, 3] += 0.1
    start[:3, :3] = cs.exp_so3([0.1, -0.2, 0.1]) @ start[:3, :3]
    found = robot.ik_tasks(tasks, truth + 0.05, limits=False, T_world_base=start)
    assert found, found.reason
    cs.as_pose(found.T_world_base)
    for leaf in robot.leaves:
        there = robot.fk(found.q, leaf, T_world_base=found.T_world_base)
        np.testing.assert_allclose(there, robot.fk(truth, leaf, T_world_base=base), atol=3e-6)


def test_a_compromise_is_the_optimum_of_another_solver():
    robot, rng = cs.load_robot("panda"), np.random.default_rng(4)
    bounds = (robot.limits.lower, robot.limits.upper)
    as_good = 0
    for _ in range(10):
        q, a, b = robot.random_configuration(3, rng=rng)
        tasks = [
            cs.PoseTask(None, robot.fk(a)),
            cs.PositionTask("panda_link4", robot.fk(b, "panda_link4")[:3, 3], weight=0.5),
            cs.PostureTask(q, weight=0.1),
        ]
        found = robot.ik_tasks(tasks, q, starts=1, max_iterations=1000)
        assert found.settled
        assert ((found.q >= bounds[0]) & (found.q <= bounds[1])).all()

        def errors(x, tasks=tasks):
            return weighted_errors(robot, tasks, x)

        near = np.clip(found.q, bounds[0] + 1e-9, bounds[1] - 1e-9)
        oracle = least_squares(errors, near, bounds=bounds, xtol=1e-12)
        assert cost(robot, tasks, found.q) <= oracle.cost * (1 + 1e-6) + 1e-9
        elsewhere = least_squares(errors, q, bounds=bounds)
        as_good += cost(robot, tasks, found.q) <= elsewhere.cost * 1.001 + 1e-9
    assert as_good >= 7


def test_a_posture_of_small_weight_costs_its_square():
    robot = cs.load_robot("panda")
    q = robot.random_configuration(rng=5)
    for weight, most in [(1e-4, 1e-6), (1e-2, 1e-3)]:
        tasks = [cs.PoseTask(None, robot.fk(q)), cs.PostureTask(q + 0.3, weight=weight)]
        found = robot.ik_tasks(tasks, q)
        assert found.position_error[0] < most
        assert found.rotation_error[0] < most
        assert found.success == (weight == 1e-4)
        assert np.linalg.norm(found.q - q - 0.3) < np.linalg.norm(np.full(7, 0.3))


def test_what_cannot_be_done_says_so_and_answers_are_reproducible():
    robot = cs.load_robot("ur5e")
    far = robot.fk(np.zeros(6))
    far[0, 3] = 7
    found = robot.ik_tasks(cs.PoseTask(None, far), starts=3)
    assert not found
    assert "task 0 (PoseTask) misses its target by" in found.reason
    assert "TaskSolution of ur5e" in repr(found)
    for rng in (None, 3):
        again = [robot.ik_tasks(cs.PoseTask(None, far), starts=3, rng=rng).q for _ in range(2)]
        np.testing.assert_array_equal(*again)
    still = robot.ik_tasks(cs.PoseTask(None, far), np.full(6, 0.2), starts=1, max_iterations=0)
    np.testing.assert_array_equal(still.q, np.full(6, 0.2))
    assert not still.settled
    assert still.iterations == 0


def test_bad_tasks_are_refused():
    robot, massless, T = cs.load_robot("ur5e"), cs.load_robot("irb120"), np.eye(4)
    for make in [
        lambda: cs.PoseTask(None, np.ones((4, 4))),
        lambda: cs.PoseTask(None, np.stack([T, T])),
        lambda: cs.PoseTask(None, T, weight=-1),
        lambda: cs.PoseTask(None, T, weight=np.zeros(6)),
        lambda: cs.PoseTask(None, T, weight=np.ones(3)),
        lambda: cs.PoseTask(None, T, gain=0),
        lambda: cs.PoseTask(None, T, gain=1.5),
        lambda: cs.PositionTask(None, [0, 0]),
        lambda: cs.PositionTask(None, [np.nan, 0, 0]),
        lambda: cs.DirectionTask(None, [0, 0, 0], [0, 0, 1]),
        lambda: cs.DirectionTask(None, [0, 0, 1], [0, 0, 1], weight=0),
        lambda: cs.PostureTask(np.zeros((2, 6))),
        lambda: cs.PostureTask([]),
        lambda: robot.task_velocity(np.zeros(6), [], 0.1),
        lambda: robot.task_velocity(np.zeros(6), cs.PostureTask(np.zeros(5)), 0.1),
        lambda: robot.task_velocity(np.zeros(5), cs.PoseTask(None, T), 0.1),
        lambda: robot.task_velocity(np.zeros(6), cs.PoseTask(None, T), 0),
        lambda: robot.task_velocity(np.zeros(6), cs.PoseTask(None, T), 0.1, damping=0),
        lambda: robot.task_velocity(np.zeros(6), cs.PoseTask(None, T), 0.1, velocity=np.ones(3)),
        lambda: massless.task_velocity(np.zeros(6), cs.CenterOfMassTask([0, 0, 0]), 0.1),
    ]:
        with pytest.raises(InputError):
            make()
    with pytest.raises(UnknownNameError):
        robot.ik_tasks(cs.PoseTask("nose", T))
    with pytest.raises(InputTypeError, match="expected PoseTask"):
        robot.ik_tasks([T])
