"""Landmark SLAM: equal to dense filters in plain numpy, consistent, and honest about what it cannot know."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy import stats
from scipy.linalg import expm

import cspace as cs
from cspace.errors import InputError, InputTypeError, TimeLimitError, UnknownNameError
from cspace.localization import (
    EkfSlam,
    FastSlam,
    Landmarks,
    Log,
    Odometry,
    RangeBearing,
    Readings,
    run_ekf_slam,
    run_fast_slam,
    simulate,
)
from cspace.mobile import RandomWalk, VelocityNoise
from data import shared_data
from localization.worlds import NOISE, SENSOR, disturbed_start, log_of, rmse

P0 = np.diag([0.04, 0.04, 0.01])
J = np.array([[0.0, -1.0], [1.0, 0.0]])
STILL = RandomWalk(0, 0, 0, 0, 0, 0)
LINEARIZATIONS = ("invariant", "first_estimate", "plain")
MOUNTED = replace(SENSOR, mount=(0.3, -0.2, 0.6), range_bias=0.05, bearing_bias=-0.02)


def turn(angle):
    return np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])


class DenseFilter:
    """EKF-SLAM on dense matrices. Invariant: errors of the group of poses with landmarks, (ρ_p, θ, ρ_l …)
    on the left, moved by the exponential of the matrix group (Barrau & Bonnabel 2015). Plain: errors x, y,
    θ, l."""

    def __init__(self, invariant, start, P, sensor):
        self.invariant, self.sensor = invariant, sensor
        self.p, self.angle, self.l, self.names = np.array(start[:2]), start[2], [], []
        B = np.eye(3)
        B[:2, :2] = turn(self.angle)
        self.P = B @ P @ B.T
        if invariant:
            self.P = self.to_group(inverse=False) @ self.P @ self.to_group(inverse=False).T

    def to_group(self, inverse):
        """From errors of the map to those of the group: ρ = δ − θ J x."""
        M = np.eye(3 + 2 * len(self.l))
        sign = 1.0 if inverse else -1.0
        M[:2, 2] = sign * J @ self.p
        for k, point in enumerate(self.l):
            M[3 + 2 * k : 5 + 2 * k, 2] = sign * J @ point
        return M

    def map_covariance(self):
        M = self.to_group(inverse=True) if self.invariant else np.eye(len(self.P))
        return M @ self.P @ M.T

    def predict(self, increment, Q):
        before = self.p
        self.p = self.p + turn(self.angle) @ increment[:2]
        self.angle += increment[2]
        G = np.zeros((len(self.P), 3))
        G[:2, :2], G[2, 2] = turn(self.angle), 1.0
        F = np.eye(len(self.P))
        if self.invariant:
            G[:, 2] = self.to_group(inverse=False)[:, 2]
        else:
            F[:2, 2] = J @ (self.p - before)
        self.P = F @ self.P @ F.T + G @ Q @ G.T

    def see(self, point):
        s = self.sensor
        q = turn(self.angle).T @ (point - self.p) - np.array(s.mount[:2])
        return turn(s.mount[2]).T @ q

    def update(self, rows):
        known = [row for row in rows if row[0] in self.names]
        if known:
            self.correct(known)
        for row in rows:
            if row[0] not in self.names:
                self.create(row)

    def model(self, row):
        s = self.sensor
        k = self.names.index(row[0])
        h = self.see(self.l[k])
        r = np.hypot(*h)
        G = np.array([h / r, [-h[1] / r**2, h[0] / r**2]])
        A = G @ turn(self.angle + s.mount[2]).T
        H = np.zeros((2, len(self.P)))
        H[:, :2], H[:, 3 + 2 * k : 5 + 2 * k] = -A, A
        if not self.invariant:
            H[:, 2] = -A @ J @ (self.l[k] - self.p)
        nu = np.array([row[1] - s.range_bias - r, row[2] - s.bearing_bias - np.arctan2(h[1], h[0])])
        nu[1] = (nu[1] + np.pi) % (2 * np.pi) - np.pi
        keep = ~np.isnan(nu)
        R = np.diag([s.range_sigma**2, s.bearing_sigma**2])
        return H[keep], nu[keep], R[np.ix_(keep, keep)]

    def correct(self, rows):
        parts = [self.model(row) for row in rows]
        H, nu = np.concatenate([p[0] for p in parts]), np.concatenate([p[1] for p in parts])
        R = np.diag(np.concatenate([np.diag(p[2]) for p in parts]))
        K = self.P @ H.T @ np.linalg.inv(H @ self.P @ H.T + R)
        d = K @ nu
        I_KH = np.eye(len(self.P)) - K @ H
        self.P = I_KH @ self.P @ I_KH.T + K @ R @ K.T
        m = len(self.l)
        if not self.invariant:
            self.p, self.angle = self.p + d[:2], self.angle + d[2]
            self.l = [point + d[3 + 2 * k : 5 + 2 * k] for k, point in enumerate(self.l)]
            return
        X = np.zeros((3 + m, 3 + m))
        X[:2, :2] = d[2] * J
        X[:2, 2] = d[:2]
        for k in range(m):
            X[:2, 3 + k] = d[3 + 2 * k : 5 + 2 * k]
        T = np.eye(3 + m)
        T[:2, :2], T[:2, 2] = turn(self.angle), self.p
        for k in range(m):
            T[:2, 3 + k] = self.l[k]
        T = expm(X) @ T
        self.p, self.angle = T[:2, 2], self.angle + d[2]
        self.l = [T[:2, 3 + k] for k in range(m)]

    def create(self, row):
        s = self.sensor
        r, b = row[1] - s.range_bias, row[2] - s.bearing_bias
        h = np.array([r * np.cos(b), r * np.sin(b)])
        point = self.p + turn(self.angle) @ (np.array(s.mount[:2]) + turn(s.mount[2]) @ h)
        E = np.array([[np.cos(b), -r * np.sin(b)], [np.sin(b), r * np.cos(b)]])
        E = turn(self.angle + s.mount[2]) @ E
        n = len(self.P)
        F = np.zeros((2, n))
        F[:, :2] = np.eye(2)
        if not self.invariant:
            F[:, 2] = J @ (point - self.p)
        P = np.zeros((n + 2, n + 2))
        P[:n, :n], P[n:, :n] = self.P, F @ self.P
        P[:n, n:] = P[n:, :n].T
        R = np.diag([s.range_sigma**2, s.bearing_sigma**2])
        P[n:, n:] = F @ self.P @ F.T + E @ R @ E.T
        self.P = P
        self.l.append(point)
        self.names.append(row[0])


def random_steps(seed, sensor, steps=25, kinds=False):
    """Increments, and readings of random landmarks with errors, rows name, range, bearing."""
    rng = np.random.default_rng(seed)
    points = rng.uniform(-6, 6, size=(9, 2))
    truth = DenseFilter(False, np.zeros(3), np.eye(3), sensor)
    out = []
    for _ in range(steps):
        increment = rng.normal(size=3) * [0.3, 0.05, 0.2]
        truth.predict(increment, np.zeros((3, 3)))
        seen = rng.choice(9, size=rng.integers(1, 8), replace=False)
        h = np.array([truth.see(points[k]) for k in seen])
        rows = np.stack([seen, np.hypot(*h.T) + sensor.range_bias, np.arctan2(h[:, 1], h[:, 0])], axis=-1)
        rows[:, 2] += sensor.bearing_bias
        rows[:, 1:] += rng.normal(size=(len(rows), 2)) * [sensor.range_sigma, sensor.bearing_sigma]
        known = len(out) > 5
        if kinds and known:
            rows[rng.random(len(rows)) < 0.3, 1] = np.nan
            rows[np.isfinite(rows[:, 1]) & (rng.random(len(rows)) < 0.3), 2] = np.nan
        out.append((increment, rows))
    return out


@pytest.mark.parametrize("kinds", [False, True])
@pytest.mark.parametrize("sensor", [SENSOR, MOUNTED])
@pytest.mark.parametrize("linearization", ["invariant", "plain"])
def test_the_filter_is_the_dense_one(linearization, sensor, kinds):
    start = np.array([1.0, -2.0, 2.8])
    P = np.diag([0.02, 0.01, 0.005])
    slam = EkfSlam(
        start=start,
        start_covariance=P,
        sensor=sensor,
        noise=NOISE,
        linearization=linearization,
        gate=1 - 1e-15,
    )
    dense = DenseFilter(linearization == "invariant", start, P, sensor)
    for increment, rows in random_steps(1, sensor, kinds=kinds):
        slam.predict(increment, 0.5)
        dense.predict(increment, NOISE.covariance(cs.log_se2(cs.pose_2d(xytheta=increment)), 0.5))
        rows = rows[[np.isfinite(row).all() or row[0] in dense.names for row in rows]]
        slam.update(rows)
        dense.update(rows)
        np.testing.assert_allclose(slam.pose[:2], dense.p, atol=1e-9)
        np.testing.assert_allclose(np.exp(1j * slam.pose[2]), np.exp(1j * dense.angle), atol=1e-9)
        np.testing.assert_array_equal(slam.landmarks.names, dense.names)
        np.testing.assert_allclose(slam.landmarks.points, dense.l, atol=1e-9)
        np.testing.assert_allclose(slam.joint_covariance, dense.map_covariance(), atol=1e-10)
    B = np.eye(3)
    B[:2, :2] = turn(slam.pose[2])
    np.testing.assert_allclose(B @ slam.covariance @ B.T, slam.joint_covariance[:3, :3], atol=1e-12)
    for k, P in enumerate(slam.landmarks.covariances):
        at = 3 + 2 * k
        np.testing.assert_array_equal(P, slam.joint_covariance[at : at + 2, at : at + 2])


@pytest.mark.parametrize("linearization", ["invariant", "first_estimate"])
def test_nobody_measures_the_heading_of_the_map(linearization):
    """Readings are the same in a turned world, so that the heading is never known better than at the start:
    the plain filter claims it is."""

    def least(linearization):
        slam = EkfSlam(start_covariance=P0, sensor=SENSOR, noise=STILL, linearization=linearization)
        variances = []
        for increment, rows in random_steps(2, SENSOR, 60):
            slam.predict(increment)
            slam.update(rows)
            N = np.zeros((3 + 2 * len(slam.landmarks), 3))
            N[:2, :2], N[2, 2] = np.eye(2), 1.0
            variances.append(slam.covariance[2, 2])
        return min(variances)

    assert least(linearization) > 0.01 * (1 - 1e-9)
    assert least("plain") < 0.005


@pytest.mark.parametrize("linearization", ["invariant", "first_estimate"])
def test_no_information_along_turns_and_shifts_of_the_world(linearization):
    """Nᵀ P⁻¹ N stays as it was for N the turns and shifts of the whole state, about where it is
    linearised."""
    slam = EkfSlam(start_covariance=P0, sensor=SENSOR, noise=STILL, linearization=linearization)
    first = {}
    for increment, rows in random_steps(3, SENSOR, 12):
        slam.predict(increment)
        predicted = slam.pose[:2]
        slam.update(rows)
        for name, point in zip(slam.landmarks.names, slam.landmarks.points, strict=True):
            first.setdefault(int(name), point)
        points = slam.landmarks.points
        about = slam.pose[:2]
        if linearization == "first_estimate":
            points, about = np.array([first[int(k)] for k in slam.landmarks.names]), predicted
        N = np.zeros((3 + 2 * len(points), 3))
        N[:2, :2], N[:2, 2], N[2, 2] = np.eye(2), J @ about, 1.0
        for k, point in enumerate(points):
            N[3 + 2 * k : 5 + 2 * k, :2], N[3 + 2 * k : 5 + 2 * k, 2] = np.eye(2), J @ point
        information = N.T @ np.linalg.solve(slam.joint_covariance, N)
        np.testing.assert_allclose(information, np.linalg.inv(P0), rtol=1e-6, atol=1e-6)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("linearization", "consistent"), [*zip(LINEARIZATIONS, (True, True, False), strict=True)]
)
def test_consistency(linearization, consistent):
    """NEES over 100 runs of three states, as for the filters on known maps; the plain filter fails."""
    values = []
    for seed in range(100):
        log = log_of(1000 + seed, 30.0, 1.0)
        start = disturbed_start(log, P0, seed)
        run = run_ekf_slam(
            log,
            start=start,
            start_covariance=P0,
            sensor=SENSOR,
            noise=NOISE,
            gate=1 - 1e-12,
            linearization=linearization,
        )
        values.append(run.nees(log.truth))
    mean = np.mean(values, axis=0)
    inside = ((mean > 2.54) & (mean < 3.50)).mean() >= 0.9 and mean.min() > 2.14 and mean.max() < 4.05
    assert inside == consistent


@pytest.mark.slow
@pytest.mark.parametrize("version", [1, 2])
def test_fast_slam_is_consistent_with_the_error_of_its_start(version):
    """Resampling loses what is drawn into particles, but not the start, which no reading corrects."""
    xi = np.random.default_rng(5).standard_normal((60, 3))
    xi = xi @ np.linalg.inv(np.linalg.cholesky(xi.T @ xi / 60)).T @ np.sqrt(P0)
    values = []
    for seed, error in enumerate(xi):
        log = log_of(1000 + seed, 30.0, 1.0)
        start = cs.to_xytheta(cs.pose_2d(xytheta=log.truth.poses[0]) @ cs.exp_se2(-error))
        run = run_fast_slam(
            log,
            version=version,
            n=500,
            rng=seed,
            start=start,
            start_covariance=P0,
            sensor=SENSOR,
            noise=NOISE,
            gate=1 - 1e-12,
        )
        values.append(run.nees(log.truth))
    mean = np.mean(values, axis=0)
    low, high = stats.chi2.ppf([0.025, 0.975], 3 * len(xi)) / len(xi)
    assert ((mean > low) & (mean < high)).mean() >= 0.9


@pytest.mark.parametrize("version", [1, 2])
def test_the_start_moves_all_of_fast_slam_as_one_body(version):
    """Poses and landmarks have the covariances of EKF-SLAM where the error of the start is all there is."""
    log = log_of(4, 20.0, 1.0)
    wide, narrow = np.array([[0.3, 0.1, 0.02], [0.1, 0.2, -0.01], [0.02, -0.01, 0.05]]), 1e-12 * np.eye(3)
    options = {"sensor": SENSOR, "noise": NOISE, "start": log.truth.poses[0]}
    cloud, sharp = (
        run_fast_slam(log, version=version, rng=3, start_covariance=P, **options) for P in (wide, narrow)
    )
    assert np.array_equal(cloud.poses, sharp.poses)
    kalman = [run_ekf_slam(log, start_covariance=P, **options) for P in (wide, narrow)]
    more = cloud.covariances - sharp.covariances
    np.testing.assert_allclose(more, kalman[0].covariances - kalman[1].covariances, atol=0.02 * more.max())
    spread = cloud.landmarks.covariances - sharp.landmarks.covariances
    of_kalman = kalman[0].landmarks.covariances - kalman[1].landmarks.covariances
    np.testing.assert_allclose(spread, of_kalman, atol=0.02 * spread.max())


@pytest.mark.parametrize("method", [run_ekf_slam, run_fast_slam])
def test_moving_the_frame_changes_nothing_in_base(method):
    log = log_of(1, 20.0)
    T = cs.pose_2d(xytheta=[30.0, -7.0, 2.5])
    shared = {"start_covariance": P0, "sensor": SENSOR, "noise": NOISE}
    if method is run_fast_slam:
        shared["rng"] = 3
    a = method(log, **shared)
    b = method(log, start=cs.to_xytheta(T), **shared)
    np.testing.assert_allclose(T @ cs.pose_2d(xytheta=a.poses), cs.pose_2d(xytheta=b.poses), atol=1e-7)
    np.testing.assert_allclose(b.covariances, a.covariances, atol=1e-9)
    np.testing.assert_allclose(b.nis, a.nis, atol=1e-6)
    moved = cs.transform_points_2d(T, a.landmarks.points)
    np.testing.assert_allclose(b.landmarks.points, moved, atol=1e-7)


@pytest.mark.parametrize("method", ["ekf", "fastslam"])
def test_slam_of_a_log_begins_at_the_start_that_is_given(method):
    log, start = log_of(3, 12.0), (5.0, -2.0, 0.7)
    found = cs.slam(log, method=method, start=start, rng=1)
    same = run_ekf_slam(log, start=start) if method == "ekf" else run_fast_slam(log, start=start, rng=1)
    assert np.array_equal(found.poses, same.poses)
    assert not np.allclose(found.poses[0], 0)


@pytest.mark.parametrize("linearization", LINEARIZATIONS)
def test_the_order_of_readings_does_not_matter(linearization):
    runs = []
    for order in (1, -1):
        slam = EkfSlam(sensor=SENSOR, noise=NOISE, linearization=linearization)
        for increment, rows in random_steps(4, SENSOR):
            slam.predict(increment, 0.1)
            slam.update(rows[::order])
        by_name = np.argsort(slam.landmarks.names)
        runs.append((slam.pose, slam.covariance, slam.landmarks.points[by_name]))
    for a, b in zip(*runs, strict=True):
        np.testing.assert_allclose(a, b, atol=1e-9)


def test_a_drive_without_a_map_is_better_than_odometry():
    log = log_of(5, 60.0)
    start = log.truth.poses[0]
    raw = rmse(log.odometry.dead_reckoning(start), log)
    runs = [
        run_ekf_slam(log, start=start, sensor=SENSOR, noise=NOISE, linearization=k) for k in LINEARIZATIONS
    ]
    runs += [run_fast_slam(log, start=start, sensor=SENSOR, noise=NOISE, version=v, rng=1) for v in (1, 2)]
    for run in runs:
        assert run
        assert rmse(run, log) < 0.5 * raw
        points = log.landmarks.points[log.landmarks.rows_of(run.landmarks.names)]
        error = run.landmarks.points - points
        assert np.hypot(*error.T).max() < 0.5
        assert run.stats.mean_nis == pytest.approx(1.0, abs=0.2)
        assert len(run.readings) == len(log.readings) == len(run.measured)
        assert run.covariance(frame="map").shape == run.covariances.shape


def test_readings_without_names_find_their_landmarks():
    log = log_of(6, 60.0)
    nameless = replace(log, readings=replace(log.readings, landmark=np.full(len(log.readings), -1)))
    start = log.truth.poses[0]
    named = run_ekf_slam(log, start=start, sensor=SENSOR, noise=NOISE)
    for run in (
        run_ekf_slam(nameless, start=start, sensor=SENSOR, noise=NOISE),
        run_ekf_slam(nameless, start=start, sensor=SENSOR, noise=NOISE, association="nearest"),
        run_fast_slam(nameless, start=start, sensor=SENSOR, noise=NOISE, rng=2),
    ):
        assert run
        assert rmse(run, log) < 2 * rmse(named, log) + 0.05
        assert abs(len(run.landmarks) - len(named.landmarks)) <= 2
        nearest = [np.hypot(*(log.landmarks.points - p).T).min() for p in run.landmarks.points]
        assert max(nearest) < 0.6


def well_known(points, association):
    """A filter that knows landmarks as seen from the origin almost exactly."""
    slam = EkfSlam(sensor=RangeBearing(0.1, 0.02), noise=STILL, association=association)
    rows = as_rows(points)
    for _ in range(200):
        slam.update(rows)
    return slam, rows


def as_rows(points):
    return np.stack([np.full(len(points), -1.0), np.hypot(*points.T), np.arctan2(*points.T[::-1])], axis=-1)


@pytest.mark.parametrize("association", ["joint", "nearest"])
def test_a_shifted_scan_is_not_compatible_as_a_whole(association):
    """Each range is 2.5 deviations too long, which its own gate accepts; together they contradict the map."""
    points = np.array([[4.0, 0.0], [0.0, 4.0], [-4.0, 0.0], [0.0, -4.0], [3.0, 3.0], [-3.0, 3.0]])
    slam, rows = well_known(points, association)
    slam.update(rows + np.array([0, 0.25, 0]))
    assert 0 < slam.outcomes.used.sum() < len(points)
    slam.update(rows)
    assert slam.outcomes.used.all()


def test_two_landmarks_that_explain_a_reading_alike_are_ambiguous():
    points = np.array([[4.0, 0.0], [4.0, 0.4], [0.0, 4.0]])
    slam, rows = well_known(points, "joint")
    between = as_rows(np.array([[4.0, 0.2]]))
    slam.update(between)
    assert slam.outcomes.verdict.tolist() == ["rejected"]
    slam.update(rows)
    assert slam.outcomes.used.all()
    assert slam


def test_a_landmark_counts_after_three_updates_and_is_dropped_if_it_is_not_seen_again():
    points = np.array([[4.0, 0.0], [0.0, 4.0]])
    slam, rows = well_known(points, "joint")
    slam.update(np.concatenate([rows, as_rows(np.array([[-4.0, -4.0]]))]))
    assert slam.outcomes.verdict.tolist() == ["used", "used", "created"]
    assert len(slam.landmarks) == 2
    assert len(slam._core.landmarks[0]) == 3
    before = slam.joint_covariance[:7, :7]
    for _ in range(20):
        assert len(slam._core.landmarks[0]) == 3
        slam.update(rows)
    assert len(slam._core.landmarks[0]) == 2
    assert slam.joint_covariance.shape == (7, 7)
    assert (np.linalg.eigvalsh(before - slam.joint_covariance) > -1e-12).all()


def test_the_same_seed_gives_the_same_particles():
    log = log_of(7, 10.0)
    a, b, c = (run_fast_slam(log, sensor=SENSOR, noise=NOISE, rng=seed) for seed in (1, 1, 2))
    np.testing.assert_array_equal(a.poses, b.poses)
    np.testing.assert_array_equal(a.landmarks.points, b.landmarks.points)
    assert np.abs(a.poses - c.poses).max() > 1e-6


@pytest.mark.parametrize("version", [1, 2])
def test_many_particles_agree_with_the_kalman_filter(version):
    """A motion with noise, then readings of two landmarks seen before: the posterior is nearly normal."""
    noise = RandomWalk(0, 0, 0, 0, 1e-3, 2e-4)
    sensor = RangeBearing(0.1, 0.02)
    points = np.array([[4.0, 1.0], [2.0, -3.0]])
    rows = as_rows(points)
    rows[:, 0] = [0, 1]
    slam = EkfSlam(sensor=sensor, noise=noise)
    cloud = FastSlam(n=20_000, version=version, sensor=sensor, noise=noise, rng=5)
    for each in (slam, cloud):
        for _ in range(20):
            each.update(rows)
        each.predict([0.1, 0.0, 0.0], 2.0)
        seen = as_rows(points - [0.18, 0.05])
        seen[:, 0] = [0, 1]
        each.update(seen)
    spread = np.sqrt(np.diag(slam.covariance))
    np.testing.assert_allclose(cloud.pose, slam.pose, atol=0.08 * spread.max())
    np.testing.assert_allclose(np.sqrt(np.diag(cloud.covariance)), spread, rtol=0.1)
    np.testing.assert_allclose(cloud.landmarks.points, slam.landmarks.points, atol=0.01)
    np.testing.assert_allclose(cloud.outcomes.nis, slam.outcomes.nis, rtol=0.15)
    assert cloud.weights.sum() == pytest.approx(1.0)
    assert cloud.particles.shape == (20_000, 3)


def test_one_particle_without_noise_maps_with_known_poses():
    """Every landmark is a Kalman filter of its own: the dense filter with a pose that is known."""
    cloud = FastSlam(n=1, sensor=SENSOR, noise=STILL, rng=0, gate=1 - 1e-15)
    dense = DenseFilter(False, np.zeros(3), np.zeros((3, 3)), SENSOR)
    for increment, rows in random_steps(8, SENSOR):
        cloud.predict(increment)
        dense.predict(increment, np.zeros((3, 3)))
        cloud.update(rows)
        for row in rows:
            dense.update([row])
    np.testing.assert_allclose(cloud.landmarks.points, dense.l, atol=1e-9)
    for k, P in enumerate(cloud.landmarks.covariances):
        at = 3 + 2 * k
        np.testing.assert_allclose(P, dense.P[at : at + 2, at : at + 2], atol=1e-12)


def test_particles_share_landmarks_that_they_do_not_see():
    cloud = FastSlam(n=200, version=1, sensor=RangeBearing(0.5, 0.1), noise=NOISE, rng=1)
    points = np.random.default_rng(0).uniform(-9, 9, size=(160, 2))
    rows = as_rows(points)
    rows[:, 0] = np.arange(160)
    cloud.update(rows)
    assert cloud._core.chunks == 200 * 10
    sharp = RangeBearing(0.5, 0.1)
    del sharp
    for _ in range(60):
        cloud.predict([0.05, 0.0, 0.02], 0.1)
        cloud.update(rows[:3])
    assert cloud._core.counts[-1] > 0
    assert cloud._core.chunks < 200 * 10 / 2


def test_a_kidnapped_robot_says_so():
    log = log_of(9, 40.0)
    r = log.readings
    jumped = replace(log, readings=replace(r, range=r.range + np.where(r.times > 30.0, 2.5, 0.0)))
    for run in (
        run_ekf_slam(jumped, sensor=SENSOR, noise=NOISE),
        run_fast_slam(jumped, sensor=SENSOR, noise=NOISE, rng=1),
    ):
        assert run.lost.any()
        assert not run.lost[run.times < 30.0].any()
        assert run.stats.inflations > 0


ROUND = [(0, 0), (9, 0), (9, 6), (0, 6), (0, 0.5), (8, 0.5), (8.5, 5.5), (0.5, 5.5)]


@pytest.mark.parametrize("run_filter", [run_ekf_slam, run_fast_slam])
@pytest.mark.parametrize("share", [0.0, 0.2, 0.85, 1.0])
def test_a_filter_is_lost_where_most_readings_contradict_its_map(run_filter, share):
    """From half time on a share of the readings is of other landmarks than it says: some fit by chance."""
    for seed in range(4):
        rng = np.random.default_rng([seed, 5])
        points = rng.uniform([-1.5, -1.5], [10.5, 7.5], (16, 2))
        drive = cs.navigation.follow(ROUND, vehicle=cs.Unicycle())
        sensor = RangeBearing(range_sigma=0.1, bearing_sigma=0.02, most_range=4.0)
        log = simulate(drive, Landmarks(range(16), points), sensor=sensor, rng=seed)
        half, end = 0.5 * log.readings.times[-1], log.readings.times[-1]
        is_wrong = (log.readings.times > half) & (rng.random(len(log.readings)) < share)
        names = np.where(is_wrong, rng.permutation(16)[log.readings.landmark], log.readings.landmark)
        wrong = replace(log, readings=replace(log.readings, landmark=names))
        run = run_filter(wrong, sensor=sensor, start=log.truth.poses[0])
        assert not run.lost[run.times < half].any()
        late = run.lost[(run.times > 0.6 * end)]
        if share > 0.5:
            assert late.mean() > 0.7
            assert not run
        else:
            assert late.mean() < 0.02


def test_wrong_names_are_rejected():
    log = log_of(10, 40.0)
    names = log.readings.landmark.copy()
    later = np.flatnonzero(log.readings.times > 20.0)[::9]
    names[later] = (names[later] + 7) % 25
    known = set(log.readings.landmark[log.readings.times <= 20.0].tolist())
    run = run_ekf_slam(
        replace(log, readings=replace(log.readings, landmark=names)), sensor=SENSOR, noise=NOISE
    )
    wrong = [k for k in later if int(names[k]) in known]
    assert (run.readings.verdict[wrong] == "rejected").mean() > 0.9
    assert run


def test_a_thousand_landmarks():
    points = np.random.default_rng(1).uniform(-50, 50, size=(1000, 2))
    rows = as_rows(points)
    rows[:, 0] = np.arange(1000)
    slam = EkfSlam(sensor=SENSOR, noise=NOISE)
    slam.update(rows)
    for _ in range(3):
        slam.predict([0.1, 0.0, 0.0], 0.1)
        moved = as_rows(points - slam.pose[:2])
        moved[:, 0] = np.arange(1000)
        slam.update(moved[:200])
    assert slam
    assert len(slam.landmarks) == 1000
    P = slam.joint_covariance
    np.testing.assert_allclose(P, P.T, atol=1e-12)
    assert np.linalg.eigvalsh(P).min() > -1e-12


def test_degenerate_input_is_legal():
    slam = EkfSlam(sensor=SENSOR, noise=STILL)
    slam.update(np.empty((0, 3)))
    slam.update([])
    slam.update([[4, 2.0, 0.1]])  # before any odometry; a landmark seen once
    slam.update([[5, 0.0, 0.1], [6, np.nan, 0.1], [7, 3.0, np.nan]])  # nothing can be made of these
    assert slam.outcomes.verdict.tolist() == ["skipped"] * 3
    slam.update([[4, 0.0, np.nan]])
    assert slam.outcomes.verdict.tolist() == ["rejected"]
    slam.update([[4, 2.0, 0.1], [4, 2.0, 0.1], [8, 3.0, 1.0], [8, 3.01, 1.0]])  # names twice
    assert slam.outcomes.verdict.tolist() == ["used", "used", "created", "used"]
    assert np.isfinite(slam.joint_covariance).all()
    assert "2 landmarks" in repr(slam)
    cloud = FastSlam(sensor=SENSOR, noise=STILL, rng=0)
    cloud.update([[4, 2.0, 0.1], [5, 0.0, 0.1]])
    cloud.update([[4, 2.0, 0.1]])
    assert len(cloud.landmarks) == 1
    assert cloud


def test_other_models_of_noise_and_readings_as_objects():
    a, b = (EkfSlam(sensor=SENSOR, noise=VelocityNoise()) for _ in range(2))
    for increment, rows in random_steps(11, SENSOR, 5):
        a.predict(increment, 0.5)
        b.predict(list(increment), 0.5)
        a.update(rows)
        b.update(Readings(np.zeros(len(rows)), rows[:, 0], rows[:, 1], rows[:, 2]))
    np.testing.assert_array_equal(a.pose, b.pose)
    Q = VelocityNoise().covariance([0.3, 0.0, 0.1], 0.5)
    c = EkfSlam(noise=VelocityNoise())
    c.predict(cs.to_xytheta(cs.exp_se2([0.3, 0.0, 0.1])), 0.5)
    np.testing.assert_allclose(c.covariance, Q, atol=1e-12)


@pytest.mark.parametrize("xi", [[0.5, 0.1, 0.4], [1.0, 0.0, 0.0], [2.0, -1.0, 5.0], [0.0, 0.0, -3.0]])
def test_the_random_walk_of_the_core_is_that_of_the_package(xi):
    walk = RandomWalk()
    slam = EkfSlam(noise=walk)
    short = np.array(xi) * (1.0 if abs(xi[2]) < np.pi else 0.5)
    slam.predict(cs.to_xytheta(cs.exp_se2(short)), 0.7)
    np.testing.assert_allclose(slam.covariance, walk.covariance(short, 0.7), rtol=1e-9, atol=1e-15)


@pytest.mark.parametrize(
    ("rows", "part"),
    [
        ([[0.5, 1.0, 0.0]], "whole numbers"),
        ([[-2, 1.0, 0.0]], "whole numbers"),
        ([[np.nan, 1.0, 0.0]], "whole numbers"),
        ([[1, -1.0, 0.0]], "range is -1"),
        ([[1, np.nan, np.nan]], "neither range nor bearing"),
        ([[1, np.inf, 0.0]], "infinite"),
        ([[1, 1.0, 90.0]], "radians"),
        ([[1, 1.0, 0.0], [1, 1.0, 90.0]], "radians"),
        ([[1, 1.0, 0.0], [-1, 1.0, 0.0]], "some have none"),
        ([[1, 1.0]], "rows name, range, bearing"),
    ],
)
def test_readings_that_cannot_be_used_are_named(rows, part):
    for slam in (EkfSlam(), FastSlam(rng=0)):
        with pytest.raises(InputError, match=part):
            slam.update(rows)
        assert not len(slam.landmarks)


def test_a_misuse_is_named():
    with pytest.raises(UnknownNameError, match="did you mean 'invariant'"):
        EkfSlam(linearization="invarient")
    with pytest.raises(UnknownNameError, match="association"):
        EkfSlam(association="joined")
    with pytest.raises(InputError, match="version is 3"):
        FastSlam(version=3)
    with pytest.raises(InputError, match="n is 0"):
        FastSlam(n=0)
    with pytest.raises(InputError, match=r"gate is 1\.5"):
        EkfSlam(gate=1.5)
    with pytest.raises(InputError, match="positive semi-definite"):
        EkfSlam(start_covariance=-np.eye(3))
    with pytest.raises(InputError, match="increment"):
        EkfSlam().predict([0.0, np.nan, 0.0])
    with pytest.raises(InputError, match="dt is"):
        EkfSlam().predict([0.0, 0.0, 0.0], -1.0)
    log = log_of(1, 5.0)
    with pytest.raises(TimeLimitError, match="time_limit"):
        run_ekf_slam(log, time_limit=1e-9)
    with pytest.raises(InputError, match="no readings"):
        run_ekf_slam(replace(log, readings=None))
    with pytest.raises(InputError, match="no odometry"):
        run_ekf_slam(Log(Odometry([], np.empty((0, 3))), readings=log.readings))
    with pytest.raises(InputTypeError, match="log is a str"):
        run_fast_slam("log.txt")
    names = log.readings.landmark.copy()
    names[3] = -1
    with pytest.raises(InputError, match="have no name"):
        run_ekf_slam(replace(log, readings=replace(log.readings, landmark=names)))


def test_readings_outside_of_the_odometry_are_counted():
    log = log_of(12, 5.0)
    late = replace(log, readings=replace(log.readings, times=log.readings.times + 2.0))
    run = run_ekf_slam(late, sensor=SENSOR, noise=NOISE)
    assert run.stats.skipped > 0
    none = run_ekf_slam(replace(log, readings=Readings([], [], [], [])), noise=NOISE)
    assert none.status == "lost"
    assert "dead reckoning" in none.reason
    np.testing.assert_allclose(none.poses, log.odometry.dead_reckoning().poses, atol=1e-9)


def align(points, onto):
    """Points moved onto others, the least squares of the plane: a function."""
    a, b = points - points.mean(0), onto - onto.mean(0)
    U, _, Vt = np.linalg.svd(b.T @ a)
    R = U @ np.diag([1.0, np.linalg.det(U @ Vt)]) @ Vt
    return lambda p: (p - points.mean(0)) @ R.T + onto.mean(0)


@pytest.mark.slow
def test_mrclam_without_its_map():
    """Mean errors of three robots after alignment: poses below 0.27 m, landmarks below 0.25 m."""
    errors, plain = [], []
    for robot in (1, 2, 3):
        log = cs.read_log(shared_data() / "localization/mrclam6", robot=robot)
        log = replace(log, odometry=cs.mobile.calibrate(log.odometry, log.truth).odometry)
        times = log.odometry.times
        truth = log.truth.at(times)[:, :2]
        known = ~np.isnan(truth[:, 0])
        for kind, results in (("invariant", errors), ("plain", plain)):
            run = run_ekf_slam(log, linearization=kind)
            assert run
            assert run.lost.mean() < 0.02
            move = align(run.at(times)[known, :2], truth[known])
            path = move(run.at(times)[known, :2]) - truth[known]
            points = log.landmarks.points[log.landmarks.rows_of(run.landmarks.names)]
            marks = move(run.landmarks.points) - points
            results.append([np.sqrt((each**2).sum(1).mean()) for each in (path, marks)])
    assert (np.mean(errors, axis=0) < [0.27, 0.25]).all()
    assert (np.mean(errors, axis=0) < np.mean(plain, axis=0)).all()


def far_off_readings(log, rng):
    """The readings with ranges that contradict each other."""
    wrong = log.readings.range * rng.uniform(0.5, 1.5, len(log.readings))
    return replace(log, readings=replace(log.readings, range=wrong))


@pytest.mark.parametrize("seed", range(3))
def test_a_map_that_readings_contradict_is_ambiguous(seed):
    rng = np.random.default_rng(seed)
    run = cs.navigation.follow([(0, 0), (9, 0), (9, 6), (0, 6), (0, 1), (9, 1)], vehicle=cs.Unicycle())
    points = rng.uniform([-3, -3], [12, 9], (20, 2))
    sensor = RangeBearing(range_sigma=0.05, bearing_sigma=0.01, most_range=6.0)
    log = simulate(run, Landmarks(range(20), points), sensor=sensor, rng=seed)
    right = run_ekf_slam(log, sensor=sensor)
    assert right.status == "localised"
    assert not right.doubt
    wrong = far_off_readings(log, rng)
    unnamed = replace(wrong, readings=replace(wrong.readings, landmark=np.full(len(wrong.readings), -1)))
    for contradicting in (wrong, unnamed):
        found = run_ekf_slam(contradicting, sensor=sensor)
        assert not found
        assert found.status in ("ambiguous", "lost")
        assert found.reason


def test_shares_of_doubt_by_brute_force():
    from cspace.localization.landmark_slam.doubts import DOUBT_SPAN, find_rejected_share, find_twin_share
    from cspace.localization.landmark_slam.outcomes import ReadingOutcomes

    rng = np.random.default_rng(5)
    for count in (0, DOUBT_SPAN - 1, DOUBT_SPAN, 300):
        verdict = rng.choice(["used", "rejected"], count)
        none = np.zeros(count, int)
        outcomes = ReadingOutcomes(none, verdict, none, np.zeros(count), np.zeros((count, 2)))
        shares = [
            np.mean(verdict[k : k + DOUBT_SPAN] == "rejected") for k in range(max(0, count - DOUBT_SPAN + 1))
        ]
        assert find_rejected_share(outcomes) == pytest.approx(max(shares, default=0.0))
    points = rng.uniform(0, 10, (60, 2))
    near = [any(0 < np.hypot(*(p - q)) < 0.6 for q in points) for p in points]
    assert find_twin_share(Landmarks(range(60), points), 0.2) == pytest.approx(np.mean(near))
    assert find_twin_share(Landmarks([], np.zeros((0, 2))), 0.2) == 0.0


def twelve_landmarks(seed, most_range=5.0):
    """A drive along twelve landmarks, and what it read of them."""
    rng = np.random.default_rng(seed)
    run = cs.navigation.follow([(0, 0), (9, 0), (9, 6), (0, 6), (0, 1)], vehicle=cs.Unicycle())
    points = rng.uniform([-3, -3], [12, 9], (12, 2))
    sensor = RangeBearing(
        range_sigma=0.05,
        bearing_sigma=0.01,
        most_range=most_range,
        mount=(0.2, 0.1, 0.3),
        field_of_view=float(rng.choice([4.0, 2 * np.pi])),
    )
    log = simulate(run, Landmarks(range(12), points), sensor=sensor, rng=seed)
    return log, sensor


@pytest.mark.parametrize("seed", range(4))
def test_missed_sightings_by_going_through_all(seed):
    from cspace.localization.landmark_slam.doubts import SURELY_SEEN, find_missed_share

    log, sensor = twelve_landmarks(seed)
    found = run_ekf_slam(log, sensor=sensor, start=log.truth.poses[0])
    marks = Landmarks(
        np.append(found.landmarks.names, 99), np.concatenate([found.landmarks.points, [[4, 3]]])
    )
    share = find_missed_share(marks, found.poses, found.measured, found.readings, sensor)
    expected, missed = 0, 0
    for node in np.unique(found.measured):
        T = cs.pose_2d(xytheta=found.poses[node]) @ cs.pose_2d(xytheta=sensor.mount)
        seen = set(found.readings.landmark[found.measured == node])
        for name, point in zip(marks.names, marks.points, strict=True):
            x, y = (cs.inverse_pose_2d(T) @ [*point, 1.0])[:2]
            is_near = np.hypot(x, y) < SURELY_SEEN * sensor.most_range
            is_ahead = abs(np.arctan2(y, x)) < SURELY_SEEN * 0.5 * sensor.field_of_view
            if is_near and (is_ahead or sensor.field_of_view == 2 * np.pi):
                expected += 1
                missed += name not in seen
    assert expected > 100
    assert share == pytest.approx(missed / expected)
    assert share > found.stats.missed_share  # nobody saw the one added
    unlimited = replace(sensor, most_range=np.inf)
    assert find_missed_share(marks, found.poses, found.measured, found.readings, unlimited) == 0.0


def random_drive(seed):
    """A drive twice past one wall of a room of landmarks, and what a random sensor read of them."""
    rng = np.random.default_rng(seed)
    run = cs.navigation.follow([(0, 0), (9, 0), (9, 6), (0, 6), (0, 1), (9, 1)], vehicle=cs.Unicycle())
    count = int(rng.integers(12, 30))
    marks = Landmarks(range(count), rng.uniform([-3, -3], [12, 9], (count, 2)))
    sensor = RangeBearing(rng.uniform(0.03, 0.15), rng.uniform(0.01, 0.04), most_range=rng.uniform(3, 6))
    return simulate(run, marks, sensor=sensor, rng=seed), sensor


def test_wrong_maps_of_simulated_drives_without_names_say_so_and_right_ones_do_not():
    sure, wrong, doubted, right = 0, 0, 0, 0
    for seed in range(300, 316):
        log, sensor = random_drive(seed)
        start = log.truth.poses[0]
        named = rmse(run_fast_slam(log, sensor=sensor, start=start, rng=seed), log)
        nameless = replace(log, readings=replace(log.readings, landmark=np.full(len(log.readings), -1)))
        for found in (
            run_ekf_slam(nameless, sensor=sensor, start=start),
            run_fast_slam(nameless, sensor=sensor, start=start, rng=seed),
        ):
            error = rmse(found, log)
            is_right, is_sure = error <= max(2 * named, 0.1), found.status == "localised"
            wrong += not is_right and error > 0.5
            sure += not is_right and error > 0.5 and is_sure
            right += is_right
            doubted += is_right and not is_sure
    assert wrong >= 4
    assert sure <= 0.2 * wrong
    assert doubted <= 0.2 * right


def test_a_heading_that_nobody_knows_makes_the_map_doubtful():
    log, sensor = twelve_landmarks(3)
    vague = RandomWalk(0, 0, 0, 0, 1e-4, 4.0)
    found = run_ekf_slam(log, sensor=sensor, start=log.truth.poses[0], noise=vague)
    turned = np.sqrt((found.covariances[:, 2, 2] - found.covariances[0, 2, 2]).max())
    assert (found.status == "ambiguous") == (turned > 1.0)
    assert turned > 1.0
    assert "heading was uncertain" in found.reason
