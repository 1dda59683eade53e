"""The inertia that is felt at a frame."""

from __future__ import annotations

import numpy as np
import pytest

import cspace as cs
from cspace.errors import InputError
from dynamics.test_motion_and_force import ARMS, TREES
from kinematics.robots import random_q
from model.random_robots import random_pose

SIX = [ARMS[0], ARMS[1], ARMS[4]]


@pytest.mark.parametrize("robot", SIX, ids=lambda robot: robot.name)
def test_it_is_the_acceleration_under_a_wrench(robot):
    rng = np.random.default_rng(2)
    q, w = random_q(robot, rng), rng.normal(size=6)
    felt = robot.operational_space(q)
    rest, none = np.zeros(robot.dof), np.zeros(3)
    qdd = robot.forward_dynamics(q, rest, rest, wrenches={robot.tip: w}, gravity=none, friction=False)
    expected = robot.jacobian(q) @ qdd
    np.testing.assert_allclose(felt.mobility @ w, expected, atol=1e-10 * np.abs(expected).max())
    np.testing.assert_allclose(felt.inertia @ felt.mobility, np.eye(6), atol=1e-6)
    assert felt.lost.shape == (0, 6)
    d = w[:3] / np.linalg.norm(w[:3])
    assert felt.effective_mass(w[:3]) == pytest.approx(1 / (d @ felt.mobility[:3, :3] @ d))


@pytest.mark.parametrize("robot", TREES[:3], ids=lambda robot: robot.name)
def test_lost_wrenches_move_nothing_and_the_others_do(robot):
    rng = np.random.default_rng(4)
    q = random_q(robot, rng)
    for frame in robot.leaves:
        felt = robot.operational_space(q, frame)
        rank = np.linalg.matrix_rank(felt.J, tol=1e-7)
        assert len(felt.lost) == 6 - rank
        np.testing.assert_allclose(felt.lost @ felt.lost.T, np.eye(6 - rank), atol=1e-12)
        scale = np.abs(felt.mobility).max(initial=1e-300)
        np.testing.assert_allclose(felt.mobility @ felt.lost.T, 0.0, atol=1e-9 * scale)
        again = felt.mobility @ felt.inertia @ felt.mobility
        np.testing.assert_allclose(again, felt.mobility, atol=1e-8 * scale)


def test_a_straight_planar_arm_cannot_be_pushed_along_itself():
    robot = cs.load_robot("planar_2r")
    bent, straight = robot.operational_space([0.3, 0.8]), robot.operational_space([0.0, 0.0])
    assert (len(bent.lost), len(straight.lost)) == (4, 4)
    assert np.isinf(straight.effective_mass([1, 0, 0]))
    assert 0 < straight.effective_mass([0, 1, 0]) < robot.mass
    assert np.isinf(bent.effective_mass([0, 0, 1]))
    with pytest.raises(InputError, match="length 0"):
        bent.effective_mass([0, 0, 0])
    with pytest.raises(InputError, match="q has shape"):
        robot.operational_space([[0.0, 0.0, 0.0]])


@pytest.mark.parametrize("robot", [*SIX, *TREES[:2]], ids=lambda robot: robot.name)
def test_rows_of_a_batch_are_those_alone(robot):
    rng = np.random.default_rng(6)
    q, d = random_q(robot, rng, 4).reshape(2, 2, -1), rng.normal(size=(2, 2, 3))
    T = random_pose(rng)
    many = robot.operational_space(q, robot.frames[-1], T_world_base=T)
    assert many.lost.shape == (2, 2, 6, 6)
    assert "4 rows" in repr(many)
    for i in np.ndindex(2, 2):
        one = robot.operational_space(q[i], robot.frames[-1], T_world_base=T)
        scale = np.abs(one.mobility).max(initial=1e-300)
        np.testing.assert_allclose(many.mobility[i], one.mobility, atol=1e-12 * scale)
        np.testing.assert_allclose(
            many.inertia[i], one.inertia, rtol=1e-6, atol=1e-6 * np.abs(one.inertia).max()
        )
        assert many.rank[i] == one.rank == 6 - len(one.lost)
        assert not many.lost[i][len(one.lost) :].any()
        assert many.effective_mass(d)[i] == pytest.approx(one.effective_mass(d[i]), rel=1e-9)


def test_the_inertia_is_written_where_it_is_wanted():
    panda = cs.load_robot("panda")
    q = panda.random_configuration(4, rng=0)
    out = np.empty((4, 6, 6))
    felt = panda.operational_space(q, out=out)
    assert felt.inertia is out
    np.testing.assert_array_equal(out, panda.operational_space(q).inertia)
    with pytest.raises(InputError, match=r"^out has shape"):
        panda.operational_space(q, out=np.empty((3, 6, 6)))
