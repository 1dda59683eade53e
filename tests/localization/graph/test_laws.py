"""Laws of pose graphs, against normal equations in plain numpy."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import cspace as cs
from localization.graph.graphs import chi2, jacobian, matrix, numbers, random_graph, residuals

SPACES = pytest.mark.parametrize("spatial", [False, True], ids=["plane", "space"])


@pytest.mark.slow
@SPACES
@pytest.mark.parametrize("landmarks", [0, 5])
@pytest.mark.parametrize("method", ["gauss_newton", "levenberg_marquardt", "dog_leg"])
@pytest.mark.parametrize("start", ["given", "odometry", "rotations"])
def test_the_answer_is_stationary_and_its_chi2_the_definition(spatial, landmarks, method, start):
    rng = np.random.default_rng(5)
    for _ in range(3):
        graph = random_graph(rng, spatial=spatial, landmarks=landmarks)
        answer = graph.optimize(method=method, start=start)
        assert answer, answer.reason
        assert answer.chi2 == pytest.approx(chi2(graph, answer.poses, answer.landmarks), rel=1e-10)
        assert answer.chi2 == pytest.approx(answer.edge_chi2.sum() + answer.sighting_chi2.sum())
        J = jacobian(graph, answer.poses, answer.landmarks)[:, 6 if spatial else 3 :]
        e = residuals(graph, [matrix(row) for row in answer.poses], answer.landmarks)
        step = np.linalg.lstsq(J, -e, rcond=None)[0]
        assert np.abs(step).max() < 1e-5
        assert graph.dof == len(e) - J.shape[1]


@SPACES
@pytest.mark.parametrize("landmarks", [0, 4])
def test_marginals_are_the_dense_inverse(spatial, landmarks):
    rng = np.random.default_rng(6)
    size, d = (6, 3) if spatial else (3, 2)
    graph = random_graph(rng, spatial=spatial, landmarks=landmarks)
    answer = graph.optimize()
    J = jacobian(graph, answer.poses, answer.landmarks)[:, size:]
    P = np.linalg.inv(J.T @ J)
    n = len(graph.poses)
    assert not answer.marginals[0].any()
    for k in range(1, n):
        own = slice(size * (k - 1), size * k)
        assert np.allclose(answer.marginals[k], P[own, own], rtol=1e-5, atol=1e-9)
        for other in range(1, n):
            across = slice(size * (other - 1), size * other)
            assert np.allclose(answer.covariance(k, other), P[own, across], rtol=1e-5, atol=1e-8)
    for m in range(landmarks):
        own = slice(size * (n - 1) + d * m, size * (n - 1) + d * (m + 1))
        assert np.allclose(answer.landmark_marginals[m], P[own, own], rtol=1e-5, atol=1e-8)


def test_covariance_in_the_map_is_turned():
    graph = random_graph(np.random.default_rng(7))
    answer = graph.optimize()
    P, Q = answer.covariance(4), answer.covariance(4, frame="map")
    assert np.allclose(np.linalg.eigvalsh(P[:2, :2]), np.linalg.eigvalsh(Q[:2, :2]))
    c, s = np.cos(answer.poses[4, 2]), np.sin(answer.poses[4, 2])
    R = np.array([[c, -s], [s, c]])
    assert np.allclose(R @ P[:2, :2] @ R.T, Q[:2, :2])


@SPACES
def test_moving_the_world_changes_nothing_in_it(spatial):
    rng = np.random.default_rng(8)
    graph = random_graph(rng, spatial=spatial, landmarks=3)
    d = graph.dimension
    T = cs.exp_se3(rng.uniform(-2, 2, 6)) if spatial else cs.exp_se2(rng.uniform(-2, 2, 3))
    moved = graph.with_poses(
        [numbers(T @ matrix(row)) for row in graph.poses], graph.landmarks @ T[:d, :d].T + T[:d, d]
    )
    a, b = graph.optimize(), moved.optimize()
    assert a.chi2 == pytest.approx(b.chi2, rel=1e-9)
    for x, y in zip(a.poses, b.poses, strict=True):
        assert np.allclose(T @ matrix(x), matrix(y), atol=1e-6)
    assert np.allclose(a.marginals, b.marginals, rtol=1e-4, atol=1e-8)


@SPACES
def test_the_order_of_rows_changes_nothing(spatial):
    rng = np.random.default_rng(9)
    graph = random_graph(rng, spatial=spatial, landmarks=3)
    poses, edges, seen = (
        rng.permutation(k) for k in (len(graph.poses), len(graph.edges), len(graph.sightings))
    )
    place = np.argsort(poses)
    mixed = replace(
        graph,
        poses=graph.poses[poses],
        edges=place[graph.edges[edges]],
        motions=graph.motions[edges],
        information=graph.information[edges],
        sightings=np.stack([place[graph.sightings[seen, 0]], graph.sightings[seen, 1]], axis=1),
        points=graph.points[seen],
        point_information=graph.point_information[seen],
        ranged=graph.ranged[seen],
        fixed=(int(place[0]),),
        ids=(),
    )
    a, b = graph.optimize(), mixed.optimize()
    assert a.chi2 == pytest.approx(b.chi2, rel=1e-9)
    assert np.allclose(a.poses[poses], b.poses, atol=1e-6)


def test_ranges_and_bearings_agree_with_points():
    rng = np.random.default_rng(10)
    graph = random_graph(rng, landmarks=4, noise=1e-9)
    polar = np.stack([np.hypot(*graph.points.T), np.arctan2(graph.points[:, 1], graph.points[:, 0])], axis=1)
    ranged = np.ones(len(polar), bool)
    for hidden in ((), (0,), (1,)):
        points = polar.copy()
        points[:, list(hidden)] = np.nan
        seen = replace(graph, points=points, ranged=ranged)
        answer = seen.optimize(start="given")
        assert answer
        assert answer.chi2 < 1e-9
        assert np.allclose(answer.landmarks, graph.optimize().landmarks, atol=1e-5)
    assert replace(graph, points=np.where([True, False], np.nan, polar), ranged=ranged).optimize(
        start="odometry"
    )


def test_kernels_with_great_widths_change_nothing():
    graph = random_graph(np.random.default_rng(11))
    plain = graph.optimize()
    for kernel in ("huber", "cauchy", "geman_mcclure", "tukey", "dcs"):
        assert np.allclose(graph.optimize(kernel=kernel, width=1e4).poses, plain.poses, atol=1e-5)


@pytest.mark.parametrize("robust", ["dcs", "gnc", "best"])
def test_false_loops_are_listed(robust):
    rng = np.random.default_rng(12)
    graph = random_graph(rng, poses=40, noise=0.02)
    graph = replace(graph, information=np.eye(3) / 0.02**2)
    false = np.array([(2, 30), (5, 20), (9, 38)])
    wrong = replace(
        graph,
        edges=np.concatenate([graph.edges, false]),
        motions=np.concatenate([graph.motions, rng.uniform(2, 4, (3, 3))]),
        information=np.eye(3) / 0.02**2,
    )
    answer = wrong.optimize(robust=robust)
    assert answer
    k = len(graph.edges)
    assert {each.edge for each in answer.rejected} >= {k, k + 1, k + 2}
    assert len(answer.rejected) <= 4
    found = {each.edge: each for each in answer.rejected}
    assert (found[k].first, found[k].second) == (2, 30)
    assert found[k].chi2 > found[k].limit
    assert np.abs(answer.poses - graph.optimize().poses).max() < 0.05


def test_residual_of_g2o_has_half_angles():
    X = cs.exp_se3([0.3, -0.2, 0.1, 0.4, 0.5, -0.3])
    graph = cs.PoseGraph([np.eye(4), X], [(0, 1)], [np.eye(4)], np.eye(6), fixed=(0, 1))
    q = cs.to_xyzw(X[:3, :3])
    answer = graph.optimize(residual="g2o", start="given")
    assert answer.chi2 == pytest.approx((X[:3, 3] ** 2).sum() + (q[:3] ** 2).sum())


def test_time_limit_keeps_the_best_state():
    rng = np.random.default_rng(13)
    graph = random_graph(rng, poses=3000, spatial=True, noise=0.3)
    answer = graph.optimize(time_limit=0.02, start="given")
    assert not answer
    assert answer.status == "time_limit"
    assert "0.02" in answer.reason
    assert np.isfinite(answer.poses).all()
    assert answer.stats["seconds"] < 1.0
