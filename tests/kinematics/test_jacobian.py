"""Jacobians against differences of poses, their derivative against differences of Jacobians."""

import numpy as np
import pytest

from kinematics import robots
from kinematics.robots import STEP, twist_between
from model.random_robots import random_pose


def differences(robot, q, frame, point):
    """The Jacobian in base axes by central differences of fk."""
    columns = []
    for step in np.eye(len(q)) * STEP:
        columns.append(twist_between(robot.fk(q - step, frame), robot.fk(q + step, frame), 2 * STEP, point))
    return np.array(columns).T.reshape(6, len(q))


@pytest.mark.parametrize("seed", range(8))
def test_the_jacobian_of_every_frame_and_point_is_the_difference_of_poses(seed):
    rng = np.random.default_rng(seed)
    robot = robots.tree(seed) if seed % 2 else robots.arm(seed, "RPRRPRR"[: 4 + seed // 2])
    q = robots.random_q(robot, rng)
    for frame in robot.frames:
        point = rng.normal(size=3)
        np.testing.assert_allclose(
            robot.jacobian(q, frame), differences(robot, q, frame, np.zeros(3)), atol=2e-8
        )
        moved = robot.jacobian(q, frame, point=point)
        np.testing.assert_allclose(moved, differences(robot, q, frame, point), atol=2e-8)


@pytest.mark.parametrize("seed", range(6))
def test_in_the_tip_the_jacobian_is_the_one_in_the_base_turned(seed):
    rng = np.random.default_rng(seed)
    robot = robots.tree(seed) if seed % 2 else robots.arm(seed)
    q, point, base = robots.random_q(robot, rng, 3), rng.normal(size=(3, 3)), random_pose(rng)
    frame = robot.frames[-1]
    options = {"point": point, "T_world_base": base}
    R = robot.fk(q, frame, T_world_base=base)[:, :3, :3]
    J = robot.jacobian(q, frame, **options)
    turned = np.concatenate([np.swapaxes(R, 1, 2) @ J[:, :3], np.swapaxes(R, 1, 2) @ J[:, 3:]], axis=1)
    np.testing.assert_allclose(robot.jacobian(q, frame, expressed_in="tip", **options), turned, atol=1e-14)


def test_single_and_batch_pose_and_jacobian_are_one_answer():
    for robot in (robots.arm(1), robots.arm(2, "RPRPRRR"), robots.planar(1.0, 0.5), robots.arm(3, "R" * 35)):
        q = robots.random_q(robot, np.random.default_rng(0), 6)
        T, J = robot.fk_jacobian(q)
        np.testing.assert_array_equal(J, robot.jacobian(q))
        for k in range(6):
            T_one, J_one = robot.fk_jacobian(q[k])
            np.testing.assert_allclose(T_one, T[k], atol=1e-13)
            np.testing.assert_allclose(J_one, J[k], atol=1e-13)
            np.testing.assert_allclose(J_one, robot.jacobian(q[k]), atol=1e-14)
            np.testing.assert_allclose(T_one, robot.fk(q[k]), atol=1e-14)


@pytest.mark.parametrize("expressed_in", ["base", "tip"])
@pytest.mark.parametrize("seed", range(8))
def test_the_derivative_of_the_jacobian_is_the_difference_of_jacobians(seed, expressed_in):
    rng = np.random.default_rng(seed)
    robot = robots.tree(seed) if seed % 2 else robots.arm(seed, "RPRRPRR"[: 4 + seed // 2])
    q, qd = robots.random_q(robot, rng), rng.normal(size=robot.dof)
    for frame in robot.frames[::3]:
        options = {"frame": frame, "point": rng.normal(size=3), "expressed_in": expressed_in}
        ahead, behind = (robot.jacobian(q + s * STEP * qd, **options) for s in (1, -1))
        J_rate = robot.jacobian_dot(q, qd, **options)
        scale = 1.0 + np.abs(J_rate).max()
        np.testing.assert_allclose(J_rate, (ahead - behind) / (2 * STEP), atol=1e-8 * scale)


def moved_base(T_world_base, twist, dt):
    """The base after dt at the twist [v; ω] of its origin in world axes."""
    from scipy.spatial.transform import Rotation

    T = np.array(T_world_base)
    T[:3, 3] += dt * twist[:3]
    T[:3, :3] = Rotation.from_rotvec(dt * twist[3:]).as_matrix() @ T[:3, :3]
    return T


@pytest.mark.parametrize("seed", range(6))
def test_a_floating_base_adds_six_columns_that_move_everything(seed):
    rng = np.random.default_rng(seed)
    made = robots.tree(seed) if seed % 2 else robots.arm(seed)
    robot = type(made)(made.description, floating=True)
    n = len(robot.joint_names)
    assert robot.dof == n + 6
    q, base, qd = robots.random_q(robot, rng), random_pose(rng), rng.normal(size=n + 6)
    frame, point = robot.frames[-1], rng.normal(size=3)

    def at(s, function, *args, **options):
        place = moved_base(base, qd[:6], s * STEP)
        return function(q + s * STEP * qd[6:], *args, T_world_base=place, **options)

    twist = twist_between(at(-1, robot.fk, frame), at(1, robot.fk, frame), 2 * STEP, point)
    J = robot.jacobian(q, frame, point=point, T_world_base=base)
    np.testing.assert_allclose(J @ qd, twist, atol=2e-8)
    for axes in ("base", "tip"):
        options = {"frame": frame, "point": point, "expressed_in": axes}
        rate = robot.jacobian_dot(q, qd, T_world_base=base, **options)
        ahead, behind = (at(s, robot.jacobian, **options) for s in (1, -1))
        np.testing.assert_allclose(rate, (ahead - behind) / (2 * STEP), atol=3e-8 * (1 + np.abs(rate).max()))
    ahead, behind = (at(s, robot.center_of_mass) for s in (1, -1))
    J_center = robot.center_of_mass_jacobian(q, T_world_base=base)
    np.testing.assert_allclose(J_center @ qd, (ahead - behind) / (2 * STEP), atol=2e-8)
