"""within, nearest and wrapped against trying every whole turn."""

import itertools

import numpy as np
import pytest

from cspace.errors import InputError, InputTypeError, UnknownNameError
from cspace.model import Limits
from cspace.robot import Robot
from ik.arms import load
from ik.geometries import random_q

TURN = 2 * np.pi
ROBOTS = ["ur5e", "puma560", "al5d"]


def limits(lower, upper):
    return Limits(lower=np.array(lower, dtype=float), upper=np.array(upper, dtype=float))


def solutions(name, seed=0):
    robot = load(name)
    return robot.ik(robot.fk(random_q(np.random.default_rng(seed), robot.dof)))


def turns_inside(angle, lower, upper, most=4):
    return [angle + k * TURN for k in range(-most, most + 1) if lower <= angle + k * TURN <= upper]


def every_copy(q, bounds):
    """All combinations of whole turns of all rows of q inside the limits."""
    out = []
    for row in q:
        choices = [turns_inside(*joint) for joint in zip(row, bounds.lower, bounds.upper, strict=True)]
        out.extend(itertools.product(*choices))
    return np.array(out).reshape(-1, q.shape[1])


def as_set(q):
    return {tuple(np.round(row, 9)) for row in q}


def random_limits(rng, n, kind):
    if kind == "narrow":
        middle = rng.uniform(-np.pi, np.pi, n)
        return limits(middle - 2, middle + 2)
    if kind == "two turns":
        return limits([-TURN] * n, [TURN] * n)
    if kind == "350 degrees":
        return limits([-np.radians(350)] * n, [np.radians(350)] * n)
    if kind == "far away":
        middle = rng.uniform(-20, 20, n)
        return limits(middle - 3, middle + 3)
    lower = np.where(rng.random(n) < 0.5, -np.inf, rng.uniform(-9, 0, n))
    upper = np.where((rng.random(n) < 0.5) | np.isfinite(lower), np.inf, rng.uniform(0, 9, n))
    return limits(lower, upper)


KINDS = ["narrow", "two turns", "350 degrees", "far away", "one-sided"]


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("name", ROBOTS)
def test_within_keeps_exactly_what_a_whole_turn_brings_inside(name, kind):
    rng = np.random.default_rng([1, *map(ord, kind)])
    for seed in range(8):
        found = solutions(name, seed)
        bounds = random_limits(rng, found.solver.dof, kind)
        inside = found.within(bounds)
        fits = [
            all(turns_inside(*joint, most=9) for joint in zip(row, bounds.lower, bounds.upper, strict=True))
            for row in found.q
        ]
        assert len(inside) == sum(fits)
        assert bool(inside) == any(fits)
        assert ((inside.q >= bounds.lower) & (inside.q <= bounds.upper)).all()
        assert (
            np.abs((inside.q - found.q[fits]) / TURN - np.round((inside.q - found.q[fits]) / TURN)).max(
                initial=0
            )
            < 1e-12
        )
        assert inside.branch == tuple(b for b, ok in zip(found.branch, fits, strict=True) if ok)
        # The violations name the joints of exactly those rows that no turn brings inside.
        assert [not v for v in found.violations(bounds)] == fits


@pytest.mark.parametrize("kind", ["narrow", "two turns", "350 degrees", "far away"])
@pytest.mark.parametrize("name", ROBOTS)
def test_windings_are_all_copies_and_nothing_else(name, kind):
    rng = np.random.default_rng([2, *map(ord, kind)])
    for seed in range(3):
        found = solutions(name, seed)
        bounds = random_limits(rng, found.solver.dof, kind)
        copies = found.within(bounds, windings=True)
        expected = every_copy(found.q, bounds) if kind != "far away" else None
        if expected is not None:
            assert len(copies) == len(expected)
            assert as_set(copies.q) == as_set(expected)
        assert ((copies.q >= bounds.lower) & (copies.q <= bounds.upper)).all()
        assert (len(copies) > 0) == bool(found.within(bounds))
        if len(copies):
            assert copies.residual.max() < 1e-9


def test_windings_of_an_arm_with_two_turns_on_each_joint():
    found = solutions("ur5e")
    copies = found.within(limits([-TURN] * 6, [TURN] * 6), windings=True)
    assert len(copies) == 64 * len(found)
    assert len(set(map(tuple, copies.q))) == len(copies)
    assert len(copies.branch) == len(copies)


def test_windings_with_a_limit_on_one_side_keep_what_within_keeps():
    for seed in range(10):
        found = solutions("puma560", seed)
        bounds = limits(
            [0.5, -np.inf, -np.inf, 7, -np.inf, -np.inf], [np.inf, -0.5, np.inf, np.inf, -8, np.inf]
        )
        assert as_set(found.within(bounds, windings=True).q) == as_set(found.within(bounds).q)
        assert len(found.within(bounds)) == len(found)


def test_limits_of_a_thousand_turns_are_refused_before_they_are_listed():
    with pytest.raises(InputError, match="copies of the solutions by multiples of 2π"):
        solutions("ur5e").within(limits([-6000] * 6, [6000] * 6), windings=True)


def test_limits_that_nothing_fits_name_the_joint_and_by_how_much():
    found = solutions("ur5e")
    others = np.full(6, 100.0)
    middle = found.q[:, 2]
    gap = np.sort(np.append(middle, middle[np.argmin(middle)] + TURN))
    hole = int(np.argmax(np.diff(gap)))
    centre = 0.5 * (gap[hole] + gap[hole + 1])
    lower, upper = -others, others.copy()
    lower[2], upper[2] = centre - 0.01, centre + 0.01
    none = found.within(limits(lower, upper))
    assert not none
    assert len(none) == 0
    out = 0.5 * (gap[hole + 1] - gap[hole]) - 0.01
    assert f"elbow_joint out by {out:.4g} rad" in none.reason
    assert f"{len(found)} configurations reach the goal, none within limits" in none.reason
    assert not none.nearest(np.zeros(6))


def test_no_solution_is_lost_at_the_border_of_its_limits():
    found = solutions("puma560")
    for row in found.q:
        inside = found.within(limits(row, row + 0.1))
        assert np.array_equal(inside.q[0], row)
        assert found.within(limits(row - 0.1, row))


@pytest.mark.parametrize("metric", ["euclidean", "max"])
@pytest.mark.parametrize("name", ROBOTS)
def test_nearest_against_every_winding(name, metric):
    rng = np.random.default_rng(4)
    for seed in range(6):
        found = solutions(name, seed)
        robot = found.solver
        q = rng.uniform(-7, 7, robot.dof)
        one = found.nearest(q, metric)
        assert len(one) == 1
        wide = limits([-3 * TURN] * robot.dof, [3 * TURN] * robot.dof)
        order = 2 if metric == "euclidean" else np.inf
        best = []
        for row in found.q:
            copies = [turns_inside(*joint) for joint in zip(row, wide.lower, wide.upper, strict=True)]
            near = [
                min(c, key=lambda a: abs(a - seed_angle))
                for c, seed_angle in zip(inside_own_limits(copies, robot.limits), q, strict=True)
            ]
            best.append(near)
        distances = np.linalg.norm(np.array(best) - q, ord=order, axis=1)
        assert np.isclose(np.linalg.norm(one.q[0] - q, ord=order), distances.min(), atol=1e-9)


def inside_own_limits(copies, bounds):
    """Per joint the copies inside the limits, or all where there are none."""
    out = []
    for angles, lower, upper in zip(copies, bounds.lower, bounds.upper, strict=True):
        out.append([a for a in angles if lower <= a <= upper] or angles)
    return out


def test_nearest_to_a_solution_is_itself():
    for name in ROBOTS:
        found = solutions(name)
        for q in found.within().q:
            assert np.allclose(found.nearest(q).q, q, atol=1e-12)


def test_wrapped_brings_every_angle_back():
    found = solutions("ur5e")
    copies = found.within(limits([-TURN] * 6, [TURN] * 6), windings=True)
    back = copies.wrapped()
    assert ((back.q > -np.pi) & (back.q <= np.pi)).all()
    assert as_set(back.q) == as_set(found.q)
    assert back.status == found.status


def test_batch_filters_agree_with_the_single_ones():
    for name in ROBOTS:
        robot = load(name)
        rng = np.random.default_rng(5)
        batch = robot.ik(robot.fk(random_q(rng, 30, robot.dof)))
        seeds = random_q(rng, 30, robot.dof)
        bounds = random_limits(rng, robot.dof, "narrow")
        inside, wrapped = (
            batch.within(bounds),
            batch.within(limits([3] * robot.dof, [10] * robot.dof)).wrapped(),
        )
        assert np.nanmax(np.abs(wrapped.q)) <= np.pi
        for metric in ("euclidean", "max"):
            near, one_seed = batch.nearest(seeds, metric), batch.nearest(seeds[0], metric)
            for i in range(30):
                assert np.array_equal(near[i], batch[i].nearest(seeds[i], metric).q[0])
                assert np.array_equal(one_seed[i], batch[i].nearest(seeds[0], metric).q[0])
        for i in range(30):
            assert np.array_equal(inside[i].q, batch[i].within(bounds).q)
            assert inside.count[i] == len(inside[i])
            if batch.count[i] and not inside.count[i]:
                assert not inside[i]
                assert "filter" in inside[i].reason or "limits" in inside[i].reason


def test_batch_nearest_of_an_unreachable_goal_is_nan():
    far = np.eye(4)
    far[0, 3] = 50
    batch = load("ur5e").ik(np.stack([far, load("ur5e").fk(np.full(6, 0.3))]))
    near = batch.nearest(np.zeros(6))
    assert np.isnan(near[0]).all()
    assert np.isfinite(near[1]).all()


def test_what_makes_no_sense_is_refused():
    found = solutions("ur5e")
    with pytest.raises(UnknownNameError, match="manhattan"):
        found.nearest(np.zeros(6), "manhattan")
    with pytest.raises(InputError, match=r"\(5,\)"):
        found.nearest(np.zeros(5))
    with pytest.raises(InputTypeError, match="str"):
        found.within("all")
    with pytest.raises(InputError, match="ur5e"):
        found.within(load("al5d").limits)


def test_limits_of_a_million_turns_are_refused_before_anything_is_listed():
    chain = load("ur5e").chain
    for size in (1e7, 1e300):
        robot = Robot.from_screws(chain.axes, chain.points, chain.T_zero, lower=[-size] * 6, upper=[size] * 6)
        with pytest.raises(InputError, match="copies of the solutions by multiples of 2π"):
            robot.ik(robot.fk(np.full(6, 0.3))).within(robot.limits, windings=True)
