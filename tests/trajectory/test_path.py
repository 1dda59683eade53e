"""Paths: splines, B-splines, blends, and curves fitted by pieces."""

from math import factorial

import numpy as np
import pytest

import cspace as cs
from cspace.errors import InputError
from cspace.trajectory import Path, b_spline, fit_path
from trajectory.path_cases import MAKERS, random_waypoints

RNG = np.random.default_rng(5)


@pytest.mark.parametrize("ends", ["natural", "clamped"])
def test_cubic_splines_are_those_of_scipy(ends):
    interpolate = pytest.importorskip("scipy.interpolate")
    w = RNG.uniform(-1, 1, (9, 3))
    path = cs.spline(w, ends=ends)
    reference = interpolate.CubicSpline(path.breaks, w, bc_type=ends)
    s = np.linspace(0, path.length, 101)[:-1]
    for order in range(3):
        assert np.allclose(path(s, order), reference(s, order), atol=1e-12)
    assert path.continuity == 2


@pytest.mark.parametrize("ends", ["natural", "clamped"])
def test_quintic_splines_are_those_of_scipy(ends):
    interpolate = pytest.importorskip("scipy.interpolate")
    w = RNG.uniform(-1, 1, (9, 3))
    path = cs.spline(w, 5, ends=ends)
    zero = np.zeros(3)
    at_end = [(2, zero), (4, zero)] if ends == "natural" else [(1, zero), (2, zero)]
    reference = interpolate.make_interp_spline(path.breaks, w, k=5, bc_type=(at_end, at_end))
    s = np.linspace(0, path.length, 101)[:-1]
    for order in range(4):
        assert np.allclose(path(s, order), reference(s, order), atol=1e-10)
    assert path.continuity == 3


@pytest.mark.parametrize("degree", range(1, 6))
def test_b_splines_are_those_of_scipy(degree):
    interpolate = pytest.importorskip("scipy.interpolate")
    c = RNG.uniform(-1, 1, (9, 2))
    path = b_spline(c, degree, length=9.0 - degree)
    knots = np.concatenate([np.zeros(degree), np.arange(10.0 - degree), np.full(degree, 9.0 - degree)])
    s = np.linspace(0, path.length, 101)[:-1]
    assert np.allclose(path(s), interpolate.BSpline(knots, c, degree)(s), atol=1e-13)
    assert path.continuity == min(degree - 1, 3)


@pytest.mark.parametrize("name", MAKERS)
def test_paths_are_continuous_pass_both_ends_and_reverse(name):
    for _ in range(20):
        w = random_waypoints(RNG, 12)
        path = MAKERS[name](w)
        assert np.array_equal(path.start, w[0])
        assert np.allclose(path.end, w[-1], atol=1e-12)
        s = RNG.uniform(0, path.length, 50)
        assert np.isfinite(path(s, 3)).all()
        back = path.reversed()
        for order in range(3):
            scale = 1.0 + np.abs(path(s, order)).max()
            # Beside a break either side may be evaluated.
            near = np.abs(s[:, None] - path.breaks).min(axis=1) > 1e-9 * path.length
            turned = (-1.0) ** order * back(np.clip(path.length - s, 0, path.length), order)
            assert np.allclose(path(s, order)[near], turned[near], atol=1e-6 * scale)


@pytest.mark.parametrize("name", ["cubic", "quintic", "clamped", "centripetal"])
def test_splines_pass_every_waypoint(name):
    w = RNG.uniform(-1, 1, (8, 4))
    path = MAKERS[name](w)
    assert np.allclose(path(path.breaks), w, atol=1e-13)


def test_the_excursion_is_the_largest_overshoot():
    w = RNG.uniform(-1, 1, (7, 3))
    for degree in (3, 5):
        path = cs.spline(w, degree)
        s = np.linspace(0, path.length, 200_001)
        piece = np.clip(np.searchsorted(path.breaks, s, side="right") - 1, 0, len(path) - 1)
        low, high = np.minimum(w[:-1], w[1:])[piece], np.maximum(w[:-1], w[1:])[piece]
        over = np.maximum(path(s) - high, low - path(s)).max(axis=0)
        assert np.allclose(path.excursion, np.maximum(over, 0), atol=1e-6)
    assert not cs.spline(w[:2]).excursion.any()


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["quintic", "circular"])
def test_blends_deviate_as_stated_and_stay_in_the_hull(kind):
    rng = np.random.default_rng(8)
    for deviation in 25 * (1e-4, 0.02, 0.1, 10.0):
        w = rng.uniform(-1, 1, (6, 2))
        path = cs.blend(w, deviation, kind=kind)
        dense = path(np.linspace(0, path.length, 40_001))
        for corner in w[1:-1]:
            assert np.linalg.norm(dense - corner, axis=1).min() <= deviation * (1 + 1e-3) + 1e-4
        smooth = 2 if kind == "quintic" else 1
        assert path.continuity == (0 if path.stops.size else smooth)  # it stops where it nearly turns back
        legs = np.diff(w, axis=0)
        for q in dense[::500]:
            ahead = np.clip(((q - w[:-1]) * legs).sum(1) / (legs**2).sum(1), 0, 1)
            nearest = np.linalg.norm(w[:-1] + ahead[:, None] * legs - q, axis=1).min()
            assert nearest <= deviation + 1e-12
        assert (dense >= w.min(0) - 1e-12).all()
        assert (dense <= w.max(0) + 1e-12).all()


def test_blends_stop_where_the_path_turns_back():
    path = cs.blend([[0, 0], [1, 0], [0, 1e-4], [1, 1]], 0.05)
    assert len(path.stops) == 1
    assert np.allclose(path(path.stops), [[1, 0]])
    assert "180" in path.remarks[0]
    corners = cs.blend([[0, 0], [1, 0], [1, 1]], 0.0)
    assert np.allclose(corners(corners.stops), [[1, 0]])
    assert not cs.blend([[0, 0], [1, 0], [3, 0]], 0.0).stops.size


def test_waypoints_that_are_the_same_merge():
    w = np.array([[0, 0], [1, 0], [1, 0], [1, 1e-12], [2, 1], [2, 1]], dtype=float)
    for make in (cs.spline, lambda x: cs.blend(x, 0.1)):
        path = make(w)
        assert path.remarks == ("3 waypoints merged with the one before",)
        assert np.array_equal(path.end, w[-1])
        assert np.isfinite(path(np.linspace(0, path.length, 99), 3)).all()


def test_fitted_curves_are_within_the_tolerance():
    def curve(s, order):
        return np.stack(
            [np.sin(3 * s + order * np.pi / 2) * 3**order, np.cos(s + order * np.pi / 2)], axis=-1
        )

    for tolerance in (1e-3, 1e-6, 1e-9):
        path = fit_path(curve, 5.0, tolerance=tolerance)
        s = np.linspace(0, 5, 3001)
        assert np.linalg.norm(path(s) - curve(s, 0), axis=1).max() <= 1.05 * tolerance
        assert path.continuity >= 2
        assert "fitted within" in path.remarks[0]
    with pytest.raises(cs.CspaceError, match=r"not smooth at s = 2\."):
        fit_path(lambda s, order: [np.abs(s - 2.123), np.sign(s - 2.123), 0 * s][order][:, None], 5.0)


def test_coefficients_and_control_points_are_the_same_path():
    for degree in (3, 5):
        path = cs.spline(RNG.uniform(-1, 1, (6, 3)), degree)
        again = Path.from_coefficients(path.breaks, path.coefficients)
        assert np.allclose(again.control_points, path.control_points, atol=1e-13)


@pytest.mark.parametrize("degree", range(1, 6))
@pytest.mark.parametrize("seed", range(4))
def test_derivatives_jump_where_they_were_made_to(degree, seed):
    """Each piece continues the last one up to an order, where a jump is added; SciPy has the derivatives."""
    interpolate = pytest.importorskip("scipy.interpolate")
    rng = np.random.default_rng(10 * degree + seed)
    count, dof = 12, int(rng.integers(1, 8))
    h = 10.0 ** rng.uniform(-1, 0.3, count)
    smooth = rng.integers(0, 4, count - 1)  # the highest order that does not jump; 3: none within reach does
    c = np.zeros((count, degree + 1, dof))
    c[0] = rng.standard_normal((degree + 1, dof))
    for k in range(1, count):
        before = interpolate.PPoly(c[k - 1][::-1, None], [0.0, h[k - 1]])
        for order in range(degree + 1):
            c[k, order] = before(h[k - 1], nu=order) / factorial(order)
            if order > smooth[k - 1]:
                c[k, order] += (1.0 + np.abs(c[k, order]).max()) * rng.choice([-1.0, 1.0], dof)
    breaks = np.concatenate([[0.0], np.cumsum(h)])
    path = Path.from_coefficients(breaks, c)
    for order in (1, 2, 3):
        wanted = (order == smooth + 1) if order <= degree else np.zeros(count - 1, dtype=bool)
        found = path.jumps(order)
        assert not found[[0, -1]].any()
        np.testing.assert_array_equal(found[1:-1] & (smooth + 1 >= order), wanted)
    np.testing.assert_array_equal(path.stop_flags[1:-1] == 1, smooth == 0)
    np.testing.assert_array_equal(path.stops, breaks[1:-1][smooth == 0])
    assert path.continuity == min(3, smooth.min() if smooth.min() < degree else 3)


def test_joints_that_stand_and_gaps_are_found():
    rng = np.random.default_rng(3)
    for _ in range(50):
        count, dof = rng.integers(1, 9), rng.integers(1, 8)
        points = rng.standard_normal((count, 4, dof)).cumsum(axis=1)
        still = rng.random((count, dof)) < 0.4
        points[:, 1:] = np.where(still[:, None], points[:, :1], points[:, 1:])
        for k in range(1, count):
            points[k] += points[k - 1, -1] - points[k, 0]
        path = Path(np.arange(count + 1.0), points)
        np.testing.assert_array_equal(path.moving, ~still)
        if count > 1:
            k, j = rng.integers(1, count), rng.integers(dof)
            points[k:, :, j] += 0.25
            with pytest.raises(InputError, match=rf"jumps by 0\.25 at s = {k}"):
                Path(np.arange(count + 1.0), points)


@pytest.mark.slow
def test_ten_thousand_waypoints():
    w = np.cumsum(RNG.normal(size=(10_000, 3)), axis=0)
    for make in (cs.spline, lambda x: cs.spline(x, 5), lambda x: cs.blend(x, 0.1)):
        assert np.array_equal(make(w).end, w[-1])


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: cs.spline([[0, 0]]), "shape"),
        (lambda: cs.spline([[0, 0], [0, 0]]), "all the same"),
        (lambda: cs.spline([[0, np.nan], [0, 0]]), "finite"),
        (lambda: cs.spline([[0, 1], [0, 0]], 4), "3 or 5"),
        (lambda: cs.spline([[0, 1], [0, 0]], ends="free"), "natural"),
        (lambda: cs.blend([[0, 1], [0, 0]], -1.0), "0 or more"),
        (lambda: cs.blend([[0, 1], [0, 0]], 0.1, kind="parabola"), "quintic"),
        (lambda: cs.blend([[0, 1], [0, 0], [1, 1]], [0.1, 0.1]), "one per waypoint"),
        (lambda: b_spline([[0, 1], [0, 0]], 3), "4 points"),
        (lambda: fit_path(3.0, 1.0), r"must accept \(s, order\)"),
        (lambda: Path([0, 1], np.zeros((2, 4, 1))), "expected"),
        (lambda: Path([0, 1, 2], [[[0], [1]], [[2], [3]]]), "jumps"),
        (lambda: Path([0, 1, 1], [[[0], [1]], [[1], [3]]]), "increase"),
        (lambda: cs.spline([[0, 1], [0, 0]])(2.0), "from 0 to 1"),
        (lambda: cs.spline([[0, 1], [0, 0]])(0.0, 4), "0 to 3"),
    ],
)
def test_bad_input_is_named(call, message):
    with pytest.raises(cs.CspaceError, match=message):
        call()


@pytest.mark.parametrize("name", MAKERS)
def test_a_part_of_a_path_is_the_path_up_to_there(name):
    path = MAKERS[name](random_waypoints(np.random.default_rng(6)))
    for end in (*path.breaks[1:3], 0.37 * path.length, path.length, 1e-3 * path.length):
        part = path.part(float(end))
        assert part.length == end
        s = np.linspace(0.0, end, 40)
        for order in range(3):
            scale = np.abs(path(s, order)).max() + 1.0
            np.testing.assert_allclose(part(s, order)[:-1], path(s, order)[:-1], atol=1e-8 * scale)
        np.testing.assert_allclose(part.end, path(end), atol=1e-12)
    for end in (0.0, -1.0, path.length * 1.01):
        with pytest.raises(InputError, match="must be above 0"):
            path.part(end)
    with pytest.raises(InputError, match="finite"):
        path.part(np.nan)
