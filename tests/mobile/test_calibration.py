"""Calibration: factors put into odometry are found again, with errors that the covariance tells."""

from __future__ import annotations

import numpy as np
import pytest

from cspace.errors import InputError
from cspace.mobile import (
    DifferentialDrive,
    Odometry,
    TimedPoses,
    calibrate,
    calibrate_wheels,
    umbmark,
)
from data import shared_data


def drive_around(seed, n=6000):
    rng = np.random.default_rng(seed)
    turn = np.repeat(rng.normal(0.0, 0.6, n // 50), 50)
    twists = np.stack([np.full(n, 0.5), np.zeros(n), turn], axis=-1)
    return Odometry.from_twists(np.arange(n) * 0.1, twists)


def test_factors_are_found_again_exactly_without_noise():
    true = drive_around(1)
    k_d, k_r, k_m = 0.96, 1.05, -0.04
    steps = true.steps.copy()
    steps[:, 0] /= k_d
    steps[:, 2] = (true.steps[:, 2] - k_m * steps[:, 0]) / k_r
    fit = calibrate(Odometry(true.times, steps), true.dead_reckoning((1.0, 2.0, 3.0)))
    np.testing.assert_allclose([fit.distance, fit.turn, fit.drift], [k_d, k_r, k_m], atol=2e-3)
    assert fit.held_out[1] < 0.05 * fit.held_out[0]


def test_the_covariance_tells_the_error():
    """Normalised errors of many fits have about the size that a normal distribution gives them."""
    errors = []
    for seed in range(12):
        rng = np.random.default_rng(100 + seed)
        true = drive_around(seed)
        noise = rng.normal(size=true.steps.shape) * [0.01, 0.0, 0.02]
        fit = calibrate(
            Odometry(true.times, true.steps + noise), true.dead_reckoning(), part=1.0, window=10.0
        )
        errors.append(
            (np.array([fit.distance, fit.turn, fit.drift]) - [1, 1, 0]) / np.sqrt(np.diag(fit.covariance))
        )
    assert 0.4 < np.sqrt(np.mean(np.square(errors))) < 2.0


def test_moving_the_world_changes_nothing():
    true = drive_around(3)
    raw = true.corrected(distance=1.04, turn=0.98)
    a, b = (calibrate(raw, true.dead_reckoning(start)) for start in ((0.0, 0.0, 0.0), (5.0, -3.0, 2.0)))
    np.testing.assert_allclose([a.distance, a.turn, a.drift], [b.distance, b.turn, b.drift], atol=1e-9)


def test_radii_and_track_are_found_again():
    true = drive_around(4)
    left, right, track = 0.0503, 0.0497, 0.312
    v, w = true.steps[:, 0], true.steps[:, 2]
    wheels = np.stack([(v - 0.5 * track * w) / left, (v + 0.5 * track * w) / right], axis=-1)
    fit = calibrate_wheels(true.times, wheels, true.dead_reckoning((0.0, 0.0, 1.0)))
    np.testing.assert_allclose([*fit.radii, fit.vehicle.track], [left, right, track], rtol=1e-6)
    np.testing.assert_allclose(fit.odometry.steps, true.steps, atol=1e-6)
    assert np.linalg.eigvalsh(fit.covariance).min() >= -1e-18


def end_of_square(left, right, track, nominal, side, sign):
    """Where a drive of these wheels truly ends that drives a square by its nominal odometry."""
    at = np.zeros(3)
    for _ in range(4):
        for step in ([side, 0.0, 0.0], [0.0, 0.0, sign * np.pi / 2]):
            wl, wr = nominal.wheel_speeds(step)
            twist = [0.5 * (left * wl + right * wr), 0.0, (right * wr - left * wl) / track]
            at = Odometry([0.0, 1.0], [twist]).dead_reckoning(at).poses[-1]
    return at[:2]


@pytest.mark.parametrize(("b", "d"), [(1.01, 1.0), (1.0, 1.002), (0.99, 1.001), (1.005, 0.998)])
def test_umbmark_finds_track_and_diameters(b, d):
    nominal = DifferentialDrive(0.05, 0.34)
    left = 0.05 * 2 / (1 + d)
    ends = [end_of_square(left, d * left, 0.34 * b, nominal, 4.0, sign) for sign in (-1, 1)]
    fit = umbmark([ends[0]], [ends[1]], nominal, side=4.0)
    assert fit.track_ratio == pytest.approx(b, abs=6e-4)
    assert fit.diameter_ratio == pytest.approx(d, abs=1e-4)
    better = DifferentialDrive(0.05, fit.track)
    del better
    assert fit.most_systematic == pytest.approx(max(np.hypot(*e) for e in ends))


def test_a_drive_that_does_not_determine_the_factors_is_named():
    straight = Odometry.from_twists(np.arange(3000) * 0.1, np.tile([0.0, 0.0, 0.0], (3000, 1)))
    with pytest.raises(InputError, match="does not determine"):
        calibrate(straight, straight.dead_reckoning(), window=10.0)


def test_too_little_in_common_is_named():
    o = drive_around(5, 500)
    later = TimedPoses(o.times + 1e4, o.dead_reckoning().poses)
    with pytest.raises(InputError, match="windows"):
        calibrate(o, later)


def test_the_second_half_of_the_intel_log_drifts_less():
    """The bar of the project: 6 m, from 27 m raw."""
    from cspace.localization import read_log

    log = read_log(shared_data() / "localization/carmen/intel-corrected.log.gz")
    fit = calibrate(log.odometry, log.truth)
    raw, corrected = fit.held_out
    assert raw > 25
    assert corrected < 6
