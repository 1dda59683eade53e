"""Point to point motions of robots."""

import numpy as np
import pytest

import cspace as cs
from cspace.errors import InputError, InputTypeError, UnknownNameError
from cspace.model import Limits
from cspace.trajectory.point_to_point import PROFILES
from cspace.trajectory.time_scaling import BOUNDARY_ORDERS, PEAKS, connect_states

Q0 = np.array([0.0, -0.7, 0.0, -2.0, 0.0, 1.5, 0.7])
Q1 = Q0 + np.array([0.5, 0.3, -0.4, 0.2, 0.0, 0.1, -0.6])


@pytest.fixture(scope="module")
def panda():
    return cs.load_robot("panda")


def limits_for(profile):
    return {"acceleration": 10.0} | ({} if profile == "trapezoidal" else {"jerk": 200.0})


def bounds(robot, profile):
    given = {key: np.full(robot.dof, value) for key, value in limits_for(profile).items()}
    own = robot.limits
    return cs.Limits(own.lower, own.upper, velocity=own.velocity, **given)


@pytest.mark.parametrize("profile", PROFILES)
def test_every_profile_keeps_limits_and_attains_both_ends(panda, profile):
    motion = panda.move_to(Q1, start=Q0, profile=profile, **limits_for(profile))
    assert motion
    assert motion.joint_names == panda.joint_names
    assert (motion(0.0) == Q0).all()
    assert (motion(motion.duration) == Q1).all()
    assert (motion([0.0, motion.duration], 1) == 0.0).all()
    assert (motion(np.linspace(0, motion.duration, 9))[:, 4] == 0.0).all()  # a joint that need not move
    assert motion.check(bounds(panda, profile))
    assert not motion.scaled(1 - 1e-6).check(bounds(panda, profile))  # no shorter


@pytest.mark.parametrize("profile", PROFILES)
def test_prescribed_durations_and_cycles(panda, profile):
    least = panda.move_to(Q1, start=Q0, profile=profile, **limits_for(profile)).duration
    slow = panda.move_to(Q1, start=Q0, profile=profile, duration=2.5 * least, **limits_for(profile))
    assert slow
    assert slow.duration == pytest.approx(2.5 * least, rel=1e-12)
    fast = panda.move_to(Q1, start=Q0, profile=profile, duration=0.5 * least, **limits_for(profile))
    assert not fast
    assert fast.reason
    ticks = panda.move_to(Q1, start=Q0, profile=profile, cycle=0.004, **limits_for(profile)).duration / 0.004
    assert ticks == pytest.approx(round(ticks), rel=1e-12)
    assert least / 0.004 <= ticks < least / 0.004 + 1


@pytest.mark.parametrize("profile", PROFILES)
def test_moving_ends_are_attained(panda, profile):
    v = np.linspace(-0.4, 0.4, 7)
    motion = panda.move_to(
        Q1, start=Q0, profile=profile, start_velocity=v, goal_velocity=-v, **limits_for(profile)
    )
    assert (motion(0.0, 1) == v).all()
    assert (motion(motion.duration, 1) == -v).all()
    assert motion.check(bounds(panda, profile))
    if profile not in ("trapezoidal", "cubic"):
        a = np.linspace(2, -2, 7)
        motion = panda.move_to(Q1, start=Q0, profile=profile, start_acceleration=a, **limits_for(profile))
        assert (motion(0.0, 2) == a).all()
        assert motion.check(bounds(panda, profile))


@pytest.mark.parametrize("profile", BOUNDARY_ORDERS)
def test_peaks_of_polynomials_are_those_of_the_table(profile):
    m = BOUNDARY_ORDERS[profile]
    states = np.zeros((2, m, 1))
    states[1, 0] = 1.0
    motion = connect_states(states, 1.0, None)
    for order, peak in enumerate(PEAKS[profile], 1):
        found = motion.extremes(order)
        assert max(found.highest[0], -found.lowest[0]) == pytest.approx(peak, rel=1e-12)


def test_the_quintic_has_the_least_jerk_of_all_motions_between_two_states():
    """Any other motion with the same ends has a larger integral of squared jerk."""
    rng = np.random.default_rng(5)
    states = rng.normal(size=(2, 3, 1))
    t = np.linspace(0.0, 1.3, 20001)
    quintic = connect_states(states, 1.3, None)(t, 3)[:, 0]
    bump = np.poly1d([1.0, 0.0]) ** 3 * np.poly1d([-1.0, 1.3]) ** 3  # zero with two derivatives at both ends
    for power in range(3):
        other = quintic + 0.3 * (bump * np.poly1d([1.0, 0.0]) ** power).deriv(3)(t)
        assert np.trapezoid(other**2, t) > np.trapezoid(quintic**2, t)


def test_septic_jerks_are_zero_at_both_ends(panda):
    motion = panda.move_to(Q1, start=Q0, profile="septic", **limits_for("septic"))
    assert (motion([0.0, motion.duration], 3) == 0.0).all()


def test_limits_that_are_missing_are_named(panda):
    ur5e = cs.load_robot("ur5e")
    with pytest.raises(InputError, match="ur5e has no acceleration limits; pass acceleration="):
        ur5e.move_to(np.ones(6), start=np.zeros(6))
    with pytest.raises(InputError, match="pass jerk="):
        ur5e.move_to(np.ones(6), start=np.zeros(6), acceleration=1.0)
    assert ur5e.move_to(np.ones(6), start=np.zeros(6), profile="quintic", duration=3.0)
    assert panda.move_to(Q1, start=Q0)  # the catalogue has them


def test_a_motion_out_of_position_limits_names_joint_and_time(panda):
    motion = panda.move_to(Q1 + 3.0, start=Q0)
    assert not motion
    assert "panda_joint4 exceeds its upper limit" in motion.reason
    assert panda.move_to(Q1 + 3.0, start=Q0, limits=False)
    # Both ends lie within the limits, the motion swings out between them.
    edge = np.array(panda.limits.upper) - 0.01
    goal = edge - [0.2] * 7
    swing = panda.move_to(goal, start=edge, start_velocity=[1.0] + [0.0] * 6, acceleration=5.0, jerk=100.0)
    assert not swing
    assert "panda_joint1 exceeds its upper limit" in swing.reason


def test_equal_configurations_take_no_time(panda):
    for profile in PROFILES:
        motion = panda.move_to(Q0, start=Q0, profile=profile, **limits_for(profile))
        assert motion
        assert motion.duration == 0.0
        assert (motion(0.0) == Q0).all()
        waiting = panda.move_to(Q0, start=Q0, profile=profile, duration=2.0, **limits_for(profile))
        assert (waiting([0.0, 0.7, 2.0]) == Q0).all()


def test_misuse_is_named(panda):
    for change, error, text in (
        ({"profile": "dubble_s"}, UnknownNameError, "did you mean 'double_s'"),
        ({"profile": "trapezoidal", "jerk": 3.0}, InputTypeError, "jerk= does not go with trapezoidal"),
        ({"profile": "cubic", "start_acceleration": 1.0}, InputTypeError, "use profile='quintic'"),
        ({"profile": "quintic", "synchronize": "none"}, InputTypeError, "does not go with quintic"),
        ({"profile": "quintic", "duration": 0.0}, InputError, "positive"),
        ({"start": np.zeros((2, 7))}, InputError, "one motion"),
        ({"start": np.zeros(6)}, InputError, "shape"),
        ({"profile": "quintic", "start_velocity": 9.0}, InputError, "start_velocity of panda_joint1 is 9"),
    ):
        with pytest.raises(error, match=text):
            panda.move_to(**{"q_goal": Q1, "start": Q0} | change)


def keeps_limits(states, h, most):
    motion = connect_states(states, h, None)
    for order, kind in enumerate(("velocity", "acceleration", "jerk"), 1):
        found = motion.extremes(order)
        if (np.maximum(found.highest, -found.lowest) > most[kind] * (1.0 + 1e-9)).any():
            return False
    return True


@pytest.mark.parametrize("profile", ["cubic", "quintic", "septic"])
def test_no_duration_before_the_shortest_keeps_the_limits_between_moving_states(profile):
    """Windows of durations are not missed: where a dense scan finds one, no later one is answered."""
    rng, counts = np.random.default_rng(8), [0, 0]
    robot = cs.Robot.from_dh([(0.3, 0.0, 0.0, 0.0), (0.2, 0.0, 0.0, 0.0)], convention="standard")
    orders = BOUNDARY_ORDERS[profile]
    most = {"velocity": np.full(2, 1.0), "acceleration": np.full(2, 2.0), "jerk": np.full(2, 40.0)}
    limits = Limits(np.full(2, -np.inf), np.full(2, np.inf), **most)
    for _ in range(20):
        states = np.zeros((2, orders, 2))
        states[:, 0] = rng.normal(size=(2, 2)) * rng.choice([0.01, 0.3, 1.0])
        states[:, 1] = rng.uniform(-1.0, 1.0, (2, 2))
        if orders > 2:
            states[:, 2] = rng.uniform(-2.0, 2.0, (2, 2))
        ends = {"start_velocity": states[0, 1], "goal_velocity": states[1, 1]}
        if orders > 2:
            ends |= {"start_acceleration": states[0, 2], "goal_acceleration": states[1, 2]}
        q0, q1 = states[:, 0]
        motion = robot.move_to(q1, start=q0, profile=profile, limits=False, **ends, **most)
        last = motion.duration * (1.0 - 1e-6) if motion else 20.0
        assert not any(keeps_limits(states, h, most) for h in np.geomspace(0.01, last, 40))
        counts[bool(motion)] += 1
        if not motion:
            assert f"no {profile} motion" in motion.reason
            continue
        assert motion.check(limits)
        ticks = robot.move_to(q1, start=q0, profile=profile, limits=False, cycle=0.004, **ends, **most)
        if ticks:
            assert ticks.check(limits)
            assert np.isclose(ticks.duration / 0.004, round(ticks.duration / 0.004))
            assert ticks.duration >= motion.duration * (1.0 - 1e-9)
    assert counts[1] > 5
    assert profile == "cubic" or counts[0] > 5  # moving states that only double-S motions connect


@pytest.mark.parametrize("width", [1e-2, 1e-4, 1e-6])
def test_a_narrow_window_of_durations_is_found(width):
    """An acceleration at both ends that swings out by its square: only some durations keep the velocity."""
    robot = cs.Robot.from_dh([(0.3, 0.0, 0.0, 0.0)], convention="standard")
    ends = {"start_acceleration": -1.0, "goal_acceleration": 1.0, "acceleration": 1e3}
    wide = robot.move_to([1.0], start=[0.0], profile="septic", limits=False, velocity=1e3, **ends)
    assert wide
    durations = np.geomspace(0.05, 50.0, 500)
    states = np.zeros((2, 4, 1))
    states[1, 0], states[0, 2], states[1, 2] = 1.0, -1.0, 1.0
    peaks = [
        max(abs(e.lowest[0]), abs(e.highest[0]))
        for e in (connect_states(states, h, None).extremes(1) for h in durations)
    ]
    least = min(peaks)
    narrow = robot.move_to(
        [1.0], start=[0.0], profile="septic", limits=False, velocity=least * (1.0 + width), **ends
    )
    assert narrow
    assert narrow.duration == pytest.approx(durations[int(np.argmin(peaks))], rel=0.3)
    below = robot.move_to([1.0], start=[0.0], profile="septic", limits=False, velocity=0.9 * least, **ends)
    assert not below
    assert "whatever its duration" in below.reason
