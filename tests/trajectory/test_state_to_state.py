"""Motions from state to state: laws that every one keeps."""

import numpy as np
import pytest

import cspace as cs
from cspace.errors import InputError, InputTypeError, UnknownNameError
from cspace.trajectory import PolynomialTrajectory, TrajectoryBatch, state_to_state
from trajectory.problems import MAGNITUDES, random_problem, within_limits

KINDS = ("any", "rest", "steps")


def limits_of(problem):
    free = np.full(len(problem["start"]), np.inf)
    return cs.Limits(-free, free, **{name: problem[name] for name in MAGNITUDES})


def has_exact_ends(motion, problem):
    names = "", "_velocity", "_acceleration"
    for order, name in enumerate(names):
        for t, key in ((0.0, "start" + name), (motion.duration, "goal" + name)):
            given = problem.get(key, 0.0)
            assert (motion(t, order) == given).all(), (key, motion(t, order) - given)


@pytest.mark.parametrize("kind", KINDS)
def test_limits_are_kept_and_both_ends_exact(kind):
    rng = np.random.default_rng(11)
    for _ in range(150):
        problem = within_limits(random_problem(rng, 3, kind))
        motion = state_to_state(**problem)
        if motion.duration == 0.0:
            continue
        has_exact_ends(motion, problem)
        check = motion.check(limits_of(problem))
        assert check, check.violations
        assert motion.continuity >= 2


@pytest.mark.parametrize("kind", KINDS)
def test_any_duration_that_is_answered_is_kept(kind):
    rng = np.random.default_rng(12)
    refused = 0
    for _ in range(100):
        problem = within_limits(random_problem(rng, 3, kind))
        least = state_to_state(**problem).duration
        asked = least * rng.uniform(0.3, 3.0) + 1e-3
        motion = state_to_state(**problem, duration=asked)
        if not motion:
            refused += 1
            assert "is not possible" in motion.reason
            assert motion.duration > asked
            assert state_to_state(**problem, duration=motion.duration)
        else:
            assert motion.duration == pytest.approx(asked, rel=1e-12)
        has_exact_ends(motion, problem)
        assert motion.check(limits_of(problem))
        assert motion.continuity >= 2
    assert refused > 10


def test_a_shorter_time_is_refused_and_the_shortest_accepted():
    rng = np.random.default_rng(13)
    for _ in range(100):
        problem = within_limits(random_problem(rng, 1))
        motion = state_to_state(**problem)
        assert state_to_state(**problem, duration=motion.duration)
        assert not state_to_state(**problem, duration=motion.duration * (1 - 1e-6))


def test_reversed_problems_take_the_same_time():
    rng = np.random.default_rng(14)
    for _ in range(100):
        problem = within_limits(random_problem(rng, 2))
        back = problem | {
            "start": problem["goal"],
            "goal": problem["start"],
            "start_velocity": -problem["goal_velocity"],
            "goal_velocity": -problem["start_velocity"],
            "start_acceleration": problem["goal_acceleration"],
            "goal_acceleration": problem["start_acceleration"],
        }
        assert state_to_state(**back).duration == pytest.approx(state_to_state(**problem).duration, rel=1e-9)


def test_times_scale_as_physics_says():
    """Lengths by λ and times by τ: velocities by λ/τ, accelerations by λ/τ², jerks by λ/τ³."""
    rng = np.random.default_rng(15)
    for _ in range(100):
        problem = within_limits(random_problem(rng, 2))
        length, time = np.exp(rng.uniform(-7, 7, 2))
        factors = {"velocity": length / time, "acceleration": length / time**2, "jerk": length / time**3}
        scaled = {key: value * factors.get(key.rpartition("_")[2], length) for key, value in problem.items()}
        want = state_to_state(**problem).duration * time
        assert state_to_state(**scaled).duration == pytest.approx(want, rel=1e-9)


def test_mirrored_problems_take_the_same_time():
    rng = np.random.default_rng(16)
    for _ in range(100):
        problem = within_limits(random_problem(rng, 2))
        mirrored = {key: value if key in MAGNITUDES else -value for key, value in problem.items()}
        assert state_to_state(**mirrored).duration == pytest.approx(
            state_to_state(**problem).duration, rel=1e-12
        )


def test_known_durations():
    """Rest to rest in closed form: all phases, no cruise, no hold."""
    limits = {"velocity": 1.0, "acceleration": 2.0, "jerk": 20.0}
    assert state_to_state([0.0], [1.0], **limits).duration == pytest.approx(1 + 0.5 + 0.1)
    assert state_to_state([0.0], [1e-4], **limits).duration == pytest.approx((32e-4 / 20) ** (1 / 3))
    trapezoid = {"velocity": 1.0, "acceleration": 2.0}
    assert state_to_state([0.0], [1.0], **trapezoid).duration == pytest.approx(1.5)
    assert state_to_state([0.0], [0.125], **trapezoid).duration == pytest.approx(0.5)


def test_trapezoids_are_the_limit_of_large_jerks():
    rng = np.random.default_rng(17)
    for _ in range(50):
        problem = within_limits(random_problem(rng, 2)) | {
            "start_acceleration": None,
            "goal_acceleration": None,
        }
        problem["start_velocity"] = np.clip(
            problem["start_velocity"], -problem["velocity"], problem["velocity"]
        )
        trapezoid = state_to_state(**problem | {"jerk": np.inf})
        smooth = state_to_state(**problem | {"jerk": 1e7})
        assert trapezoid.duration == pytest.approx(smooth.duration, abs=1e-4)
        assert trapezoid.check(limits_of(problem | {"jerk": np.full(2, np.inf)}))
        assert (trapezoid(trapezoid.duration) == problem["goal"]).all()


def test_fast_starts_are_brought_within_limits_and_stay_there():
    rng = np.random.default_rng(18)
    for _ in range(100):
        problem = random_problem(rng, 2)
        problem["start_velocity"] = rng.uniform(-3, 3, 2) * problem["velocity"]
        problem["start_acceleration"] = rng.uniform(-2, 2, 2) * problem["acceleration"]
        motion = state_to_state(**problem)
        has_exact_ends(motion, problem)
        assert motion.continuity >= 2
        outside = motion.extremes(2)
        most = np.maximum(np.abs(problem["start_acceleration"]), problem["acceleration"])
        assert (outside.highest <= most * (1 + 1e-9)).all()
        assert (outside.lowest >= -most * (1 + 1e-9)).all()


def test_phase_synchronised_motions_are_straight():
    rng = np.random.default_rng(19)
    for _ in range(50):
        problem = random_problem(rng, 3, "rest")
        motion = state_to_state(**problem, synchronize="phase")
        q = motion(np.linspace(0.0, motion.duration, 50)) - problem["start"]
        line = problem["goal"] - problem["start"]
        s = q @ line / (line @ line)
        assert np.allclose(q, s[:, None] * line, atol=1e-12)
        assert (motion(motion.duration) == problem["goal"]).all()
        assert motion.check(limits_of(problem))
        assert motion.duration >= state_to_state(**problem).duration * (1 - 1e-12)


def test_moving_states_on_one_line_move_in_phase():
    line = np.array([1.0, -2.0, 0.0])
    limits = {"velocity": [1.0, 1.0, 1.0], "acceleration": 2.0, "jerk": 10.0}
    motion = state_to_state(
        0 * line, line, start_velocity=-0.1 * line, goal_velocity=0.2 * line, synchronize="phase", **limits
    )
    assert np.allclose(motion(np.linspace(0, motion.duration, 9)) @ [2, 1, 5], 0.0, atol=1e-12)
    with pytest.raises(InputError, match="are not parallel"):
        state_to_state(0 * line, line, start_velocity=[0.1, 0.1, 0.0], synchronize="phase", **limits)


def test_joints_alone_take_their_own_shortest_time():
    limits = {"velocity": 1.0, "acceleration": 2.0, "jerk": 20.0}
    motion = state_to_state([0, 0, 0], [1, 0.1, 0], synchronize="none", **limits)
    alone = state_to_state([0], [0.1], **limits)
    assert (motion(alone.duration + 1e-12)[1:] == [0.1, 0]).all()
    assert np.allclose(motion(alone.duration / 3)[1], alone(alone.duration / 3)[0])
    assert (motion(motion.duration) == [1, 0.1, 0]).all()
    with pytest.raises(InputError, match="must rest"):
        state_to_state([0], [1], goal_velocity=[0.5], synchronize="none", **limits)


def test_durations_are_multiples_of_a_cycle():
    rng = np.random.default_rng(20)
    for _ in range(50):
        problem = within_limits(random_problem(rng, 3))
        motion = state_to_state(**problem, cycle=0.008)
        count = motion.duration / 0.008
        assert abs(count - round(count)) < 1e-9
        assert motion.duration >= state_to_state(**problem).duration
        has_exact_ends(motion, problem)
        assert motion.check(limits_of(problem))


def test_batches_are_the_single_motions():
    rng = np.random.default_rng(21)
    limits = {"velocity": 1.0, "acceleration": 3.0, "jerk": 20.0}
    start, goal = rng.normal(size=(2, 300, 4))
    v = rng.uniform(-1, 1, (300, 4))
    batch = state_to_state(start, goal, start_velocity=v, **limits)
    assert isinstance(batch, TrajectoryBatch)
    assert batch
    assert len(batch) == 300
    for i in (0, 7, 299):
        one = state_to_state(start[i], goal[i], start_velocity=v[i], **limits)
        assert isinstance(one, PolynomialTrajectory)
        assert one.duration == batch.durations[i] == batch[i].duration
        t = np.linspace(0, one.duration, 20)
        assert (batch[i](t) == one(t)).all()
        alone = [
            state_to_state(start[i, j : j + 1], goal[i, j : j + 1], start_velocity=v[i, j : j + 1], **limits)
            for j in range(4)
        ]
        assert np.allclose([each.duration for each in alone], batch.shortest[i])
    short = state_to_state(start, goal, duration=0.5, **limits)
    assert not short
    assert "not possible" in short.reason
    assert not short.possible.all()


def test_unlimited_velocities_and_accelerations():
    motion = state_to_state([0.0], [1.0], velocity=np.inf, acceleration=np.inf, jerk=32.0)
    assert motion.duration == pytest.approx(1.0)
    motion = state_to_state([0.0], [1.0], velocity=np.inf, acceleration=4.0)
    assert motion.duration == pytest.approx(1.0)


@pytest.mark.parametrize("size", [1e-18, 1e-9, 1e4])
def test_tiny_and_huge_displacements(size):
    motion = state_to_state([0.0, 0.0], [size, -size / 3], velocity=1.0, acceleration=2.0, jerk=20.0)
    assert (motion(motion.duration) == [size, -size / 3]).all()
    limits = cs.Limits([-np.inf] * 2, [np.inf] * 2, velocity=[1] * 2, acceleration=[2] * 2, jerk=[20] * 2)
    assert motion.check(limits)
    far = state_to_state([0.0], [1e9], velocity=1.0, acceleration=2.0, jerk=20.0)
    assert far.duration == pytest.approx(1e9 + 0.6, rel=1e-15)


@pytest.mark.parametrize("seed", [5, 22, 23, 24])
def test_very_unequal_limits(seed):
    rng = np.random.default_rng(seed)
    for _ in range(300):
        low, high = 10.0 ** rng.uniform(-3, 3, (2, 2))
        motion = state_to_state(
            [0.0],
            [rng.normal()],
            velocity=high[0],
            lowest_velocity=-low[0],
            acceleration=high[1],
            lowest_acceleration=-low[1],
            jerk=10.0 ** rng.uniform(-3, 3),
        )
        v, a = motion.extremes(1), motion.extremes(2)
        assert v.highest[0] <= high[0] * (1 + 1e-9)
        assert v.lowest[0] >= -low[0] * (1 + 1e-9)
        assert a.highest[0] <= high[1] * (1 + 1e-9)
        assert a.lowest[0] >= -low[1] * (1 + 1e-9)


def test_nothing_to_do_takes_no_time():
    limits = {"velocity": 1.0, "acceleration": 2.0, "jerk": 20.0}
    motion = state_to_state([1.0, 2.0], [1.0, 2.0], **limits)
    assert motion
    assert motion.duration == 0.0
    assert (motion(0.0) == [1.0, 2.0]).all()
    waiting = state_to_state([1.0, 2.0], [1.0, 2.0], duration=3.0, lowest_velocity=-7.0, **limits)
    assert waiting.duration == 3.0
    assert (waiting(np.linspace(0, 3, 7)) == [1.0, 2.0]).all()
    cruising = state_to_state([1.0], [1.0], start_velocity=[0.5], goal_velocity=[0.5], **limits)
    assert cruising.duration == 0.0
    assert state_to_state(np.zeros((0, 3)), np.zeros((0, 3)), **limits).durations.shape == (0,)


def test_misuse_is_named():
    limits = {"velocity": 1.0, "acceleration": 2.0, "jerk": 20.0}
    for change, error, text in (
        ({"velocity": 0.0}, InputError, "velocity contains 0; it must be above zero"),
        ({"jerk": -1.0}, InputError, "jerk contains -1"),
        ({"acceleration": np.inf, "jerk": np.inf}, InputError, "joint 0 has no limit of acceleration"),
        ({"goal_velocity": [2.0, 0.0]}, InputError, "goal_velocity of joint 0 is 2; it must be within"),
        ({"goal_velocity": [1.0, 0.0], "goal_acceleration": [-1.0, 0.0]}, InputError, "before goal_acc"),
        ({"start_velocity": [np.nan, 0.0]}, InputError, "must be finite"),
        ({"start_velocity": [0.0] * 3}, InputError, "shape"),
        ({"synchronize": "tiem"}, UnknownNameError, "did you mean 'time'"),
        ({"duration": 1.0, "cycle": 0.1}, InputTypeError, "do not go together"),
        ({"duration": -1.0}, InputError, "must not be negative"),
        ({"lowest_velocity": 1.0}, InputError, "must be below zero"),
        ({"joint_names": ["a"]}, InputError, "1 names"),
    ):
        with pytest.raises(error, match=text):
            state_to_state([0.0, 0.0], [1.0, 1.0], **limits | change)


@pytest.mark.parametrize("kind", KINDS)
def test_many_axes_at_once_move_as_one_alone(kind):
    # Motions in phase are solved one axis at a time, others in lanes.
    rng = np.random.default_rng(21)
    for _ in range(20):
        problem = random_problem(rng, 60, kind)
        names = [name for name in problem if name not in MAGNITUDES]
        rows = {name: np.stack([problem[name]] * 4)[:, :1] * rng.uniform(0, 1, (4, 1)) for name in names}
        limits = {name: problem[name][:1] for name in MAGNITUDES}
        rows |= {name: problem[name][:1] + np.zeros((4, 1)) for name in names if name.startswith("goal_")}
        lanes = state_to_state(**rows, **limits)
        alone = state_to_state(**rows, **limits, synchronize="phase")
        np.testing.assert_allclose(lanes.durations, alone.durations, rtol=1e-9, atol=1e-12)
        for a, b in zip(lanes, alone, strict=True):
            t = np.linspace(0.0, min(a.duration, b.duration), 50)
            np.testing.assert_allclose(a(t), b(t), atol=1e-8)


def test_single_calls_are_rows_of_batches():
    rng = np.random.default_rng(22)
    for kind in KINDS:
        for _ in range(50):
            problem = random_problem(rng, 7, kind)
            one = state_to_state(**problem)
            listed = state_to_state(**{name: value.tolist() for name, value in problem.items()})
            assert one.duration == listed.duration
            assert np.array_equal(one.coefficients, listed.coefficients)
            assert np.array_equal(one.joint_knots, listed.joint_knots)
