"""Motions from state to state at any magnitude of lengths and times."""

from __future__ import annotations

import numpy as np
import pytest

from cspace.errors import InputError
from cspace.trajectory import state_to_state


def draw_problem(rng, dof=3):
    """Start and goal (3, dof), and limits of velocity, acceleration and jerk (3, dof)."""
    limits = np.array([rng.uniform(0.5, 2, dof), rng.uniform(0.5, 3, dof), rng.uniform(1, 20, dof)])

    def draw_state():
        q = rng.normal(size=dof) * 10 ** rng.uniform(-3, 2)
        a = rng.uniform(-0.3, 0.3, dof) * limits[1] * (rng.random() < 0.5)
        return np.array([q, rng.uniform(-0.5, 0.5, dof) * limits[0], a])

    return draw_state(), draw_state(), limits


def solve(start, goal, limits):
    names = ("velocity", "acceleration")
    ends = {f"start_{n}": start[k] for k, n in enumerate(names, 1)}
    ends |= {f"goal_{n}": goal[k] for k, n in enumerate(names, 1)}
    bounds = dict(zip((*names, "jerk"), limits, strict=True))
    return state_to_state(start[0], goal[0], **ends, **bounds)


@pytest.mark.parametrize("seed", range(8))
def test_units_do_not_matter(seed):
    """In units of length and time from 1e-9 to 1e9 the motion is the same, to rounding."""
    rng, compared = np.random.default_rng(seed), 0
    for _ in range(60):
        start, goal, limits = draw_problem(rng)
        try:
            plain = solve(start, goal, limits)
        except InputError:  # a goal that no motion within the limits leads to
            continue
        length, time = 10 ** rng.uniform(-9, 9, 2)
        units = length / time ** np.arange(4.0)
        scaled = solve(start * units[:3, None], goal * units[:3, None], limits * units[1:, None])
        compared += 1
        assert scaled.duration == pytest.approx(time * plain.duration, rel=1e-14)
        shares = np.linspace(0, 1, 33)
        for order in range(3):
            here, there = plain(shares * plain.duration, order), scaled(shares * scaled.duration, order)
            size = np.abs(here).max() + (limits[order - 1].max() if order else 0.0)
            assert np.abs(there / units[order] - here).max() < 1e-11 * size
    assert compared > 30


@pytest.mark.parametrize("jerk", [None, 20.0, 1e60])
@pytest.mark.parametrize("decades", [(2, 30), (30, 70), (90, 100)])
def test_a_limit_that_is_never_reached_is_none(decades, jerk):
    rng = np.random.default_rng(1)
    for _ in range(40):
        start, goal, acceleration = rng.normal(size=2), rng.normal(size=2), rng.uniform(0.1, 5, 2)
        most = 10 ** rng.uniform(*decades)
        found, free = (
            state_to_state(start, goal, velocity=v, acceleration=acceleration, jerk=jerk)
            for v in (most, np.inf)
        )
        assert found.duration == pytest.approx(free.duration, rel=1e-13)
        t = np.linspace(0, min(found.duration, free.duration), 9)
        assert np.allclose(found(t), free(t), rtol=0, atol=1e-11)


@pytest.mark.parametrize("decade", [0, 3, 5, 7, 9])
def test_long_motions_are_off_by_the_rounding_of_time_alone(decade):
    """A time t is known to an ulp of the duration; derivatives change by the next one times that. This is how
    far velocities and accelerations jump between pieces, and pass their limits. Positions jump in the middle
    by what such a velocity adds over the whole motion."""
    rng = np.random.default_rng(decade)
    for _ in range(60):
        start, goal, limits = draw_problem(rng, 1)
        start[0], goal[0] = rng.normal(size=2) * 10.0**decade
        start[2] = goal[2] = 0
        motion = solve(start, goal, limits)
        knots, ulp = motion.joint_knots[0, 1:-1], np.spacing(motion.duration)
        v, a, j = limits[:, 0]
        lengths = abs(start[0, 0]) + abs(goal[0, 0]) + v * motion.duration
        over_all = 8 * ulp * a * motion.duration
        slack = [
            8 * (ulp * v + np.spacing(lengths)) + over_all,
            8 * ulp * a + 1e-14 * v,
            8 * ulp * j + 1e-14 * a,
        ]
        for order in range(3):
            sides = [motion._evaluate_joint(0, knots, order, before) for before in (True, False)]
            assert np.abs(sides[0] - sides[1]).max(initial=0.0) <= slack[order], order
        assert np.abs(motion(knots, 1)).max(initial=0.0) <= v + slack[1]
        assert np.abs(motion(knots, 2)).max(initial=0.0) <= a + slack[2]
        assert np.array_equal(motion(0.0), start[0])
        assert np.array_equal(motion(motion.duration), goal[0])
        assert np.array_equal(motion(motion.duration, 1), goal[1])


@pytest.mark.parametrize("name", ["velocity", "acceleration", "jerk"])
def test_limits_beyond_all_magnitudes_are_refused(name):
    limits = {"velocity": 1.0, "acceleration": 2.0, "jerk": 3.0}
    for start in (np.zeros(2), [0.0, 0.0]):
        with pytest.raises(InputError, match=rf"{name} contains 1e\+101.*inf or None is no limit"):
            state_to_state(start, np.ones(2), **limits | {name: 1e101})
        assert state_to_state(start, np.ones(2), **limits | {name: np.inf})


@pytest.mark.parametrize("jerk", [None, 20.0])
@pytest.mark.parametrize("length", [10.0, 1e3, 1e5, 1e7, 1e9])
@pytest.mark.parametrize("synchronize", ["time", "phase", "none"])
def test_positions_of_long_motions_jump_by_the_rounding_of_time_alone(length, jerk, synchronize):
    rng = np.random.default_rng(int(length))
    for _ in range(30):
        velocity, acceleration = rng.uniform(0.5, 3, 3), rng.uniform(0.5, 10, 3)
        way = velocity * rng.uniform(-1, 1, 3) * length
        start = rng.uniform(-3, 3, 3)
        moving = velocity if synchronize != "phase" else 0.5 * way / length
        begin, end = (moving * rng.uniform(-1, 1, 3 if synchronize != "phase" else 1) for _ in range(2))
        motion = state_to_state(
            start, start + way, velocity=velocity, acceleration=acceleration, jerk=jerk,
            synchronize=synchronize, start_velocity=begin,
            goal_velocity=end if synchronize != "none" else 0.0 * end,
        )  # fmt: skip
        inner = motion.knots[1:-1]
        for j in range(3):
            before, after = (motion._evaluate_joint(j, inner, 0, side) for side in (True, False))
            rounding = np.spacing(motion.duration) * velocity[j] + np.spacing(np.abs(way[j]) + 3.0)
            assert np.abs(after - before).max(initial=0.0) <= 16 * rounding
        if length <= 1e5:
            assert motion.continuity == (1 if jerk is None else 2)
