"""Following: within limits at every step, onto the path from beside it, and to its end."""

import numpy as np
import pytest

import cspace as cs
from cspace.errors import InputError, InputTypeError, UnknownNameError

nav = cs.navigation
CAR = nav.Car(wheelbase=2.5, max_speed=4.0, acceleration=2.0, max_steering=0.55, steering_rate=1.0)
ROBOT = nav.Unicycle(
    max_speed=1.0, acceleration=0.8, max_turn_rate=1.5, turn_acceleration=3.0, max_reverse=0.5
)
CASES = [("pure_pursuit", ROBOT), ("pure_pursuit", CAR), ("stanley", CAR)]
LINE = np.array([[0.0, 0.0], [60.0, 0.0]])


def circle(radius, turns=2.0, n=2000):
    a = np.linspace(0, 2 * np.pi * turns, n)
    return radius * np.stack([np.sin(a), 1 - np.cos(a)], axis=-1)


def check_limits(run):
    """Every step stays within the limits of the vehicle, and poses are those of its controls."""
    v, car = run.vehicle, isinstance(run.vehicle, nav.Car)
    dt = run.times[1]
    speed, turn = run.controls.T
    assert speed.max() <= v.max_speed + 1e-12
    assert speed.min() >= -v.max_reverse - 1e-12
    assert np.abs(np.diff(speed)).max() <= v.acceleration * dt + 1e-12
    assert np.abs(turn).max() <= (v.max_steering if car else v.max_turn_rate) + 1e-12
    change = v.steering_rate if car else v.turn_acceleration
    assert np.abs(np.diff(turn)).max() <= change * dt + 1e-12
    rate = speed * np.tan(turn) / v.wheelbase if car else turn
    fine = 200  # the equations of motion in small steps, halves first
    x, y, theta = (c.copy() for c in run.poses[:-1].T)
    for _ in range(fine):
        h = dt / fine
        middle = theta + 0.5 * h * rate[1:]
        x, y, theta = (
            x + h * speed[1:] * np.cos(middle),
            y + h * speed[1:] * np.sin(middle),
            theta + h * rate[1:],
        )
    np.testing.assert_allclose(np.stack([x, y, theta], -1), run.poses[1:], atol=1e-6)


@pytest.mark.parametrize(("controller", "vehicle"), CASES)
def test_a_line_is_followed_exactly(controller, vehicle):
    run = nav.follow(LINE, controller, vehicle=vehicle)
    assert run, run.reason
    check_limits(run)
    assert np.abs(run.cross_track).max() < 1e-12
    assert run.reason.startswith("arrived")
    assert np.hypot(*(run.path[-1] - LINE[-1])) <= 0.05
    assert run.controls[-1, 0] == pytest.approx(0, abs=1e-3)
    assert run.times[-1] < 60 / vehicle.max_speed + vehicle.max_speed / vehicle.acceleration + 3


@pytest.mark.parametrize(("controller", "vehicle"), CASES)
@pytest.mark.parametrize("offset", [-2.0, 0.5, 1.5])
@pytest.mark.parametrize("angle", [-0.8, 0.0, 1.2])
def test_it_converges_to_a_line_from_beside_it(controller, vehicle, offset, angle):
    run = nav.follow(LINE, controller, vehicle=vehicle, start=(0.0, offset, angle))
    assert run, run.reason
    check_limits(run)
    error = np.abs(run.cross_track)
    far = run.progress > 30
    assert error[far].max() < 0.02
    assert error[-1] < 2e-3


@pytest.mark.parametrize(("controller", "vehicle"), CASES)
def test_a_circle_is_followed_closely(controller, vehicle):
    run = nav.follow(circle(8.0), controller, vehicle=vehicle, speed=2.0, tolerance=0.5)
    assert run, run.reason
    check_limits(run)
    # At the start the front axle is off the circle, and the wheels are straight.
    assert np.abs(run.cross_track).max() < 0.4
    settled = (run.progress > 30) & (run.progress < 80)
    assert np.abs(run.cross_track[settled]).max() < 0.01


def test_pursuit_is_an_arc_of_the_stated_curvature():
    """From rest beside a line, the first turn is that of curvature 2 y / d² (Coulter 1992)."""
    vehicle = nav.Unicycle(acceleration=100.0, turn_acceleration=1e3, max_turn_rate=50.0)
    run = nav.follow(LINE, vehicle=vehicle, start=(1.0, 0.6, 0.0), lookahead=1.0)
    speed, turn = run.controls[1]
    assert turn / speed == pytest.approx(2 * -0.6 / 1.0**2, rel=1e-9)


def test_stanley_turns_the_front_wheels_by_its_law():
    vehicle = nav.Car(max_speed=5.0, steering_rate=1e3, acceleration=2.0)
    run = nav.follow(
        LINE, "stanley", vehicle=vehicle, start=(1.0, 0.5, 0.1, 3.0, 0.0), gain=1.2, softening=0.5
    )
    front = 0.5 + vehicle.wheelbase * np.sin(0.1)
    assert run.controls[1, 1] == pytest.approx(-0.1 - np.arctan2(1.2 * front, 3.5), rel=1e-9)
    assert run.cross_track[0] == pytest.approx(front)


def test_a_robot_turns_on_the_spot_where_the_path_lies_behind():
    run = nav.follow([[0, 0], [-5, 0.01]], vehicle=ROBOT, start=(0, 0, 0))
    assert run
    turning = run.times < 1.0
    assert np.abs(run.path[turning]).max() < 1e-9
    assert abs(run.poses[-1, 2]) == pytest.approx(np.pi, abs=0.05)


@pytest.mark.parametrize("seed", range(5))
@pytest.mark.parametrize("vehicle", [CAR, ROBOT])
def test_curves_with_changes_of_gear_are_followed(seed, vehicle):
    rng = np.random.default_rng(seed)
    start, goal = (rng.uniform(-1, 1, 3) * [10, 10, np.pi] for _ in range(2))
    curve = nav.reeds_shepp(start, goal, 6.0)
    run = nav.follow(curve, vehicle=vehicle, speed=1.0, tolerance=0.15, lookahead=1.0)
    assert run, run.reason
    check_limits(run)
    assert np.abs(run.cross_track).max() < 0.6
    if len(curve.cusps):
        assert (run.controls[:, 0] < 0).any()


def test_time_and_standing_still_are_told():
    run = nav.follow(LINE, time_limit=3.0)
    assert not run
    assert (run.status, run.times[-1]) == ("timeout", pytest.approx(3.0))
    assert "before the end" in run.reason
    slow = nav.Unicycle(max_speed=1e-6)
    assert nav.follow(LINE, vehicle=slow, patience=5.0, time_limit=100.0).status == "stuck"
    wide = nav.follow([[0, 0], [0.5, 0]], vehicle=CAR, start=(0, 2, 0))
    assert wide.status == "missed"
    assert "next to the end" in wide.reason


def test_the_same_question_has_the_same_answer():
    a, b = (nav.follow(circle(5.0), vehicle=CAR, speed=1.5) for _ in range(2))
    assert (a.poses == b.poses).all()


def test_what_cannot_be_followed_is_refused():
    with pytest.raises(UnknownNameError, match="stanley"):
        nav.follow(LINE, "stanly")
    with pytest.raises(InputTypeError, match="front wheels"):
        nav.follow(LINE, "stanley")
    with pytest.raises(InputError, match="no length"):
        nav.follow([[1, 1], [1, 1]])
    with pytest.raises(InputError, match="shape"):
        nav.follow([1, 2, 3])
    with pytest.raises(InputError, match="backwards"):
        nav.follow([[0, 0, 0], [-1, 0, 0]])
    with pytest.raises(InputError, match="speed"):
        nav.follow(LINE, speed=0)
    with pytest.raises(InputError, match="start"):
        nav.follow(LINE, start=(1, 2))
    with pytest.raises(InputError, match="max_steering"):
        nav.Car(max_steering=2.0)
    with pytest.raises(InputError, match="wheelbase"):
        nav.Car(wheelbase=0)
    with pytest.raises(InputTypeError, match="vehicle"):
        nav.follow(LINE, vehicle="car")


@pytest.mark.parametrize(("controller", "vehicle"), CASES)
def test_a_vehicle_that_believes_the_truth_drives_as_one_that_knows_it(controller, vehicle):
    known = nav.follow(circle(12.0), controller, vehicle=vehicle)
    believed = nav.follow(circle(12.0), controller, vehicle=vehicle, estimate=lambda t, pose: pose)
    np.testing.assert_array_equal(known.poses, believed.poses)
    np.testing.assert_array_equal(believed.believed, believed.poses)
    np.testing.assert_array_equal(known.believed, known.poses)


@pytest.mark.parametrize(("controller", "vehicle"), CASES)
def test_a_vehicle_with_a_wrong_place_drives_beside_its_path(controller, vehicle):
    """The run is that of the path moved the other way, and ends beside the goal."""
    shift = np.array([0.3, -0.8, 0.0])
    start = np.array([0.0, 0.0, 0.0])
    run = nav.follow(
        LINE, controller, vehicle=vehicle, start=start - shift, estimate=lambda t, pose: pose + shift
    )
    plain = nav.follow(LINE, controller, vehicle=vehicle, start=start)
    assert run.status == "missed"
    np.testing.assert_allclose(run.believed, plain.poses, atol=1e-9)
    np.testing.assert_allclose(run.poses, plain.poses - shift, atol=1e-9)
    check_limits(run)


def test_a_vehicle_with_a_noisy_place_arrives_within_its_limits():
    rng = np.random.default_rng(2)
    run = nav.follow(
        LINE,
        vehicle=ROBOT,
        tolerance=0.1,
        estimate=lambda t, pose: pose + rng.normal(size=3) * [0.01, 0.01, 0.005],
    )
    assert run
    check_limits(run)
    assert np.abs(run.poses[:, 1]).max() < 0.1
    assert np.abs(run.believed - run.poses)[:, :2].max() < 0.06


def test_a_vehicle_touches_things_where_it_is():
    blocked = np.zeros((40, 200), dtype=bool)
    blocked[:, 150] = True
    grid = cs.OccupancyGrid(blocked, 0.1)
    way = [(1.0, 2.0), (10.0, 2.0)]
    run = nav.follow(way, vehicle=ROBOT, world=grid, estimate=lambda t, pose: pose - [6.0, 0.0, 0.0])
    assert run.status == "collision"
    assert 14.0 < run.poses[-1, 0] < 15.0


@pytest.mark.parametrize("told", [None, "here", np.zeros(2), np.full(3, np.nan), 1.0])
def test_an_estimate_that_is_no_pose_is_named(told):
    with pytest.raises((InputError, InputTypeError), match=r"^the estimate at t = 0 s "):
        nav.follow(LINE, estimate=lambda t, pose: told)


def test_bad_estimates():
    with pytest.raises(InputTypeError, match=r"^estimate is a float"):
        nav.follow(LINE, estimate=1.0)
    with pytest.raises(InputTypeError, match="dynamic_window"):
        nav.follow(LINE, "dynamic_window", estimate=lambda t, pose: pose)
    with pytest.raises(ZeroDivisionError):
        nav.follow(LINE, estimate=lambda t, pose: pose / (1 // 0))
