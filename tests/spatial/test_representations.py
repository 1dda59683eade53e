"""Laws of every representation: it goes there and back, in one call or in a batch, and keeps its ranges."""

import numpy as np
import pytest

import cspace as cs
from spatial.draws import ANGLES, BATCHES, close, poses, rotvecs

FORMS = {
    "wxyz": cs.to_wxyz,
    "xyzw": cs.to_xyzw,
    "rpy": cs.to_rpy,
    "rotvec": cs.to_rotvec,
    "axis_angle": cs.to_axis_angle,
    "matrix": cs.as_rotation,
    **{f"euler {s}": lambda R, s=s: (s, cs.to_euler(R, s)) for s in cs.SEQUENCES},
    **{f"fixed {s}": lambda R, s=s: (s, cs.to_fixed(R, s)) for s in cs.SEQUENCES},
}


@pytest.mark.parametrize("batch", BATCHES, ids=str)
@pytest.mark.parametrize("form", FORMS)
@pytest.mark.parametrize("along_axes", [False, True])
def test_a_rotation_read_and_made_again_is_itself(form, batch, along_axes):
    for angle in ANGLES:
        R = cs.exp_so3(rotvecs(angle, batch, along_axes=along_axes))
        assert R.shape == (*batch, 3, 3)
        close(cs.rotation(**{form.split()[0]: FORMS[form](R)}), R)


@pytest.mark.parametrize("form", FORMS)
@pytest.mark.parametrize("angle", ANGLES)
def test_a_batch_is_the_single_calls_stacked_and_a_pose_is_read_as_its_rotation(form, angle):
    T = poses(angle, (4,))
    batch = FORMS[form](T)
    single = [FORMS[form](x[:3, :3]) for x in T]
    if isinstance(batch, tuple):
        pairs = zip(batch, zip(*single, strict=True), strict=True)
        for whole, items in pairs:
            if not isinstance(whole, str):
                close(whole, np.stack(items), atol=1e-15)
    else:
        close(batch, np.stack(single), atol=1e-15)


@pytest.mark.parametrize("sequence", cs.SEQUENCES)
@pytest.mark.parametrize("distance", [0.0, 1e-16, 1e-15, 1e-14, 1e-13, 1e-10, 1e-8, 1e-6, 1e-3])
def test_angles_reproduce_the_rotation_in_gimbal_lock_and_ever_so_near_it(sequence, distance):
    generator = np.random.default_rng(5)
    angles = generator.uniform(-np.pi, np.pi, (40, 3))
    locks = [0.0, np.pi] if sequence[0] == sequence[2] else [np.pi / 2, -np.pi / 2]
    angles[:, 1] = np.repeat(locks, 20) + distance * generator.choice([-1.0, 1.0], 40)
    R = cs.rotation(euler=(sequence, angles))
    close(cs.rotation(euler=(sequence, cs.to_euler(R, sequence))), R, atol=5e-14)
    close(cs.rotation(fixed=(sequence, cs.to_fixed(R, sequence))), R, atol=5e-14)
    if distance <= 1e-15:
        assert (cs.to_euler(R, sequence)[:, 2] == 0.0).all()


@pytest.mark.parametrize("sequence", cs.SEQUENCES)
@pytest.mark.parametrize("read", [cs.to_euler, cs.to_fixed])
def test_angles_keep_their_ranges(sequence, read):
    R = np.concatenate(
        [cs.random_rotation(200, rng=1), *(cs.exp_so3(rotvecs(a, (50,), along_axes=True)) for a in ANGLES)]
    )
    first, middle, last = np.moveaxis(read(R, sequence), -1, 0)
    low = 0.0 if sequence[0] == sequence[2] else -np.pi / 2
    assert (middle >= low).all()
    assert (middle <= low + np.pi).all()
    for outer in (first, last):
        assert (outer > -np.pi).all()
        assert (outer <= np.pi).all()


@pytest.mark.parametrize("sequence", cs.SEQUENCES)
def test_fixed_axes_are_euler_axes_in_reverse_order(sequence):
    angles = np.random.default_rng(6).uniform(-3.0, 3.0, (20, 3))
    R = cs.rotation(fixed=(sequence, angles))
    close(cs.rotation(euler=(sequence[::-1], angles[:, ::-1])), R)


def test_a_sequence_is_the_product_of_its_turns():
    axes = dict(zip("XYZ", np.eye(3), strict=True))
    for sequence in cs.SEQUENCES:
        angles = np.random.default_rng(7).uniform(-3.0, 3.0, 3)
        turns = [cs.rotation(axis_angle=(axes[s], a)) for s, a in zip(sequence, angles, strict=True)]
        close(cs.rotation(euler=(sequence, angles)), turns[0] @ turns[1] @ turns[2])
        close(cs.rotation(fixed=(sequence, angles)), turns[2] @ turns[1] @ turns[0])


def test_signs_of_quaternions():
    q = cs.to_wxyz(cs.random_rotation(500, rng=2))
    assert (q[:, 0] >= 0.0).all()
    half_turns = cs.rotation(wxyz=[[0, -1, 0, 0], [0, 0, -1, 0], [0, 0, 0, -1], [0, -0.6, 0.8, 0]])
    close(cs.to_wxyz(half_turns), [[0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1], [0, 0.6, -0.8, 0]])
    close(cs.to_rotvec(half_turns[3]), [0.6 * np.pi, -0.8 * np.pi, 0.0])


def test_the_axis_of_the_identity_is_z():
    axis, angle = cs.to_axis_angle(np.eye(3))
    assert axis.tolist() == [0.0, 0.0, 1.0]
    assert angle == 0.0


@pytest.mark.parametrize("scale", [1e-320, 1e-300, 1.0, 1e300])
def test_the_length_of_a_quaternion_or_an_axis_does_not_matter(scale):
    q = np.array([0.5, 0.5, -0.5, 0.5])
    close(cs.rotation(wxyz=q * scale), cs.rotation(wxyz=q))
    close(
        cs.rotation(axis_angle=(np.array([1.0, 1.0, 0.0]) * scale, 0.3)),
        cs.rotation(rotvec=[0.3 / 2**0.5] * 2 + [0]),
    )


def test_leading_axes_broadcast():
    T = cs.pose(np.zeros((4, 1, 3)), rpy=np.zeros((5, 3)))
    assert T.shape == (4, 5, 4, 4)
    assert cs.pose(xyz=(1, 2, 3)).tolist() == [[1, 0, 0, 1], [0, 1, 0, 2], [0, 0, 1, 3], [0, 0, 0, 1]]
    assert cs.rotation(axis_angle=((0, 0, 1), np.zeros(7))).shape == (7, 3, 3)
    assert cs.transform_points(np.eye(4), np.zeros((9, 3))).shape == (9, 3)
    assert cs.transform_points(np.zeros((6, 1, 4, 4)) + np.eye(4), np.zeros((9, 3))).shape == (6, 9, 3)
