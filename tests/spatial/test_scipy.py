"""Agreement with scipy's Rotation to 1e-12, on random and on degenerate rotations."""

import numpy as np
import pytest

import cspace as cs

Rotation = pytest.importorskip("scipy.spatial.transform").Rotation

EXACT = 1e-12


def close(actual, expected):
    np.testing.assert_allclose(actual, expected, rtol=0.0, atol=EXACT)


@pytest.fixture(scope="module")
def random_rotations():
    return Rotation.from_quat(np.random.default_rng(1).normal(size=(500, 4)))


@pytest.mark.parametrize("sequence", cs.SEQUENCES)
def test_all_24_sequences_agree(sequence, random_rotations):
    R = random_rotations.as_matrix()
    close(cs.to_euler(R, sequence), random_rotations.as_euler(sequence))
    close(cs.to_fixed(R, sequence), random_rotations.as_euler(sequence.lower()))
    angles = np.random.default_rng(2).uniform(-7.0, 7.0, (100, 3))
    close(cs.rotation(euler=(sequence, angles)), Rotation.from_euler(sequence, angles).as_matrix())
    close(cs.rotation(fixed=(sequence, angles)), Rotation.from_euler(sequence.lower(), angles).as_matrix())


def test_quaternions_and_rotation_vectors_agree(random_rotations):
    R = random_rotations.as_matrix()
    close(cs.to_xyzw(R), random_rotations.as_quat(canonical=True))
    close(cs.to_wxyz(R), random_rotations.as_quat(canonical=True, scalar_first=True))
    close(cs.to_rotvec(R), random_rotations.as_rotvec())
    close(cs.rotation(xyzw=random_rotations.as_quat() * 3.0), R)
    close(cs.rotation(rotvec=random_rotations.as_rotvec()), R)


@pytest.mark.parametrize(
    "angle", [0.0, 1e-12, 1e-9, 1e-6, 1.0, np.pi - 1e-6, np.pi - 1e-9, np.pi, np.pi + 1e-9]
)
def test_rotation_vectors_of_tiny_angles_and_half_turns_agree(angle):
    axes = np.random.default_rng(3).normal(size=(50, 3))
    rotvec = angle * axes / np.linalg.norm(axes, axis=1, keepdims=True)
    theirs = Rotation.from_rotvec(rotvec)
    close(cs.rotation(rotvec=rotvec), theirs.as_matrix())
    close(cs.exp_so3(cs.log_so3(theirs.as_matrix())), theirs.as_matrix())
    if abs(angle - np.pi) > 1e-12:
        close(cs.log_so3(cs.exp_so3(rotvec)), theirs.as_rotvec())


@pytest.mark.filterwarnings("ignore:Gimbal lock")
@pytest.mark.parametrize("sequence", cs.SEQUENCES)
def test_gimbal_lock_agrees_and_keeps_the_rotation(sequence):
    angles = np.random.default_rng(4).uniform(-3.0, 3.0, (20, 3))
    for middle in (0.0, np.pi) if sequence[0] == sequence[2] else (np.pi / 2, -np.pi / 2):
        angles[:, 1] = middle
        for form, read, name in (("euler", cs.to_euler, sequence), ("fixed", cs.to_fixed, sequence.lower())):
            R = cs.rotation(**{form: (sequence, angles)})
            ours, theirs = read(R, sequence), Rotation.from_matrix(R).as_euler(name)
            close(cs.rotation(**{form: (sequence, ours)}), R)
            close(np.exp(1j * ours), np.exp(1j * theirs))
            close(ours[:, 2], 0.0)
