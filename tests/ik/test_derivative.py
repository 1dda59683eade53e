"""The derivative of every solution with respect to the goal, against solutions of goals beside it."""

import numpy as np
import pytest

import cspace as cs
from ik.arms import load
from ik.geometries import random_q

STEP = 1e-6


def moved_goals(T, twists):
    """Each goal moved by a base twist [v; ω], v the velocity of its origin."""
    out = np.tile(T, (len(twists), 1, 1))
    out[:, :3, 3] += twists[:, :3]
    out[:, :3, :3] = cs.spatial.exp_so3(twists[:, 3:]) @ T[:3, :3]
    return out


def beside(row, others):
    """The one of some configurations that is nearest to a row, by the turns that bring it there."""
    gaps = (others - row + np.pi) % (2 * np.pi) - np.pi
    return row + gaps[np.nanargmin(np.abs(gaps).max(axis=1))]


@pytest.mark.parametrize("name", ["ur5e", "puma560", "jaco2", "stanford"])
def test_it_predicts_the_solutions_of_goals_beside_it(name):
    robot = load(name)
    rng = np.random.default_rng(1)
    checked = 0
    for q in random_q(rng, 20, robot.dof):
        T = robot.fk(q)
        found = robot.ik(T)
        if np.linalg.svd(robot.jacobian(found.q), compute_uv=False)[:, -1].min() < 0.02:
            continue
        twists = STEP * np.vstack([np.eye(6), -np.eye(6)])
        batch = robot.ik(moved_goals(T, twists))
        there = np.array([[beside(row, batch.q[i]) for row in found.q] for i in range(12)])
        slope = (there[:6] - there[6:]) / (2 * STEP)
        assert np.abs(slope.transpose(1, 2, 0) - found.derivative).max() < 1e-3
        checked += 1
    assert checked >= 5


def test_it_inverts_the_jacobian():
    robot = load("ur5e")
    b = robot.ik(robot.fk(random_q(np.random.default_rng(2), 50, 6)))
    D = b.derivative
    assert D.shape == (50, 8, 6, 6)
    real = np.isfinite(b.q).all(axis=-1)
    assert np.isnan(D[~real]).all()
    assert np.abs(robot.jacobian(b.q[real]) @ D[real] - np.eye(6)).max() < 1e-9
    one = b[3]
    assert np.abs(one.derivative - D[3, : len(one)]).max() < 1e-9


def test_a_singular_solution_has_none():
    robot = load("puma560")
    q = np.array([0.3, -0.4, 0.5, 0.2, 0.0, 0.6])
    found = robot.ik(robot.fk(q), near=q, limits=False)
    assert np.isnan(found.derivative).all()


def test_an_arm_of_fewer_joints_follows_what_it_can():
    robot = load("so101")
    q = random_q(np.random.default_rng(3), 1, robot.dof)[0]
    found = robot.ik(robot.fk(q), near=q, limits=False)
    qd = np.random.default_rng(4).normal(size=robot.dof)
    assert np.allclose(found.derivative[0] @ (robot.jacobian(q) @ qd), qd, atol=1e-9)


def test_a_point_does_not_mind_how_it_is_turned():
    robot = cs.Robot.from_screws(
        [[0, 0, 1], [0, 1, 0], [0, 1, 0]], [[0, 0, 0], [0, 0, 0.3], [0.4, 0, 0.3]], np.eye(4)
    )
    q = np.array([0.3, -0.5, 0.9])
    D = robot.ik(position=robot.fk(q)[:3, 3], near=q).derivative
    assert D.shape == (1, 3, 6)
    assert (D[..., 3:] == 0).all()
    assert np.abs(robot.jacobian(q)[:3] @ D[0, :, :3] - np.eye(3)).max() < 1e-9
