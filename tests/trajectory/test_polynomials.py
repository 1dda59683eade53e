"""Trajectories of polynomial pieces: derivatives, extremes, joins, checks."""

import numpy as np
import pytest

import cspace as cs
from cspace.errors import CspaceError, InputError, InputTypeError
from cspace.trajectory import PolynomialTrajectory, state_to_state
from cspace.trajectory.polynomials import attain_end


def random_trajectory(rng, degree=5, pieces=4, dof=3):
    knots = np.concatenate([np.zeros((dof, 1)), rng.uniform(0.1, 1.0, (dof, pieces)).cumsum(axis=1)], axis=1)
    knots *= 2.0 / knots[:, -1:]
    knots[:, -1] = 2.0
    c = rng.normal(size=(dof, pieces, degree + 1))
    return PolynomialTrajectory(knots, c)


def rest_to_rest():
    c = np.array([[[0, 0, 0, 10, -15, 6.0]], [[1, 0, 0, -10, 15, -6.0]]])
    parts = attain_end(np.array([0, 1.0]), c, np.array([[1, 0], [0, 0], [0, 0.0]]))
    return PolynomialTrajectory(*parts, joint_names=["a", "b"])


@pytest.mark.parametrize("degree", [1, 2, 3, 5, 7])
def test_extremes_are_those_of_dense_samples_or_beyond(degree):
    rng = np.random.default_rng(degree)
    for _ in range(20):
        motion = random_trajectory(rng, degree)
        t = np.sort(np.concatenate([np.linspace(0, motion.duration, 5001), motion.knots]))
        for order in range(4):
            values, found = motion(t, order), motion.extremes(order)
            size = np.abs(values).max() + 1e-12
            assert (values.max(axis=0) <= found.highest + 1e-12 * size).all()
            assert (values.min(axis=0) >= found.lowest - 1e-12 * size).all()
            if order < degree:  # attained where the answer says, from one side at least
                for j in range(motion.dof):
                    sides = [
                        motion._evaluate_joint(j, found.t_highest[j : j + 1], order, side)
                        for side in (True, False)
                    ]
                    assert np.isclose(sides, found.highest[j], atol=1e-12 * size).any()


def test_derivatives_agree_with_differences():
    motion = random_trajectory(np.random.default_rng(1), 5, 1)
    t, h = np.linspace(0.1, 1.9, 50), 1e-5
    for order in range(3):
        slope = (motion(t + h, order) - motion(t - h, order)) / (2 * h)
        assert np.allclose(slope, motion(t, order + 1), atol=1e-5 * np.abs(slope).max())


def test_both_ends_are_attained_exactly():
    motion = rest_to_rest()
    assert (motion(0.0) == [0, 1]).all()
    assert (motion(1.0) == [1, 0]).all()
    assert (motion(1.0, 1) == 0).all()
    assert (motion(1.0, 2) == 0).all()


def test_scaled_and_reversed_are_the_same_path():
    motion = random_trajectory(np.random.default_rng(2))
    t = np.linspace(0.0, 2.0, 101)[1:-1]
    slow, back = motion.scaled(2.5), motion.reversed()
    for order in range(4):
        assert np.allclose(slow(2.5 * t, order), motion(t, order) / 2.5**order)
        assert np.allclose(back(2.0 - t, order), (-1) ** order * motion(t, order))
    assert slow.duration == 5.0


def test_joined_motions_say_up_to_which_order_they_fit():
    motion = rest_to_rest()
    there_and_back = motion.then(motion.reversed())
    assert there_and_back.duration == 2.0
    assert there_and_back.continuity == 2  # the jerk jumps from 60 to −60
    assert motion.then(motion.scaled(2.0).reversed()).continuity == 2
    with pytest.raises(InputError, match="position of a jumps from 1 to 0"):
        motion.then(motion)


def test_joined_with_other_kinds_of_trajectories():
    a = rest_to_rest()
    joined = cs.trajectory.JoinedTrajectory([a, a.reversed(), a])
    t = np.linspace(0.0, 3.0, 100)
    merged = a.then(a.reversed()).then(a)
    for order in range(4):
        assert np.allclose(joined(t, order), merged(t, order))
    assert np.allclose(joined.extremes(1).highest, merged.extremes(1).highest)
    assert np.allclose(joined.reversed()(t), merged.reversed()(t))
    assert joined.scaled(2.0).duration == 6.0


def test_a_check_names_joint_limit_and_time():
    limits = cs.Limits([-1, -1], [1, 1], velocity=[1, 2], acceleration=[5, 6])
    check = rest_to_rest().check(limits)
    assert not check
    first, second = check.violations
    assert (first.joint, first.limit) == ("a", "acceleration")
    assert first.excess == pytest.approx(10 / np.sqrt(3) - 5)
    assert (second.joint, second.limit, second.worst_time) == ("a", "velocity", 0.5)
    assert second.excess == pytest.approx(0.875)
    motion = rest_to_rest()
    assert motion(second.time, 1)[0] == pytest.approx(1.0)
    assert "a exceeds its acceleration limit" in check.reason
    assert motion.scaled(1.875).check(limits)


def test_binding_limits_are_stretches_of_time():
    limits = cs.Limits([-9, -9], [9, 9], velocity=[1.875, 2])
    (binding,) = rest_to_rest().binding(limits)
    assert (binding.joint, binding.limit) == ("a", "velocity")
    assert binding.begin < 0.5 < binding.end < 0.501


def test_a_peak_between_samples_is_found():
    """A spike of a millisecond in a motion of a thousand seconds."""
    knots = np.array([0.0, 500.0, 500.001, 1000.0])
    spike = np.zeros((1, 3, 5))
    spike[0, 1, 1:] = 0.0, 1e3, -2e6 / 3, 0.0
    motion = PolynomialTrajectory(knots, spike)
    check = motion.check(cs.Limits([-9], [9], velocity=[0.1]))
    assert check.violations[0].worst_time == pytest.approx(500.0005)


def test_samples_contain_the_end_and_times_increase():
    motion = rest_to_rest().scaled(1.2345)
    for rate in (1.0, 3.0, 100.0, 1e3 / 1.2345):
        samples = motion.sample(rate)
        assert samples.times[0] == 0.0
        assert samples.times[-1] == motion.duration
        assert (np.diff(samples.times) > 0.1 / rate * 1e-3).all()
        assert (samples.q[-1] == [1, 0]).all()


def test_times_outside_are_refused():
    motion = rest_to_rest()
    with pytest.raises(InputError, match=r"t is 1\.5 s; the trajectory is from 0 to 1 s"):
        motion(1.5)
    assert motion(1.0 + 1e-13).shape == (2,)
    assert motion(np.zeros((2, 3))).shape == (2, 3, 2)
    with pytest.raises(InputError, match="order"):
        motion(0.0, 4)


def test_bad_pieces_are_refused():
    with pytest.raises(InputError, match="expected"):
        PolynomialTrajectory([0, 1, 2], np.zeros((1, 1, 4)))
    with pytest.raises(InputError, match="not decrease"):
        PolynomialTrajectory([0, 2, 1], np.zeros((1, 2, 4)))
    with pytest.raises(InputError, match="limits is of 3 joints"):
        rest_to_rest().check(cs.Limits([0] * 3, [1] * 3))


NOT_NUMBERS = ("x", b"x", [], object(), {}, 1 + 2j, None, np.nan, np.array(["a"]), lambda: 0)


def every_kind():
    """A motion of each class."""
    way = cs.spline([[0.0, 0.0], [1.0, 1.0], [2.0, 0.0]])
    limits = {"velocity": 1.0, "acceleration": 1.0}
    made = state_to_state([0.0, 0.0], [1.0, 1.0], jerk=1.0, **limits)
    timed = [cs.time_parametrize(way, **limits), cs.time_parametrize(way, jerk=5.0, **limits)]
    return [made, *timed, made.then(made.reversed())]


@pytest.mark.parametrize("kind", range(4))
def test_calls_with_anything_but_numbers_are_refused(kind):
    motion = every_kind()[kind]
    calls = [motion, motion.sample, motion.scaled, lambda x: motion(0.1, x)]
    if hasattr(motion, "parameter"):
        calls += [motion.parameter, lambda x: motion.parameter(0.1, x)]
    for call in calls:
        for value in NOT_NUMBERS:
            if isinstance(value, list) and call in (motion, getattr(motion, "parameter", None)):
                continue  # no times at all: no answers
            with pytest.raises(CspaceError):
                call(value)


@pytest.mark.parametrize("kind", range(4))
def test_any_factor_makes_a_motion_of_finite_numbers_or_is_refused(kind):
    motion = every_kind()[kind]
    for power in (*range(-300, 301, 20), -29, -15, 15, 29):
        factor = 10.0**power
        if not 1e-30 <= factor <= 1e30:
            with pytest.raises(InputError, match="factor"):
                motion.scaled(factor)
            continue
        other = motion.scaled(factor)
        assert other.duration == pytest.approx(factor * motion.duration)
        t = np.linspace(0.0, 1.0, 30)
        np.testing.assert_allclose(other(t * other.duration), motion(t * motion.duration), atol=1e-9)
        for order in (1, 2, 3):
            assert np.isfinite(other(t * other.duration, order)).all()


def test_no_jerk_limit_is_none_or_infinity():
    ends = ([0.0, 0.3], [1.0, -1.0])
    limits = {"velocity": 1.0, "acceleration": [1.0, 2.0]}
    for options in ({}, {"cycle": 0.01}, {"duration": 9.0}, {"synchronize": "none"}):
        one, other, third = (
            state_to_state(*ends, **limits, **options, **each)
            for each in ({}, {"jerk": None}, {"jerk": np.inf})
        )
        assert one.duration == other.duration == third.duration
    for names in (3, 0.5, "ab", [1, 2], object()):
        with pytest.raises(InputTypeError, match="joint_names"):
            state_to_state(*ends, **limits, joint_names=names)
