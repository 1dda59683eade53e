"""Resolved rate against the pseudo-inverse and its laws."""

from __future__ import annotations

import numpy as np
import pytest

import cspace as cs
from cspace.errors import CspaceError, InputError

ROBOTS = ["ur5e", "panda", "planar_3r", "stanford", "so101"]


def drawn(name: str, n: int) -> tuple[cs.Robot, np.ndarray, np.ndarray]:
    robot, rng = cs.load_robot(name), np.random.default_rng(3)
    return robot, robot.random_configuration(n, rng=rng, reach=0.5), rng.normal(size=(n, 6))


@pytest.mark.parametrize("name", ROBOTS)
def test_without_damping_it_is_the_pseudo_inverse(name):
    robot, q, twist = drawn(name, 100)
    expected = np.einsum("nij,nj->ni", np.linalg.pinv(robot.jacobian(q), rcond=1e-8), twist)
    qd = robot.resolved_rate(q, twist, damping=0)
    np.testing.assert_allclose(qd, expected, rtol=1e-6, atol=1e-9 * np.abs(expected).max())


@pytest.mark.parametrize("name", ROBOTS)
def test_damping_is_that_of_least_squares(name):
    robot, q, twist = drawn(name, 50)
    J, lam = robot.jacobian(q), 0.1
    JT = np.swapaxes(J, -1, -2)
    expected = (JT @ np.linalg.solve(J @ JT + lam**2 * np.eye(6), twist[..., None]))[..., 0]
    np.testing.assert_allclose(robot.resolved_rate(q, twist, damping=lam), expected, atol=1e-12)


def test_far_from_singularities_the_twist_is_met_and_at_them_speeds_stay_bounded():
    robot, q, twist = drawn("ur5e", 500)
    qd = robot.resolved_rate(q, twist)
    regular = robot.singular_values(q)[..., -1] > 0.011
    assert regular.sum() > 400
    met = np.einsum("nij,nj->ni", robot.jacobian(q), qd)
    np.testing.assert_allclose(met[regular], twist[regular], atol=1e-10)
    for nearby in np.logspace(-12, -1, 100):
        speed = np.linalg.norm(robot.resolved_rate([0, 0, nearby, 0, nearby, 0], twist[0]))
        assert speed <= np.linalg.norm(twist[0]) / 0.01 * 1.001


@pytest.mark.parametrize("name", ["panda", "planar_3r", "so101"])
def test_the_null_space_does_not_move_the_frame(name):
    robot, q, twist = drawn(name, 50)
    wish = np.random.default_rng(1).normal(size=q.shape)
    plain, both = robot.resolved_rate(q, twist), robot.resolved_rate(q, twist, null_space=wish)
    J = robot.jacobian(q)
    np.testing.assert_allclose(np.einsum("nij,nj->ni", J, both - plain), 0, atol=1e-9)
    # What is left of the wish lies in the rows of J.
    lost = wish - (both - plain)
    projected = np.einsum("nij,njk,nk->ni", np.linalg.pinv(J, rcond=1e-9), J, lost)
    np.testing.assert_allclose(projected, lost, atol=1e-6)


def test_limits_slow_down_and_keep_the_direction():
    robot, q, twist = drawn("panda", 200)
    most = np.full(7, 0.5)
    wish = np.random.default_rng(2).normal(size=q.shape)
    plain = robot.resolved_rate(q, twist)
    qd = robot.resolved_rate(q, twist, velocity=most, null_space=wish)
    assert np.abs(qd).max() <= 0.5 * (1 + 1e-12)
    J = robot.jacobian(q)
    before, after = (np.einsum("nij,nj->ni", J, x) for x in (plain, qd))
    ratio = (before * after).sum(-1) / (before * before).sum(-1)
    np.testing.assert_allclose(after, ratio[:, None] * before, atol=1e-9)
    assert ratio.max() <= 1 + 1e-9
    assert ratio.min() > 0
    # Where the twist alone is slow enough it is met in full, whatever the wish.
    slow = np.abs(plain).max(-1) < 0.5
    np.testing.assert_allclose(ratio[slow], 1, atol=1e-9)
    own = robot.resolved_rate(q, 100 * twist, velocity=True)
    assert (np.abs(own) <= robot.limits.velocity * (1 + 1e-12)).all()


def test_batches_broadcast_and_threads_do_not_matter():
    robot, q, twist = drawn("panda", 700)
    one = robot.resolved_rate(q, twist, threads=1)
    np.testing.assert_array_equal(one, robot.resolved_rate(q, twist, threads=3))
    np.testing.assert_array_equal(one[5], robot.resolved_rate(q[5], twist[5]))
    np.testing.assert_array_equal(robot.resolved_rate(q, twist[0])[:5], robot.resolved_rate(q[:5], twist[0]))
    assert robot.resolved_rate(q[0], twist.reshape(7, 100, 6)).shape == (7, 100, 7)


def test_points_frames_and_axes_are_those_of_the_jacobian():
    robot, q, twist = drawn("panda", 5)
    options = {"frame": "panda_link5", "point": [0.1, 0, 0.2], "expressed_in": "tip"}
    qd = robot.resolved_rate(q, twist, damping=0.05, **options)
    J = robot.jacobian(q, options["frame"], point=options["point"], expressed_in="tip")
    JT = np.swapaxes(J, -1, -2)
    expected = (JT @ np.linalg.solve(J @ JT + 0.0025 * np.eye(6), twist[..., None]))[..., 0]
    np.testing.assert_allclose(qd, expected, atol=1e-12)


def test_bad_input_is_refused():
    robot = cs.load_robot("ur5e")
    for q, twist, options in [
        (np.zeros(5), np.zeros(6), {}),
        (np.zeros(6), np.zeros(3), {}),
        (np.zeros(6), [np.nan] * 6, {}),
        ([np.inf] * 6, np.zeros(6), {}),
        (np.zeros(6), np.zeros(6), {"damping": -1}),
        (np.zeros(6), np.zeros(6), {"velocity": -np.ones(6)}),
        (np.zeros(6), np.zeros(6), {"null_space": np.ones(5)}),
        (np.zeros((3, 6)), np.zeros((2, 6)), {}),
        (np.zeros(6), np.zeros(6), {"frame": "nose"}),
    ]:
        with pytest.raises(CspaceError):
            robot.resolved_rate(q, twist, **options)
    with pytest.raises(InputError, match="threads"):
        robot.resolved_rate(np.zeros(6), np.zeros(6), threads=-1)


@pytest.mark.parametrize("damping", [np.zeros(7), [], -0.1, np.nan, [0.1, 0.2]])
def test_damping_is_one_number(damping):
    robot = cs.load_robot("panda")
    with pytest.raises(InputError, match="damping"):
        robot.resolved_rate(np.full(7, 0.3), np.ones(6), damping=damping)


def test_a_robot_without_joints_has_no_rates():
    still = cs.Robot.from_urdf('<robot name="still"><link name="a"/></robot>')
    assert still.resolved_rate(np.empty(0), np.ones(6)).shape == (0,)
    assert still.ik_numeric(np.eye(4), np.empty(0))
