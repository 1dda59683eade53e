"""The posture nearest to a wish: the frame stays where it is, and nothing nearby is nearer."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import minimize

import cspace as cs


def cost(q: np.ndarray, rest: np.ndarray, weights: np.ndarray) -> float:
    return float(0.5 * (weights * (q - rest) ** 2).sum())


@pytest.mark.parametrize("name", ["panda", "iiwa14", "xarm7"])
@pytest.mark.parametrize("weighted", [False, True])
def test_the_posture_moves_in_the_null_space_and_is_stationary(name, weighted):
    robot = cs.load_robot(name)
    rng = np.random.default_rng(3)
    lower, upper = robot.limits.lower, robot.limits.upper
    checked = 0
    for _ in range(20):
        truth, rest = robot.random_configuration(2, rng=rng)
        weights = rng.uniform(0.2, 5, 7) if weighted else np.ones(7)
        T = robot.fk(truth)
        plain = robot.ik_numeric(T, rest)
        found = robot.ik_numeric(T, rest, rest=rest, rest_weights=weights)
        assert bool(found) == bool(plain)
        if not found:
            continue
        np.testing.assert_allclose(robot.fk(found.q), T, atol=3e-9)
        assert ((found.q >= lower) & (found.q <= upper)).all()
        assert cost(found.q, rest, weights) <= cost(plain.q, rest, weights) + 1e-12
        # KKT: the pull towards the wish is one of the rows of J, but for joints at limits that push inward.
        J, pull = robot.jacobian(found.q), weights * (rest - found.q)
        free = (found.q > lower + 1e-9) & (found.q < upper - 1e-9)
        y = np.linalg.lstsq(J[:, free].T, pull[free], rcond=None)[0]
        left = pull - J.T @ y
        assert np.abs(left[free]).max(initial=0) < 1e-4
        assert (left[found.q <= lower + 1e-9] <= 1e-4).all()
        assert (left[found.q >= upper - 1e-9] >= -1e-4).all()
        checked += 1
    assert checked >= 18


def test_the_posture_is_what_a_general_optimiser_finds():
    robot = cs.load_robot("panda")
    rng = np.random.default_rng(4)
    bounds = list(zip(robot.limits.lower, robot.limits.upper, strict=True))
    better = 0
    for _ in range(5):
        truth = robot.random_configuration(rng=rng)
        T, rest = robot.fk(truth), truth + rng.normal(size=7) * 0.2
        found = robot.ik_numeric(T, truth, rest=rest)

        def away(q, T=T):
            miss = robot.fk(q)
            turned = cs.to_rotvec(T[:3, :3] @ miss[:3, :3].T)
            return np.concatenate([miss[:3, 3] - T[:3, 3], turned])

        oracle = minimize(
            cost,
            truth,
            args=(rest, np.ones(7)),
            bounds=bounds,
            method="SLSQP",
            tol=1e-12,
            constraints={"type": "eq", "fun": away},
        )
        better += cost(found.q, rest, np.ones(7)) <= oracle.fun + 1e-6
    assert better == 5


def test_where_the_goal_leaves_no_freedom_the_wish_changes_nothing():
    robot = cs.load_robot("ur5e")
    q = np.array([0.3, -1.2, 1.0, 0.4, 0.9, -0.5])
    free = robot.ik_numeric(robot.fk(q), q + 0.1)
    wished = robot.ik_numeric(robot.fk(q), q + 0.1, rest=q + 0.3)
    np.testing.assert_allclose(wished.q, free.q, atol=1e-9)


def test_a_position_alone_leaves_three_freedoms_to_the_wish():
    robot = cs.load_robot("ur5e")
    q = np.array([0.3, -1.2, 1.0, 0.4, 0.9, -0.5])
    p = robot.fk(q)[:3, 3]
    found = robot.ik_numeric(position=p, start=q + 0.4, rest=q)
    np.testing.assert_allclose(found.q, q, atol=1e-6)


def test_slides_and_turns_share_a_wish():
    robot = cs.load_robot("stanford")
    q = robot.random_configuration(rng=1, reach=0.5)
    found = robot.ik_numeric(position=robot.fk(q)[:3, 3], start=q, rest=q + 0.05, limits=False)
    assert found
    assert np.linalg.norm(found.q - q - 0.05) <= np.linalg.norm(np.full(6, 0.05)) + 1e-12
