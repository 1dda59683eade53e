"""What counts as a pose, and what is told about what does not."""

import numpy as np
import pytest

import cspace as cs
from cspace.errors import InputError, InputTypeError

T_GOOD = cs.pose((0.1, 0.2, 0.3), rpy=(0.4, 0.5, 0.6))


class HoldsArray:
    def __array__(self, dtype=None, copy=None):
        return np.array(T_GOOD, dtype=dtype)


class HoldsA:
    A = T_GOOD


class HoldsMatrix:
    def __init__(self, matrix):
        self.matrix = matrix

    def as_matrix(self):
        return self.matrix


def test_a_pose_array_is_returned_as_it_is():
    assert cs.as_pose(T_GOOD) is T_GOOD
    batch = np.stack([T_GOOD, np.eye(4)])
    assert cs.as_pose(batch) is batch
    assert cs.as_pose(np.zeros((0, 4, 4))).shape == (0, 4, 4)


@pytest.mark.parametrize(
    "value",
    [
        T_GOOD.tolist(),
        HoldsArray(),
        HoldsA(),
        HoldsMatrix(T_GOOD),
        T_GOOD.astype(np.longdouble),
        T_GOOD.T.copy().T,
    ],
)
def test_objects_that_hold_a_pose_are_poses(value):
    np.testing.assert_array_equal(cs.as_pose(value), T_GOOD)


def test_an_object_that_holds_a_rotation_gets_no_translation():
    T = cs.as_pose(HoldsMatrix(T_GOOD[:3, :3]))
    np.testing.assert_array_equal(T, cs.pose(matrix=T_GOOD[:3, :3]))


def test_scipys_objects_are_poses():
    transform = pytest.importorskip("scipy.spatial.transform")
    r = transform.Rotation.from_euler("ZYX", [0.1, 0.2, 0.3])
    np.testing.assert_allclose(cs.as_pose(r)[:3, :3], r.as_matrix())
    if hasattr(transform, "RigidTransform"):
        rigid = transform.RigidTransform.from_components([1.0, 2.0, 3.0], r)
        np.testing.assert_allclose(cs.as_pose(rigid), rigid.as_matrix())


def with_entry(row, column, value):
    T = T_GOOD.copy()
    T[row, column] = value
    return T


@pytest.mark.parametrize(
    ("value", "message"),
    [
        (with_entry(0, 3, np.nan), r"goal holds nan at index \(0, 3\)"),
        (with_entry(1, 1, np.inf), "goal holds inf"),
        (with_entry(1, 3, -np.inf), "goal holds -inf"),
        (with_entry(0, 0, 1e200), "not a rotation: RᵀR differs from the identity by inf"),
        (with_entry(3, 0, 0.1), r"last row \[0.1, 0.0, 0.0, 1.0\]"),
        (T_GOOD.T, "transpose it"),
        (T_GOOD @ np.diag([1.0, 1.0, -1.0, 1.0]), "determinant −1"),
        (T_GOOD @ np.diag([1.0, 1.0, 1.001, 1.0]), "differs from the identity by 0.002.*project_rotation"),
        (T_GOOD @ np.diag([2.0, 2.0, 2.0, 1.0]), "scaled by 2: divide by it"),
        (T_GOOD @ np.diag([1.0, 3.0, 2.0, 1.0]), "too far from any rotation"),
        (np.stack([T_GOOD, 2.0 * np.eye(4)]), r"goal \[1\] has the last row"),
        (np.eye(3), r"shape \(3, 3\), expected \(..., 4, 4\); cspace.pose\(matrix=R\)"),
        (T_GOOD[:3], "last row .* is missing"),
        (np.zeros(7), r"cspace.pose\(xyz"),
        ([[1.0, 2.0], [3.0]], "must be numbers"),
        ("pose", "must be numbers"),
        (None, "goal"),
    ],
)
def test_what_is_no_pose_is_refused_with_the_reason(value, message):
    with pytest.raises((InputError, InputTypeError), match=message):
        cs.as_pose(value, "goal")


def test_a_matrix_typed_with_seven_digits_is_a_pose_and_a_worse_one_is_not():
    assert cs.as_pose(np.round(T_GOOD, 7)).shape == (4, 4)
    with pytest.raises(InputError, match="ROTATION_ERROR"):
        cs.as_pose(np.round(T_GOOD, 4))


def test_a_rotation_is_read_from_a_rotation_or_a_pose():
    np.testing.assert_array_equal(cs.as_rotation(T_GOOD), T_GOOD[:3, :3])
    np.testing.assert_array_equal(cs.as_rotation(T_GOOD[:3, :3]), T_GOOD[:3, :3])
    with pytest.raises(InputError, match="expected"):
        cs.as_rotation(np.eye(2))
    with pytest.raises(InputError, match=r"tool \[1\] has determinant"):
        cs.as_rotation([np.eye(3), -np.eye(3)], "tool")


def test_planar_poses_are_checked_alike():
    T = np.array([[0.0, -1.0, 2.0], [1.0, 0.0, 3.0], [0.0, 0.0, 1.0]])
    assert cs.as_pose_2d(T) is T
    np.testing.assert_array_equal(cs.as_rotation_2d(T), T[:2, :2])
    with pytest.raises(InputError, match="transpose it"):
        cs.as_pose_2d(T.T)
    with pytest.raises(InputError, match="determinant −1"):
        cs.as_rotation_2d([[1.0, 0.0], [0.0, -1.0]])
    with pytest.raises(InputError, match=r"expected \(..., 3, 3\)"):
        cs.as_pose_2d(np.eye(4))


@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf])
def test_no_entry_is_overlooked(value):
    for row, column in np.ndindex(4, 4):
        for T in (with_entry(row, column, value), np.stack([T_GOOD, with_entry(row, column, value)])):
            with pytest.raises(InputError, match=f"pose holds {value} at index"):
                cs.as_pose(T)


@pytest.mark.parametrize(("i", "j"), [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)])
def test_no_column_is_overlooked(i, j):
    """One column stretched or leaning towards another by twice what is allowed, one pose and a batch."""
    lean = np.eye(4)
    lean[i, j] += 2e-6
    for T in (T_GOOD @ lean, np.stack([T_GOOD, T_GOOD @ lean])):
        with pytest.raises(InputError, match="not a rotation"):
            cs.as_pose(T)
        with pytest.raises(InputError, match="not a rotation"):
            cs.as_rotation(T[..., :3, :3])
    lean[i, j] = np.eye(4)[i, j] + 2e-7
    assert cs.as_pose(T_GOOD @ lean).shape == (4, 4)
