"""Laser SLAM on simulated buildings, and on the public logs where they are there."""

import time

import numpy as np
import pytest

import cspace as cs
from cspace.localization import LaserScanner, Log, Scans, simulate
from cspace.mobile import Odometry, RandomWalk
from data import shared_data

NOISE = RandomWalk(distance=2e-3, side=5e-4, turn=3e-3, drift=2e-3)


def building(seed, size=22.0, resolution=0.05):
    """A ring of corridors about a block, with rooms' niches and furniture along the walls."""
    n = int(size / resolution)
    blocked = np.ones((n, n), bool)
    wide = int(2.4 / resolution)
    edge = int(2.0 / resolution)
    blocked[edge:-edge, edge:-edge] = False
    blocked[edge + wide : -edge - wide, edge + wide : -edge - wide] = True
    rng = np.random.default_rng(seed)
    for _ in range(60):  # niches, at places of no pattern
        side, at, deep, long = (
            rng.integers(4),
            rng.integers(edge, n - edge - 60),
            rng.integers(4, 30),
            rng.integers(8, 50),
        )
        view = np.rot90(blocked, side)
        view[edge - deep : edge, at : at + long] = False
        inner = edge + wide
        if inner < at < n - inner - long:
            view[inner : inner + deep, at : at + long] = False
    return cs.OccupancyGrid(blocked, resolution=resolution)


def drive(size=22.0, laps=2):
    """Along the middles of the corridors, more than one lap."""
    low, high = 3.2, size - 3.2
    ring = [(low, low), (high, low), (high, high), (low, high)]
    return cs.navigation.follow([*(ring * laps), (low, low), (low + 3, low)], vehicle=cs.Unicycle())


def make_log(seed, laps=2, period=0.4):
    sensor = LaserScanner(field_of_view=np.pi, readings=180, most_range=12.0)
    raw = simulate(drive(laps=laps), building(seed), sensor, noise=NOISE, period=period, rng=seed)
    wrong = raw.odometry.corrected(distance=1.04, turn=1.03, drift=0.01)
    return Log(wrong, scans=raw.scans, truth=raw.truth)


@pytest.fixture(scope="module")
def log():
    return make_log(3)


@pytest.fixture(scope="module")
def found(log):
    return cs.slam(log)


def error(poses, log, times):
    return cs.ate(cs.localization.TimedPoses(times, poses), log.truth, align="se2").rmse


def test_a_building_is_mapped(log, found):
    assert found, found.reason
    assert found.status == "mapped"
    raw = error(found.stages["odometry"].poses, log, found.times)
    assert error(found.poses, log, found.times) < 0.06 < 0.5 < raw
    assert found.stats.accepted > 5
    assert list(found.stages) == ["odometry", "calibrated", "matched", "closed"]
    assert found.stats.factors[0] == pytest.approx(1 / 1.04, abs=0.01)
    assert all(loop.reason for loop in found.loops)
    assert np.isfinite(found.covariances).all()
    assert len(found.graph.edges) >= len(found) - 1
    assert found.map.probability.shape == found.map.shape


def test_the_answer_is_the_same_again(log, found):
    again = cs.slam(log, rng=5)
    assert np.array_equal(again.poses, found.poses)


@pytest.mark.parametrize("start", [(3.0, -40.0, 2.5), cs.pose_2d(xytheta=[-7e3, 2e4, -np.pi / 2])])
def test_another_start_moves_everything_as_a_whole(log, found, start):
    moved = cs.slam(log, start=start)
    first = np.asarray(start) if np.shape(start) == (3,) else cs.to_xytheta(start)
    assert list(moved.stages) == list(found.stages)
    assert np.array_equal(moved.poses[0], first)
    for name, stage in found.stages.items():
        here, there = cs.pose_2d(xytheta=stage.poses), cs.pose_2d(xytheta=moved.stages[name].poses)
        assert np.allclose(cs.pose_2d(xytheta=first) @ here, there, rtol=1e-15, atol=1e-11)
    assert np.array_equal(moved.poses, moved.stages["closed"].poses)
    assert np.array_equal(moved.poses, moved.graph.poses)
    assert np.array_equal(moved.covariances, found.covariances)
    assert np.array_equal(moved.graph.motions, found.graph.motions)
    assert all(np.array_equal(a.pose, b.pose) for a, b in zip(moved.loops, found.loops, strict=True))
    walls = [(s.map.probability > 0.65).sum() for s in (moved, found)]
    assert walls[0] == pytest.approx(walls[1], rel=0.05)


def test_a_start_that_is_no_pose_is_named(log):
    for bad in ((0.0, np.nan, 0.0), (1.0, 2.0), np.full((3, 3), 2.0), "origin"):
        for method in ("graph", "ekf", "fastslam"):
            with pytest.raises(cs.CspaceError, match="start"):
                cs.slam(log, method=method, start=bad)


def test_half_a_log(log):
    middle = log.scans.times[len(log.scans) // 2]
    half = Log(
        log.odometry.between(0, middle), scans=log.scans.subset(log.scans.times <= middle), truth=log.truth
    )
    s = cs.slam(half)
    assert error(s.poses, log, s.times) < 0.15


def reverse(log):
    """The log backwards in time: the robot backs along its way."""
    end = log.odometry.times[-1]
    scans = log.scans
    return Log(
        Odometry(end - log.odometry.times[::-1], -log.odometry.steps[::-1]),
        scans=Scans(
            (end - scans.times)[::-1], scans.ranges[::-1], scans.angles, scans.most, scans.T_base_laser
        ),
        truth=cs.localization.TimedPoses((end - log.truth.times)[::-1], log.truth.poses[::-1]),
    )


@pytest.mark.slow
@pytest.mark.parametrize("seed", [3, 5, 6])
def test_a_robot_that_backs_is_mapped_as_well(seed):
    # Strips of wall that come into view beside a robot that backs must not draw it forwards.
    back = reverse(make_log(seed))
    s = cs.slam(back)
    assert s
    assert error(s.poses, back, s.times) < 0.06
    assert error(s.stages["matched"].poses, back, s.times) < 0.25


def test_a_drift_beyond_the_first_window_is_closed():
    """One lap in the dark: the loop at its end is as far off as the odometry."""
    log = make_log(7, laps=2, period=0.4)
    scans = log.scans
    middle = scans.times[-1] / 2
    dark = (scans.times > 0.25 * middle) & (scans.times < 0.9 * middle)
    ranges = np.where(dark[:, None], np.inf, scans.ranges).astype(np.float32)
    blind = Log(log.odometry, scans=Scans(scans.times, ranges, scans.angles, scans.most), truth=log.truth)
    s = cs.slam(blind, calibrated=False)
    seen = ~dark
    gap = np.hypot(*(s.stages["matched"].poses - cs_align(s, log)).T[:2])[seen].max()
    assert gap > 2.5  # farther than the window of loops while all is well
    assert s.stats.accepted > 3
    rest = seen & (scans.times > middle)
    assert error(s.poses[rest], log, s.times[rest]) < 0.1
    both = np.concatenate([s.poses[: np.argmax(dark)], s.poses[rest]])
    times = np.concatenate([s.times[: np.argmax(dark)], s.times[rest]])
    assert error(both, log, times) < 0.25


def cs_align(s, log):
    """The true poses in the frame of the first one."""
    T = cs.pose_2d(xytheta=log.truth.at(s.times))
    moved = cs.spatial.inverse_pose_2d(T[:1]) @ T
    return np.asarray(cs.spatial.to_xytheta(moved))


def test_without_loops_the_drift_stays(log, found):
    open_ended = cs.slam(log, loops=False)
    assert not open_ended.loops
    assert open_ended.stats.accepted == 0
    assert error(open_ended.poses, log, open_ended.times) >= error(found.poses, log, found.times) - 0.02


def test_standing_still_moves_nothing():
    log = make_log(4, laps=1)
    scans = log.scans.subset(np.zeros(60, int))
    times = np.arange(60.0)
    still = Log(
        Odometry(times, np.zeros((59, 3))), scans=Scans(times, scans.ranges, scans.angles, scans.most)
    )
    s = cs.slam(still)
    assert s
    assert np.abs(s.poses).max() < 1e-3


def test_beams_one_after_the_other_are_moved_to_one_time():
    rng = np.random.default_rng(1)
    walls = rng.uniform(2, 6, 90)
    angles = np.linspace(-1.5, 1.5, 90)
    twist = np.array([0.5, 0.0, 0.8])
    T = cs.exp_se2(twist * (0.01 * np.arange(90))[:, None])
    world = np.stack([walls * np.cos(angles), walls * np.sin(angles)], -1)
    seen = np.einsum("kij,kj->ki", np.swapaxes(T[:, :2, :2], 1, 2), world - T[:, :2, 2])
    ranges, bearings = np.hypot(*seen.T), np.arctan2(seen[:, 1], seen[:, 0])
    scans = Scans([0.0], ranges[None], bearings, time_increment=0.01)
    odometry = Odometry.from_twists([0.0, 2.0], [twist])
    points, first = cs.localization.scans.points.place_beams(scans, odometry, 20.0)
    assert first.tolist() == [0, 90]
    assert np.allclose(points, world, atol=1e-5)


def test_time_limits_are_kept(log):
    begin = time.perf_counter()
    s = cs.slam(log, time_limit=0.1)
    assert time.perf_counter() - begin < 1.5
    assert not s
    assert s.status == "time_limit"
    assert len(s.times) == len(s.poses) >= 1


def test_progress_rises(log):
    shares = []
    cs.slam(log, progress=shares.append)
    assert shares == sorted(shares)
    assert shares[-1] == 1.0


def test_one_scan_is_a_map(log):
    one = Log(log.odometry, scans=log.scans[5])
    s = cs.slam(one)
    assert s
    assert s.poses.tolist() == [[0, 0, 0]]
    assert len(s.graph.edges) == 0


def test_a_robot_that_sees_nothing_any_more_is_lost(log):
    ranges = log.scans.ranges.copy()
    ranges[-40:] = np.inf
    s = cs.slam(
        Log(log.odometry, scans=Scans(log.scans.times, ranges, log.scans.angles, log.scans.most)), loops=False
    )
    assert not s
    assert s.status == "lost"
    assert s.stats.unmatched >= 40


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda log: Log(log.odometry), "no scans"),
        (lambda log: Log(Odometry([], np.zeros((0, 3))), scans=log.scans), "no odometry"),
        (lambda log: Log(Odometry(log.odometry.times + 1e6, log.odometry.steps), scans=log.scans), "outside"),
        (
            lambda log: Log(log.odometry, scans=Scans([1.0, 2.0], np.full((2, 3), np.nan), [0, 1, 2])),
            "no beam",
        ),
        (lambda log: "intel.log", "read_log"),
    ],
)
def test_bad_logs_are_named(log, change, words):
    with pytest.raises(cs.CspaceError, match=words):
        cs.slam(change(log))


def test_bad_arguments_are_named(log):
    with pytest.raises(cs.CspaceError, match="graph"):
        cs.slam(log, method="grahp")
    with pytest.raises(cs.CspaceError, match="resolution"):
        cs.slam(log, resolution=0)


@pytest.mark.slow
@pytest.mark.parametrize(("name", "most"), [("intel", 0.10), ("freiburg-079", 0.15)])
def test_public_logs_from_raw_odometry(name, most):
    log = cs.read_log(shared_data() / "localization" / "carmen" / f"{name}-corrected.log.gz")
    s = cs.slam(log)
    assert s
    assert cs.ate(s, log.truth, align="se2").rmse < most
