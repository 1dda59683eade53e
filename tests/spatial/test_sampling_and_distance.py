"""Uniform draws, distances as metrics, the nearest rotation and the mean."""

import numpy as np
import pytest

import cspace as cs
from spatial.draws import ANGLES, close, poses, rotvecs


@pytest.mark.parametrize(
    ("draw", "tail"),
    [
        (cs.random_rotation, (3, 3)),
        (cs.random_pose, (4, 4)),
        (cs.random_rotation_2d, (2, 2)),
        (cs.random_pose_2d, (3, 3)),
    ],
)
def test_draws_have_the_size_asked_for_and_repeat_with_the_seed(draw, tail):
    for size, shape in (((), ()), (4, (4,)), ((2, 3), (2, 3)), (0, (0,))):
        X = draw(size, rng=7)
        assert X.shape == shape + tail
        np.testing.assert_array_equal(X, draw(size, rng=np.random.default_rng(7)))
    assert not np.array_equal(draw(3, rng=7), draw(3, rng=8))
    assert not np.array_equal(draw(3), draw(3))


def test_random_rotations_are_uniform():
    """The angle has the density (1 − cos θ)/π, each entry is uniform in [−1, 1], in any frame."""
    n = 40_000
    R = cs.random_rotation(n, rng=1)
    for frame in (np.eye(3), cs.random_rotation(rng=2)):
        angle = np.sort(np.linalg.norm(cs.log_so3(frame @ R), axis=-1))
        expected = (angle - np.sin(angle)) / np.pi
        assert np.abs(expected - (np.arange(n) + 0.5) / n).max() < 1.95 / np.sqrt(n)
    for entry in (R[:, i, j] for i in range(3) for j in range(3)):
        expected = 0.5 * (1.0 + np.sort(entry))
        assert np.abs(expected - (np.arange(n) + 0.5) / n).max() < 1.95 / np.sqrt(n)


def test_random_translations_fill_the_box():
    p = cs.to_xyz(cs.random_pose(2000, lower=(0, -1, 2), upper=(1, -1, 4), rng=3))
    close(p.min(axis=0), [0.0, -1.0, 2.0], atol=5e-3)
    close(p.max(axis=0), [1.0, -1.0, 4.0], atol=5e-3)
    assert (
        np.abs(cs.to_xytheta(cs.random_pose_2d(500, lower=-3.0, upper=-2.0, rng=3))[:, :2] + 2.5).max() <= 0.5
    )


@pytest.mark.parametrize("angle", ANGLES)
def test_the_distance_of_rotations_is_the_angle_between_them(angle):
    R = cs.random_rotation(20, rng=4)
    w = rotvecs(angle, (20,))
    turn = np.asarray(ANGLES[angle](np.random.default_rng(1), (20,)))
    turn = np.linalg.norm(w, axis=-1) if angle == "any" else np.minimum(turn, 2.0 * np.pi - turn)
    close(cs.rotation_distance(R, R @ cs.exp_so3(w)), turn)
    distance = cs.rotation_distance(np.eye(3), cs.exp_so3(w))
    np.testing.assert_allclose(distance, turn, rtol=1e-12, atol=2e-323)


def test_distances_are_metrics_and_do_not_depend_on_the_base():
    A, B, C, T_new_base = cs.random_pose((4, 100), rng=5)
    for distance in (
        cs.rotation_distance,
        cs.translation_distance,
        lambda X, Y: cs.pose_distance(X, Y, length=0.3),
    ):
        close(distance(A, A), np.zeros(100), atol=1e-7)
        close(distance(A, B), distance(B, A))
        assert (distance(A, C) <= distance(A, B) + distance(B, C) + 1e-12).all()
        close(distance(T_new_base @ A, T_new_base @ B), distance(A, B))
    close(cs.pose_distance(A, B, length=0.0), cs.translation_distance(A, B))
    near = cs.pose((3.0, 0.0, 0.0), rpy=(0.0, 0.0, 2.0))
    assert cs.pose_distance(np.eye(4), near, length=2.0) == pytest.approx(5.0, abs=1e-14)
    assert isinstance(cs.rotation_distance(np.eye(3), np.eye(3)), float)


def test_the_projection_is_the_nearest_rotation():
    generator = np.random.default_rng(6)
    R = cs.random_rotation(50, rng=7)
    M = R + generator.uniform(-0.015, 0.015, R.shape)
    nearest = cs.project_rotation(M)
    close(nearest, cs.as_rotation(nearest))
    loss = np.linalg.norm(nearest - M, axis=(-2, -1))
    for step in cs.exp_so3(1e-3 * generator.normal(size=(20, 3))):
        assert (np.linalg.norm(nearest @ step - M, axis=(-2, -1)) > loss).all()
    close(cs.project_rotation(R), R)
    close(cs.project_rotation(cs.project_rotation(M)), nearest)


def test_the_projection_of_a_pose_keeps_the_translation():
    T = poses("any", (5,))
    worn = T.copy()
    worn[:, :3, :3] *= 1.01
    close(cs.project_pose(worn), T)


def test_a_wider_limit_must_be_asked_for():
    with pytest.raises(cs.CspaceError, match="accepts up to"):
        cs.project_rotation(1.2 * np.eye(3))
    close(cs.project_rotation(1.2 * np.eye(3), limit=0.5), np.eye(3))


def test_distances_in_the_plane_are_those_of_the_embedded_poses():
    A, B = cs.random_pose_2d(200, rng=8), cs.random_pose_2d(200, rng=9)
    a, b = cs.embed_pose_2d(A), cs.embed_pose_2d(B)
    close(cs.rotation_distance_2d(A, B), cs.rotation_distance(a, b))
    close(cs.rotation_distance_2d(A[:, :2, :2], B[:, :2, :2]), cs.rotation_distance(a, b))
    close(cs.translation_distance_2d(A, B), cs.translation_distance(a, b))
    close(cs.pose_distance_2d(A, B, length=0.7), cs.pose_distance(a, b, length=0.7))
    assert cs.pose_distance_2d(A[:, None], B[:3], length=1.0).shape == (200, 3)
    half = cs.rotation_distance_2d(cs.rotation_2d(np.pi), np.eye(2))
    assert half == np.pi
    tiny = cs.rotation_distance_2d(cs.rotation_2d(1e-300), np.eye(2))
    assert tiny == 1e-300
    with pytest.raises(cs.CspaceError, match="length is -1"):
        cs.pose_distance_2d(A, B, length=-1)
    with pytest.raises(cs.CspaceError, match="second planar pose has shape"):
        cs.translation_distance_2d(A, b)


def test_the_projection_in_the_plane_is_that_of_the_embedded_pose():
    T = cs.random_pose_2d(50, rng=8)
    worn = T + np.random.default_rng(6).uniform(-0.015, 0.015, T.shape) * [[1, 1, 0], [1, 1, 0], [0, 0, 0]]
    mended = cs.project_pose_2d(worn)
    space = np.tile(np.eye(4), (50, 1, 1))
    space[:, :2, :2], space[:, :2, 3] = worn[:, :2, :2], worn[:, :2, 2]
    close(cs.embed_pose_2d(mended), cs.project_pose(space))
    close(cs.project_rotation_2d(worn[:, :2, :2]), mended[:, :2, :2])
    close(cs.project_rotation_2d(1.2 * np.eye(2), limit=0.5), np.eye(2))
    with pytest.raises(cs.CspaceError, match="accepts up to"):
        cs.project_rotation_2d(1.2 * np.eye(2))
    with pytest.raises(cs.CspaceError, match="it is a reflection"):
        cs.project_rotation_2d(np.diag([1.0, -1.0]))
    with pytest.raises(cs.CspaceError, match=r"last row of matrix differs from \[0, 0, 1\]"):
        cs.project_pose_2d(np.ones((3, 3)))


def test_the_mean_is_in_the_middle_and_moves_with_the_frame():
    R = cs.random_rotation(rng=8) @ cs.exp_so3(0.4 * np.random.default_rng(9).normal(size=(6, 11, 3)))
    mean = cs.mean_rotation(R)
    assert mean.shape == (6, 3, 3)
    frame = cs.random_rotation(rng=10)
    close(cs.mean_rotation(frame @ R), frame @ mean)
    close(cs.mean_rotation(R @ frame), mean @ frame)
    close(cs.mean_rotation(R[:, :2]), cs.slerp(R[:, 0], R[:, 1], 0.5))
    close(cs.mean_rotation(R[:, :1]), R[:, 0])
    twice = np.concatenate([R, R[:, :1]], axis=1)
    close(cs.mean_rotation(twice), cs.mean_rotation(R, weights=[2.0] + [1.0] * 10))
    close(cs.mean_rotation(R, weights=np.full(11, 1e-300)), mean)
