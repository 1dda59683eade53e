"""Monte Carlo localisation: draws, weights, resampling, laws of the filter, recovery, bad input."""

from __future__ import annotations

import hashlib
import itertools
import os
import subprocess
import sys

import numpy as np
import pytest

import cspace as cs
from cspace import _core
from cspace.errors import InputError, InputTypeError, UnknownNameError
from cspace.localization import (
    HistogramFilter,
    Landmarks,
    LaserScanner,
    ParticleFilter,
    RangeBearing,
    Readings,
    Scans,
    simulate,
)
from cspace.localization.filters.rows import relate_rows
from cspace.localization.particles.beam_model import CELL, BeamTable
from cspace.localization.particles.models import Judgement, ScanModel
from cspace.localization.particles.recovery import FIRST_SCORES, ScoreMonitor
from cspace.localization.particles.thinning import thin_ends
from cspace.maps import OccupancyGrid
from cspace.mobile import Odometry, RandomWalk

CLEAN = LaserScanner(hit=1.0, short=0.0, max=0.0, rand=1e-6, range_sigma=0.02)


def building(seed=3, side=0.1):
    """Rooms with doors and furniture, without symmetry."""
    rng = np.random.default_rng(seed)
    blocked = np.zeros((160, 200), dtype=bool)
    blocked[[0, -1]] = blocked[:, [0, -1]] = True
    blocked[70:73] = blocked[:, 90:92] = True
    for row, column in ((70, 30), (70, 150), (30, 90), (120, 90)):
        blocked[
            row : row + 12 if column in (90,) else row + 3, column : column + (2 if column == 90 else 14)
        ] = 0
    for _ in range(25):
        row, column = rng.integers(4, 150), rng.integers(4, 190)
        blocked[row : row + rng.integers(3, 9), column : column + rng.integers(3, 9)] = True
    return OccupancyGrid(blocked, side)


def corridor(side=0.1):
    """A room that looks the same after half a turn."""
    blocked = np.zeros((40, 160), dtype=bool)
    blocked[[0, -1]] = blocked[:, [0, -1]] = True
    blocked[10:14, 40:44] = blocked[26:30, 116:120] = True
    return OccupancyGrid(blocked, side)


def route(points, speed=0.5, dt=0.1):
    """Poses along a polyline: straight lines, turns on the spot."""
    poses = []
    for a, b in itertools.pairwise(points):
        a, b = np.array(a, float), np.array(b, float)
        n = max(int(np.hypot(*(b - a)) / (speed * dt)), 1)
        heading = np.arctan2(*(b - a)[::-1])
        if poses:
            turn = (heading - poses[-1][2] + np.pi) % (2 * np.pi) - np.pi
            poses += [[*a, poses[-1][2] + turn * k / 10] for k in range(1, 11)]
        poses += [[*(a + (b - a) * k / n), heading] for k in range(n + (not poses))]
    poses = np.array(poses)
    times = dt * np.arange(len(poses))

    class Run:
        pass

    run = Run()
    run.times, run.poses = times, poses
    return run


WAY = [(2.0, 2.0), (7.5, 2.0), (7.5, 5.5), (3.6, 6.2), (3.6, 9.5), (6.5, 13.0)]


def test_no_scan_fits_inside_of_what_is_solid():
    """Beams end on surfaces. Solid are cells that a ROS map does not know, and the ground about a house."""
    rng = np.random.default_rng(2)
    for _ in range(8):
        blocked = np.ones((90, 120), dtype=bool)
        top, left = rng.integers(25, 40, 2)
        blocked[top : top + 40, left : left + 50] = False
        grid = OccupancyGrid(blocked, 0.1)
        inside = grid.origin + 0.1 * np.array([left + 25.0, top + 20.0])
        angles = np.linspace(-np.pi, np.pi, 60)
        reach = cs.maps.cast_rays(grid, inside, angles)
        pf = ParticleFilter(grid, start=(*inside, 0.0), rng=1)
        scan = Scans([0.0], reach[None], angles)
        pf.update(scan)
        model = ScanModel(grid, LaserScanner())
        cloud = _core.ParticleCloud(2, 1)
        cloud.place(np.array([[*(inside - 10.0), 0.0], [1.0, 1.0, 0.4]]))
        solid = model.weigh(cloud, Scans([0.0], np.full((1, 60), 0.3), angles), 0.0, 1)
        assert pf.score > 0.85
        assert solid < 0.2


# --- draws ----------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("counter", "key", "expected"),
    [
        ([0] * 4, [0] * 2, [0x6627E8D5, 0xE169C58D, 0xBC57AC4C, 0x9B00DBD8]),
        ([0xFFFFFFFF] * 4, [0xFFFFFFFF] * 2, [0x408F276D, 0x41C83B0E, 0xA20BC7C6, 0x6D5451FD]),
        (
            [0x243F6A88, 0x85A308D3, 0x13198A2E, 0x03707344],
            [0xA4093822, 0x299F31D0],
            [0xD16CFE09, 0x94FDCCEB, 0x5001E420, 0x24126EA1],
        ),
    ],
)
def test_draws_are_those_published_for_philox(counter, key, expected):
    drawn = _core._draw_counter_words(np.array(counter, np.uint32), np.array(key, np.uint32))
    assert drawn.tolist() == expected


def test_normal_draws_have_the_moments_of_a_normal_distribution():
    z = _core.ParticleCloud(200_000, 11).draw_normals(200_000)
    assert np.abs(z.mean(axis=0)).max() < 5 / np.sqrt(len(z))
    assert np.allclose(np.cov(z.T), np.eye(3), atol=0.02)
    assert np.allclose((z**4).mean(axis=0), 3.0, atol=0.15)


def test_moved_particles_have_the_covariance_of_the_step():
    Q = np.array([[4e-3, 1e-3, -5e-4], [1e-3, 2e-3, 1e-3], [-5e-4, 1e-3, 3e-3]])
    cloud = _core.ParticleCloud(100_000, 5)
    start, step = np.array([3.0, -2.0, 2.9]), np.array([0.5, 0.1, 0.6])
    cloud.place(np.tile(start, (100_000, 1)))
    cloud.move(step, Q.ravel(), 1)
    mean = cs.to_xytheta(cs.pose_2d(xytheta=start) @ cs.pose_2d(xytheta=step))
    T = cs.inverse_pose_2d(cs.pose_2d(xytheta=mean)) @ cs.pose_2d(xytheta=cloud.poses())
    w = cs.log_se2(T)
    assert np.allclose(np.cov(w.T), Q, atol=1e-4)
    assert np.allclose(w.mean(axis=0), 0.0, atol=1e-3)


# --- weights and resampling -----------------------------------------------------------------------------


def test_scores_are_means_of_the_bytes_where_beams_end():
    rng = np.random.default_rng(0)
    # Blocks of equal bytes, so that the rounding of floats at borders of cells hardly matters.
    field = np.kron(rng.integers(0, 256, (31, 37)), np.ones((20, 20), int)).astype(np.uint8)
    poses, ends = rng.uniform([-3, -3, -7], [40, 34, 7], (3000, 3)), rng.uniform(-8, 8, (60, 2))
    cloud = _core.ParticleCloud(3000, 0)
    cloud.place(poses)
    scores = cloud.score(_core.ScoreMap(field, 0.05, (0.5, -0.25), 9), ends, 2)
    T = cs.pose_2d(xytheta=poses)
    p = np.einsum("nij,mj->nmi", T[:, :2, :2], ends) + T[:, None, :2, 2]
    cells = np.floor((p - [0.5, -0.25]) / 0.05).astype(int)
    inside = ((cells >= 0) & (cells < field.shape[::-1])).all(axis=-1)
    column, row = np.where(inside[..., None], cells, 0).transpose(2, 0, 1)
    expected = np.where(inside, field[row, column], 9).mean(axis=1) / 255
    assert np.abs(scores - expected).max() < 3 / 60
    assert np.abs(scores - expected).mean() < 1e-4


def test_weights_are_those_of_floating_point():
    rng = np.random.default_rng(1)
    logs = rng.uniform(-30, 0, 5000)
    cloud = _core.ParticleCloud(5000, 0)
    cloud.place(np.zeros((5000, 3)))
    cloud.add_logs(0.5 * logs)
    cloud.add_logs(0.5 * logs)
    expected = np.exp(logs - logs.max())
    quanta = 2 * 2.0**-32 / expected.sum()
    assert np.allclose(cloud.weights(), expected / expected.sum(), rtol=3e-6, atol=quanta)
    assert cloud.effective_count() == pytest.approx(expected.sum() ** 2 / (expected**2).sum(), rel=1e-4)


def test_all_weights_zero_keep_the_particles():
    cloud = _core.ParticleCloud(100, 0)
    cloud.place(np.zeros((100, 3)))
    cloud.add_logs(np.full(100, -np.inf))
    assert np.allclose(cloud.weights(), 0.01)
    cloud.add_logs(np.full(100, np.nan))
    assert cloud.effective_count() == pytest.approx(100)
    cloud.resample(100, 0.05, 2.326)
    assert len(cloud) == 100


def test_systematic_resampling_keeps_shares_to_one_particle():
    rng = np.random.default_rng(2)
    for n in (100, 777, 5000):
        logs = np.log(rng.random(50))
        cloud = _core.ParticleCloud(n, int(rng.integers(2**40)))
        poses = np.column_stack([np.arange(50) * 1e-3, np.zeros(50), np.zeros(50)])
        cloud.place(poses)
        cloud.add_logs(logs)
        shares = cloud.weights()
        cloud.resample(n, 0.05, 2.326)
        counts = np.bincount(np.round(cloud.poses()[:, 0] * 1e3).astype(int), minlength=50)
        assert counts.sum() == n
        assert np.abs(counts - n * shares).max() < 1


@pytest.mark.parametrize(("bins", "count"), [(10, 217), (50, 749), (100, 1346), (500, 5754), (1000, 11059)])
def test_numbers_of_particles_are_those_of_the_published_formula(bins, count):
    assert round(_core._count_particles_for_bins(bins, 0.05, 2.326)) == count


def test_one_bin_needs_the_least_number_of_particles():
    assert _core._count_particles_for_bins(1, 0.05, 2.326) == 0
    cloud = _core.ParticleCloud(5000, 0)
    cloud.place(np.tile([0.1, 0.1, 0.1], (5000, 1)))
    assert cloud.resample(200, 0.05, 2.326) == 1
    assert len(cloud) == 200
    spread = _core.ParticleCloud(5000, 0)
    spread.place(np.random.default_rng(0).uniform([0, 0, -3], [10, 10, 3], (1000, 3)))
    bins = spread.resample(200, 0.05, 2.326)
    assert len(spread) == min(5000, int(np.ceil(_core._count_particles_for_bins(bins, 0.05, 2.326))))


def test_modes_are_means_and_covariances_across_half_a_turn():
    rng = np.random.default_rng(4)
    a = np.array([2.0, 3.0, np.pi]) + rng.normal(0, [0.1, 0.05, 0.05], (6000, 3))
    b = np.array([8.0, 3.0, 0.3]) + rng.normal(0, 0.05, (2000, 3))
    cloud = _core.ParticleCloud(8000, 0)
    cloud.place(np.concatenate([a, b]))
    poses, covariances, shares = cloud.find_modes()
    assert len(poses) >= 2
    assert np.allclose(shares[:2], [0.75, 0.25], atol=0.01)
    assert np.allclose(relate_rows(np.array([2.0, 3.0, np.pi]), poses[0]), 0, atol=0.01)
    assert np.allclose(poses[1], [8.0, 3.0, 0.3], atol=0.01)
    assert np.allclose(covariances[0].reshape(3, 3), np.diag([0.01, 0.0025, 0.0025]), atol=6e-4)


PROGRAM = """
import hashlib, sys
import numpy as np
sys.path.insert(0, {tests!r})
import cspace as cs
from test_particles import building, route, WAY, CLEAN
from cspace.localization import simulate
grid = building()
log = simulate(route(WAY), grid, CLEAN, rng=3)
run = cs.localize(log, grid, filter="mcl", sensor=CLEAN, n=3000, threads={threads}, rng=5)
print(hashlib.sha256(run.particles.tobytes() + run.poses.tobytes()).hexdigest())
"""


@pytest.mark.slow
def test_the_same_seed_gives_the_same_bits_on_every_instruction_set_and_thread_count():
    found = set()
    for isa in ("baseline", "avx2", ""):
        for threads in (1, 4):
            program = PROGRAM.format(tests=os.path.dirname(__file__), threads=threads)
            environment = {**os.environ, "CSPACE_ISA": isa}
            done = subprocess.run(
                [sys.executable, "-c", program], capture_output=True, text=True, env=environment, check=True
            )
            found.add(done.stdout.strip())
    assert len(found) == 1
    assert len(found.pop()) == len(hashlib.sha256().hexdigest())


# --- models of sensors ----------------------------------------------------------------------------------


def test_the_beam_model_is_normalised():
    scanner = LaserScanner(model="beam", most_range=10.0, range_sigma=0.2)
    table = BeamTable(scanner)
    p = np.exp(table.logs)
    for wall in (1.0, 5.0, 9.5):
        row = p[round(wall / CELL)]
        z = row[: table.count]
        total = CELL * (z.sum() - 0.5 * (z[0] + z[-1])) + row[-1]
        assert total == pytest.approx(1.0, abs=0.01)
    none = p[-1]
    assert none[-1] > 0.85


def test_the_beam_model_localises():
    grid, scanner = building(), LaserScanner(model="beam", most_range=15.0, range_sigma=0.05)
    log = simulate(route(WAY), grid, scanner, rng=2)
    run = cs.localize(log, grid, filter="mcl", sensor=scanner, start=log.truth.poses[0], rng=1)
    error = (run.at(log.truth.times) - log.truth.poses)[:, :2]
    assert run
    assert np.sqrt((error**2).sum(axis=1).mean()) < 0.12


def test_thinned_ends_are_spread_evenly_along_walls():
    near = np.column_stack([np.linspace(0, 1, 200), np.zeros(200)])
    far = np.column_stack([np.linspace(5, 9, 100), np.ones(100)])
    rows = thin_ends(np.concatenate([near, far]), 45)
    assert len(rows) <= 45
    assert (rows >= 200).sum() > 2.5 * (rows < 200).sum()


# --- laws of the filter ---------------------------------------------------------------------------------


def test_many_particles_agree_with_the_kalman_filter():
    landmarks = Landmarks(np.arange(4), np.array([[5.0, 5.0], [-5.0, 4.0], [4.0, -6.0], [0.0, 7.0]]))
    sensor = RangeBearing(range_sigma=0.3, bearing_sigma=0.1)
    times = np.arange(0.0, 8.0, 0.1)
    true = Odometry.from_twists(times, np.tile([0.5, 0.0, 0.2], (len(times), 1))).dead_reckoning()
    noise = RandomWalk(distance=5e-3, side=1e-3, turn=1e-2, drift=5e-3)
    log = simulate(true, landmarks, sensor, noise=noise, period=1.0, rng=1)
    P = np.diag([0.04, 0.04, 0.01])
    shared = {"sensor": sensor, "noise": noise, "start": (0.0, 0.0, 0.0), "start_covariance": P}
    kalman = cs.localize(log, landmarks, filter="ekf", **shared)
    cloud = cs.localize(log, landmarks, filter="mcl", n=100_000, rng=3, **shared)
    at = np.flatnonzero(np.isin(kalman.times, cloud.times[cloud.measured]))
    ours = np.searchsorted(cloud.times, kalman.times[at])
    deviation = np.sqrt(kalman.covariances[at][:, [0, 1, 2], [0, 1, 2]])
    difference = np.abs(relate_rows(kalman.poses[at], cloud.poses[ours]))
    assert (difference < 0.35 * deviation + 0.005).all()
    ratio = cloud.covariances[ours][:, [0, 1, 2], [0, 1, 2]] / deviation**2
    assert (ratio > 0.6).all()
    assert (ratio < 1.6).all()


@pytest.mark.slow
def test_standing_for_an_hour_neither_collapses_nor_drifts():
    grid = building()
    scans = simulate(route(WAY), grid, CLEAN, rng=3).scans
    start = route(WAY).poses[0]
    pf = ParticleFilter(grid, sensor=CLEAN, start=start, rng=1)
    for _ in range(4):
        pf.update(scans[0])
    before, spread = pf.pose, np.sqrt(np.diag(pf.covariance))
    distinct = len(np.unique(pf.particles, axis=0))
    rng = np.random.default_rng(0)
    jitter = rng.normal(0, 2e-5, (3600, 3))
    for k, noise in enumerate(jitter):
        pf.predict(noise - jitter[k - 1], 1.0)
        pf.update(scans[0])
    assert np.abs(relate_rows(before, pf.pose)).max() < 0.01
    assert np.allclose(np.sqrt(np.diag(pf.covariance)), spread, rtol=0.3)
    assert len(np.unique(pf.particles, axis=0)) > 0.9 * distinct
    assert pf.status == "localised"


def test_a_split_step_is_the_whole_step():
    grid = building()
    a = ParticleFilter(grid, start=(5, 4, 0.3), n=20_000, rng=2)
    b = ParticleFilter(grid, start=(5, 4, 0.3), n=20_000, rng=3)
    a.predict((0.5, 0.0, 0.4), 1.0)
    half = cs.to_xytheta(cs.exp_se2(0.5 * cs.log_se2(cs.pose_2d(xytheta=[0.5, 0.0, 0.4]))))
    b.predict(half, 0.5), b.predict(half, 0.5)
    assert np.abs(relate_rows(a.pose, b.pose)).max() < 0.01
    assert np.allclose(a.covariance, b.covariance, atol=8e-4)


# --- global start, kidnapping, ambiguity, glass ---------------------------------------------------------


def test_a_global_start_finds_the_robot():
    grid = building()
    log = simulate(route(WAY), grid, CLEAN, rng=3)
    for seed in range(3):
        run = cs.localize(log, grid, filter="mcl", sensor=CLEAN, rng=seed)
        error = np.hypot(*(run.at(log.truth.times) - log.truth.poses)[-50:, :2].T)
        assert run.status == "localised"
        assert error.max() < 0.2
        assert run.events[0].kind == "search"


def test_a_kidnapped_robot_is_found_again():
    grid = building()
    log = simulate(route(WAY), grid, CLEAN, rng=3)
    pf = ParticleFilter(grid, sensor=CLEAN, start=(17.0, 12.0, 1.0), rng=4)
    poses = log.truth.at(log.scans.times)
    for k in range(12):
        if k:
            pf.predict(relate_rows(poses[k - 1], poses[k]))
        pf.update(log.scans[k])
    assert pf.status == "localised"
    assert np.hypot(*(pf.pose - poses[11])[:2]) < 0.2
    assert any(event.kind == "search" for event in pf.events)


def test_a_kidnapping_while_standing_is_noticed():
    grid = building()
    log = simulate(route(WAY), grid, CLEAN, rng=3)
    poses = log.truth.at(log.scans.times)
    pf = ParticleFilter(grid, sensor=CLEAN, start=poses[0], rng=4)
    for _ in range(5):
        pf.update(log.scans[0])
    for _ in range(6):
        pf.update(log.scans[20])
    assert np.hypot(*(pf.pose - poses[20])[:2]) < 0.2


def test_a_symmetric_corridor_is_ambiguous():
    grid = corridor()
    run = route([(3.0, 2.0), (8.0, 2.0)])
    log = simulate(run, grid, CLEAN, rng=1)
    found = cs.localize(log, grid, filter="mcl", sensor=CLEAN, rng=2)
    assert found.status == "ambiguous"
    assert not found
    assert len(found.modes) == 2
    a, b = found.modes
    assert np.allclose(a.pose[:2] + b.pose[:2], [16.0, 4.0], atol=0.3)
    truth = log.truth.poses[-1]
    assert min(np.hypot(*(mode.pose - truth)[:2]) for mode in found.modes) < 0.25
    assert "2 modes" in found.reason


def test_glass_changes_nothing():
    grid = building()
    pf = ParticleFilter(grid, start=(5.0, 4.0, 0.0), rng=1)
    before = pf.particles
    scan = Scans([0.0], np.full((1, 60), np.inf), np.linspace(-1.5, 1.5, 60), 30.0)
    for _ in range(20):
        pf.update(scan)
    assert np.array_equal(before, pf.particles)
    assert pf.updates == 0
    assert pf.status == "localised"


def test_scans_that_fit_nowhere_make_it_lost():
    grid = building()
    pf = ParticleFilter(grid, start=(5.0, 4.0, 0.0), rng=1)
    angles = np.linspace(-np.pi, np.pi, 90)[:, None]
    rng = np.random.default_rng(0)
    for _ in range(6):
        pf.predict((0.2, 0.0, 0.0))
        pf.update(rng.uniform(0.5, 9.0, (90, 1)) * np.concatenate([np.cos(angles), np.sin(angles)], axis=1))
    assert pf.status == "lost"
    assert not pf
    assert any(event.kind == "lost" for event in pf.events)


def test_readings_of_landmarks_localise_from_anywhere():
    landmarks = Landmarks(
        np.arange(5), np.array([[2.0, 2.0], [9.0, 3.0], [7.0, 11.0], [1.0, 9.0], [5.0, 6.5]])
    )
    sensor = RangeBearing(range_sigma=0.1, bearing_sigma=0.03)
    log = simulate(route(WAY), landmarks, sensor, rng=3)
    run = cs.localize(log, landmarks, filter="mcl", sensor=sensor, rng=2)
    error = np.hypot(*(run.at(log.truth.times) - log.truth.poses)[-60:, :2].T)
    assert run
    assert error.max() < 0.3


def test_the_histogram_filter_localises_and_admits_ambiguity():
    grid = building()
    log = simulate(route(WAY[:4]), grid, CLEAN, rng=3)
    run = cs.localize(log, grid, filter="histogram", sensor=CLEAN)
    error = np.hypot(*(run.at(log.truth.times) - log.truth.poses)[-50:, :2].T)
    assert run
    assert error.max() < 0.35
    twin = corridor()
    log = simulate(route([(3.0, 2.0), (6.0, 2.0)]), twin, CLEAN, rng=1)
    found = cs.localize(log, twin, filter="histogram", sensor=CLEAN)
    assert found.status == "ambiguous"
    assert len(found.modes) >= 2


def test_a_step_of_the_histogram_filter_moves_mean_and_covariance():
    grid = building()
    hf = HistogramFilter(grid, start=(5.0, 4.0, 0.5), headings=72, resolution=0.2)
    before = hf.covariance
    Q = np.diag([0.04, 0.04, 0.01])
    hf.predict((0.6, 0.1, 0.3), covariance=Q)
    hf._move()
    expected = cs.to_xytheta(cs.pose_2d(xytheta=[5.0, 4.0, 0.5]) @ cs.pose_2d(xytheta=[0.6, 0.1, 0.3]))
    assert np.abs(relate_rows(expected, hf.pose)).max() < 0.06
    A = cs.adjoint_2d(cs.inverse_pose_2d(cs.pose_2d(xytheta=[0.6, 0.1, 0.3])))
    assert np.allclose(np.diag(hf.covariance), np.diag(A @ before @ A.T + Q), rtol=0.3)
    assert hf.belief.sum() == pytest.approx(1.0)


def test_the_threshold_is_learned_from_scores_of_the_log():
    monitor = ScoreMonitor(0.7)
    for _ in range(FIRST_SCORES):
        monitor.add(Judgement(0.65, 0.65), True)
    assert monitor.threshold == pytest.approx(0.8 * 0.65)
    assert not monitor.wants_search(Judgement(0.6, 0.6))
    assert monitor.wants_search(Judgement(0.5, 0.5))
    assert monitor.wants_search(Judgement(0.9, 0.1))  # its beams go through walls


# --- bad input ------------------------------------------------------------------------------------------


def test_bad_input_is_named():
    grid = building()
    with pytest.raises(InputError, match="n is 10000000"):
        ParticleFilter(grid, n=10_000_000)
    with pytest.raises(InputError, match="beam model"):
        ParticleFilter(grid, sensor=LaserScanner(model="beam"), n=1000)
    with pytest.raises(InputError, match="fewer than the least"):
        ParticleFilter(grid, n=1000, most=500)
    with pytest.raises(InputError, match="off the map"):
        ParticleFilter(grid, start=(-5.0, 2.0, 0.0))
    walls = np.zeros((60, 60), bool)
    walls[20:40, 20:40] = True
    with pytest.raises(InputError, match="in a wall"):
        ParticleFilter(OccupancyGrid(walls, 0.1), start=(3.0, 3.0, 0.0))
    with pytest.raises(InputError, match="no free cells"):
        ParticleFilter(OccupancyGrid(np.ones((5, 5), bool), 0.1))
    with pytest.raises(InputTypeError, match="grid is a str"):
        ParticleFilter("map.yaml")
    with pytest.raises(InputTypeError, match="needs sensor=LaserScanner"):
        ParticleFilter(grid, sensor=RangeBearing())
    with pytest.raises(InputTypeError, match="motion is a"):
        ParticleFilter(grid, motion=3.0)
    pf = ParticleFilter(grid, start=(5.0, 4.0, 0.0), rng=0)
    with pytest.raises(InputError, match="increment"):
        pf.predict((0.1, np.nan, 0.0))
    with pytest.raises(InputError, match="these are 2"):
        pf.update(Scans([0.0, 1.0], np.ones((2, 5)), np.zeros(5)))
    with pytest.raises(InputError, match="seconds"):
        pf.predict((0.1, 0.0, 0.0), -1.0)
    with pytest.raises(UnknownNameError, match="did you mean 'beam'"):
        LaserScanner(model="beams")
    with pytest.raises(InputTypeError, match="takes Readings"):
        ParticleFilter(Landmarks([0], [(1.0, 1.0)])).update(np.zeros((5, 2)))
    with pytest.raises(InputError, match="resolution"):
        HistogramFilter(grid, resolution=0.02)


def test_logs_without_what_a_map_needs_are_named():
    grid = building()
    log = simulate(route(WAY[:2]), grid, CLEAN, rng=3)
    with pytest.raises(InputError, match="needs a map"):
        cs.localize(log, filter="mcl")
    with pytest.raises(InputError, match="no readings"):
        cs.localize(log, Landmarks([0], [(1.0, 1.0)]), filter="mcl")
    with pytest.raises(InputTypeError, match="filter='mcl'"):
        cs.localize(log, grid, filter="ekf", start=(0, 0, 0))
    with pytest.raises(cs.errors.TimeLimitError):
        cs.localize(log, grid, filter="mcl", time_limit=1e-9)


def test_unnamed_readings_count_for_the_most_likely_landmark():
    landmarks = Landmarks([0, 1], [(2.0, 0.0), (0.0, 2.0)])
    pf = ParticleFilter(landmarks, start=(0.0, 0.0, 0.0), n=5000, rng=1)
    pf.update(Readings([0.0, 0.0], [-1, -1], [2.0, 2.0], [0.0, np.pi / 2]))
    assert np.hypot(*pf.pose[:2]) < 0.1


def test_a_million_particles_take_less_than_a_hundred_megabytes():
    program = """
import resource
import numpy as np
from cspace import _core
cloud = _core.ParticleCloud(10, 0)
before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
cloud = _core.ParticleCloud(1_000_000, 0)
poses = np.random.default_rng(0).uniform([0, 0, -3], [30, 30, 3], (1_000_000, 3))
cloud.place(poses)
placed = poses.nbytes
cloud.move(np.array([0.1, 0.0, 0.0]), np.diag([1e-3] * 3).ravel(), 1)
field = _core.ScoreMap(np.full((600, 600), 7, np.uint8), 0.05, (0.0, 0.0), 0)
cloud.add_scan(field, np.random.default_rng(1).uniform(-5, 5, (60, 2)), 0.001, 1)
cloud.resample(1_000_000, 0.05, 2.326)
cloud.find_modes()
print((resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before) * 1024 - 2 * placed)
"""
    pytest.importorskip("resource")
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    assert int(done.stdout) < 100e6
