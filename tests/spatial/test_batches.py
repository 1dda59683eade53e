"""Compiled batches of conversions: each row is what the formula for one rotation gives."""

import numpy as np
import pytest

import cspace as cs
from cspace import _core
from cspace.errors import InputError

RNG = np.random.default_rng(3)
SIZES = [0, 1, 2, 3, 4, 5, 7, 8, 9, 17]
FORMS = {
    "wxyz": lambda v: {"wxyz": v},
    "xyzw": lambda v: {"xyzw": v},
    "rotvec": lambda v: {"rotvec": v[..., :3]},
    "axis_angle": lambda v: {"axis_angle": (v[..., :3], v[..., 3])},
}


def numbers(n: int) -> np.ndarray:
    return RNG.normal(size=(n, 4)) * 10 ** RNG.uniform(-3, 2, (n, 1))


@pytest.mark.parametrize("form", FORMS)
@pytest.mark.parametrize("n", SIZES)
def test_a_row_of_a_batch_is_the_single_conversion(form, n):
    values = numbers(n)
    batch = cs.rotation(**FORMS[form](values))
    assert batch.shape == (n, 3, 3)
    for R, v in zip(batch, values, strict=True):
        np.testing.assert_allclose(R, cs.rotation(**FORMS[form](v)), rtol=0, atol=2e-15)


@pytest.mark.parametrize("form", FORMS)
def test_the_layout_of_a_batch_does_not_matter(form):
    values = numbers(60)
    expected = cs.rotation(**FORMS[form](values))
    for array in (np.asfortranarray(values), values[::-1][::-1], np.repeat(values, 2, axis=1)[:, ::2]):
        np.testing.assert_array_equal(cs.rotation(**FORMS[form](array)), expected)
    shaped = cs.rotation(**FORMS[form](values.reshape(3, 4, 5, 4)))
    np.testing.assert_array_equal(shaped, expected.reshape(3, 4, 5, 3, 3))


@pytest.mark.parametrize("form", FORMS)
@pytest.mark.parametrize("scale", [1e-320, 1e-200, 1e-141, 1e-100, 1e100, 1e139, 1e141, 1e300])
def test_a_row_of_extreme_length_spoils_no_other(form, scale):
    values = numbers(9)
    values[4] = np.array([0.5, 0.1, -0.7, 0.4]) * scale
    if form == "axis_angle":
        values[4, 3] = 0.7
    batch = cs.rotation(**FORMS[form](values))
    single = np.array([cs.rotation(**FORMS[form](v)) for v in values])
    np.testing.assert_allclose(batch, single, rtol=0, atol=2e-15)
    squares = batch @ np.swapaxes(batch, -1, -2)
    np.testing.assert_allclose(squares, np.broadcast_to(np.eye(3), (9, 3, 3)), rtol=0, atol=4e-15)


def test_small_rotation_vectors_keep_all_digits():
    w = np.zeros((6, 3))
    w[1, 0], w[2, 1], w[3, 2], w[4, 0], w[5, :2] = 1e-300, 3e-160, 1e-8, 4.9e-324, (1e-5, 2e-5)
    R = cs.exp_so3(w)
    np.testing.assert_array_equal(R[0], np.eye(3))
    np.testing.assert_array_equal(R[[1, 4], 2, 1], w[[1, 4], 0])
    assert R[2, 0, 2] == 3e-160
    np.testing.assert_allclose(cs.log_so3(R)[[3, 5]], w[[3, 5]], rtol=3e-16, atol=0)


def test_a_batch_is_broadcast():
    axes, angles = RNG.normal(size=(4, 1, 3)), RNG.uniform(-9, 9, 5)
    R = cs.rotation(axis_angle=(axes, angles))
    for i, j in np.ndindex(4, 5):
        np.testing.assert_allclose(R[i, j], cs.rotation(axis_angle=(axes[i, 0], angles[j])), atol=2e-15)


@pytest.mark.parametrize("form", FORMS)
@pytest.mark.parametrize("bad", [np.nan, np.inf])
def test_a_row_that_is_no_number_is_named(form, bad):
    values = numbers(9)
    values[5, 2] = bad
    with pytest.raises(InputError, match=rf"holds {bad} at index \(5, 2\)"):
        cs.rotation(**FORMS[form](values))


@pytest.mark.parametrize("form", ["wxyz", "xyzw", "axis_angle"])
def test_a_zero_row_is_refused(form):
    values = numbers(9)
    values[5] = 0.0
    with pytest.raises(InputError, match="is zero"):
        cs.rotation(**FORMS[form](values))


def test_the_raw_functions_refuse_other_sizes():
    R = np.empty((3, 3, 3))
    with pytest.raises(ValueError, match="matching sizes"):
        _core.quaternion_matrices(np.ones((4, 4)), False, R)
    with pytest.raises(ValueError, match="matching sizes"):
        _core.rotvec_matrices(np.ones((2, 3)), R)
    with pytest.raises(ValueError, match="matching sizes"):
        _core.axis_angle_matrices(np.ones((3, 3)), np.ones(2), R)
    with pytest.raises(TypeError):
        _core.rotvec_matrices(np.ones((3, 4)), R)
