"""Filters: equal to each other where they must be, to Gauss–Newton, to dense smoothing, and consistent."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy import optimize, stats

import cspace as cs
from cspace.errors import InputError, InputTypeError, TimeLimitError, UnknownNameError
from cspace.localization import (
    Compass,
    Fixes,
    Gps,
    Headings,
    Landmarks,
    Log,
    Odometry,
    RangeBearing,
    Readings,
    TimedPoses,
    calibrate_sensor,
    localize,
    simulate,
)
from cspace.localization.filters.gates import chi2_quantile
from cspace.localization.filters.measurements import LandmarkReading, Measurement, PositionReading
from cspace.localization.filters.rows import find_twist, move_pose
from cspace.localization.filters.updates import UPDATES, subtract_values
from cspace.mobile import RandomWalk
from data import shared_data
from localization.worlds import NOISE, SENSOR, disturbed_start, log_of, rmse

P0 = np.diag([0.04, 0.04, 0.01])
ALL = list(UPDATES)


def reading(pose, seed=0, used=(0, 1), sensor=SENSOR, spread=None):
    rng = np.random.default_rng(seed)
    used = np.array(used)
    point = np.asarray(pose[:2]) + rng.normal(size=2) * 3
    blank = LandmarkReading(np.zeros(len(used)), used == 1, used, sensor, point, spread)
    return replace(blank, value=blank.predict(np.asarray(pose)) + rng.normal(size=len(used)) * 0.05)


def random_covariance(rng):
    A = rng.normal(size=(3, 3)) * [0.3, 0.3, 0.1]
    return A.T @ A + 1e-4 * np.eye(3)


@pytest.mark.parametrize("used", [(0, 1), (0,), (1,)])
@pytest.mark.parametrize("heading", [0.3, 0.0, np.pi, -np.pi + 1e-7])
def test_derivatives_of_measurements_are_their_differences(used, heading):
    pose = np.array([1.0, -2.0, heading])
    sensor = replace(SENSOR, mount=(0.2, -0.1, 0.7))
    kinds: list[Measurement] = [
        reading(pose, 1, used, sensor),
        PositionReading(np.zeros(2), 1.0, (0.3, 0.2), np.array([False, False])),
    ]
    for m in kinds:
        H, _ = m.linearize(pose)
        for k in range(3):
            d = np.zeros(3)
            d[k] = 1e-6
            difference = (
                subtract_values(m, m.predict(move_pose(pose, d)), m.predict(move_pose(pose, -d))) / 2e-6
            )
            np.testing.assert_allclose(H[:, k], difference, atol=1e-7)


@pytest.mark.parametrize("seed", range(5))
def test_the_information_form_is_the_extended_filter(seed):
    rng = np.random.default_rng(seed)
    pose, P = rng.normal(size=3), random_covariance(rng)
    m = reading(pose, seed)
    for a, b in zip(UPDATES["ekf"](pose, P, m), UPDATES["information"](pose, P, m), strict=True):
        np.testing.assert_allclose(a, b, atol=1e-10)


@pytest.mark.parametrize("name", ALL)
def test_every_filter_is_the_linear_kalman_filter_where_all_is_linear(name):
    """A position fix with the heading known: Kalman's formula in the plane."""
    rng = np.random.default_rng(3)
    P = np.diag([0.3, 0.2, 1e-14])
    pose, z = np.array([1.0, 2.0, 0.0]), np.array([1.4, 1.7])
    m = PositionReading(z, 0.5, (0.0, 0.0), np.array([False, False]))
    after, covariance = UPDATES[name](pose, P, m)
    K = P[:2, :2] @ np.linalg.inv(P[:2, :2] + 0.25 * np.eye(2))
    np.testing.assert_allclose(after[:2], pose[:2] + K @ (z - pose[:2]), atol=1e-9)
    np.testing.assert_allclose(covariance[:2, :2], (np.eye(2) - K) @ P[:2, :2], atol=1e-9)
    del rng


@pytest.mark.parametrize("seed", range(5))
def test_the_iterated_filter_is_gauss_newton(seed):
    """Oracle: SciPy minimises prior and measurement together."""
    rng = np.random.default_rng(seed)
    pose, P = rng.normal(size=3), random_covariance(rng)
    m = reading(pose + rng.normal(size=3) * 0.2, seed)
    R = m.linearize(pose)[1]
    L, M = np.linalg.inv(np.linalg.cholesky(P)), np.linalg.inv(np.linalg.cholesky(R))

    def residuals(xi):
        return np.concatenate([L @ xi, M @ subtract_values(m, m.value, m.predict(move_pose(pose, xi)))])

    best = optimize.least_squares(residuals, np.zeros(3), xtol=1e-14, ftol=1e-14, gtol=1e-14).x
    after, _ = UPDATES["iekf"](pose, P, m)
    np.testing.assert_allclose(find_twist(pose, after), best, atol=1e-6)


@pytest.mark.parametrize("name", ALL)
def test_updates_across_the_half_turn_do_not_flip(name):
    pose = np.array([0.0, 0.0, np.pi - 1e-3])
    m = reading(np.array([0.0, 0.0, -np.pi + 0.02]), 4)
    after, P = UPDATES[name](pose, P0, m)
    assert abs(np.angle(np.exp(1j * (after[2] - pose[2])))) < 0.3
    assert np.linalg.eigvalsh(P).min() > 0


@pytest.mark.slow
@pytest.mark.parametrize("name", ALL)
def test_moving_world_and_map_together_changes_nothing_in_base(name):
    log = log_of(1, 20.0)
    T = cs.pose_2d(xytheta=[30.0, -7.0, 2.5])
    points = cs.transform_points_2d(T, log.landmarks.points)
    start = disturbed_start(log, P0, 1)
    moved_start = cs.to_xytheta(T @ cs.pose_2d(xytheta=start))
    a = localize(log, filter=name, start=start, start_covariance=P0, sensor=SENSOR, noise=NOISE)
    moved = Landmarks(log.landmarks.names, points)
    b = localize(log, moved, filter=name, start=moved_start, start_covariance=P0, sensor=SENSOR, noise=NOISE)
    np.testing.assert_allclose(b.covariances, a.covariances, atol=1e-9)
    np.testing.assert_allclose(T @ cs.pose_2d(xytheta=a.poses), cs.pose_2d(xytheta=b.poses), atol=1e-7)
    np.testing.assert_allclose(b.nis, a.nis, atol=1e-6)


def test_permuting_the_landmarks_changes_nothing():
    log = log_of(2, 10.0)
    order = np.random.default_rng(2).permutation(len(log.landmarks))
    shuffled = Landmarks(log.landmarks.names[order], log.landmarks.points[order])
    a, b = (localize(log, each, sensor=SENSOR, noise=NOISE) for each in (log.landmarks, shuffled))
    np.testing.assert_array_equal(a.poses, b.poses)


def test_finer_odometry_changes_nothing():
    """The random walk and the exact prediction do not depend on the step."""
    log = log_of(3, 10.0)
    finer = replace(log, odometry=log.odometry.split(np.arange(0.0, 10.0, 0.013)))
    a, b = (localize(each, sensor=SENSOR, noise=NOISE) for each in (log, finer))
    np.testing.assert_allclose(b.at(a.times), a.poses, atol=1e-9)
    at = np.searchsorted(b.times, a.times)
    np.testing.assert_allclose(b.covariances[at], a.covariances, atol=1e-10)


def test_prediction_is_a_p_a_plus_q_step_by_step():
    """Oracle: the textbook recursion over every step of odometry."""
    o = log_of(4, 20.0).odometry
    run = localize(Log(o), start=(0.0, 0.0, 0.0), start_covariance=P0, noise=NOISE)
    P = P0
    for k, xi in enumerate(o.steps):
        A = cs.adjoint_2d(cs.exp_se2(-xi))
        P = A @ P @ A.T + NOISE.covariance(xi, o.durations[k])
        np.testing.assert_allclose(run.covariances[k + 1], P, rtol=1e-8, atol=1e-12)
    np.testing.assert_allclose(run.poses, o.dead_reckoning().poses, atol=1e-10)
    assert not run
    assert run.status == "lost"
    assert "dead reckoning" in run.reason


@pytest.mark.slow
def test_the_smoother_is_dense_least_squares():
    """Oracle: all poses at once with small noise, where the problem is linear; and its end is the filter."""
    noise = RandomWalk(1e-5, 1e-5, 1e-5, 1e-5, 1e-7, 1e-7)
    sensor = RangeBearing(0.005, 0.002, most_range=9.0)
    log = log_of(5, 3.0, 0.4, sensor, noise)
    P = np.diag([1e-5, 1e-5, 1e-5])
    run = localize(
        log, start=disturbed_start(log, P, 5), start_covariance=P, sensor=sensor, noise=noise, gate=1 - 1e-12
    )
    past = run.smoothed()
    np.testing.assert_array_equal(past.poses[-1], run.poses[-1])
    split = log.odometry
    Q = np.linalg.inv(np.linalg.cholesky(noise.covariance(split.steps, split.durations)))
    rows = np.searchsorted(split.times, log.readings.times)
    points = log.landmarks.points[log.landmarks.rows_of(log.readings.landmark)]
    values = np.stack([log.readings.range, log.readings.bearing], axis=-1)

    def residuals(x):
        poses = move_pose(run.poses, x.reshape(-1, 3))
        D = (
            np.linalg.inv(cs.exp_se2(split.steps))
            @ np.linalg.inv(cs.pose_2d(xytheta=poses[:-1]))
            @ cs.pose_2d(xytheta=poses[1:])
        )
        parts = [find_twist(run._passed.poses_before[0], poses[0]) / np.sqrt(np.diag(P))]
        parts.append(np.einsum("nij,nj->ni", Q, cs.log_se2(D)).ravel())
        for value, point, row in zip(values, points, rows, strict=True):
            m = LandmarkReading(value, np.array([False, True]), np.array([0, 1]), sensor, point, None)
            parts.append(
                subtract_values(m, value, m.predict(poses[row])) / [sensor.range_sigma, sensor.bearing_sigma]
            )
        return np.concatenate(parts)

    solved = optimize.least_squares(residuals, np.zeros(3 * len(run)), x_scale="jac")
    np.testing.assert_allclose(past.poses, move_pose(run.poses, solved.x.reshape(-1, 3)), atol=3e-5)
    dense = np.linalg.inv(solved.jac.T @ solved.jac).reshape(len(run), 3, len(run), 3)
    own = np.stack([dense[k, :, k] for k in range(len(run))])
    np.testing.assert_allclose(past.covariances, own, rtol=0.03, atol=1e-8)


def test_a_lag_lies_between_filter_and_smoother():
    log = log_of(6)
    run = localize(log, start_covariance=P0, start=disturbed_start(log, P0, 6), sensor=SENSOR, noise=NOISE)
    past, lagged = run.smoothed(), run.smoothed(lag=3.0)
    all_later = run.smoothed(lag=1e6)
    np.testing.assert_allclose(all_later.poses, past.poses, atol=1e-9)
    np.testing.assert_allclose(all_later.covariances, past.covariances, atol=1e-12)
    tiny = run.smoothed(lag=1e-9)
    np.testing.assert_allclose(tiny.poses, run.poses, atol=1e-12)
    traces = [np.trace(each.covariances, axis1=1, axis2=2) for each in (past, lagged, run)]
    assert (traces[0] <= traces[1] + 1e-12).all()
    assert (traces[1] <= traces[2] + 1e-12).all()
    assert rmse(past, log) < rmse(run, log)
    with pytest.raises(InputError, match="smoother already"):
        past.smoothed()


@pytest.mark.slow
@pytest.mark.parametrize("name", ALL)
def test_filters_are_consistent(name):
    """NEES over 100 runs of three states: 90 % of the steps in the 95 % band of χ², all in a wider one."""
    values = []
    for seed in range(100):
        log = log_of(1000 + seed, 12.0, 1.0)
        start = disturbed_start(log, P0, seed)
        run = localize(
            log, filter=name, start=start, start_covariance=P0, sensor=SENSOR, noise=NOISE, gate=1 - 1e-12
        )
        values.append(run.nees(log.truth))
    mean = np.mean(values, axis=0)
    assert ((mean > 2.54) & (mean < 3.50)).mean() >= 0.9
    assert mean.min() > 2.14
    assert mean.max() < 4.05


@pytest.mark.parametrize("name", ALL)
def test_a_start_known_exactly_is_legal_but_for_the_information_form(name):
    log = log_of(8, 5.0)
    if name == "information":
        log = replace(log, readings=log.readings.subset(log.readings.times == 0.0))
        with pytest.raises(InputError, match="information form"):
            localize(log, filter=name, start_covariance=np.zeros((3, 3)), sensor=SENSOR, noise=NOISE)
    else:
        run = localize(log, filter=name, start_covariance=np.zeros((3, 3)), sensor=SENSOR, noise=NOISE)
        assert run
        assert np.isfinite(run.smoothed().poses).all()
        np.testing.assert_allclose(run.smoothed().poses[0], log.truth.poses[0], atol=1e-9)


def test_readings_without_names_find_their_landmarks():
    log = log_of(9)
    known = localize(log, sensor=SENSOR, noise=NOISE)
    nameless = replace(log, readings=replace(log.readings, landmark=np.full(len(log.readings), -1)))
    unknown = localize(nameless, sensor=SENSOR, noise=NOISE)
    assert rmse(unknown, log) < 1.2 * rmse(known, log) + 0.01


@pytest.mark.parametrize("missing", ["range", "bearing"])
def test_one_of_range_and_bearing_is_enough(missing):
    log = log_of(10)
    less = replace(log, readings=replace(log.readings, **{missing: np.full(len(log.readings), np.nan)}))
    run = localize(less, sensor=SENSOR, noise=NOISE)
    assert run
    assert (run.dof == 1).all()
    assert np.isnan(run.innovations[:, 1]).all()
    assert rmse(run, log) < 0.5 * rmse(localize(Log(log.odometry, truth=log.truth), noise=NOISE), log)


def test_compass_and_gps_bound_the_drift():
    log = log_of(11, 60.0, noise=RandomWalk())
    rng, truth = np.random.default_rng(11), log.truth
    headings = Headings(truth.times, truth.poses[:, 2] + 0.1 + 0.05 * rng.normal(size=len(truth)))
    lever = cs.transform_points_2d(cs.pose_2d(xytheta=truth.poses), np.array([0.4, 0.2]))
    fixes = Fixes(truth.times[::10], (lever + 0.5 * rng.normal(size=lever.shape))[::10])
    sensed = Log(log.odometry, headings=headings, fixes=fixes, truth=truth)
    run = localize(
        sensed, compass=Compass(0.05, bias=0.1), gps=Gps(0.5, lever=(0.4, 0.2)), noise=RandomWalk()
    )
    alone = localize(Log(log.odometry, truth=truth))
    assert run
    assert rmse(run, log) < 0.4
    assert rmse(run, log) < rmse(alone, log)
    assert run.stats.mean_nis == pytest.approx(1.0, abs=0.25)


def test_false_readings_are_rejected_and_a_kidnapping_is_said():
    log = log_of(12)
    r = log.readings
    wrong = r.range.copy()
    wrong[::17] += 3.0
    run = localize(replace(log, readings=replace(r, range=wrong)), sensor=SENSOR, noise=NOISE)
    assert run
    assert run.rejected[::17].all()
    assert run.rejected.sum() < len(wrong) / 17 + 6
    jumped = r.range + np.where(r.times > 30.0, 2.5, 0.0)
    lost = localize(replace(log, readings=replace(r, range=jumped)), sensor=SENSOR, noise=NOISE)
    assert lost.lost.any()
    assert lost.stats.inflations > 0
    assert not lost.lost[lost.times < 30.0].any()


@pytest.mark.slow
@pytest.mark.parametrize("name", ALL)
def test_a_filter_that_began_at_a_wrong_place_says_lost(name):
    """Some readings pass their gate by chance, so that never ten in a row are rejected."""
    sensor, silent = RangeBearing(0.1, 0.05, most_range=6.0), 0
    for seed in range(16):
        log, rng = log_of(seed, sensor=sensor, period=1.0), np.random.default_rng(seed)
        aside = rng.uniform(2.0, 8.0) * np.array([np.cos(seed), np.sin(seed)])
        start = log.truth.poses[0] + np.append(aside, rng.uniform(-0.6, 0.6))
        run = localize(log, filter=name, start=start, sensor=sensor, noise=NOISE)
        error = np.hypot(*(run.poses[-1] - log.truth.at(run.times[-1]))[:2])
        silent += bool(run) and error > 0.5
        assert bool(run) or "contradict the filter" in run.reason
        assert not (run and run.rejected[-30:].mean() > 0.8)
    assert silent == 0
    log = log_of(20)
    r = log.readings
    for right in (4, 6, 9):  # every fourth reading fits, or fewer
        moved = r.range + np.where((r.times > 10.0) & (np.arange(len(r)) % right > 0), 2.5, 0.0)
        run = localize(
            replace(log, readings=replace(r, range=moved)), filter=name, sensor=SENSOR, noise=NOISE
        )
        assert not run
        assert not run.lost[run.times < 10.0].any()
        assert run.lost[run.times > 20.0].all()
    for seed in range(6):  # of which a third of the readings are false, at the right place
        log = log_of(seed)
        r, rng = log.readings, np.random.default_rng(seed)
        false = np.where(rng.random(len(r)) < 1 / 3, rng.uniform(0.5, 6.0, len(r)), r.range)
        run = localize(
            replace(log, readings=replace(r, range=false)), filter=name, sensor=SENSOR, noise=NOISE
        )
        assert run, seed


def test_landmarks_known_badly_widen_the_innovation():
    log = log_of(13, 5.0)
    m = log.landmarks
    vague = Landmarks(m.names, m.points, np.tile(np.eye(2) * 0.25, (len(m), 1, 1)))
    a, b = (localize(log, each, sensor=SENSOR, noise=NOISE) for each in (m, vague))
    assert b.stats.mean_nis < 0.5 * a.stats.mean_nis


def test_ellipses_of_the_map_are_turned_ones_of_base():
    run = localize(log_of(14, 5.0), sensor=SENSOR, noise=NOISE)
    c, s = np.cos(run.poses[-1, 2]), np.sin(run.poses[-1, 2])
    R = np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])
    np.testing.assert_allclose(run.covariance(frame="map")[-1], R @ run.covariances[-1] @ R.T, atol=1e-15)
    with pytest.raises(UnknownNameError):
        run.covariance(frame="odom")


def test_a_late_sensor_is_calibrated_and_used():
    sensor = RangeBearing(0.1, 0.02, range_bias=0.07, bearing_bias=-0.03, delay=0.2, most_range=6.0)
    log = log_of(15, 120.0, 0.2, sensor)
    fit = calibrate_sensor(log.readings, log.landmarks, log.truth)
    assert fit.delay == pytest.approx(0.2, abs=0.03)
    assert fit.range_bias == pytest.approx(0.07, abs=0.02)
    assert fit.bearing_bias == pytest.approx(-0.03, abs=0.005)
    assert fit.range_sigma == pytest.approx(0.1, rel=0.15)
    assert fit.bearing_sigma == pytest.approx(0.02, rel=0.15)


@pytest.mark.parametrize("dof", [1, 2, 3])
def test_quantiles_of_chi2(dof):
    for share in (0.5, 0.9, 0.999, 1 - 1e-9):
        assert chi2_quantile(share, dof) == pytest.approx(stats.chi2.ppf(share, dof), rel=1e-6)


def test_the_answer_is_the_same_every_time():
    a, b = (localize(log_of(16, 10.0), sensor=SENSOR, noise=NOISE) for _ in range(2))
    np.testing.assert_array_equal(a.covariances, b.covariances)


@pytest.mark.slow
def test_standing_still_for_an_hour_neither_drifts_nor_collapses():
    times = np.arange(0.0, 3600.0, 1.0)
    still = TimedPoses(times, np.zeros((len(times), 3)))
    log = simulate(still, log_of(1, 1.0).landmarks, sensor=SENSOR, noise=NOISE, period=5.0, rng=3)
    run = localize(log, sensor=SENSOR, noise=NOISE)
    assert run
    assert np.abs(run.poses).max() < 0.1
    assert np.linalg.eigvalsh(run.covariances).min() > 0


@pytest.mark.parametrize(
    ("change", "kind", "part"),
    [
        ({"filter": "efk"}, UnknownNameError, "did you mean 'ekf'"),
        ({"gate": 1.5}, InputError, "gate is 1.5"),
        ({"start": (0.0, np.nan, 0.0)}, InputError, "must be finite"),
        ({"start_covariance": -np.eye(3)}, InputError, "positive semi-definite"),
        ({"landmarks": Landmarks([99], [[0.0, 0.0]])}, InputError, "is read but not on the map"),
        ({"time_limit": 1e-9}, TimeLimitError, "time_limit"),
    ],
)
def test_a_misuse_is_named(change, kind, part):
    with pytest.raises(kind) as error:
        localize(log_of(1, 5.0), **change)
    assert part in str(error.value)


def test_what_a_log_lacks_is_named():
    log = log_of(1, 5.0)
    with pytest.raises(InputError, match="start of the robot is unknown"):
        localize(replace(log, truth=None))
    with pytest.raises(InputError, match="no map of them"):
        localize(replace(log, landmarks=None))
    with pytest.raises(InputError, match="no odometry"):
        localize(Log(Odometry([], np.empty((0, 3)))), start=(0, 0, 0))
    with pytest.raises(InputTypeError, match="log is a str"):
        localize("log.txt")
    none = Readings([], [], [], [])
    assert localize(replace(log, readings=none)).status == "lost"


@pytest.mark.slow
def test_mrclam_within_the_bars_of_the_project():
    """Defaults and odometry calibrated on the first half: filter 0.18 m, smoother 0.14 m, mean of three
    robots."""
    filtered, smoothed = [], []
    for robot in (1, 2, 3):
        log = cs.read_log(shared_data() / "localization/mrclam6", robot=robot)
        run = localize(replace(log, odometry=cs.mobile.calibrate(log.odometry, log.truth).odometry))
        for results, each in ((filtered, run), (smoothed, run.smoothed())):
            times = log.odometry.times
            error = each.at(times) - log.truth.at(times)
            results.append(np.sqrt(np.nanmean((error[:, :2] ** 2).sum(axis=1))))
    assert np.mean(filtered) < 0.18
    assert np.mean(smoothed) < 0.14


@pytest.mark.parametrize("variance", [1e13, 1e20, 1e300])
@pytest.mark.parametrize("name", ["ekf", "ukf", "information", "mcl"])
def test_a_start_that_may_be_anywhere_is_refused(name, variance):
    log = log_of(1)
    with pytest.raises(InputError, match="start_covariance holds"):
        localize(log, filter=name, start=(0, 0, 0), start_covariance=variance * np.eye(3), noise=NOISE)


@pytest.mark.parametrize(
    ("name", "options"),
    [
        ("ekf", {"rng": 1}),
        ("ukf", {"n": 100}),
        ("information", {"most": 100}),
        ("histogram", {"rng": 1}),
        ("histogram", {"gate": 0.9}),
        ("mcl", {"gate": 0.9}),
    ],
)
def test_arguments_that_a_filter_does_not_use_are_refused(name, options):
    with pytest.raises(InputError, match=f"does not use {next(iter(options))}"):
        localize(log_of(1), filter=name, **options)
