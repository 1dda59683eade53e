"""Odometry: round trips, splitting, ticks that wrap, and noise that does not depend on the step."""

from __future__ import annotations

import numpy as np
import pytest

import cspace as cs
from cspace.errors import InputError
from cspace.mobile import (
    DifferentialDrive,
    Mecanum,
    Odometry,
    OdometryNoise,
    RandomWalk,
    TimedPoses,
    VelocityNoise,
    wheel_angles,
)

MODELS = [RandomWalk(side=3e-3), VelocityNoise(), OdometryNoise()]


def random_odometry(seed, n=30):
    rng = np.random.default_rng(seed)
    times = np.cumsum(rng.uniform(0.0, 0.3, n + 1))
    return Odometry(times, rng.normal(size=(n, 3)) * [0.3, 0.1, 0.5])


def test_increments_twists_and_poses_make_the_same_odometry():
    o = random_odometry(1)
    for same in (
        Odometry.from_increments(o.times, o.increments),
        Odometry.from_twists(o.times, o.twists),
        Odometry.from_poses(o.times, o.dead_reckoning((3.0, -2.0, 1.0)).poses),
    ):
        np.testing.assert_allclose(same.steps, o.steps, atol=1e-12)


def test_dead_reckoning_is_the_product_of_the_steps():
    o = random_odometry(2)
    T = cs.pose_2d(xytheta=[1.0, 2.0, 3.0])
    for xi in o.steps:
        T = T @ cs.exp_se2(xi)
    last = o.dead_reckoning((1.0, 2.0, 3.0)).poses[-1]
    np.testing.assert_allclose(cs.pose_2d(xytheta=last), T, atol=1e-12)


def test_splitting_a_step_changes_nothing():
    o = random_odometry(3)
    finer = o.split(np.random.default_rng(3).uniform(-1.0, 7.0, 200))
    assert len(finer) > len(o)
    at = np.searchsorted(finer.times, o.times)
    np.testing.assert_allclose(finer.dead_reckoning().poses[at], o.dead_reckoning().poses, atol=1e-12)
    assert finer.distances.sum() == pytest.approx(o.distances.sum())


def test_a_step_of_no_duration_is_kept_by_a_split():
    o = Odometry([0.0, 1.0, 1.0, 2.0], [[1.0, 0.0, 0.0], [0.5, 0.0, 0.3], [1.0, 0.0, 0.0]])
    assert o.split([0.5, 1.0, 1.5]).distances.sum() == pytest.approx(2.5)


@pytest.mark.parametrize("bits", [16, 32])
def test_counters_that_wrap_count_on(bits):
    rng = np.random.default_rng(4)
    true = np.cumsum(rng.integers(-2000, 2000, size=(300, 2)), axis=0) + 2 ** (bits - 1) - 100
    for wrapped in (true % 2**bits, (true + 2 ** (bits - 1)) % 2**bits - 2 ** (bits - 1)):
        angles = wheel_angles(wrapped, per_turn=500, bits=bits)
        np.testing.assert_allclose(angles, np.diff(true, axis=0) * 2 * np.pi / 500)


@pytest.mark.parametrize("vehicle", [DifferentialDrive(), Mecanum()], ids=["DifferentialDrive", "Mecanum"])
def test_ticks_of_a_drive_give_its_odometry(vehicle):
    rng = np.random.default_rng(5)
    steps = rng.normal(size=(50, vehicle.allowed_twists.shape[1])) @ vehicle.allowed_twists.T * 0.1
    per_turn = 1 << 24
    turns = np.cumsum(np.vstack([np.zeros(len(vehicle.wheel_matrix)), vehicle.wheel_speeds(steps)]), axis=0)
    ticks = np.round(turns / (2 * np.pi) * per_turn).astype(np.int64)
    times = np.cumsum(rng.uniform(0.0, 0.2, 51))
    o = Odometry.from_ticks(times, ticks, vehicle, per_turn=per_turn)
    np.testing.assert_allclose(o.steps, steps, atol=1e-7)


def test_standing_still_for_an_hour_goes_nowhere():
    o = Odometry.from_twists(np.arange(36000) * 0.1, np.zeros((36000, 3)))
    assert np.ptp(o.dead_reckoning().poses) == 0.0


@pytest.mark.parametrize("scale", [0.05, 1.0, 6.0])
def test_halving_a_step_changes_nothing_for_a_random_walk(scale):
    rng = np.random.default_rng(6)
    model, xi, dt = RandomWalk(side=2e-3, rest=1e-3), scale * rng.normal(size=(40, 3)), rng.uniform(0, 1, 40)
    half = model.covariance(xi / 2, dt / 2)
    A = cs.adjoint_2d(cs.exp_se2(-xi / 2))
    whole = model.covariance(xi, dt)
    np.testing.assert_allclose(A @ half @ np.swapaxes(A, 1, 2) + half, whole, rtol=1e-10, atol=1e-13)
    third = model.covariance(xi / 3, dt / 3)
    A = cs.adjoint_2d(cs.exp_se2(-xi / 3))
    two = A @ third @ np.swapaxes(A, 1, 2) + third
    np.testing.assert_allclose(A @ two @ np.swapaxes(A, 1, 2) + third, whole, rtol=1e-10, atol=1e-12)


@pytest.mark.slow
@pytest.mark.parametrize("turn", [0.0, 1e-9, 0.4, 3.0, 25.0])
def test_the_covariance_of_a_random_walk_is_the_sum_over_many_short_steps(turn):
    rng = np.random.default_rng(9)
    xi, dt, n = rng.normal(size=(6, 3)) * [1.0, 1.0, turn], rng.uniform(0, 1, 6), 4000
    model, Q = RandomWalk(side=2e-3, rest=1e-3), np.zeros((6, 3, 3))
    distance = np.hypot(xi[:, 0], xi[:, 1])
    walk = np.stack(
        [
            model.distance * distance + model.rest * dt,
            model.side * distance + model.rest * dt,
            model.turn * np.abs(xi[:, 2]) + model.drift * distance + model.rest_turn * dt,
        ],
        axis=-1,
    )
    for k in range(n):  # the rest of the arc carries what was disturbed within a short step
        A = cs.adjoint_2d(cs.exp_se2(-(n - k - 0.5) / n * xi))
        Q += A @ (walk[:, :, None] * np.eye(3)) @ np.swapaxes(A, 1, 2) / n
    np.testing.assert_allclose(model.covariance(xi, dt), Q, rtol=1e-4, atol=1e-7)


@pytest.mark.parametrize("model", MODELS[1:], ids=["velocity", "odometry"])
def test_the_models_of_thrun_depend_on_the_step(model):
    """n steps of d/n give 1/n of the variance along the way."""
    xi, n = np.array([1.0, 0.0, 0.0]), 4
    whole = model.covariance(xi, 1.0)[0, 0]
    assert n * model.covariance(xi / n, 1.0 / n)[0, 0] == pytest.approx(whole / n)


@pytest.mark.parametrize("model", MODELS, ids=["walk", "velocity", "odometry"])
@pytest.mark.parametrize("step", [[0.5, 0.0, 0.3], [-0.5, 0.0, 0.3], [0.001, 0.0, 0.1], [0.2, 0.0, 0.0]])
def test_samples_have_the_covariance_of_the_model(model, step):
    small = (
        model.__class__(**{k: tuple(0.1 * a for a in v) for k, v in vars(model).items()})
        if hasattr(model, "alpha")
        else model
    )
    n = 40_000
    drawn = small.sample(np.tile(step, (n, 1)), 0.5, rng=7)
    w = cs.log_se2(np.linalg.inv(cs.exp_se2(step)) @ cs.exp_se2(drawn))
    Q = small.covariance(step, 0.5)
    spread = np.sqrt(np.outer(np.diag(Q), np.diag(Q))) + 1e-9
    np.testing.assert_allclose(np.cov(w.T) / spread, Q / spread, atol=0.04)


@pytest.mark.parametrize("model", MODELS, ids=["walk", "velocity", "odometry"])
def test_covariances_are_symmetric_and_not_below_zero(model):
    rng = np.random.default_rng(8)
    Q = model.covariance(rng.normal(size=(4, 50, 3)), rng.uniform(0, 1, (4, 50)))
    np.testing.assert_allclose(Q, np.swapaxes(Q, -1, -2), atol=1e-15)
    assert np.linalg.eigvalsh(Q).min() > -1e-15


def test_driving_backwards_costs_no_half_turns_of_noise():
    model = OdometryNoise()
    there, back = model.covariance([0.3, 0.0, 0.0], 1.0), model.covariance([-0.3, 0.0, 0.0], 1.0)
    np.testing.assert_allclose(np.diag(there), np.diag(back), atol=1e-15)


def test_headings_are_interpolated_the_short_way():
    poses = TimedPoses([0.0, 1.0], [[0.0, 0.0, 3.0], [1.0, 2.0, -3.0]])
    x, y, theta = poses.at(0.5)
    assert (x, y) == (0.5, 1.0)
    assert abs(abs(theta) - np.pi) < 1e-12
    assert np.isnan(poses.at([-0.1, 1.1])).all()
    assert np.isnan(poses.at(0.5, max_gap=0.9)).all()


def test_nothing_to_drive_is_an_answer():
    empty = Odometry([], np.empty((0, 3)))
    assert len(empty) == 0
    assert len(empty.dead_reckoning()) == 0
    assert len(empty.split([1.0])) == 0


@pytest.mark.parametrize(
    ("call", "part"),
    [
        (lambda: Odometry([0.0, 2.0, 1.0], np.zeros((2, 3))), "runs backwards at row 2"),
        (lambda: Odometry([0.0, 1.0], np.zeros((3, 3))), "3 rows and there are 2 times"),
        (lambda: Odometry([0.0, 1.0], [[0.0, np.nan, 0.0]]), "must be finite"),
        (lambda: wheel_angles([[0.5, 1.0]], per_turn=10), "whole numbers"),
        (lambda: wheel_angles([1, 2], per_turn=10), "(n, k)"),
        (lambda: RandomWalk(turn=-1.0), "turn is -1.0"),
        (lambda: VelocityNoise(alpha=(1.0, 2.0)), "give 6 numbers"),
        (lambda: RandomWalk().covariance([0.0, 0.0, 0.0], -1.0), "durations are not below zero"),
        (lambda: Odometry.from_ticks([0.0, 1.0], [[0, 0], [1, 1]], cs.Car(), per_turn=8), "vehicle is a Car"),
    ],
)
def test_a_misuse_is_named(call, part):
    with pytest.raises(InputError) as error:
        call()
    assert part in str(error.value)
