"""Large errors make Gauss-Newton converge linearly: its steps are mixed, and few of them are enough."""

from __future__ import annotations

import numpy as np
import pytest

import cspace as cs


def wrenched_chain(rng: np.random.Generator, poses: int, turn: float):
    """A chain in space with two loops that contradict it by a turn [rad] about some axis."""
    steps = cs.exp_se3(
        np.concatenate(
            [rng.normal([1, 0, 0], 0.1, (poses - 1, 3)), rng.normal(0, 0.1, (poses - 1, 3))], axis=1
        )
    )
    X = [np.eye(4)]
    for step in steps:
        X.append(X[-1] @ step)
    axis = rng.normal(size=3)
    axis *= turn / np.linalg.norm(axis)
    loops = [(0, poses - 1), (3, poses - 4)]
    closed = [
        np.linalg.inv(X[i]) @ X[j] @ cs.exp_se3(np.concatenate([rng.normal(0, 2, 3), axis])) for i, j in loops
    ]
    edges = [(k, k + 1) for k in range(poses - 1)] + loops
    information = np.diag([2.5, 2.5, 2.5, 10, 10, 10])
    return cs.PoseGraph(np.array(X), edges, np.concatenate([steps, closed]), information)


@pytest.mark.parametrize("turn", [1.0, 2.0, 2.8])
def test_few_steps_are_enough(turn):
    for seed in range(8):
        graph = wrenched_chain(np.random.default_rng(seed), 40, turn)
        by_newton = graph.optimize()
        damped = graph.optimize(method="levenberg_marquardt")
        assert by_newton, by_newton.reason
        assert damped, damped.reason
        assert damped.stats["iterations"] <= 40
        again = graph.with_poses(by_newton.poses).optimize(start="given", method="dog_leg")
        assert by_newton.chi2 == pytest.approx(again.chi2, rel=1e-8)
