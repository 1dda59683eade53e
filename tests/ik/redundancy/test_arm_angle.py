"""The swivel of arms with two spherical joints: eight solutions, each at the swivel that was asked for."""

import numpy as np
import pytest

import cspace as cs
from cspace.errors import InputError, InputTypeError

ARMS = ["iiwa14", "iiwa7", "openarm_left", "r1pro_left", "xmatepro7", "lwr4"]


def wrapped(difference):
    return np.abs(np.angle(np.exp(1j * difference)))


@pytest.mark.parametrize("name", ARMS)
def test_eight_solutions_at_the_swivel_of_the_configuration_that_made_the_goal(name):
    robot = cs.load_robot(name)
    for q in np.random.default_rng(3).uniform(-3, 3, (40, 7)):
        T = robot.fk(q)
        s = robot.ik(T, swivel=cs.ik.swivel(robot, q))
        assert len(s) == 8
        assert s.complete
        assert s.residual.max() < 1e-11
        assert wrapped(s.q - q).max(axis=1).min() < 1e-9
        assert wrapped(cs.ik.swivel(robot, s.q) - cs.ik.swivel(robot, q)).max() < 1e-9


def test_the_swivel_is_the_angle_of_the_elbow_about_the_line_to_the_wrist():
    robot = cs.load_robot("iiwa14")
    q = np.array([0.4, 0.7, -0.5, -1.2, 0.3, 0.9, 0.2])
    chain = robot.chain
    S = np.array([0.0, 0.0, chain.points[1][2]])
    frames = robot.fk_all(q)
    E = next(T[:3, 3] for T in frames if abs(np.linalg.norm(T[:3, 3] - S) - 0.42) < 1e-9)
    W = (robot.fk(q) @ np.linalg.inv(chain.T_zero) @ [0, 0, chain.points[5][2], 1])[:3]
    n = (W - S) / np.linalg.norm(W - S)
    zero, e = np.array([0, 0, 1.0]) - n[2] * n, E - S
    assert cs.ik.swivel(robot, q) == pytest.approx(np.arctan2(n @ np.cross(zero, e), zero @ e), abs=1e-12)


def test_turning_the_swivel_moves_the_elbow_and_not_the_tip():
    robot = cs.load_robot("iiwa14")
    T = robot.fk([0.4, 0.7, -0.5, -1.2, 0.3, 0.9, 0.2])
    swivels = np.linspace(-np.pi, np.pi, 101)
    b = robot.ik(T, swivel=swivels)
    assert b.count.tolist() == [8] * 101
    assert b.residual.max() < 1e-11
    assert wrapped(cs.ik.swivel(robot, b.q) - swivels[:, None]).max() < 1e-9
    assert np.array_equal(b.q[7], robot.ik(T, swivel=swivels[7]).q)
    goals = robot.fk(np.random.default_rng(1).uniform(-2, 2, (5, 7)))
    each = robot.ik(goals, swivel=0.3)
    for T_one, rows in zip(goals, each.q, strict=True):
        assert np.allclose(robot.ik(T_one, swivel=0.3).q, rows, atol=1e-13)


def test_every_solution_with_a_held_joint_is_one_at_its_swivel():
    robot = cs.load_robot("iiwa14")
    for q in robot.random_configuration(10, rng=5):
        for row in robot.ik(robot.fk(q), locked={6: q[6]}).q:
            s = robot.ik(robot.fk(q), swivel=cs.ik.swivel(robot, row))
            assert wrapped(s.q - row).max(axis=1).min() < 1e-7


def test_where_the_wrist_is_on_the_first_axis_another_direction_serves():
    robot = cs.load_robot("iiwa14")
    q = np.array(
        [0.0, 0.6, 0.0, -1.2, 0.0, 0.6, 0.0]
    )  # both halves lean alike: the wrist is above the shoulder
    s = robot.ik(robot.fk(q), swivel=cs.ik.swivel(robot, q))
    assert len(s)
    assert wrapped(s.q - q).max(axis=1).min() < 1e-6


def test_near_out_of_reach_and_what_has_no_swivel():
    robot = cs.load_robot("iiwa14")
    q = robot.random_configuration(rng=2)
    T = robot.fk(q)
    near = robot.ik(T, swivel=cs.ik.swivel(robot, q), near=q)
    assert len(near) == 1
    assert np.abs(near.q - q).max() < 1e-9
    far = T.copy()
    far[:3, 3] = [3, 0, 0]
    assert not robot.ik(far, swivel=0.1)
    assert "out of reach" in robot.ik(far, swivel=0.1).reason
    with pytest.raises(InputError, match="no swivel in closed form"):
        cs.load_robot("panda").ik(np.eye(4), swivel=0.1)
    with pytest.raises(InputError, match="seven revolute joints"):
        cs.ik.swivel(cs.load_robot("ur5e"), np.zeros(6))
    with pytest.raises(InputTypeError, match="combined with near="):
        robot.ik(T, swivel=0.1, locked={0: 0.1})
    with pytest.raises(InputError, match="finite"):
        robot.ik(T, swivel=np.nan)
