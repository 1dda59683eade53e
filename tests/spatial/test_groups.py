"""Group laws: SO(2), SE(2), SO(3), SE(3), their exponentials, logarithms, adjoints and Jacobians."""

import numpy as np
import pytest

import cspace as cs
from cspace.errors import InputError
from spatial.draws import ANGLES, BATCHES, close, poses, rotvecs, twists


def planar_twists(name, shape, seed=0):
    angle = np.asarray(ANGLES[name](np.random.default_rng(seed), shape))[..., None]
    return np.concatenate([np.random.default_rng(seed + 1).uniform(-1.0, 1.0, (*shape, 2)), angle], axis=-1)


def angles_of(name, shape, seed=0):
    return planar_twists(name, shape, seed)[..., 2]


GROUPS = {
    "SO2": (cs.exp_so2, cs.log_so2, angles_of, cs.hat_so2, cs.vee_so2),
    "SE2": (cs.exp_se2, cs.log_se2, planar_twists, cs.hat_se2, cs.vee_se2),
    "SO3": (cs.exp_so3, cs.log_so3, rotvecs, cs.hat_so3, cs.vee_so3),
    "SE3": (cs.exp_se3, cs.log_se3, twists, cs.hat_se3, cs.vee_se3),
}


@pytest.fixture(params=GROUPS)
def group(request):
    return GROUPS[request.param]


def matrix_exponential(A):
    """Scaling, a Taylor series, squaring: slow and independent of every closed form."""
    small = A / 2.0**10
    term = total = np.eye(len(A))
    for n in range(1, 12):
        term = term @ small / n
        total = total + term
    for _ in range(10):
        total = total @ total
    return total


@pytest.mark.parametrize("batch", BATCHES, ids=str)
@pytest.mark.parametrize("angle", ANGLES)
def test_exp_and_log_undo_each_other(group, angle, batch):
    exp, log, draw, _, _ = group
    x = draw(angle, batch)
    X = exp(x)
    close(exp(log(X)), X)
    if angle not in {"π", "π + 1e-9"}:
        close(log(X), x)


@pytest.mark.parametrize("angle", ANGLES)
def test_exp_is_the_matrix_exponential(group, angle):
    exp, _, draw, hat, vee = group
    x = draw(angle, (3,))
    close(vee(hat(x)), x)
    for item in x:
        close(exp(item), matrix_exponential(hat(item)), atol=3e-13)


@pytest.mark.parametrize("angle", ["1e-9", "1e-5", "any", "quarter"])
def test_small_parts_keep_their_digits(group, angle):
    """Relative, not absolute: the logarithm of a turn by 1e-9 has nine more digits than the matrix shows."""
    exp, log, draw, _, _ = group
    x = draw(angle, (20,)) * 1.0
    np.testing.assert_allclose(log(exp(x)), x, rtol=1e-13, atol=1e-15)


@pytest.mark.parametrize("angle", ANGLES)
def test_a_batch_is_the_single_calls_stacked(group, angle):
    exp, log, draw, _, _ = group
    x = draw(angle, (2, 4))
    X = exp(x)
    close(X, np.stack([[exp(item) for item in row] for row in x]), atol=4e-15)
    close(log(X), np.stack([[log(item) for item in row] for row in X]), atol=4e-15)


def test_one_parameter_subgroups(group):
    exp, _, draw, _, _ = group
    x = draw("any", (5,))
    close(exp(0.3 * x) @ exp(0.7 * x), exp(x))
    close(exp(x) @ exp(-x), np.broadcast_to(np.eye(exp(x).shape[-1]), exp(x).shape))


@pytest.mark.parametrize("batch", BATCHES, ids=str)
@pytest.mark.parametrize("angle", ANGLES)
def test_the_inverse_of_a_pose(angle, batch):
    T = poses(angle, batch)
    close(cs.inverse_pose(T) @ T, np.broadcast_to(np.eye(4), T.shape))
    close(cs.inverse_pose(cs.inverse_pose(T)), T)
    planar = cs.exp_se2(planar_twists(angle, batch))
    close(cs.inverse_pose_2d(planar) @ planar, np.broadcast_to(np.eye(3), planar.shape))


@pytest.mark.parametrize("batch", BATCHES, ids=str)
def test_points_and_directions(batch):
    T, S = poses("any", batch), poses("any", batch, seed=3)
    p = np.random.default_rng(1).normal(size=(*batch, 3))
    homogeneous = np.concatenate([p, np.ones((*batch, 1))], axis=-1)
    close(cs.transform_points(T, p), (T @ homogeneous[..., None])[..., :3, 0])
    close(cs.transform_points(T @ S, p), cs.transform_points(T, cs.transform_points(S, p)))
    close(cs.transform_directions(T, p), cs.transform_points(T, p) - cs.to_xyz(T))
    planar = cs.exp_se2(planar_twists("any", batch))
    embedded = cs.embed_pose_2d(planar)
    flat = p * [1.0, 1.0, 0.0]
    close(cs.transform_points_2d(planar, p[..., :2]), cs.transform_points(embedded, flat)[..., :2])
    close(cs.transform_directions_2d(planar, p[..., :2]), cs.transform_directions(embedded, flat)[..., :2])


@pytest.mark.parametrize("batch", BATCHES, ids=str)
@pytest.mark.parametrize("angle", ANGLES)
def test_adjoints(angle, batch):
    T, S, xi = poses(angle, batch), poses("any", batch, seed=3), twists("any", batch, seed=4)
    close(cs.adjoint(T @ S), cs.adjoint(T) @ cs.adjoint(S))
    moved = (cs.adjoint(T) @ xi[..., None])[..., 0]
    close(cs.hat_se3(moved), T @ cs.hat_se3(xi) @ cs.inverse_pose(T))
    close(cs.exp_se3(moved), T @ cs.exp_se3(xi) @ cs.inverse_pose(T))
    close(np.swapaxes(cs.coadjoint(T), -1, -2) @ cs.adjoint(T), np.broadcast_to(np.eye(6), (*batch, 6, 6)))


def test_the_adjoint_of_the_plane_is_that_of_space_restricted():
    T = cs.exp_se2(planar_twists("any", (5,)))
    kept = np.ix_(range(5), [0, 1, 5], [0, 1, 5])
    close(cs.adjoint_2d(T), cs.adjoint(cs.embed_pose_2d(T))[kept])
    close(cs.adjoint_2d(T @ T), cs.adjoint_2d(T) @ cs.adjoint_2d(T))


def test_the_jacobians_of_the_plane_are_those_of_space_restricted():
    pairs = [
        (cs.left_jacobian_se2, cs.left_jacobian_se3),
        (cs.right_jacobian_se2, cs.right_jacobian_se3),
        (cs.left_jacobian_inv_se2, cs.left_jacobian_inv_se3),
        (cs.right_jacobian_inv_se2, cs.right_jacobian_inv_se3),
    ]
    kept = np.ix_(range(7), [0, 1, 5], [0, 1, 5])
    for kind in ("any", "zero", "1e-5", "1e-9"):
        xi = planar_twists(kind, (7,))
        embedded = np.zeros((7, 6))
        embedded[:, [0, 1, 5]] = xi
        for planar, spatial in pairs:
            close(planar(xi), spatial(embedded)[kept], atol=1e-10)
    with pytest.raises(InputError, match="no inverse"):
        cs.left_jacobian_inv_se2([1.0, 0.0, 2 * np.pi])


def test_the_small_adjoint_is_the_bracket_and_the_logarithm_of_the_adjoint():
    x, y = twists("any", (5,)), twists("any", (5,), seed=3)
    bracket = cs.hat_se3(x) @ cs.hat_se3(y) - cs.hat_se3(y) @ cs.hat_se3(x)
    close((cs.small_adjoint(x) @ y[..., None])[..., 0], cs.vee_se3(bracket))
    for item in x:
        close(matrix_exponential(cs.small_adjoint(item)), cs.adjoint(cs.exp_se3(item)))


JACOBIANS = {
    "SO3": (cs.exp_so3, rotvecs, cs.left_jacobian_so3, cs.right_jacobian_so3),
    "SE3": (cs.exp_se3, twists, cs.left_jacobian_se3, cs.right_jacobian_se3),
}
INVERSES = {
    "SO3": (rotvecs, cs.left_jacobian_inv_so3, cs.right_jacobian_inv_so3, *JACOBIANS["SO3"][2:]),
    "SE3": (twists, cs.left_jacobian_inv_se3, cs.right_jacobian_inv_se3, *JACOBIANS["SE3"][2:]),
}


def jacobian_by_integration(generator_matrix):
    """J = ∫₀¹ exp(s ad x) ds, by Gauss–Legendre quadrature of the matrix exponential."""
    nodes, weights = np.polynomial.legendre.leggauss(20)
    return sum(
        0.5 * w * matrix_exponential((0.5 + 0.5 * s) * generator_matrix)
        for s, w in zip(nodes, weights, strict=True)
    )


@pytest.mark.parametrize("name", JACOBIANS)
@pytest.mark.parametrize("angle", ANGLES)
def test_jacobians_of_the_exponential(name, angle):
    _, draw, left, right = JACOBIANS[name]
    bracket = cs.hat_so3 if name == "SO3" else cs.small_adjoint
    for x in draw(angle, (3,)):
        close(left(x), jacobian_by_integration(bracket(x)))
        close(right(x), jacobian_by_integration(-bracket(x)))


@pytest.mark.parametrize("name", JACOBIANS)
def test_jacobians_against_differences(name):
    exp, draw, left, right = JACOBIANS[name]
    h = 1e-6
    x = draw("any", ())
    for k, step in enumerate(h * np.eye(x.size)):
        close(exp(x + step), exp(left(x)[:, k] * h) @ exp(x), atol=1e-11)
        close(exp(x + step), exp(x) @ exp(right(x)[:, k] * h), atol=1e-11)


@pytest.mark.parametrize("name", INVERSES)
@pytest.mark.parametrize("angle", ANGLES)
def test_inverse_jacobians(name, angle):
    draw, left_inv, right_inv, left, right = INVERSES[name]
    x = draw(angle, (2, 3))
    eye = np.broadcast_to(np.eye(x.shape[-1]), (2, 3, x.shape[-1], x.shape[-1]))
    close(left_inv(x) @ left(x), eye)
    close(right_inv(x) @ right(x), eye)


def test_the_coupling_is_smooth_where_its_series_ends():
    below, above = twists("any", ()), twists("any", ())
    below[3:] *= (1.0 - 1e-13) / np.linalg.norm(below[3:])
    above[3:] *= (1.0 + 1e-13) / np.linalg.norm(above[3:])
    close(cs.left_jacobian_se3(below), cs.left_jacobian_se3(above), atol=1e-12)


@pytest.mark.parametrize("turns", [1, 2, 7])
def test_at_whole_turns_the_jacobian_has_no_inverse(turns):
    with pytest.raises(cs.CspaceError, match="multiples of 2π"):
        cs.left_jacobian_inv_so3([0.0, 0.0, 2.0 * np.pi * turns])


def test_a_half_turn_of_the_plane_is_plus_pi_from_either_side():
    for sine in (0.0, -0.0, 1e-17, -1e-17):
        R = np.array([[-1.0, -sine], [sine, -1.0]])
        assert cs.log_so2(R) == np.pi
        assert cs.to_xytheta(cs.pose_2d((1.0, 2.0), matrix=R)).tolist() == [1.0, 2.0, np.pi]
