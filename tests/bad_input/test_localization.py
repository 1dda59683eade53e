"""Hostile values for every argument of vehicles, localisation and SLAM: an answer, or an error of ours.

No call may crash the interpreter, leak an error of numpy or Python, warn, or leave a filter without a pose.
"""

from __future__ import annotations

import inspect
import warnings

import numpy as np
import pytest

import cspace as cs
from cspace import localization, mobile
from cspace.errors import CspaceError
from data import ROOT

LOG = cs.read_log(ROOT / "examples/small_drive")
BLOCKED = np.zeros((40, 60), dtype=bool)
BLOCKED[[0, -1]] = BLOCKED[:, [0, -1]] = BLOCKED[10:20, 20:30] = True
GRID = cs.OccupancyGrid(BLOCKED, 0.1)
RUN = cs.navigation.follow([(0.5, 0.5), (4, 0.5), (4, 3)], vehicle=cs.Unicycle(), world=GRID)
SEEN = localization.simulate(RUN, GRID, cs.LaserScanner(most_range=6.0, readings=61), period=1.0, rng=1)
POINTS = SEEN.scans.points(0)
BASE = cs.DifferentialDrive(0.05, 0.3)
STEPS = LOG.odometry.between(0.0, 3.0)
GRAPH = {
    "poses": [[0, 0, 0], [1, 0, 0], [1, 1, 1.57]],
    "edges": [(0, 1), (1, 2)],
    "motions": [[1, 0, 0], [0, 1, 1.57]],
    "information": np.eye(3),
}
SIGHTED = {"landmarks": [[1, 1.0]], "sightings": [(0, 0), (1, 0)], "points": [[1, 1.0], [0, 1]]}

HOSTILE = [
    None,
    True,
    0,
    -1,
    3,
    1e308,
    -1e-300,
    1e-9,
    float("nan"),
    float("inf"),
    -float("inf"),
    2**70,
    "x",
    b"x",
    [],
    {},
    set(),
    object(),
    1j,
    np.zeros(0),
    np.zeros((0, 3)),
    np.zeros(3),
    -np.eye(3),
    np.full(3, np.nan),
    np.full((3, 3), np.inf),
    np.zeros((5, 2)),
    np.zeros((2, 3, 3)),
    np.zeros((5, 3), complex),
    np.array(["a", "b", "c"]),
    np.array([None] * 3),
    [[1, 2], [3]],
    [1, "a"],
    [1e200] * 3,
    np.zeros((1, 1, 1, 1)),
    np.datetime64("2020"),
    LOG,
    STEPS,
    LOG.truth,
    LOG.landmarks,
    LOG.readings,
    SEEN.scans,
    GRID,
    BASE,
    localization.RangeBearing(),
    localization.RangeBearing,
]


def grow():
    graph = cs.IncrementalGraph([0, 0, 0])
    graph.add(0, 1, [1, 0, 0], np.eye(3))
    graph.add_sighting(0, 3, [1, 1.0], np.eye(2))
    return graph


def call(make, method, **arguments):
    """A method of a fresh object, which must still have a pose afterwards."""

    def run(**given):
        owner = make()
        answer = getattr(owner, method)(**given)
        repr(owner)
        if isinstance(getattr(owner, "pose", None), np.ndarray):
            assert np.isfinite(owner.pose).all()
            assert np.isfinite(owner.covariance).all()
        return answer

    bound = getattr(make(), method)
    run.__signature__, run.__qualname__ = inspect.signature(bound), bound.__qualname__
    return run, arguments


def filters():
    place = {"start": (1, 1, 0)}
    makers = {
        "particles": (lambda: cs.ParticleFilter(GRID, rng=1, **place), {"scan": SEEN.scans[0]}),
        "histogram": (lambda: localization.HistogramFilter(GRID, **place), {"scan": SEEN.scans[0]}),
        "ekf": (localization.EkfSlam, {"readings": [[1, 2.0, 0.3]]}),
        "fast": (lambda: localization.FastSlam(n=5, rng=1), {"readings": [[1, 2.0, 0.3]]}),
    }
    for make, seen in makers.values():
        yield call(make, "predict", increment=[0.1, 0, 0], dt=0.1)
        yield call(make, "update", **seen)


CALLS = [
    (localization.Compass, {}),
    (localization.Gps, {}),
    (localization.RangeBearing, {}),
    (localization.LaserScanner, {}),
    (localization.Landmarks, {"names": [1, 2], "points": [[0, 0], [1, 1]]}),
    (localization.Readings, {"times": [0, 1], "landmark": [1, 2], "range": [1, 2], "bearing": [0, 1]}),
    (localization.Headings, {"times": [0, 1], "angles": [1, 2]}),
    (localization.Fixes, {"times": [0, 1], "points": [[1, 2], [2, 2]]}),
    (localization.Scans, {"times": [0, 1], "ranges": np.ones((2, 3)), "angles": [-1, 0, 1]}),
    (localization.TimedPoses, {"times": [0, 1], "poses": np.zeros((2, 3))}),
    (localization.EkfSlam, {}),
    (localization.FastSlam, {"n": 10}),
    (localization.HistogramFilter, {"grid": GRID}),
    (localization.ParticleFilter, {"grid": GRID}),
    (localization.ParticleFilter, {"grid": LOG.landmarks, "start": (0, 0, 0)}),
    (localization.IncrementalGraph, {"pose": [0, 0, 0]}),
    (localization.ate, {"estimate": LOG.truth, "truth": LOG.truth}),
    (localization.rpe, {"estimate": LOG.truth, "truth": LOG.truth}),
    (
        localization.calibrate_sensor,
        {"readings": LOG.readings, "landmarks": LOG.landmarks, "reference": LOG.truth},
    ),
    (localization.localize, {"log": LOG}),
    (localization.localize, {"log": SEEN, "landmarks": GRID, "filter": "mcl", "start": (1, 1, 0), "n": 50}),
    (localization.match_scan, {"scan": POINTS, "field": POINTS}),
    (localization.match_scan, {"scan": POINTS, "field": GRID.likelihood_field()}),
    (localization.match_scan, {"scan": POINTS, "field": POINTS, "method": "icp"}),
    (localization.run_ekf_slam, {"log": LOG}),
    (localization.run_fast_slam, {"log": LOG, "n": 10}),
    (localization.search_pose, {"scan_points": POINTS, "field": GRID.likelihood_field()}),
    (localization.simulate, {"run": RUN, "landmarks": LOG.landmarks}),
    (localization.simulate, {"run": RUN, "landmarks": GRID}),
    (localization.slam, {"log": SEEN}),
    (localization.PoseGraph, GRAPH),
    (localization.PoseGraph, {**GRAPH, **SIGHTED, "point_information": np.eye(2)}),
    (localization.PoseGraph(**GRAPH).optimize, {}),
    (localization.PoseGraph(**GRAPH).optimize().covariance, {"pose": 1}),
    (mobile.arc_jacobians, {"twist": [1, 0, 0.1], "dt": 0.1}),
    (mobile.calibrate, {"odometry": LOG.odometry, "reference": LOG.truth, "window": 1.0}),
    (
        mobile.calibrate_wheels,
        {"times": STEPS.times, "wheels": np.ones((len(STEPS), 2)), "reference": LOG.truth},
    ),
    (mobile.drive, {"T_map_base": np.eye(3), "twist": [1, 0, 0], "dt": 0.1}),
    (mobile.umbmark, {"clockwise": [(1, 1)], "counterclockwise": [(1, 1)], "vehicle": BASE}),
    (mobile.wheel_angles, {"ticks": [[0, 1], [1, 2]], "per_turn": 100}),
    (mobile.Odometry, {"times": [0, 1], "steps": [[1, 0, 0]]}),
    (mobile.Odometry.from_twists, {"times": [0, 1], "twists": [[1, 0, 0]]}),
    (mobile.Odometry.from_increments, {"times": [0, 1], "increments": [[1, 0, 0]]}),
    (mobile.Odometry.from_poses, {"times": [0, 1], "poses": [[1, 0, 0], [1, 1, 0]]}),
    (mobile.Odometry.from_ticks, {"times": [0], "ticks": [[0, 1]], "vehicle": BASE, "per_turn": 9}),
    (STEPS.dead_reckoning, {}),
    (STEPS.split, {"times": [1.0]}),
    (STEPS.between, {"first": 1.0, "last": 2.0}),
    (LOG.truth.at, {"times": [1.0]}),
    (LOG.truth.between, {"first": 1.0, "last": 2.0}),
    *((make, {}) for make in (mobile.RandomWalk, mobile.VelocityNoise, mobile.OdometryNoise)),
    *((make, {}) for make in (mobile.Car, mobile.Unicycle, mobile.DifferentialDrive)),
    *((make, {}) for make in (mobile.Mecanum, mobile.Omni, mobile.Tracked)),
    (cs.maps.EvidenceGrid.from_scans, {"scans": SEEN.scans, "poses": SEEN.truth}),
    (cs.maps.EvidenceGrid.from_probability, {"probability": [[0, 1.0]]}),
    *filters(),
    call(grow, "add", i=0, j=1, z=[1, 0, 0], information=np.eye(3)),
    call(grow, "add_sighting", pose=0, landmark=3, point=[1, 1.0], information=np.eye(2)),
    call(grow, "covariance", pose=1),
    call(grow, "landmark_covariance", landmark=3),
]
SLOW = {("slam", "resolution"), ("slam", "time_limit")}
"""Values that are valid and only ask for much work."""


@pytest.mark.slow
@pytest.mark.parametrize(("function", "usual"), CALLS, ids=lambda value: getattr(value, "__qualname__", ""))
def test_every_argument_is_used_or_refused(function, usual):
    for parameter in inspect.signature(function).parameters.values():
        name = parameter.name
        if name.startswith("_") or parameter.kind in (parameter.VAR_POSITIONAL, parameter.VAR_KEYWORD):
            continue
        for value in HOSTILE:
            if (function.__name__, name) in SLOW and isinstance(value, float):
                continue
            with warnings.catch_warnings():
                warnings.simplefilter("error")
                try:
                    repr(function(**{**usual, name: value}))
                except CspaceError:
                    pass
                except Exception as error:
                    raise AssertionError(f"{name}={value!r:.60}: {error!r}") from error


@pytest.mark.parametrize("size", [1e16, 1e154, 1e200, 1e308])
@pytest.mark.parametrize("name", ["range", "bearing", "points"])
def test_numbers_of_logs_and_maps_whose_squares_overflow_are_named(name, size):
    given = {"range": [1.0, 2.0], "bearing": [0.0, 0.1], "points": [[0.0, 0.0], [1.0, 0.0]]}
    given[name][1] = [size, 0.0] if name == "points" else -size if name == "bearing" else size
    with pytest.raises(CspaceError, match=name):
        use_numbers(given["points"], given["range"], given["bearing"])


def use_numbers(points, distance, bearing):
    """A map and readings."""
    return localization.Landmarks([1, 2], points), localization.Readings([0, 1], [1, 2], distance, bearing)


@pytest.mark.parametrize(
    "matrix",
    [
        -np.eye(2),
        [[1, 5], [0, 1]],
        [[1, 2], [2, 1]],
        1e100 * np.eye(2),
        np.full((2, 2), np.nan),
        np.diag([1, -1e-6]),
    ],
)
def test_covariances_of_a_map_that_are_none_are_named(matrix):
    good = np.zeros((2, 2))
    assert len(localization.Landmarks([7, 8], [[0, 0], [1, 1]], [good, np.eye(2)])) == 2
    with pytest.raises(CspaceError, match="covariances"):
        localization.Landmarks([7, 8], [[0, 0], [1, 1]], [good, matrix])


@pytest.mark.parametrize("size", [1e16, 1e200, 1e308])
@pytest.mark.parametrize("base", [BASE, mobile.Mecanum(0.05, 0.2, 0.2)])
def test_twists_beyond_all_vehicles_are_named(base, size):
    with pytest.raises(CspaceError, match="twist"):
        base.wheel_speeds([size, 0, size])
