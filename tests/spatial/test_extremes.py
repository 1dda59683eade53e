"""Any finite numbers, denormal and huge ones included: results are finite, are rotations, and lead back."""

import warnings

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

import cspace as cs

NUMBERS = st.floats(-1e150, 1e150) | st.floats(-10.0, 10.0) | st.floats(-1e-300, 1e-300)
LENGTHS = st.floats(-10.0, 10.0) | st.floats(-1e-300, 1e-300)
SETTINGS = settings(max_examples=60, deadline=None, derandomize=True)


@pytest.fixture(autouse=True)
def _warnings_are_errors():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        warnings.filterwarnings("ignore", "(?s).*are these degrees")
        yield


def vectors(n, numbers=NUMBERS):
    return st.lists(numbers, min_size=n, max_size=n).map(np.array)


def assert_rotation(R):
    n = R.shape[-1]
    np.testing.assert_allclose(
        np.swapaxes(R, -1, -2) @ R, np.broadcast_to(np.eye(n), R.shape), rtol=0, atol=2e-15
    )
    assert (np.linalg.det(R) > 0.0).all()


def both(call, x):
    """The result of one call, which that of a batch of two must repeat."""
    one, batch = call(x), call(np.stack([x, x]))
    np.testing.assert_allclose(batch, np.stack([one, one]), rtol=1e-12, atol=1e-14)
    return one


@SETTINGS
@given(vectors(3))
def test_rotation_vectors_and_angles(v):
    for make, read in (
        (lambda x: cs.rotation(rotvec=x), cs.to_rotvec),
        (lambda x: cs.rotation(rpy=x), cs.to_rpy),
        (lambda x: cs.rotation(euler=("ZXZ", x)), lambda R: cs.to_euler(R, "ZXZ")),
    ):
        R = both(make, v)
        assert_rotation(R)
        np.testing.assert_allclose(make(both(read, R)), R, rtol=0, atol=1e-14)


@SETTINGS
@given(vectors(4))
def test_quaternions(q):
    assume(q.any())
    R = both(lambda x: cs.rotation(wxyz=x), q)
    assert_rotation(R)
    np.testing.assert_allclose(cs.rotation(xyzw=both(cs.to_xyzw, R)), R, rtol=0, atol=1e-15)
    unit = q / np.abs(q).max()
    unit = unit / np.linalg.norm(unit)
    assert abs(abs(cs.to_wxyz(R) @ unit) - 1.0) < 1e-14


@SETTINGS
@given(vectors(3), LENGTHS)
def test_axes(axis, angle):
    assume(axis.any())
    R = both(lambda x: cs.rotation(axis_angle=(x, angle)), axis)
    assert_rotation(R)
    moved = R @ (axis / np.abs(axis).max())
    np.testing.assert_allclose(moved, axis / np.abs(axis).max(), rtol=0, atol=3e-15)


@SETTINGS
@given(vectors(3, LENGTHS), vectors(3))
def test_twists_and_screws(v, w):
    T = both(cs.exp_se3, np.concatenate([v, w]))
    assert np.isfinite(T).all()
    assert np.linalg.norm(T[:3, 3]) <= np.linalg.norm(v) * (1.0 + 1e-14) + 1e-322
    xi = both(cs.log_se3, T)
    np.testing.assert_allclose(cs.exp_se3(xi), T, rtol=0, atol=1e-12)
    np.testing.assert_allclose(cs.screw_of(T).pose(), T, rtol=0, atol=1e-12)
    screw = cs.twist_to_screw(xi)
    np.testing.assert_allclose(screw.twist, xi, rtol=1e-12, atol=1e-14)
    J = cs.left_jacobian_se3(xi)
    np.testing.assert_allclose(J @ cs.left_jacobian_inv_se3(xi), np.eye(6), rtol=0, atol=1e-12)


@SETTINGS
@given(vectors(2, LENGTHS), NUMBERS)
def test_the_plane(xy, angle):
    T = both(cs.exp_se2, np.array([*xy, angle]))
    assert_rotation(T[:2, :2])
    np.testing.assert_allclose(cs.exp_se2(both(cs.log_se2, T)), T, rtol=0, atol=1e-13)
    pole = cs.pole_of(T)
    if pole:
        size = 1.0 + np.abs(pole.point).max()
        np.testing.assert_allclose(
            cs.transform_points_2d(T, pole.point), pole.point, rtol=0, atol=1e-14 * size
        )
    else:
        assert abs(cs.to_theta(T)) <= 1e-13


@SETTINGS
@given(vectors(3, LENGTHS), vectors(3), vectors(3, LENGTHS), vectors(3), st.floats(0.0, 1.0))
def test_between_any_two_poses(p, v, q, w, t):
    start, end = cs.pose(p, rotvec=v), cs.pose(q, rotvec=w)
    middle = cs.interpolate(start, end, t)
    assert_rotation(middle[:3, :3])
    whole = cs.rotation_distance(start, end)
    assert abs(cs.rotation_distance(start, middle) - t * whole) < 1e-13
    assert abs(cs.rotation_distance(middle, end) - (1.0 - t) * whole) < 1e-13
    np.testing.assert_allclose(cs.interpolate(start, end, 1.0), end, rtol=0, atol=1e-13)
