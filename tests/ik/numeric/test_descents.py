"""Descents to a goal: what they reach is a solution, what they cannot reach they say."""

from __future__ import annotations

import numpy as np
import pytest

import cspace as cs
from cspace.errors import InputError, InputTypeError, UnknownNameError
from cspace.model import Limits
from cspace.robot import Robot
from kinematics.robots import arm, tree

CLOSED_FORM = ["ur5e", "puma560", "kr6_r900", "crx10ia", "planar_3r"]
ANY_KIND = [*CLOSED_FORM, "panda", "iiwa14", "jaco2", "stanford", "rpr", "so101", "two_link", "scara"]


def goals_of(robot: cs.Robot, n: int, rng: int) -> tuple[np.ndarray, np.ndarray]:
    q = robot.random_configuration(n, rng=rng, reach=0.5)
    return q, robot.fk(q)


def far_from(robot: cs.Robot, q: np.ndarray, T: np.ndarray) -> np.ndarray:
    """The larger of position error [m] and rotation angle [rad], (...)."""
    miss = robot.fk(q)
    away = np.linalg.norm(miss[..., :3, 3] - T[..., :3, 3], axis=-1)
    return np.maximum(away, cs.rotation_distance(miss, T))


def inside(robot: cs.Robot, q: np.ndarray) -> bool:
    return bool(((q >= robot.limits.lower) & (q <= robot.limits.upper)).all())


@pytest.mark.parametrize("name", ANY_KIND)
def test_reachable_goals_are_reached_within_the_limits(name):
    robot = cs.load_robot(name)
    _, T = goals_of(robot, 300, rng=1)
    found = robot.ik_numeric(T)
    assert found.success.mean() >= 0.99
    assert inside(robot, found.q)
    assert far_from(robot, found.q, T)[found.success].max() <= 2e-9
    assert np.allclose(found.residual, far_from(robot, found.q, T), atol=1e-12)
    assert (found.residual[~found.success] > 1e-9).all()


@pytest.mark.parametrize("name", CLOSED_FORM)
def test_every_start_ends_in_a_solution_of_the_closed_form_or_says_no(name):
    robot = cs.load_robot(name)
    _q, T = goals_of(robot, 10, rng=2)
    starts = robot.random_configuration(10, rng=3)
    for goal in T:
        all_of_them = robot.ik(goal).q
        batch = robot.ik_numeric(np.broadcast_to(goal, (10, 4, 4)), starts, starts=1, limits=False)
        gap = np.abs(np.mod(batch.q[:, None] - all_of_them + np.pi, 2 * np.pi) - np.pi).max(axis=-1)
        assert (gap.min(axis=1)[batch.success] < 1e-6).all()
        assert batch.success.any()


@pytest.mark.parametrize("name", ["ur5e", "kr6_r900", "crx10ia", "planar_3r"])
def test_many_starts_find_the_solutions_of_the_closed_form(name):
    robot = cs.load_robot(name)
    for goal in goals_of(robot, 5, rng=4)[1]:
        expected = robot.ik(goal).q
        found = robot.ik_many_starts(goal, 512, limits=False)
        gap = np.abs(np.mod(found.q[:, None] - expected + np.pi, 2 * np.pi) - np.pi).max(axis=-1)
        assert gap.min(axis=1).max() < 1e-6, "a solution that the closed form does not know"
        assert gap.min(axis=0).max() < 1e-6, "not found from 512 starts"
        assert len(found) == len(expected)
        assert found.hits.sum() <= 512
        assert not found.complete
        assert found.residual.max() <= 1e-9
        assert np.abs(found.q).max() <= np.pi + 1e-12


def test_many_starts_keep_the_limits_and_say_that_they_are_a_sample():
    robot = cs.load_robot("kr6_r900")
    q, T = goals_of(robot, 1, rng=5)
    found = robot.ik_many_starts(T[0], 256)
    assert found
    assert inside(robot, found.q)
    assert "may be more" in found.reason
    assert 0 <= found.unseen <= 1
    assert far_from(robot, found.q, T[0]).max() <= 2e-9
    np.testing.assert_allclose(found.nearest(q[0]), q[0], atol=1e-6)
    own = robot.ik_many_starts(T[0], q)
    np.testing.assert_allclose(own.q, q, atol=1e-9)
    nothing = robot.ik_many_starts(position=[50, 0, 0], starts=8)
    assert not nothing
    assert len(nothing) == 0
    assert "proves nothing" in nothing.reason
    with pytest.raises(InputError, match="none of 8"):
        nothing.nearest(q[0])


@pytest.mark.parametrize("method", ["levenberg_marquardt", "newton"])
def test_what_is_out_of_reach_is_never_a_success(method):
    for name in ["ur5e", "panda", "stanford", "two_link"]:
        robot = cs.load_robot(name)
        _, T = goals_of(robot, 20, rng=6)
        T = T.copy()
        T[:, :3, 3] += [0, 0, 40.0]
        found = robot.ik_numeric(T, method=method, starts=8)
        assert not found
        assert not found.success.any()
        assert not (found.status == "reached").any()
        assert found.position_error.min() > 10 if name != "stanford" else found.residual.min() > 1e-9
        assert np.isfinite(found.q).all()
        assert inside(robot, found.q)
    assert "0 of 20" in found.reason


def test_the_verdict_in_words():
    robot = cs.load_robot("ur5e")
    T = robot.fk(np.full(6, 0.4))
    assert "reached from the first start" in robot.ik_numeric(T, np.full(6, 0.5)).reason
    far = T.copy()
    far[0, 3] = 9
    found = robot.ik_numeric(far, starts=3)
    assert found.status == "stalled"
    assert "3 starts" in found.reason
    assert "proves nothing" in found.reason
    narrow = Limits(lower=np.full(6, 0.45), upper=np.full(6, 0.6))
    held = robot.ik_numeric(T, limits=narrow, starts=1)
    assert "at a limit" in held.reason
    assert robot.joint_names[1] in held.reason
    assert "NumericSolution of ur5e" in repr(held)


def test_no_iteration_moves_nothing_and_a_start_on_the_goal_stays():
    robot = cs.load_robot("ur5e")
    q = np.array([0.3, -1.2, 1.0, 0.4, 0.9, -0.5])
    still = robot.ik_numeric(robot.fk(q), q + 0.3, max_iterations=0, starts=1)
    np.testing.assert_array_equal(still.q, q + 0.3)
    assert not still
    assert still.iterations == 0
    assert still.status == "out of iterations"
    there = robot.ik_numeric(robot.fk(q), q)
    np.testing.assert_allclose(there.q, q, atol=1e-12)
    assert there
    assert there.iterations <= 1
    assert there.start == 0


@pytest.mark.parametrize("name", ["ur5e", "puma560", "panda", "iiwa14"])
def test_singular_starts_are_left(name):
    robot = cs.load_robot(name)
    zero = np.zeros(robot.dof)
    _, T = goals_of(robot, 50, rng=7)
    found = robot.ik_numeric(T, zero)
    assert found.success.mean() > 0.95
    half_turned = robot.fk(zero) @ np.diag([-1.0, -1.0, 1.0, 1.0])
    assert np.isfinite(robot.ik_numeric(half_turned, zero).q).all()


def test_newton_converges_quadratically_beside_a_solution():
    for name in ["ur5e", "panda", "stanford"]:
        robot = cs.load_robot(name)
        q, T = goals_of(robot, 100, rng=8)
        near = q + np.random.default_rng(0).normal(size=q.shape) * 1e-3
        found = robot.ik_numeric(T, near, method="newton", starts=1, limits=False)
        assert np.median(found.iterations) <= 4
        assert found.success.mean() > 0.97


def test_a_batch_is_its_goals_one_by_one_on_any_number_of_threads():
    robot = cs.load_robot("panda")
    q, T = goals_of(robot, 300, rng=9)
    one = robot.ik_numeric(T, threads=1)
    for threads in (2, 5):
        many = robot.ik_numeric(T, threads=threads)
        np.testing.assert_array_equal(many.q, one.q)
        np.testing.assert_array_equal(many.iterations, one.iterations)
    for k in range(20):
        alone = robot.ik_numeric(T[k])
        np.testing.assert_array_equal(alone.q, one.q[k])
        assert alone.success == one.success[k]
        assert alone.start == one.start[k]
    shaped = robot.ik_numeric(T[:6].reshape(2, 3, 4, 4), q[:6].reshape(2, 3, 7))
    assert shaped.q.shape == (2, 3, 7)
    assert shaped.success.shape == (2, 3)
    a = robot.ik_many_starts(T[0], 200, threads=1)
    b = robot.ik_many_starts(T[0], 200, threads=4)
    np.testing.assert_array_equal(a.q, b.q)


def test_further_starts_are_reproducible():
    robot = cs.load_robot("puma560")
    _, T = goals_of(robot, 50, rng=10)
    for rng in (None, 3):
        a, b = (robot.ik_numeric(T, rng=rng).q for _ in range(2))
        np.testing.assert_array_equal(a, b)
    assert not np.array_equal(robot.ik_numeric(T, rng=4).q, robot.ik_numeric(T, rng=3).q)


@pytest.mark.parametrize("seed", range(6))
def test_frames_of_trees_with_joints_that_mimic_others(seed):
    robot, rng = tree(seed), np.random.default_rng(seed)
    n = len(robot.joint_names)
    for frame in robot.leaves:
        truth = rng.uniform(-1, 1, n)
        start = truth + rng.uniform(-0.1, 0.1, n)
        T = robot.fk(truth, frame)
        found = robot.ik_numeric(T, start, frame=frame, limits=False)
        assert found, found.reason
        np.testing.assert_allclose(robot.fk(found.q, frame), T, atol=3e-9)
        still = np.abs(robot.jacobian(start, frame)).max(axis=0) == 0
        np.testing.assert_array_equal(found.q[still], start[still])


def test_what_cannot_be_asked_of_trees_is_refused():
    with pytest.raises(InputError, match="branches"):
        tree(0).ik_numeric(np.eye(4))
    floating = Robot(tree(0).description, floating=True)
    with pytest.raises(InputError, match="floating"):
        floating.ik_numeric(np.eye(4), frame=floating.leaves[0])
    long = arm(1, "R" * 17)
    with pytest.raises(InputError, match="17 joints"):
        long.ik_numeric(np.eye(4))
    sixteen = arm(2, "RP" * 8)
    q = sixteen.random_configuration(rng=1)
    assert sixteen.ik_numeric(sixteen.fk(q))


def test_positions_and_free_directions():
    robot = cs.load_robot("ur5e")
    _, T = goals_of(robot, 40, rng=11)
    found = robot.ik_numeric(position=T[:, :3, 3])
    assert found
    np.testing.assert_allclose(robot.fk(found.q)[:, :3, 3], T[:, :3, 3], atol=2e-9)
    assert (found.rotation_error == 0).all()
    # Position and tool axis: the turn about the axis is free.
    found = robot.ik_numeric(T, weights=[1, 1, 1, 1, 1, 0])
    assert found
    np.testing.assert_allclose(robot.fk(found.q)[:, :3, 2], T[:, :3, 2], atol=2e-9)
    np.testing.assert_allclose(robot.fk(found.q)[:, :3, 3], T[:, :3, 3], atol=2e-9)
    assert np.abs(robot.fk(found.q)[:, :3, 0] - T[:, :3, 0]).max() > 1e-3


def test_other_limits_and_whole_turns():
    robot = cs.load_robot("ur5e")
    q = np.array([0.3, -1.2, 1.0, 0.4, 0.9, -0.5])
    T = robot.fk(q)
    tight = Limits(lower=q - 0.1, upper=q + 0.1)
    found = robot.ik_numeric(T, limits=tight)
    np.testing.assert_allclose(found.q, q, atol=1e-8)
    beyond = Limits(lower=q + 0.05, upper=q + 0.1)
    assert not robot.ik_numeric(T, limits=beyond)
    # The copy nearest to the start is taken.
    turned = robot.ik_numeric(T, q + 2 * np.pi * np.array([1, 0, 0, -1, 0, 3]), limits=False)
    np.testing.assert_allclose(turned.q - q, 2 * np.pi * np.array([1, 0, 0, -1, 0, 3]), atol=1e-9)


def test_bad_questions_are_refused():
    robot = cs.load_robot("ur5e")
    T = robot.fk(np.zeros(6))
    bad = T.copy()
    bad[0, 3] = np.nan
    for arguments, options, error in [
        ((bad,), {}, InputError),
        ((np.eye(3),), {}, InputError),
        ((T, np.zeros(5)), {}, InputError),
        ((T, [np.nan] * 6), {}, InputError),
        ((T, [1e200] * 6), {}, InputError),
        ((T, np.zeros((4, 6))), {}, InputError),
        ((T,), {"position": [0, 0, 0]}, InputTypeError),
        ((), {}, InputTypeError),
        ((T,), {"method": "newtn"}, UnknownNameError),
        ((T,), {"weights": [1, 1]}, InputError),
        ((T,), {"weights": [-1, 1, 1, 1, 1, 1]}, InputError),
        ((T,), {"weights": np.zeros(6)}, InputError),
        ((T,), {"tolerance": 0}, InputError),
        ((T,), {"tolerance": np.nan}, InputError),
        ((T,), {"starts": 0}, InputError),
        ((T,), {"max_iterations": -1}, InputError),
        ((T,), {"limits": "yes"}, InputTypeError),
        ((T,), {"rest": np.zeros(5)}, InputError),
        ((T,), {"rest_weights": np.ones(6)}, InputError),
        ((T,), {"rest": np.zeros(6), "rest_weights": np.zeros(6)}, InputError),
        ((T,), {"frame": "nose"}, UnknownNameError),
        ((T,), {"rng": -1}, InputError),
    ]:
        with pytest.raises(error):
            robot.ik_numeric(*arguments, **options)
    with pytest.raises(InputError, match="one goal"):
        robot.ik_many_starts(np.stack([T, T]))
    assert robot.ik_numeric(np.empty((0, 4, 4))).q.shape == (0, 6)
