"""The quadratic program in a box: the conditions of Karush, Kuhn and Tucker, and an independent solver."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import lsq_linear

from cspace import _core


def solve(H, g, lower, upper, start=None):
    x = np.zeros(len(g)) if start is None else np.array(start, dtype=float)
    steps = _core._box_qp(*(np.ascontiguousarray(a, dtype=float) for a in (H, g, lower, upper)), x)
    return steps, x


def problem(rng, n, worst=1e4):
    """A random problem: some bounds are missing, some fix their unknown, some hold at the solution."""
    Q = np.linalg.qr(rng.normal(size=(n, n)))[0]
    H = Q @ np.diag(worst ** rng.random(n)) @ Q.T
    H = 0.5 * (H + H.T)
    lower, upper = -rng.exponential(size=n), rng.exponential(size=n)
    lower[rng.random(n) < 0.2] = -np.inf
    upper[rng.random(n) < 0.2] = np.inf
    locked = (rng.random(n) < 0.1) & np.isfinite(lower)
    upper[locked] = lower[locked]
    return H, H @ rng.normal(size=n) * 2, lower, upper


@pytest.mark.parametrize("n", [1, 2, 6, 7, 20, 45])
def test_the_conditions_of_an_optimum_hold(n):
    rng = np.random.default_rng(n)
    for _ in range(40):
        H, g, lower, upper = problem(rng, n)
        steps, x = solve(H, g, lower, upper)
        assert steps > 0
        assert ((lower <= x) & (x <= upper)).all()
        gradient, scale = H @ x - g, 1e-11 * (np.abs(H).sum() + np.abs(g).max())
        inside = (lower < x) & (x < upper)
        assert np.abs(gradient[inside]).max(initial=0) <= scale
        assert (gradient[(x == lower) & (x < upper)] >= -scale).all()
        assert (gradient[(x == upper) & (x > lower)] <= scale).all()


@pytest.mark.parametrize("n", [2, 6, 20])
def test_another_solver_finds_the_same(n):
    rng = np.random.default_rng(100 + n)
    for _ in range(10):
        H, g, lower, upper = problem(rng, n, worst=100)
        upper = np.where(upper <= lower, lower + 1e-3, upper)
        L = np.linalg.cholesky(H)
        oracle = lsq_linear(L.T, np.linalg.solve(L, g), (lower, upper), method="bvls", tol=1e-14)
        steps, x = solve(H, g, lower, upper, start=rng.normal(size=n))
        assert steps > 0
        np.testing.assert_allclose(x, oracle.x, atol=1e-8)


def test_where_it_starts_does_not_matter():
    rng = np.random.default_rng(5)
    H, g, lower, upper = problem(rng, 12)
    _, expected = solve(H, g, lower, upper)
    for _ in range(20):
        _, x = solve(H, g, lower, upper, start=rng.normal(size=12) * 10)
        np.testing.assert_allclose(x, expected, atol=1e-10)


def test_what_is_no_convex_problem_is_refused():
    box = np.full(2, -1.0), np.full(2, 1.0)
    assert solve(np.diag([1.0, -1.0]), np.ones(2), *box)[0] == -1
    assert solve(np.diag([1.0, np.nan]), np.ones(2), *box)[0] == -1
    with pytest.raises(ValueError, match="sizes"):
        solve(np.eye(3), np.ones(2), *box)
