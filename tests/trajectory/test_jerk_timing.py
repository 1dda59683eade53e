"""Timing of paths under jerk limits: laws, exactness, and bad input."""

import numpy as np
import pytest

import cspace as cs
from cspace.trajectory import Path
from trajectory.path_cases import MAKERS, line, random_waypoints

SMOOTH = [name for name in MAKERS if name != "circular"]


def limits_of(path, v, a, j):
    wide = np.full(path.dof, 1e3)
    return cs.Limits(-wide, wide, v, a, j)


@pytest.mark.parametrize("name", SMOOTH)
def test_no_limit_is_exceeded_anywhere(name):
    rng = np.random.default_rng(41)
    for _ in range(4):
        path = MAKERS[name](random_waypoints(rng, 8))
        v, a = rng.uniform(0.5, 3.0, path.dof), rng.uniform(2.0, 20.0, path.dof)
        limits = limits_of(path, v, a, a * rng.uniform(3.0, 20.0))
        timed = cs.time_parametrize(path, limits, jerk=True)
        assert timed, timed.reason
        assert timed.proved
        check = timed.check(limits)
        assert check, check.reason
        assert timed.duration >= cs.time_parametrize(path, limits).duration * (1 - 1e-3)
        t = np.linspace(0, timed.duration, 3000)
        for order, limit in ((1, v), (2, a), (3, limits.jerk)):
            assert (np.abs(timed(t, order)) <= limit * (1 + 1e-9)).all()


@pytest.mark.parametrize("name", SMOOTH)
def test_the_motion_is_the_path_and_its_derivatives(name):
    rng = np.random.default_rng(42)
    path = MAKERS[name](rng.uniform(-1, 1, (5, 3)))
    timed = cs.time_parametrize(path, velocity=2.0, acceleration=8.0, jerk=60.0)
    assert np.array_equal(timed(0.0), path.start)
    assert np.array_equal(timed(timed.duration), path.end)
    for order in (1, 2):
        assert np.abs(timed([0.0, timed.duration], order)).max() < 1e-9
    assert timed.continuity == 2
    t = rng.uniform(0, timed.duration, 400)
    assert np.allclose(timed(t), path(timed.parameter(t)), atol=1e-12)
    assert (np.diff(timed.parameter(np.sort(t))) > 0).all()
    h = 1e-6
    inside = np.abs(t[:, None] - timed.knots).min(axis=1) > 2 * h
    for order in range(3):
        slope = (timed(t[inside] + h, order) - timed(t[inside] - h, order)) / (2 * h)
        exact = timed(t[inside], order + 1)
        assert np.abs(slope - exact).max() <= 1e-5 * (1.0 + np.abs(exact).max())


def test_reversed_and_scaled_motions():
    rng = np.random.default_rng(43)
    path = cs.blend(rng.uniform(-1, 1, (4, 3)), 0.1)
    timed = cs.time_parametrize(path, velocity=2.0, acceleration=8.0, jerk=60.0)
    t = rng.uniform(0, timed.duration, 100)
    back, slow = timed.reversed(), timed.scaled(1.7)
    for order in range(4):
        size = np.abs(timed(t, order)).max()
        turned = (-1.0) ** order * back(timed.duration - t, order)
        near = np.abs(t[:, None] - timed.knots).min(axis=1) > 1e-6
        assert np.allclose(turned[near], timed(t, order)[near], atol=1e-6 * size)
        assert np.allclose(1.7**order * slow(1.7 * t, order)[near], timed(t, order)[near], atol=1e-6 * size)


def test_a_line_is_nearly_as_fast_as_the_seven_phases():
    # Rest to rest over d with J, a, v: T = d / v + v / a + a / J where all limits are attained.
    path = line(5.0, 2)
    timed = cs.time_parametrize(path, velocity=1.0, acceleration=2.0, jerk=8.0, grid=2000)
    best = 5.0 / 1.0 + 1.0 / 2.0 + 2.0 / 8.0
    assert best <= timed.duration <= 1.01 * best
    used = [each.limit for each in timed.binding()]
    assert {"velocity", "acceleration", "jerk"} <= set(used)


def test_finer_grids_are_faster_and_loose_jerks_approach_none():
    path = cs.spline(np.random.default_rng(44).uniform(-1, 1, (5, 4)))
    options = {"velocity": 2.0, "acceleration": 8.0}
    coarse, fine = (cs.time_parametrize(path, **options, jerk=60.0, grid=n).duration for n in (60, 600))
    assert fine < coarse
    loose = cs.time_parametrize(path, **options, jerk=1e4, grid=1500).duration
    free = cs.time_parametrize(path, **options).duration
    assert free * (1 - 1e-3) <= loose <= 1.02 * free


@pytest.mark.parametrize("scale", [1e-6, 1e6])
def test_units_do_not_matter(scale):
    w = np.random.default_rng(45).uniform(-1, 1, (4, 3))
    base = cs.time_parametrize(cs.spline(w), velocity=2.0, acceleration=8.0, jerk=60.0)
    other = cs.time_parametrize(
        cs.spline(scale * w), velocity=2.0 * scale, acceleration=8.0 * scale, jerk=60.0 * scale
    )
    assert other.duration == pytest.approx(base.duration, rel=1e-3)


@pytest.mark.parametrize(
    ("make", "options", "message"),
    [
        (
            lambda: MAKERS["circular"]([[0, 0], [1, 0], [1, 1]]),
            {"jerk": 1.0},
            "second derivative of the path jumps",
        ),
        (lambda: line(), {"jerk": True}, "no jerk limits; pass jerk="),
        (lambda: line(), {"jerk": np.inf}, "infinite for all"),
        (lambda: line(), {"jerk": -1.0}, "0 or more"),
        (lambda: line(), {"jerk": 1.0, "start_speed": 1.0}, "from rest to rest"),
    ],
)
def test_bad_input_is_named(make, options, message):
    if "robot" in options:
        options = {**options, "robot": cs.load_robot(options["robot"])}
    with pytest.raises(cs.CspaceError, match=message):
        cs.time_parametrize(make(), velocity=1.0, acceleration=1.0, **options)


def test_a_joint_whose_jerk_limit_is_zero_may_not_move():
    refused = cs.time_parametrize(line(1.0, 2), velocity=1.0, acceleration=1.0, jerk=[1.0, 0.0])
    assert not refused
    assert "joint 1 moves" in refused.reason
    assert isinstance(line(), Path)


@pytest.mark.parametrize("blended", [False, True])
def test_jerk_limits_hold_together_with_torques_and_speeds(blended):
    robot = cs.load_robot("panda")
    middle, rng = robot.limits.range.mean(axis=0), np.random.default_rng(45)
    effort = 0.55 * robot.limits.effort
    for _ in range(3):
        q = middle + 0.25 * np.diff(robot.limits.range, axis=0)[0] * rng.uniform(-1, 1, (4, 7))
        path = cs.blend(q, 0.3) if blended else cs.spline(q)
        options = {"torque": effort, "speed": 0.7, "turn_rate": 2.5}
        timed = cs.time_parametrize(path, robot, jerk=400.0, positions=False, **options)
        plain = cs.time_parametrize(path, robot, positions=False, **options)
        free = cs.time_parametrize(path, robot, jerk=400.0, positions=False)
        assert timed, timed.reason
        assert not timed.proved
        assert timed.duration >= max(plain.duration * (1 - 2e-3), free.duration * (1 - 1e-3))
        assert timed.duration <= 1.5 * max(plain.duration, free.duration)
        t = np.linspace(0, timed.duration, 4000)
        q, qd, qdd, jerk = (timed(t, order) for order in range(4))
        assert (np.abs(jerk) <= 400.0 * (1 + 1e-9)).all()
        assert (np.abs(qdd) <= robot.limits.acceleration * (1 + 1e-9)).all()
        assert (np.abs(robot.inverse_dynamics(q, qd, qdd)) <= effort * (1 + 1e-5)).all()
        twist = np.einsum("nij,nj->ni", robot.jacobian(q), qd)
        assert np.linalg.norm(twist[:, :3], axis=1).max() <= 0.7 * (1 + 1e-5)
        assert np.linalg.norm(twist[:, 3:], axis=1).max() <= 2.5 * (1 + 1e-5)
        assert {"jerk"} < {each.limit for each in timed.binding()}


def test_a_torque_below_gravity_is_refused_with_jerk_limits_too():
    robot = cs.load_robot("panda")
    path = cs.spline([np.zeros(7), np.full(7, -0.5)])
    refused = cs.time_parametrize(path, robot, jerk=400.0, torque=2.0, positions=False)
    assert "against gravity" in refused.reason


def test_a_tolerance_refines_the_grid_under_jerk_limits():
    path = cs.spline(random_waypoints(np.random.default_rng(46), 5))
    options = {"velocity": 2.0, "acceleration": 8.0, "jerk": 80.0}
    coarse = cs.time_parametrize(path, **options)
    fine = cs.time_parametrize(path, tolerance=4e-3, **options)
    finest = cs.time_parametrize(path, grid=2400, **options)
    assert fine.converged
    assert not coarse.converged
    assert finest.duration <= fine.duration <= coarse.duration
    assert fine.duration <= finest.duration * 1.015
    assert fine.proved


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("feed", [0.5, 100.0])
def test_a_feed_is_never_slower_than_the_same_speed(seed, feed):
    robot = cs.load_robot("ur5e")
    path = cs.spline(np.random.default_rng(60 + seed).uniform(-1.0, 1.0, (4, 6)))
    for acceleration in (np.inf, 8.0):
        options = {"acceleration": acceleration, "jerk": 100.0, "positions": False}
        held = cs.time_parametrize(path, robot, feed=feed, **options)
        limited = cs.time_parametrize(path, robot, speed=feed, **options)
        assert held.duration <= limited.duration * (1 + 1e-9)


@pytest.mark.slow
@pytest.mark.parametrize("near", [False, True])
def test_long_paths_are_made_window_by_window_and_take_no_longer(near):
    # From 20,000 intervals on; where waypoints are near each other a motion brakes over hundreds of pieces.
    rng = np.random.default_rng(43)
    s = np.linspace(0, 1, 400)[:, None]
    k = np.arange(3)
    points = np.sin(3 * s + k) + 0.3 * np.cos(7 * s * k) if near else rng.uniform(-2, 2, (400, 3))
    path = cs.spline(points)
    most = {"velocity": 2.0, "acceleration": 5.0, "jerk": 50.0}
    whole, parts = (cs.time_parametrize(path, **most, grid=n) for n in (19_000, 21_000))
    assert len(whole.intervals.piece) < 20_000 < len(parts.intervals.piece)
    assert parts.duration < whole.duration * (1 + 3e-4)
    t = rng.uniform(0, parts.duration, 20_000)
    for order, limit in ((1, 2.0), (2, 5.0), (3, 50.0)):
        assert np.abs(parts(t, order)).max() <= limit * (1 + 1e-9)
    smooth = np.linspace(0, parts.duration, 200_001)
    assert np.abs(np.diff(parts(smooth, 2), axis=0)).max() <= 50.0 * smooth[1] * (1 + 1e-6)


def test_short_pieces_of_long_smooth_paths_have_fewer_intervals_by_default():
    s = np.linspace(0, 1, 500)[:, None]
    path = cs.spline(np.sin(3 * s + np.arange(3)))
    most = {"velocity": 2.0, "acceleration": 5.0, "jerk": 50.0}
    own, fine = cs.time_parametrize(path, **most), cs.time_parametrize(path, **most, grid=30 * len(path))
    assert len(own.intervals.piece) < 0.5 * len(fine.intervals.piece)
    assert fine.duration <= own.duration < fine.duration * 1.002


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(4))
def test_limits_of_jerk_cost_little_whatever_the_distances_of_waypoints(seed):
    # Tangents of the limits may alternate from step to step; that must not end the minimisation.
    rng = np.random.default_rng(seed)
    for k in range(12):
        n, dof = int(rng.integers(12, 40)), int(rng.integers(1, 4))
        steps = 10.0 ** rng.uniform(-3, 1, (n, 1)) * rng.normal(size=(n, dof))
        path = cs.spline(np.cumsum(steps, 0)) if k % 3 else cs.blend(np.cumsum(steps, 0), 0.01)
        most = {"velocity": 2.0, "acceleration": 1.0}
        timed, plain = cs.time_parametrize(path, **most, jerk=20.0), cs.time_parametrize(path, **most)
        assert plain.duration * (1 - 1e-3) < timed.duration < 1.3 * plain.duration


@pytest.mark.slow
def test_windows_of_paths_with_long_and_short_pieces_take_no_longer():
    rng = np.random.default_rng(3)
    steps = 10.0 ** rng.uniform(-1, 1, (60, 1)) * rng.normal(size=(60, 3))
    path = cs.blend(np.cumsum(steps, axis=0), 0.01)
    most = {"velocity": 2.0, "acceleration": 1.0, "jerk": 30.0}
    whole, parts = (cs.time_parametrize(path, **most, grid=n).duration for n in (19_000, 21_000))
    assert parts < whole * (1 + 3e-4)
