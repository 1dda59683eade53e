"""Certificates of the global optimum: for optima, for no other minima, and with the reason where there is none."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import cspace as cs
from data import shared_data
from localization.graph.graphs import matrix, move, numbers, random_graph

SPACES = pytest.mark.parametrize("spatial", [False, True], ids=["plane", "space"])


def make_isotropic(graph: Any, rng: np.random.Generator) -> Any:
    """The graph with information that is one number for positions and one for angles, other for each edge."""
    d = graph.dimension
    size = graph.information.shape[1]
    scales = rng.uniform(20, 60, (len(graph.edges), 2))
    weights = np.repeat(scales, [d, size - d], axis=1)
    return replace(
        graph,
        information=weights[:, :, None] * np.eye(size),
        point_information=np.eye(d) * rng.uniform(20, 60, (len(graph.sightings), 1, 1)),
    )


def ring(spatial: bool, poses: int = 12) -> Any:
    """A closed ring of equal turns: winding it once more or less is another minimum of χ²."""
    size = 6 if spatial else 3
    step = np.zeros(size)
    step[0], step[-1] = 1.0, 2 * np.pi / poses
    z = move(np.eye(4 if spatial else 3), step)
    start = [np.eye(len(z))]
    for _ in range(poses - 1):
        start.append(start[-1] @ z)
    return cs.PoseGraph(
        poses=np.array([numbers(X) for X in start]),
        edges=[(k, (k + 1) % poses) for k in range(poses)],
        motions=np.array([numbers(z)] * poses),
        information=np.eye(size),
    )


@SPACES
@pytest.mark.parametrize("landmarks", [0, 3])
def test_optima_are_certified(spatial, landmarks):
    rng = np.random.default_rng(51)
    for _ in range(5):
        graph = make_isotropic(random_graph(rng, 20, spatial=spatial, landmarks=landmarks), rng)
        answer = graph.optimize()
        certificate = answer.certificate()
        assert certificate and certificate.certified, certificate.reason
        assert certificate.bound <= answer.chi2 * (1 + 1e-9)
        assert certificate.gap <= 0.05 * answer.chi2


@SPACES
def test_other_minima_are_not(spatial):
    graph = ring(spatial)
    n = len(graph.poses)
    # Twice around instead of once: each turn is too large by the same angle.
    turn = np.zeros(6 if spatial else 3)
    turn[-1] = 2 * np.pi / n
    wrong = [matrix(graph.poses[0])]
    for z in graph.motions[:-1]:
        wrong.append(move(wrong[-1] @ matrix(z), turn))
    wrong = graph.with_poses(np.array([numbers(X) for X in wrong])).optimize(
        start="given", method="levenberg_marquardt"
    )
    assert graph.optimize().certificate()
    assert wrong.chi2 > 1.0
    certificate = wrong.certificate()
    assert not certificate
    assert "not certified" in certificate.reason


def test_bound_is_below_all_states():
    rng = np.random.default_rng(52)
    graph = make_isotropic(random_graph(rng, 10, noise=0.2), rng)
    certificate = graph.optimize().certificate()
    assert certificate
    for _ in range(20):
        start = graph.with_poses(graph.poses + rng.normal(0, 2.0, graph.poses.shape))
        for answer in (start.optimize(start="given"), start.optimize(start="given", max_iterations=1)):
            assert answer.chi2 >= certificate.bound * (1 - 1e-9)


@pytest.mark.parametrize("name", ["manhattanOlson3500_g2o.g2o", "smallGrid3D.g2o", "input_INTEL.g2o"])
def test_public_graphs(name):
    graph = cs.PoseGraph.read(shared_data() / "localization/posegraph" / name)
    answer = graph.optimize()
    certificate = answer.certificate()
    if "not isotropic" in certificate.reason:
        d = graph.dimension
        W = np.repeat(graph.information[:, [0, -1], [0, -1]], [d, len(graph.information[0]) - d], axis=1)
        answer = replace(graph, information=W[:, :, None] * np.eye(W.shape[1])).optimize()
        certificate = answer.certificate()
    assert certificate, certificate.reason
    assert certificate.gap <= 0.02 * answer.chi2


def test_reasons():
    rng = np.random.default_rng(53)
    graph = random_graph(rng, 10)
    certificate = graph.optimize().certificate()
    assert not certificate and "information of edge 0 is not isotropic" in certificate.reason
    graph = make_isotropic(graph, rng)
    assert "residual" in graph.optimize(residual="g2o").certificate().reason
    assert "kernel" in graph.optimize(kernel="huber").certificate().reason
    assert "one pose fixed" in replace(graph, fixed=[0, 3]).optimize().certificate().reason
    seen = make_isotropic(random_graph(rng, 10, landmarks=2), rng)
    points = np.stack([np.hypot(*seen.points.T), np.arctan2(seen.points[:, 1], seen.points[:, 0])], axis=1)
    ranged = replace(seen, points=points, ranged=np.ones(len(points), bool))
    assert "sighting 0" in ranged.optimize().certificate().reason
