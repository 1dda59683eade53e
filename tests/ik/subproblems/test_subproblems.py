"""The laws of the six subproblems: answers hold, misses are minima, nothing is lost, batches agree."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import cspace as cs
from cspace.errors import InputError
from cspace.ik import subproblems as sp
from oracles import subproblems as oracle

GAP = {f"subproblem_{i}": getattr(oracle, f"gap_{i}") for i in range(1, 7)}
ANGLES = {1: 1, 2: 2, 3: 1, 4: 1, 5: 3, 6: 2}

# Coordinates that make parallel, orthogonal, zero, coincident and tangent inputs likely.
coordinate = st.sampled_from([0.0, 0.0, 1.0, -1.0, 0.5, 2.0]) | st.floats(-2, 2).map(lambda x: round(x, 3))
point = st.tuples(coordinate, coordinate, coordinate).map(np.array)
axis = point.filter(lambda v: np.linalg.norm(v) > 0.1)


def answers(s, angles):
    """The answers of one problem as rows of angles."""
    return s.theta.reshape(-1, angles)[: s.count]


def check(number, arguments, sweep):
    """The laws that hold for one problem of any subproblem."""
    s = getattr(sp, f"subproblem_{number}")(*arguments)
    gap = GAP[f"subproblem_{number}"]
    theta = answers(s, ANGLES[number])
    size = 1 + sum(np.abs(a).max() for a in arguments)
    assert np.isfinite(theta).all()
    assert (theta > -np.pi).all()
    assert (theta <= np.pi).all()
    assert np.isnan(s.theta.reshape(-1, ANGLES[number])[s.count :]).all()
    left = gap(*arguments, theta)
    assert np.abs(left - s.residual).max() <= 2e-12 * size
    swept = gap(*arguments, oracle.grid(ANGLES[number], sweep)).min()
    assert s.residual <= swept + 1e-12 * size
    if s.exact:
        assert left.max() <= 1e-12 * size
    return s


@given(axis, point, point)
def test_subproblem_1_holds(k, p1, p2):
    check(1, (k, p1, p2), 360)


@settings(max_examples=60)
@given(axis, axis, point, point)
def test_subproblem_2_holds(k1, k2, p1, p2):
    check(2, (k1, k2, p1, p2), 60)


@given(axis, point, point, st.floats(0, 3) | st.sampled_from([0.0, 1.0, 2.0]))
def test_subproblem_3_holds(k, p1, p2, d):
    check(3, (k, p1, p2, d), 360)


@given(point, axis, point, coordinate)
def test_subproblem_4_holds(h, k, p, d):
    check(4, (h, k, p, d), 360)


@settings(max_examples=40, deadline=None)
@given(point, point, point, point, point, axis, axis, axis)
def test_subproblem_5_holds(p0, p1, p2, p3, p4, k1, k2, k3):
    check(5, (p0, p1, p2, p3, p4, k1, k2, k3), 20)


@settings(max_examples=40, deadline=None)
@given(
    st.lists(point, min_size=8, max_size=8), st.lists(axis, min_size=4, max_size=4), coordinate, coordinate
)
def test_subproblem_6_holds(points, axes, d1, d2):
    h, p, k = np.array(points[:4]), np.array(points[4:]), np.array(axes)
    check(6, (h, k, p, np.array([d1, d2])), 60)


@settings(max_examples=100)
@given(axis, axis, point, st.floats(-3, 3), st.floats(-3, 3))
def test_subproblem_2_finds_what_it_was_made_from(k1, k2, p1, a, b):
    p2 = oracle.turned(k2, -b, oracle.turned(k1, a, p1))
    s = sp.subproblem_2(k1, k2, p1, p2)
    assert s.exact
    if not s.free:
        # An angle is known as well as it moves its point: a small circle leaves it vague.
        levers = [np.linalg.norm(np.cross(k, p)) / np.linalg.norm(k) for k, p in ((k1, p1), (k2, p2))]
        moved = np.abs(np.exp(1j * answers(s, 2)) - np.exp(1j * np.array([a, b]))) * levers
        assert moved.max(axis=1).min() < 1e-6


@pytest.mark.parametrize("number", [3, 4])
def test_no_crossing_of_a_dense_sweep_is_lost(number):
    rng = np.random.default_rng(number)
    t = oracle.grid(1, 2000)
    counts = set()
    for _ in range(300):
        k, p, q = rng.normal(size=(3, 3))
        d = rng.uniform(0, 3)
        x = oracle.turned(k, t[:, 0], p)
        signed = np.linalg.norm(x - q, axis=-1) - d if number == 3 else x @ q - d
        s = sp.subproblem_3(k, p, q, d) if number == 3 else sp.subproblem_4(q, k, p, d)
        crossings = oracle.sign_changes(signed)
        assert crossings == (s.count if s.exact and s.count == 2 else 0)
        counts.add(crossings)
    assert counts == {0, 2}


def test_no_crossing_is_lost_by_subproblem_6():
    """Along the curve of the first equation, sampled densely, the second changes sign at answers only."""
    rng = np.random.default_rng(6)
    counts = []
    for _ in range(60):
        h, k, p = rng.normal(size=(3, 4, 3))
        d = rng.normal(size=2) * 0.7
        s = sp.subproblem_6(h, k, p, d)
        first = np.linspace(-np.pi, np.pi, 4001)[:-1]
        inner = sp.subproblem_4(h[1], k[1], p[1], d[0] - oracle.turned(k[0], first, p[0]) @ h[0])
        crossings = 0
        for branch in (0, 1):
            second = inner.theta[:, branch]
            rest = oracle.turned(k[2], first, p[2]) @ h[2] + oracle.turned(k[3], second, p[3]) @ h[3] - d[1]
            rest = np.where(inner.exact & (inner.count == 2), rest, np.nan)
            crossings += oracle.sign_changes(rest)
        assert crossings <= (s.count if s.exact else 0)
        counts.append(crossings)
    assert max(counts) == 4


@pytest.mark.parametrize(("number", "tails"), [(1, "vvv"), (2, "vvvv"), (3, "vvvs"), (4, "vvvs")])
def test_a_batch_agrees_with_its_problems(number, tails):
    rng = np.random.default_rng(number)
    arguments = [rng.uniform(0, 1, (5, 7, 3) if t == "v" else (5, 7)) for t in tails]
    arguments[0][0, 0] = arguments[1][0, 0]
    solve = getattr(sp, f"subproblem_{number}")
    batch = solve(*arguments)
    assert batch.count.shape == (5, 7)
    for i in np.ndindex(5, 7):
        one = solve(*(a[i] for a in arguments))
        np.testing.assert_allclose(batch.theta[i], one.theta, atol=1e-13)
        assert (batch.count[i], batch.exact[i], batch.free[i]) == (one.count, one.exact, one.free)


def test_leading_axes_broadcast():
    p = np.random.default_rng(0).normal(size=(4, 1, 3))
    assert sp.subproblem_1([0, 0, 1], p, np.ones((1, 6, 3))).theta.shape == (4, 6, 1)
    assert sp.subproblem_5(p, [1, 0, 0], [0, 0, 0], [1, 0, 0], [1, 0, 0], *np.eye(3)).theta.shape == (
        4,
        1,
        4,
        3,
    )
    with pytest.raises(InputError, match="broadcast"):
        sp.subproblem_1([0, 0, 1], np.ones((4, 3)), np.ones((5, 3)))


def test_degenerate_inputs_have_a_defined_answer():
    z = [0, 0, 1]
    on_axis = sp.subproblem_1(z, [0, 0, 2], [1, 0, 2])
    assert (on_axis.free, on_axis.theta[0], on_axis.residual) == (True, 0, 1)
    parallel = sp.subproblem_2(z, z, [1, 0, 0], [0, 1, 0])
    assert parallel.exact
    assert parallel.free
    np.testing.assert_allclose(parallel.theta[0], [np.pi / 2, 0])
    crossing = sp.subproblem_2([1, 0, 0], z, [0, 1, 0], [1, 0, 0])
    assert crossing.count == 2
    tangent = sp.subproblem_2([1, 0, 0], z, [0.6, 0, 0.8], [0.6, 0, 0.8])
    assert (tangent.count, bool(tangent)) == (1, True)
    assert sp.subproblem_2([1, 0, 0], z, [1, 0, 0], [1, 0, 0]).free
    touching = sp.subproblem_3(z, [1, 0, 0], [3, 0, 0], 2)
    assert (touching.count, touching.theta[0], bool(touching)) == (1, 0, True)
    assert sp.subproblem_4(z, z, [1, 0, 0], 0).free
    nothing = np.zeros(3)
    assert sp.subproblem_5(*[nothing] * 5, z, z, z).free
    assert sp.subproblem_6(np.zeros((4, 3)), [z] * 4, np.zeros((4, 3)), [0, 0]).free


def test_the_classical_names_move_the_axis_to_a_point():
    rng = np.random.default_rng(3)
    for _ in range(50):
        w1, w2, p, r = rng.normal(size=(4, 3))
        a, b = rng.uniform(-3, 3, 2)
        q1 = r + oracle.turned(w1, a, p - r)
        assert abs(sp.paden_kahan_1(w1, p, q1, point=r).theta[0] - a) < 1e-11
        q2 = r + oracle.turned(w1, a, oracle.turned(w2, b, p - r))
        two = sp.paden_kahan_2(w1, w2, p, q2, point=r)
        assert np.abs(two.theta[: two.count] - [a, b]).max(axis=1).min() < 1e-6
        for first, second in two.theta[: two.count]:
            again = r + oracle.turned(w1, first, oracle.turned(w2, second, p - r))
            np.testing.assert_allclose(again, q2, atol=1e-12)
        other = rng.normal(size=3)
        three = sp.paden_kahan_3(w1, p, other, np.linalg.norm(q1 - other), point=r)
        assert np.abs(three.theta[: three.count] - a).min() < 1e-6


def test_an_answer_says_what_it_is():
    z = [0, 0, 1]
    assert sp.subproblem_3(z, [1, 0, 0], [2, 0, 0], 2).reason == "2 solutions"
    missed = sp.subproblem_3(z, [1, 0, 0], [3, 0, 0], 5)
    assert not missed
    assert missed.reason == "no exact solution: the least-squares solution has the error 1"
    assert "infinitely many" in sp.subproblem_1(z, z, z).reason
    assert (
        sp.subproblem_1(z, [[1, 0, 0], [1, 0, 1]], [0, 1, 0]).reason == "1 of 2 problems have exact solutions"
    )
    assert cs.subproblems is sp


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: sp.subproblem_1([0, 0, 0], [1, 0, 0], [1, 0, 0]), "k is a vector of length zero"),
        (lambda: sp.subproblem_1([0, 0, 1], [np.nan, 0, 0], [1, 0, 0]), "p1 holds nan"),
        (lambda: sp.subproblem_3([0, 0, 1], [1, 0, 0], [1, 0, 0], -1), "d is -1"),
        (lambda: sp.subproblem_6(np.ones((3, 3)), np.ones((4, 3)), np.ones((4, 3)), [0, 0]), "h has shape"),
    ],
)
def test_misuse_is_named(call, message):
    with pytest.raises(InputError, match=message):
        call()


SIGNATURES = {
    1: ["axis", (3,), (3,)],
    2: ["axis", "axis", (3,), (3,)],
    3: ["axis", (3,), (3,), ()],
    4: [(3,), "axis", (3,), ()],
    5: [(3,)] * 5 + ["axis"] * 3,
    6: [(4, 3), "axes", (4, 3), (2,)],
}


def scaled_problem(number, rng, scale):
    """Arguments of a subproblem, points and lengths of about `scale`."""
    axes = {"axis": (3,), "axes": (4, 3)}
    return [
        rng.normal(size=axes[kind]) if kind in axes else scale * rng.uniform(0.1, 1.0, size=kind)
        for kind in SIGNATURES[number]
    ]


@pytest.mark.parametrize("number", SIGNATURES)
@pytest.mark.parametrize("scale", [1e60, 1e100])
def test_large_numbers_have_finite_answers(number, scale):
    rng = np.random.default_rng(number)
    for _ in range(50):
        s = getattr(sp, f"subproblem_{number}")(*scaled_problem(number, rng, scale))
        assert s.count > 0
        assert np.isfinite(answers(s, ANGLES[number])).all()
        assert np.isfinite(s.residual)


@pytest.mark.parametrize("number", SIGNATURES)
def test_numbers_whose_products_overflow_are_refused_by_name(number):
    rng = np.random.default_rng(number)
    for i, kind in enumerate(SIGNATURES[number]):
        arguments = scaled_problem(number, rng, 1.0)
        arguments[i] = arguments[i] * 1e200
        solve = getattr(sp, f"subproblem_{number}")
        if isinstance(kind, str):  # axes may have any length
            assert np.isfinite(solve(*arguments).residual)
            continue
        with pytest.raises(InputError, match=r"^(p|h|d)\d? holds .*e\+(199|200)( at index .*)?; .*1e\+100"):
            solve(*arguments)
