"""Agreement with scipy's RigidTransform to 1e-12: exponential coordinates, inverse, points, interpolation."""

import numpy as np
import pytest

import cspace as cs
from spatial.draws import ANGLES, BATCHES, close, poses, twists

transform = pytest.importorskip("scipy.spatial.transform")


@pytest.fixture(scope="module")
def rigid():
    if not hasattr(transform, "RigidTransform"):
        pytest.skip("this scipy has no RigidTransform (it came with 1.16)")
    return transform.RigidTransform


def coordinates(xi):
    """Ours are [v; ω], scipy's are [ω; v]."""
    return np.concatenate([xi[..., 3:], xi[..., :3]], axis=-1)


@pytest.mark.parametrize("angle", ANGLES)
def test_exponential_coordinates_agree(rigid, angle):
    xi = twists(angle, (50,))
    theirs = rigid.from_exp_coords(coordinates(xi))
    close(cs.exp_se3(xi), theirs.as_matrix())
    T = poses(angle, (50,))
    close(cs.log_se3(T), coordinates(rigid.from_matrix(T).as_exp_coords()))


def test_products_inverses_and_points_agree(rigid):
    T, S = poses("any", (30,)), poses("any", (30,), seed=3)
    p = np.random.default_rng(1).normal(size=(30, 3))
    close(T @ S, (rigid.from_matrix(T) * rigid.from_matrix(S)).as_matrix())
    close(cs.inverse_pose(T), rigid.from_matrix(T).inv().as_matrix())
    close(cs.transform_points(T, p), rigid.from_matrix(T).apply(p))


def test_slerp_agrees():
    R = cs.random_rotation(2, rng=1)
    t = np.linspace(0.0, 1.0, 9)
    theirs = transform.Slerp([0.0, 1.0], transform.Rotation.from_matrix(R))(t)
    close(cs.slerp(R[0], R[1], t), theirs.as_matrix())


def test_means_agree():
    R = cs.exp_so3(0.5 * np.random.default_rng(2).normal(size=(9, 3)))
    w = np.arange(1.0, 10.0)
    close(cs.mean_rotation(R, w), transform.Rotation.from_matrix(R).mean(w).as_matrix())


@pytest.mark.parametrize("batch", BATCHES[:2], ids=str)
def test_scipys_objects_are_taken_wherever_a_pose_is(rigid, batch):
    T = poses("any", batch)
    theirs = rigid.from_matrix(T)
    close(cs.log_se3(theirs), cs.log_se3(T))
    close(cs.to_rpy(theirs.rotation), cs.to_rpy(T))
    close(cs.inverse_pose(theirs), cs.inverse_pose(T))
