"""What is refused, and that the message names the subject, the rule and the remedy."""

from decimal import Decimal
from fractions import Fraction

import numpy as np
import pytest

import cspace as cs
from cspace.errors import InputError, InputTypeError, UnknownNameError

MAKERS = {
    "wxyz": lambda x: cs.rotation(wxyz=np.full(4, x)),
    "xyzw": lambda x: cs.rotation(xyzw=np.full(4, x)),
    "rpy": lambda x: cs.rotation(rpy=np.full(3, x)),
    "rotvec": lambda x: cs.rotation(rotvec=np.full(3, x)),
    "axis": lambda x: cs.rotation(axis_angle=(np.full(3, x), 1.0)),
    "angle": lambda x: cs.rotation(axis_angle=(np.ones(3), x)),
    "Euler angles": lambda x: cs.rotation(euler=("ZYX", np.full(3, x))),
    "fixed angles": lambda x: cs.rotation(fixed=("ZYX", np.full(3, x))),
    "matrix": lambda x: cs.rotation(matrix=np.full((3, 3), x)),
    "xyz": lambda x: cs.pose(np.full(3, x)),
    "xy": lambda x: cs.pose_2d(np.full(2, x)),
    "theta": lambda x: cs.rotation_2d(x),
    "xytheta": lambda x: cs.pose_2d(xytheta=np.full(3, x)),
    "vector": lambda x: cs.hat_so3(np.full(3, x)),
    "twist": lambda x: cs.exp_se3(np.full(6, x)),
    "planar twist": lambda x: cs.exp_se2(np.full(3, x)),
    "points": lambda x: cs.transform_points(np.eye(4), np.full(3, x)),
    "directions": lambda x: cs.transform_directions(np.eye(4), np.full(3, x)),
    "pose": lambda x: cs.log_se3(np.full((4, 4), x)),
    "rotation": lambda x: cs.to_rpy(np.full((3, 3), x)),
    "planar pose": lambda x: cs.pole_of(np.full((3, 3), x)),
    "t": lambda x: cs.interpolate(np.eye(4), np.eye(4), x),
    "length": lambda x: cs.pose_distance(np.eye(4), np.eye(4), length=x),
    "lower": lambda x: cs.random_pose(lower=x),
}


@pytest.mark.parametrize("subject", MAKERS)
@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf])
def test_nan_and_inf_are_refused_by_name(subject, value):
    with pytest.raises(InputError, match=f"^{subject} holds {value}"):
        MAKERS[subject](value)


@pytest.mark.parametrize("subject", MAKERS)
@pytest.mark.parametrize("value", ["one", "1.0", 1.0 + 1.0j, np.datetime64("2020-01-01")])
def test_what_is_not_a_real_number_is_refused(subject, value):
    with pytest.raises(InputTypeError, match=f"^{subject} must be numbers"):
        MAKERS[subject](value)


def test_exact_numbers_are_numbers():
    third = Fraction(1, 3)
    assert cs.pose([third, 0, Decimal("0.5")])[:3, 3].tolist() == [1 / 3, 0.0, 0.5]
    assert cs.rotation_2d(np.float32(0.5)).dtype == np.float64
    with pytest.raises(InputError, match="xyz holds nan"):
        cs.pose([None, 0, 0])


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: cs.rotation(wxyz=np.zeros(3)), r"wxyz has shape \(3,\), expected \(..., 4\)"),
        (lambda: cs.rotation(rpy=0.5), r"rpy has shape \(\), expected \(..., 3\)"),
        (lambda: cs.pose(np.zeros(4)), r"xyz has shape \(4,\), expected \(..., 3\)"),
        (lambda: cs.exp_se3(np.zeros(3)), r"twist has shape \(3,\), expected \(..., 6\)"),
        (lambda: cs.rotation(wxyz=np.zeros(4)), "wxyz is zero"),
        (lambda: cs.rotation(xyzw=[[0, 0, 0, 1], [0, 0, 0, 0]]), "xyzw is zero"),
        (lambda: cs.rotation(axis_angle=([0, 0, 0], 1.0)), "axis is zero"),
        (lambda: cs.rotation(matrix=np.diag([1.0, 1.0, -1.0])), "matrix has determinant −1"),
        (
            lambda: cs.rotation(matrix=1.01 * np.eye(3)),
            "matrix is not a rotation.*by 0.0201, allowed 1e-06.*project_rotation",
        ),
        (
            lambda: cs.pose(np.zeros((2, 3)), rpy=np.zeros((3, 3))),
            r"rotation \(3,\) and translation \(2,\) do not",
        ),
        (lambda: cs.rotation(axis_angle=(np.ones((2, 3)), np.ones(3))), r"axis \(2,\) and angle \(3,\)"),
        (
            lambda: cs.transform_points(np.zeros((5, 4, 4)) + np.eye(4), np.zeros((9, 3))),
            r"pose \(5,\) and vector \(9,\)",
        ),
        (lambda: cs.exp_so3([1.7e308] * 3), "norm overflows"),
        (
            lambda: cs.project_rotation(2.0 * np.eye(3)),
            "differs from the identity by 3; projection accepts up to 0.1",
        ),
        (lambda: cs.project_rotation(np.diag([1.0, 1.0, -0.99])), "negative determinant"),
        (lambda: cs.project_pose(np.zeros((4, 4))), "last row"),
        (lambda: cs.mean_rotation(np.eye(3)), "expected .*n, 3, 3"),
        (lambda: cs.mean_rotation(np.zeros((0, 3, 3))), "n ≥ 1"),
        (lambda: cs.mean_rotation([np.eye(3), np.diag([1.0, -1.0, -1.0])]), "no unique mean"),
        (lambda: cs.mean_rotation([np.eye(3)], weights=[0.0]), "not all zero"),
        (lambda: cs.mean_rotation([np.eye(3)] * 2, weights=[1.0, -1.0]), "must not be negative"),
        (lambda: cs.mean_rotation([np.eye(3)] * 2, weights=[1.0, 1.0, 1.0]), r"weights have shape \(3,\)"),
        (lambda: cs.random_pose(lower=2.0, upper=1.0), "lower 2.0 exceeds upper 1.0"),
        (lambda: cs.random_pose(lower=[0.0, 0.0]), r"lower has shape \(2,\), expected \(3,\)"),
        (lambda: cs.random_rotation(-1), "must not be negative"),
        (lambda: cs.random_rotation(rng=-1), "rng is -1; a seed must be 0 or more"),
        (
            lambda: cs.pose_distance(np.eye(4), np.eye(4), length=-1.0),
            "length is -1.0; it must be one number ≥ 0",
        ),
    ],
)
def test_wrong_values(call, message):
    with pytest.raises(InputError, match=message):
        call()


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: cs.pose(), r"pose\(\) needs xyz= or one of wxyz=, xyzw=, rpy="),
        (lambda: cs.rotation(), r"rotation\(\) needs one of wxyz="),
        (lambda: cs.pose_2d(), r"pose_2d\(\) needs xy="),
        (lambda: cs.pose(rpy=[0, 0, 0], wxyz=[1, 0, 0, 0]), "rotation 2 times: wxyz=, rpy=; give one"),
        (lambda: cs.pose_2d(theta=0.0, matrix=np.eye(2)), "rotation twice"),
        (lambda: cs.pose_2d((1, 2), xytheta=(1, 2, 3)), "xytheta= and another"),
        (
            lambda: cs.rotation(axis_angle=np.zeros(4)),
            r"axis_angle= takes a pair \(axis, angle\), got ndarray",
        ),
        (lambda: cs.rotation(euler=[0.1, 0.2, 0.3]), r"euler= takes a pair \(sequence, angles\)"),
        (lambda: cs.rotation(fixed=(0.1, 0.2)), "a sequence of axes is a string such as 'ZYX', got float"),
        (lambda: cs.random_rotation(2.5), "size is 2.5"),
        (lambda: cs.random_rotation(rng="7"), "rng is a str"),
        (lambda: cs.random_rotation(rng=True), "rng is a bool"),
    ],
)
def test_wrong_types_and_combinations(call, message):
    with pytest.raises(InputTypeError, match=message):
        call()


@pytest.mark.parametrize("name", ["ZYZX", "XXY", "ZZZ", "", "RPY"])
def test_sequences_that_are_none(name):
    for call in (
        lambda: cs.to_euler(np.eye(3), name),
        lambda: cs.to_fixed(np.eye(3), name),
        lambda: cs.rotation(euler=(name, [0, 0, 0])),
        lambda: cs.rotation(fixed=(name, [0, 0, 0])),
    ):
        with pytest.raises(UnknownNameError, match=f"no sequence '{name}'.* sequences: XYX, XYZ"):
            call()


def test_a_misspelt_sequence_is_answered_with_the_nearest_and_lower_case_is_explained():
    with pytest.raises(UnknownNameError, match="did you mean 'ZYX'"):
        cs.to_euler(np.eye(3), "ZYXX")
    with pytest.raises(UnknownNameError, match=r"in capitals, 'ZYX'.*lower case means fixed in scipy"):
        cs.to_euler(np.eye(3), "zyx")


@pytest.mark.parametrize("between", [cs.interpolate, cs.interpolate_decoupled, cs.slerp])
def test_planar_poses_between_poses_in_space_are_told_where_to_go(between):
    planar, spatial = cs.pose_2d(xytheta=[3.0, 4.0, 0.5]), cs.random_pose(rng=1)
    for start, end, subject in ((planar, spatial, "start"), (spatial, planar, "end")):
        with pytest.raises(InputError, match=rf"{subject} .*planar pose.*interpolate_2d.*embed_pose_2d"):
            between(start, end, 0.5)
    with pytest.raises(InputError) as caught:
        between(np.diag([1.0, 2.0, 3.0]), spatial, 0.5)
    assert "looks like" not in str(caught.value)
