"""Time parametrisation: laws that every answer obeys, adversaries, and bad input."""

import numpy as np
import pytest

import cspace as cs
from cspace.errors import InputError, InputTypeError
from cspace.trajectory import Path
from trajectory.path_cases import MAKERS, excess, line, random_waypoints

ROUNDING = 1e-9


@pytest.mark.parametrize("name", MAKERS)
def test_no_limit_is_exceeded_on_a_ten_times_finer_grid(name):
    rng = np.random.default_rng(11)
    for _ in range(12):
        w = random_waypoints(rng)
        path = MAKERS[name](w)
        v, a = rng.uniform(0.5, 3.0, path.dof), rng.uniform(1.0, 20.0, path.dof)
        for grid in (None, int(rng.integers(1, 300))):
            timed = cs.time_parametrize(path, velocity=v, acceleration=a, grid=grid)
            assert timed, timed.reason
            assert timed.proved
            assert np.isfinite(timed.duration)
            assert excess(timed, v, a) <= ROUNDING


@pytest.mark.parametrize("name", MAKERS)
def test_no_limit_is_exceeded_where_joints_start_and_stop_on_the_way(name):
    """Where a joint begins to move, a row bounds the speed at one end of an interval alone."""
    rng = np.random.default_rng(13)
    for _ in range(40):
        w = np.repeat(rng.uniform(-2.0, 2.0, (1, int(rng.integers(2, 8)))), int(rng.integers(3, 9)), axis=0)
        for k in range(1, len(w)):
            moving = rng.integers(w.shape[1], size=int(rng.integers(1, 3)))
            w[k:, moving] = rng.uniform(-2.0, 2.0, len(moving))
        path = MAKERS[name](w)
        v, a = np.full((2, path.dof), 10.0 ** rng.uniform(-1.0, 1.5, (2, 1)))
        timed = cs.time_parametrize(path, velocity=v, acceleration=a)
        assert timed, timed.reason
        assert excess(timed, v, a) <= ROUNDING


@pytest.mark.slow
@pytest.mark.parametrize("name", MAKERS)
def test_no_limit_is_exceeded_on_many_paths(name):
    rng = np.random.default_rng(12)
    for _ in range(150):
        path = MAKERS[name](random_waypoints(rng))
        v, a = rng.uniform(0.5, 3.0, path.dof), rng.uniform(1.0, 20.0, path.dof)
        timed = cs.time_parametrize(path, velocity=v, acceleration=a)
        assert timed
        assert excess(timed, v, a) <= ROUNDING


@pytest.mark.parametrize("copies", range(1, 8))
@pytest.mark.parametrize("degree", range(2, 6))
def test_repeated_control_points_do_not_make_a_path_stand(degree, copies):
    rng = np.random.default_rng([degree, copies])
    points = rng.uniform(-1, 1, (6, 3))
    for at in (0, 2, 5):
        path = cs.trajectory.b_spline(np.insert(points, [at] * copies, points[at], axis=0), degree)
        timed = cs.time_parametrize(path, velocity=2.0, acceleration=8.0)
        assert timed, timed.reason
        assert excess(timed, np.full(3, 2.0), np.full(3, 8.0)) <= ROUNDING


@pytest.mark.parametrize("jerk", [None, 50.0])
def test_a_piece_without_motion_is_named(jerk):
    stand = [[[0.0, 1.0], [0.0, 1.0], [0.0, 1.0], [0.0, 1.0]]]
    move = [[[0.0, 1.0], [0.1, 1.0], [0.2, 1.1], [0.3, 1.2]]]
    for controls, s in (([*stand, [[0.0, 1.0], *move[0][1:]]], 0.0), ([*move, [move[0][-1]] * 4], 1.0)):
        timed = cs.time_parametrize(Path([0, 1, 2], controls), velocity=1.0, acceleration=2.0, jerk=jerk)
        assert not timed
        assert timed.reason.startswith(f"nothing moves from s = {s:g} on")
        assert timed.place == s


@pytest.mark.parametrize("seed", range(4))
def test_a_place_where_all_joints_stand_and_bend_otherwise_is_named(seed):
    """A quadratic that comes to rest in its parameter, and leaves in another direction."""
    a, b, c = np.random.default_rng(seed).uniform(-1, 1, (3, 2))
    timed = cs.time_parametrize(Path([0, 1, 3], [[a, b, b], [b, b, c]]), velocity=1.0, acceleration=2.0)
    assert not timed
    assert timed.place == 1.0
    assert "make the path in parts" in timed.reason
    for controls in ([[a, b, b]], [[b, b, c]]):  # at the ends it is no fault
        part = cs.time_parametrize(Path([0, 1], controls), velocity=1.0, acceleration=2.0)
        assert part
        assert excess(part, np.ones(2), np.full(2, 2.0)) <= ROUNDING


@pytest.mark.parametrize("name", MAKERS)
def test_the_motion_is_the_path_and_its_derivatives(name):
    rng = np.random.default_rng(13)
    w = rng.uniform(-1, 1, (5, 3))
    path = MAKERS[name](w)
    timed = cs.time_parametrize(path, velocity=2.0, acceleration=8.0)
    assert np.array_equal(timed(0.0), path.start)
    assert np.array_equal(timed(timed.duration), path.end)
    if name != "clamped":
        assert not timed([0.0, timed.duration], 1).any()
    t = rng.uniform(0, timed.duration, 300)
    assert np.allclose(timed(t), path(timed.parameter(t)), atol=1e-12)
    h = 1e-6
    inside = np.abs(t[:, None] - timed.knots).min(axis=1) > 2 * h
    for order in range(3):
        slope = (timed(t[inside] + h, order) - timed(t[inside] - h, order)) / (2 * h)
        exact = timed(t[inside], order + 1)
        assert np.abs(slope - exact).max() <= 1e-6 * (1.0 + np.abs(exact).max())
    check = timed.check(cs.Limits(-9 * np.ones(3), 9 * np.ones(3), 2 * np.ones(3), 8 * np.ones(3)))
    assert check, check.reason


def test_limits_scale_the_duration():
    rng = np.random.default_rng(14)
    for _ in range(10):
        path = cs.spline(rng.uniform(-1, 1, (6, 4)))
        v, a, k = rng.uniform(1, 2, 4), rng.uniform(3, 9, 4), float(rng.uniform(1.5, 4))
        base = cs.time_parametrize(path, velocity=v, acceleration=a, grid=200).duration
        faster = cs.time_parametrize(path, velocity=k * v, acceleration=k * k * a, grid=200).duration
        assert faster == pytest.approx(base / k, rel=1e-9)
        free = cs.time_parametrize(path, velocity=np.inf, acceleration=a, grid=200).duration
        stronger = cs.time_parametrize(path, velocity=np.inf, acceleration=k * a, grid=200).duration
        assert stronger == pytest.approx(free / np.sqrt(k), rel=1e-9)


def test_the_reversed_path_takes_as_long():
    rng = np.random.default_rng(15)
    for _ in range(10):
        path = cs.spline(rng.uniform(-1, 1, (6, 4)), int(rng.choice([3, 5])))
        there, back = (
            cs.time_parametrize(each, velocity=2.0, acceleration=8.0, tolerance=1e-4)
            for each in (path, path.reversed())
        )
        assert back.duration == pytest.approx(there.duration, rel=2e-4)
        turned = there.reversed()
        t = rng.uniform(0, there.duration, 50)
        assert np.allclose(turned(there.duration - t), there(t), atol=1e-9)
        assert turned.duration == pytest.approx(there.duration, rel=1e-12)


def test_more_limits_never_shorten_a_motion():
    rng = np.random.default_rng(16)
    robot = cs.load_robot("panda")
    low, high = robot.limits.range
    for _ in range(5):
        path = cs.spline(low + (high - low) * rng.uniform(0.2, 0.8, (5, 7)))
        options = {"grid": 200}
        free = cs.time_parametrize(path, robot, velocity=np.inf, **options).duration
        base = cs.time_parametrize(path, robot, **options).duration
        assert base >= free * (1 - 1e-12)
        for extra in ({"torque": 0.7 * robot.limits.effort}, {"speed": 0.5}, {"turn_rate": 1.0}):
            assert cs.time_parametrize(path, robot, **options, **extra).duration >= base * (1 - 1e-9)


def test_a_finer_grid_ends_at_the_duration_of_the_automatic_one():
    rng = np.random.default_rng(17)
    for _ in range(10):
        path = cs.spline(rng.uniform(-1.5, 1.5, (6, 7)))
        timed = cs.time_parametrize(path, velocity=2.0, acceleration=8.0)
        fine = cs.time_parametrize(path, velocity=2.0, acceleration=8.0, grid=20_000)
        assert timed.converged
        assert timed.duration == pytest.approx(fine.duration, rel=2.5e-3)
        finer = cs.time_parametrize(path, velocity=2.0, acceleration=8.0, tolerance=1e-4)
        assert finer.duration == pytest.approx(fine.duration, rel=2.5e-4)


def test_a_line_takes_as_long_as_the_trapezoid_of_its_slowest_joint():
    path = cs.spline([[0.0, 0.0], [3.0, -6.0]])
    timed = cs.time_parametrize(path, velocity=[1.0, 1.5], acceleration=[2.0, 3.0], tolerance=1e-6)
    assert timed.duration == pytest.approx(6.0 / 1.5 + 1.5 / 3.0, rel=1e-5)
    used = timed.binding()
    assert [each.limit for each in used] == ["acceleration", "velocity", "acceleration"]


def test_a_circle_is_limited_by_its_centripetal_acceleration():
    def circle(s, order):
        return np.stack([np.cos(s + order * np.pi / 2), np.sin(s + order * np.pi / 2)], axis=-1)

    path = cs.trajectory.fit_path(circle, 8 * np.pi, tolerance=1e-9)
    timed = cs.time_parametrize(path, velocity=np.inf, acceleration=4.0, tolerance=1e-4)
    # Each joint alone may accelerate by 4: on the axes ṡ² = 4, so that no speed above 2 is possible there.
    assert timed.squared_speed.max() < 4.0 * np.sqrt(2.0)
    at_axis = np.interp(np.arange(1, 8) * np.pi, timed.grid, timed.squared_speed)
    assert (at_axis <= 4.0 + 1e-9).all()


def test_speeds_at_the_ends():
    path = line(1.0)
    options = {"velocity": np.inf, "acceleration": 2.0}
    fast = cs.time_parametrize(path, **options, start_speed=9.0)
    assert not fast
    assert fast.speed_range == pytest.approx((0.0, 2.0))
    assert fast.place == 0.0
    assert "from 0 to 2 are possible" in fast.reason
    end = cs.time_parametrize(path, **options, end_speed=9.0)
    assert not end
    assert end.speed_range[1] == pytest.approx(2.0)
    both = cs.time_parametrize(path, **options, start_speed=1.0, end_speed=1.5)
    assert both
    assert both([0.0, both.duration], 1).ravel() == pytest.approx([1.0, 1.5])
    # v² − v₀² = 2 a d up and down again.
    top = np.sqrt((2 * 2.0 * 1.0 + 1.0 + 2.25) / 2)
    assert both.duration == pytest.approx(((top - 1.0) + (top - 1.5)) / 2.0, rel=1e-3)
    # A motion that is refused is at its start, for no time.
    assert fast.duration == 0.0
    assert np.array_equal(fast(0.0), path.start)
    assert not fast.binding()


def test_zero_limits():
    path = cs.spline([[0, 0], [1, 0], [2, 1]])
    refused = cs.time_parametrize(path, velocity=[1.0, 0.0], acceleration=1.0)
    assert not refused
    assert "joint 1 moves from s = 0 on; its velocity limit is 0" in refused.reason
    still = cs.spline([[0, 5], [1, 5], [2, 5]])
    assert cs.time_parametrize(still, velocity=[1.0, 0.0], acceleration=[1.0, 0.0]).duration > 2.0


@pytest.mark.parametrize("scale", [1e-6, 1e-3, 1e3, 1e6])
def test_units_do_not_matter(scale):
    w = np.random.default_rng(18).uniform(-1, 1, (5, 3))
    base = cs.time_parametrize(cs.spline(w), velocity=2.0, acceleration=8.0)
    other = cs.time_parametrize(cs.spline(scale * w), velocity=2.0 * scale, acceleration=8.0 * scale)
    assert other.duration == pytest.approx(base.duration, rel=1e-9)
    assert excess(other, np.full(3, 2.0 * scale), np.full(3, 8.0 * scale)) <= ROUNDING


@pytest.mark.parametrize("name", MAKERS)
def test_waypoints_that_nearly_coincide(name):
    rng = np.random.default_rng(19)
    for gap in (1e-12, 1e-9, 1e-7, 1e-5, 1e-3):
        w = rng.uniform(-1, 1, (6, 3))
        w[3] = w[2] + gap * rng.normal(size=3)
        w[5] = w[4] + gap * (w[4] - w[3])
        path = MAKERS[name](w)
        timed = cs.time_parametrize(path, velocity=2.0, acceleration=8.0)
        assert timed, (gap, timed.reason)
        assert excess(timed, np.full(3, 2.0), np.full(3, 8.0)) <= ROUNDING


def test_a_path_that_turns_on_the_spot_passes_slopes_of_zero():
    cusp = Path.from_coefficients([0, 1, 2], [[[0.0], [2.0], [-1.0]], [[1.0], [0.0], [-1.0]]])
    timed = cs.time_parametrize(cusp, velocity=1.0, acceleration=2.0, tolerance=1e-5)
    # q = 1 − (s − 1)²: out and back, two trapezoids of one unit each with a turn at full deceleration.
    assert timed.duration == pytest.approx(2 * (1.0 / 1.0 + 1.0 / 2.0), rel=1e-3)
    assert excess(timed, np.ones(1), np.full(1, 2.0)) <= ROUNDING


def test_thousands_of_waypoints():
    w = np.cumsum(np.random.default_rng(20).normal(size=(10_000, 3)), axis=0)
    path = cs.spline(w)
    timed = cs.time_parametrize(path, velocity=2.0, acceleration=8.0)
    assert timed
    assert timed.converged
    assert excess(timed, np.full(3, 2.0), np.full(3, 8.0), 2) <= ROUNDING


def test_torques_keep_their_limits_at_samples():
    rng = np.random.default_rng(21)
    robot = cs.load_robot("panda")
    low, high = robot.limits.range
    limit = 0.5 * robot.limits.effort
    for grid in (None, 60):
        path = cs.spline(low + (high - low) * rng.uniform(0.25, 0.75, (5, 7)))
        timed = cs.time_parametrize(path, robot, torque=limit, grid=grid)
        assert timed, timed.reason
        assert not timed.proved
        t = np.linspace(0, timed.duration, 5000)
        tau = robot.inverse_dynamics(timed(t), timed(t, 1), timed(t, 2))
        assert (np.abs(tau) <= limit * (1 + 1e-6)).all()
        assert excess(timed, robot.limits.velocity, robot.limits.acceleration) <= ROUNDING
        assert any(each.limit == "torque" for each in timed.binding())


def test_a_torque_below_gravity_is_answered_with_the_joint_and_the_place():
    robot = cs.load_robot("panda")
    path = cs.spline([robot.q_home if hasattr(robot, "q_home") else np.zeros(7), np.full(7, -0.5)])
    refused = cs.time_parametrize(path, robot, torque=2.0, positions=False)
    assert not refused
    assert "against gravity" in refused.reason
    assert "panda_joint" in refused.reason
    assert 0.0 <= refused.place <= path.length


def test_speed_and_turn_rate_of_the_tip():
    rng = np.random.default_rng(22)
    robot = cs.load_robot("panda")
    low, high = robot.limits.range
    path = cs.spline(low + (high - low) * rng.uniform(0.25, 0.75, (5, 7)))
    timed = cs.time_parametrize(path, robot, speed=0.4, turn_rate=1.2)
    t = np.linspace(0, timed.duration, 5000)
    twist = np.einsum("kij,kj->ki", robot.jacobian(timed(t)), timed(t, 1))
    assert np.linalg.norm(twist[:, :3], axis=1).max() == pytest.approx(0.4, rel=1e-3)
    assert np.linalg.norm(twist[:, :3], axis=1).max() <= 0.4 * (1 + 1e-6)
    assert np.linalg.norm(twist[:, 3:], axis=1).max() <= 1.2 * (1 + 1e-6)
    assert {"speed"} <= {each.limit for each in timed.binding()}


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({}, "no acceleration limits; pass acceleration="),
        ({"acceleration": np.inf}, "no limit applies"),
        ({"acceleration": -1.0}, "0 or more"),
        ({"acceleration": np.nan}, "0 or more"),
        ({"acceleration": [1.0, 2.0, 3.0]}, "one per joint"),
        ({"acceleration": 1.0, "torque": 3.0}, "robot="),
        ({"acceleration": 1.0, "speed": 3.0}, "robot="),
        ({"acceleration": 1.0, "speed": 0.0, "robot": "panda"}, "positive"),
        ({"acceleration": 1.0, "grid": 0}, "grid is 0"),
        ({"acceleration": 1.0, "tolerance": 0.0}, "tolerance"),
        ({"acceleration": 1.0, "start_speed": -1.0}, "start_speed"),
        ({"acceleration": 1.0, "robot": "ur5e"}, "of 7 joints"),
        ({"limits": 3.0}, "limits is a float"),
        ({"path": [[0, 0]], "acceleration": 1.0}, "make a Path"),
    ],
)
def test_bad_input_is_named(options, message):
    options = {"path": line(1.0, 7), **options}
    if "robot" in options:
        options["robot"] = cs.load_robot(options["robot"])
    with pytest.raises(cs.CspaceError, match=message):
        cs.time_parametrize(**options)


def test_dry_friction_keeps_torque_limits_where_joints_reverse():
    robot = cs.load_robot("puma560")
    limit, (low, high) = 0.8 * robot.limits.effort, robot.limits.range
    rng, reversals = np.random.default_rng(5), 0
    for _ in range(30):
        q = 0.5 * (low + high) + 0.3 * (high - low) * rng.uniform(-1, 1, (rng.integers(3, 7), 6))
        timed = cs.time_parametrize(cs.spline(q), robot, velocity=3.0, acceleration=20.0, torque=limit)
        if not timed:
            continue
        shares = np.linspace(0.0, 1.0, 41)
        t = (timed.knots[:-1] + shares[:, None] * np.diff(timed.knots)).ravel()
        q, qd, qdd = (timed(t, order) for order in range(3))
        reversals += int((np.diff(np.sign(timed(timed.knots, 1)), axis=0) != 0.0).sum())
        assert (np.abs(robot.inverse_dynamics(q, qd, qdd)) <= limit * (1.0 + 1e-4)).all()
    assert reversals > 200


def test_a_path_beyond_a_limit_of_position_is_answered_with_the_joint_and_the_place():
    rng = np.random.default_rng(3)
    for _ in range(60):
        path = cs.spline(rng.uniform(-1, 1, (5, 3)))
        dense = path(np.linspace(0.0, path.length, 20001))
        bound = rng.uniform(0.7, 1.3, 3)
        limits = cs.Limits(-bound, bound, [1, 1, 1], [2, 2, 2])
        timed = cs.time_parametrize(path, limits, grid=50)
        within = (np.abs(dense) <= bound + 1e-7).all()
        assert bool(timed) == within
        assert cs.time_parametrize(path, limits, grid=50, positions=False)
        if not timed:
            j = int(timed.reason.split()[1])
            assert abs(path(timed.place)[j]) > bound[j]
            beyond = np.flatnonzero((np.abs(dense) > bound).any(axis=1))
            assert timed.place <= path.length * (beyond[-1] + 1) / 20000


def test_the_feed_is_held_but_where_a_limit_is_named():
    robot = cs.load_robot("ur5e")
    rng = np.random.default_rng(31)
    for feed in (0.05, 0.2, 0.8, 5.0):
        q = np.array([0.3, -1.2, 1.5, -0.8, -1.3, 0.2]) + rng.uniform(-0.4, 0.4, (4, 6))
        timed = cs.time_parametrize(cs.spline(q), robot, acceleration=6.0, feed=feed)
        t = np.linspace(0.0, timed.duration, 3000)
        twist = np.einsum("nij,nj->ni", robot.jacobian(timed(t)), timed(t, 1))
        speed = np.linalg.norm(twist[:, :3], axis=1)
        assert speed.max() <= feed * (1.0 + 1e-6)
        slow = np.zeros(len(t), dtype=bool)
        for each in timed.below_feed():
            inside = (t >= each.begin) & (t <= each.end)
            slow |= inside
            assert each.limit in ("velocity", "acceleration")
            assert each.joint in robot.joint_names
            assert each.slowest <= speed[inside].min(initial=feed) + 1e-3 * feed
        assert (speed[~slow] >= 0.985 * feed).all()
        assert slow[0]
        assert slow[-1]
    with pytest.raises(InputError, match="without a feed"):
        cs.time_parametrize(cs.spline(q), robot, acceleration=6.0).below_feed()
    with pytest.raises(InputError, match="more than speed"):
        cs.time_parametrize(cs.spline(q), robot, acceleration=6.0, feed=1.0, speed=0.5)


@pytest.mark.parametrize("jerk", [None, True])
@pytest.mark.parametrize("make", [cs.spline, lambda q: cs.blend(q, deviation=0.05)])
def test_a_feed_is_not_lost_where_every_limit_has_room(make, jerk):
    """Coarse intervals lose speed where the tip's speed by place is curved: they are divided."""
    robot = cs.load_robot("panda")
    limits, rng = robot.limits, np.random.default_rng(3)
    for feed in (0.05, 0.2, 0.4):
        q = np.array([0.0, -0.3, 0.0, -2.0, 0.0, 1.8, 0.7]) + rng.uniform(-0.5, 0.5, (4, 7))
        timed = cs.time_parametrize(make(q), robot, feed=feed, jerk=jerk)
        begin, end = timed._times[:-1, None], timed._times[1:, None]
        t = begin + (end - begin) * np.linspace(0.01, 0.99, 5)
        qd = timed(t.ravel(), 1)
        speed = np.linalg.norm(np.einsum("nij,nj->ni", robot.jacobian(timed(t.ravel()))[:, :3], qd), axis=1)
        used = np.maximum(np.abs(qd) / limits.velocity, np.abs(timed(t.ravel(), 2)) / limits.acceleration)
        if jerk:
            used = np.maximum(used, np.abs(timed(t.ravel(), 3)) / limits.jerk)
        has_room = used.max(axis=1).reshape(t.shape).max(axis=1) < 0.9
        slow = has_room & (speed.reshape(t.shape).min(axis=1) < 0.99 * feed)
        assert np.diff(timed._times)[slow].sum() < 1.5e-3 * timed.duration
        assert speed.max() <= feed * (1.0 + 1e-5)


def fine_times(motion, parts=20):
    """Times of a grid that is finer by far than the samples of the limits."""
    t = motion.knots
    return np.unique(t[:-1, None] + np.linspace(0.0, 1.0, parts + 1) * np.diff(t)[:, None]).clip(0, t[-1])


@pytest.mark.parametrize("jerk", [None, 400.0])
@pytest.mark.parametrize("name", ["panda", "puma560"])
def test_sampled_limits_hold_between_their_samples(name, jerk):
    """Torques with dry friction, tip speed and turn rate, on a finer grid, from both sides of each place."""
    robot = cs.load_robot(name)
    rng, timed = np.random.default_rng(5), 0
    middle = robot.limits.range.mean(axis=0).clip(-1, 1)
    effort = 0.6 * np.where(np.isfinite(robot.limits.effort), robot.limits.effort, 60.0)
    for k in range(8):
        path = cs.spline(middle + rng.uniform(-0.6, 0.6, (4, robot.dof)))
        limits = {"velocity": 3.0, "acceleration": 15.0, "jerk": jerk, "positions": False}
        asked = {"torque": effort} if k % 2 else {"speed": 0.4, "turn_rate": 0.9}
        motion = cs.time_parametrize(path, robot, **limits, **asked)
        if not motion:
            continue
        timed += 1
        t = fine_times(motion)
        for before in (False, True):
            q, qd, qdd = (motion._evaluate(t, order, before) for order in range(3))
            if k % 2:
                used = np.abs(robot.inverse_dynamics(q, qd, qdd)) / effort
            else:
                twist = np.einsum("kij,kj->ki", robot.jacobian(q), qd)
                rates = (np.linalg.norm(twist[:, part], axis=1) for part in (slice(3), slice(3, 6)))
                used = np.stack(list(rates), axis=1) / [0.4, 0.9]
            assert used.max() <= 1.0 + 1e-9
            assert used.max() > 0.5
    assert timed >= 5


@pytest.mark.parametrize("seed", [0, 1])
def test_dry_friction_at_rest_refuses_no_path(seed):
    """At the instant at which a motion stands its dry friction is zero: a step of the torque at both ends."""
    robot = cs.load_robot("puma560")
    rng = np.random.default_rng(seed)
    middle = robot.limits.range.mean(axis=0).clip(-1, 1)
    weak = 0.5 * np.where(np.isfinite(robot.limits.effort), robot.limits.effort, 60.0)
    options = {"velocity": 4.0, "acceleration": 20.0, "positions": False, "torque": weak}
    for _ in range(20):
        motion = cs.time_parametrize(cs.spline(middle + rng.uniform(-0.6, 0.6, (5, 6))), robot, **options)
        assert motion, motion.reason
        state = (motion(np.array([0.0, motion.duration]), order) for order in range(3))
        assert (np.abs(robot.inverse_dynamics(*state)) <= weak * (1 + 1e-9)).all()


@pytest.mark.parametrize("seed", range(8))
def test_limits_of_a_frame_are_kept_on_every_grid(seed):
    """What one interval loses is given to those beside it: they are tightened together."""
    rng = np.random.default_rng(900 + seed)
    robot = cs.load_robot(("gen3", "ur5e", "panda", "z1")[seed % 4])
    points = rng.uniform(-1.5, 1.5, (int(rng.integers(5, 9)), robot.dof))
    path = cs.trajectory.b_spline(points) if seed % 2 else cs.spline(points, ends="clamped")
    for grid in (None, 200, 700, 1000):
        for limit in ({"speed": 0.3}, {"turn_rate": 1.0}):
            options = {"velocity": np.inf, "acceleration": 7.0, "positions": False, "grid": grid}
            motion = cs.time_parametrize(path, robot, **options, **limit)
            assert motion, motion.reason
            t = np.linspace(0.0, motion.duration, 5000)
            twist = np.einsum("kij,kj->ki", robot.jacobian(motion(t)), motion(t, 1))
            rows = slice(3) if "speed" in limit else slice(3, 6)
            assert np.linalg.norm(twist[:, rows], axis=1).max() <= next(iter(limit.values())) * (1 + 1e-7)


@pytest.mark.parametrize("seed", range(12))
def test_the_automatic_grid_is_as_good_as_a_fine_one(seed):
    """An interval holds back those beside it, so that all are divided where one changes."""
    rng = np.random.default_rng(40 + seed)
    points = rng.uniform(-1.5, 1.5, (7, int(rng.integers(2, 7))))
    for path in (cs.trajectory.b_spline(points), cs.spline(points, ends="clamped")):
        own = cs.time_parametrize(path, velocity=2.0, acceleration=7.0)
        fine = cs.time_parametrize(path, velocity=2.0, acceleration=7.0, grid=8000)
        assert own.converged
        assert own.duration <= fine.duration * 1.0015


def test_a_grid_is_not_refined_to_a_tolerance():
    path = cs.spline(np.random.default_rng(1).uniform(-1.0, 1.0, (5, 3)))
    with pytest.raises(InputTypeError, match="exclude each other"):
        cs.time_parametrize(path, acceleration=8.0, grid=100, tolerance=0.01)


@pytest.mark.parametrize("name", ["cubic", "quintic", "blend", "b_spline"])
def test_a_tenth_of_the_tolerance_takes_few_more_intervals(name):
    # What is lost falls by the square of the intervals' length: 10 times for 3.2 times as many.
    rng = np.random.default_rng(51)
    path = MAKERS[name](np.cumsum(rng.normal(size=(12, 4)), axis=0))
    rough, fine = (
        cs.time_parametrize(path, velocity=2.0, acceleration=5.0, tolerance=tolerance)
        for tolerance in (1e-3, 1e-5)
    )
    assert rough.converged
    assert fine.converged
    assert fine.duration <= rough.duration * (1 + 1e-9) <= fine.duration * (1 + 2e-3)
    assert len(fine.rises) < 15 * len(rough.rises)


def test_squared_speeds_are_quadratic_between_places_and_keep_all_limits():
    rng = np.random.default_rng(52)
    path = cs.blend(np.cumsum(0.3 * rng.normal(size=(30, 5)), axis=0), 0.1)
    timed = cs.time_parametrize(path, velocity=2.0, acceleration=5.0)
    assert np.count_nonzero(timed.rises) > 0.2 * len(timed.rises)
    x, r = timed.squared_speed, timed.rises
    places = timed.grid[:-1] + 0.25 * np.diff(timed.grid)
    t = np.interp(places, timed.parameter(ts := np.linspace(0, timed.duration, 2_000_001)), ts)
    expected = 0.75 * x[:-1] + 0.25 * x[1:] + 0.375 * r
    assert timed.parameter(t, 1) ** 2 == pytest.approx(expected, rel=1e-5, abs=1e-6)
    assert excess(timed, np.full(5, 2.0), np.full(5, 5.0)) <= 1e-12


@pytest.mark.parametrize(("bend", "deviation"), [(0.3, 1e-4), (0.1, 1e-5), (0.03, 1e-5), (0.003, 1e-6)])
def test_small_corners_are_resolved(bend, deviation):
    # Halving such a corner gains little at first, and more each time.
    path = cs.blend([[0, 0], [1, 0], [2, bend]], deviation)
    own, fine = (
        cs.time_parametrize(path, velocity=2.0, acceleration=5.0, tolerance=tolerance)
        for tolerance in (None, 1e-5)
    )
    assert own.converged
    assert own.duration < fine.duration * (1 + 1.5e-3)


def test_automatic_grids_of_random_nearly_straight_blends_are_as_exact_as_they_say():
    rng = np.random.default_rng(53)
    for _ in range(60):
        n, count = int(rng.integers(2, 8)), int(rng.integers(3, 8))
        steps = rng.normal(size=n) + 10.0 ** rng.uniform(-4, 0) * rng.normal(size=(count, n))
        path = cs.blend(np.cumsum(steps, axis=0), 10.0 ** rng.uniform(-6, -1))
        v, a = rng.uniform(1, 3, n) * 10.0 ** rng.uniform(-1, 1, n), rng.uniform(1, 15, n)
        own, fine = (
            cs.time_parametrize(path, velocity=v, acceleration=a, tolerance=tolerance)
            for tolerance in (None, 3e-5)
        )
        assert own.converged
        assert own.duration < fine.duration * (1 + 1.5e-3)


def test_motions_with_a_speed_or_a_feed_are_as_exact_as_others():
    robot = cs.load_robot("ur5e")
    path = cs.spline(np.random.default_rng(54).uniform(-1.5, 1.5, (4, 6)))
    most = {"velocity": 3.0, "acceleration": 10.0, "robot": robot}
    for asked in ({"speed": 0.4}, {"feed": 0.2}):
        timed = cs.time_parametrize(path, **most, **asked)
        assert timed.converged
        assert timed.rises.any()
    slow = cs.time_parametrize(path, **most, speed=0.4)
    assert slow.duration < cs.time_parametrize(path, **most, speed=0.4, grid=20_000).duration * (1 + 1e-3)


def test_an_impossible_speed_beside_the_possible_ones_is_told_apart_from_them():
    timed = cs.time_parametrize(
        cs.spline([[0.0], [1.0]]), velocity=np.inf, acceleration=2.0, start_speed=2.0 + 1e-9
    )
    assert not timed
    assert "from 0 to 1.99999" in timed.reason


@pytest.mark.parametrize("count", [2_000, 20_000])
def test_waypoints_close_to_each_other_do_not_slow_a_motion_down(count):
    def time(number):
        s = np.linspace(0, 1, number)[:, None]
        k = np.arange(3)
        path = cs.spline(np.sin(3 * s + k) + 0.3 * np.cos(7 * s * k))
        return cs.time_parametrize(path, velocity=2.0, acceleration=5.0).duration

    assert time(count) == pytest.approx(time(200), rel=3e-3)
