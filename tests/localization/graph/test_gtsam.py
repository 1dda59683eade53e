"""χ² and marginals against gtsam."""

from __future__ import annotations

import numpy as np
import pytest

import cspace as cs
from data import shared_data
from localization.graph.graphs import random_graph

pytestmark = pytest.mark.oracle
gtsam = pytest.importorskip("gtsam")


def turn_order(W: np.ndarray) -> np.ndarray:
    """Rotations first, as gtsam has them in space."""
    order = [3, 4, 5, 0, 1, 2] if W.shape[-1] == 6 else [0, 1, 2]
    return np.asarray(W[..., order, :][..., order])


def to_gtsam(graph, poses):
    """The factors, with the first pose held, and the poses as values."""
    space = graph.is_spatial
    factors, values = gtsam.NonlinearFactorGraph(), gtsam.Values()
    make = (lambda T: gtsam.Pose3(T)) if space else (lambda row: gtsam.Pose2(*row))
    between = gtsam.BetweenFactorPose3 if space else gtsam.BetweenFactorPose2
    for (i, j), z, W in zip(graph.edges, graph.motions, graph.information, strict=True):
        noise = gtsam.noiseModel.Gaussian.Information(turn_order(W))
        factors.add(between(int(i), int(j), make(z), noise))
    equal = gtsam.NonlinearEqualityPose3 if space else gtsam.NonlinearEqualityPose2
    factors.add(equal(0, make(poses[0])))
    for k, row in enumerate(poses):
        values.insert(k, make(row))
    return factors, values


def check_graph(graph, tolerance):
    answer = graph.optimize()
    factors, values = to_gtsam(graph, answer.poses)
    parameters = gtsam.GaussNewtonParams()
    parameters.setRelativeErrorTol(1e-14)
    theirs = gtsam.GaussNewtonOptimizer(factors, values, parameters).optimize()
    assert answer.chi2 == pytest.approx(2 * factors.error(values), rel=1e-10, abs=1e-18)
    assert answer.chi2 == pytest.approx(2 * factors.error(theirs), rel=tolerance)
    return answer, factors, theirs


@pytest.mark.parametrize("spatial", [False, True], ids=["plane", "space"])
def test_random_graphs(spatial):
    rng = np.random.default_rng(14)
    for _ in range(5):
        # In the plane gtsam leaves the Jacobian of the logarithm out, which is the identity for small errors.
        graph = random_graph(rng, spatial=spatial, poses=20, noise=0.05 if spatial else 1e-8)
        answer, factors, theirs = check_graph(graph, 1e-8)
        marginals = gtsam.Marginals(factors, theirs)
        for k in range(1, 20):
            expected = turn_order(marginals.marginalCovariance(k))
            assert np.allclose(answer.marginals[k], expected, rtol=1e-5, atol=1e-7)


@pytest.mark.parametrize(
    "name", ["intel.g2o", "smallGrid3D.g2o", "manhattanOlson3500_g2o.g2o", "sphere2500.g2o"]
)
def test_public_graphs(name):
    graph = cs.PoseGraph.read(shared_data() / "localization/posegraph" / name)
    check_graph(graph, 1e-9)
