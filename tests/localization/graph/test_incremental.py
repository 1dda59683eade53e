"""Incremental pose graphs: the batch optimum, any order, waiting measurements, covariances, bad input."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import cspace as cs
from cspace.errors import CspaceError, InputError
from data import shared_data
from localization.graph.graphs import random_graph

SPACES = pytest.mark.parametrize("spatial", [False, True], ids=["plane", "space"])


def feed(graph: Any, rows: Any = None, **options: Any) -> Any:
    """The edges of a graph one by one, in this order, then its sightings."""
    grown = cs.IncrementalGraph(graph.poses[0], fixed=0, **options)
    for k in range(len(graph.edges)) if rows is None else rows:
        i, j = graph.edges[k]
        grown.add(int(i), int(j), graph.motions[k], graph.information[k])
    for k in range(len(graph.sightings)):
        i, m = graph.sightings[k]
        grown.add_sighting(
            int(i), int(m), graph.points[k], graph.point_information[k], ranged=bool(graph.ranged[k])
        )
    return grown


def noisy_ranges(graph: Any) -> Any:
    """The graph with its points seen as ranges and bearings, some of them not measured."""
    points = np.stack([np.hypot(*graph.points.T), np.arctan2(graph.points[:, 1], graph.points[:, 0])], axis=1)
    points[1::4, 0], points[3::4, 1] = np.nan, np.nan
    return replace(graph, points=points, ranged=np.ones(len(points), bool))


@SPACES
@pytest.mark.parametrize("landmarks", [0, 3])
def test_batch_optimum(spatial, landmarks):
    rng = np.random.default_rng(31)
    for _ in range(4):
        graph = random_graph(rng, 25, spatial=spatial, landmarks=landmarks)
        grown = feed(graph)
        answer = grown.optimize()
        batch = graph.optimize(start="given")
        assert answer
        assert batch
        assert grown.chi2 == pytest.approx(batch.chi2, rel=1e-8)
        assert np.allclose(grown.poses, batch.poses, atol=1e-5)
        assert np.allclose(grown.landmarks, batch.landmarks, atol=1e-5)
        assert grown.ids.tolist() == list(range(25))
        assert grown.waiting == 0


@SPACES
def test_near_the_optimum_at_every_step(spatial):
    rng = np.random.default_rng(32)
    graph = random_graph(rng, 40, spatial=spatial, noise=0.02)
    order = np.argsort(graph.edges.max(axis=1), kind="stable")
    grown = cs.IncrementalGraph(graph.poses[0], fixed=0)
    for count, k in enumerate(order):
        i, j = graph.edges[k].tolist()
        grown.add(i, j, graph.motions[k], graph.information[k])
        if count % 10 == 9:
            best = grown.to_graph().optimize(start="given").chi2
            assert best * (1 - 1e-9) <= grown.chi2 <= best * 1.01 + 1e-6


@SPACES
def test_any_order(spatial):
    rng = np.random.default_rng(33)
    graph = random_graph(rng, 20, spatial=spatial)
    best = graph.optimize(start="given").chi2
    for _ in range(4):
        grown = feed(graph, rng.permutation(len(graph.edges)))
        assert grown.waiting == 0
        assert grown.optimize().chi2 == pytest.approx(best, rel=1e-8)


def test_many_at_once_are_one_step():
    rng = np.random.default_rng(34)
    graph = random_graph(rng, 20)
    grown = cs.IncrementalGraph(graph.poses[0], fixed=0)
    grown.add(graph.edges[:, 0], graph.edges[:, 1], graph.motions, graph.information)
    assert grown.stats["steps"] == 1
    assert grown.optimize().chi2 == pytest.approx(graph.optimize(start="given").chi2, rel=1e-8)


def test_ranges_and_bearings():
    rng = np.random.default_rng(35)
    graph = noisy_ranges(random_graph(rng, 25, landmarks=4))
    grown = feed(graph)
    assert grown.waiting == 0
    assert grown.optimize().chi2 == pytest.approx(graph.optimize(start="given").chi2, rel=1e-6)


def test_bearings_wait_until_they_cross():
    grown = cs.IncrementalGraph()
    grown.add(0, 1, [1.0, 0, 0], np.eye(3))
    grown.add_sighting(0, 7, [np.nan, np.pi / 4], np.eye(2), ranged=True)
    assert grown.waiting == 1
    assert len(grown.landmarks) == 0
    grown.add_sighting(1, 7, [np.nan, 0.75 * np.pi], np.eye(2), ranged=True)
    assert grown.waiting == 0
    assert np.allclose(grown.landmarks, [[0.5, 0.5]])


def test_parts_wait_until_they_are_joined():
    grown = cs.IncrementalGraph()
    grown.add(10, 11, [1.0, 0, 0], np.eye(3))
    grown.add(20, 21, [1.0, 0, 0], np.eye(3))
    grown.add_sighting(21, 0, [0.0, 1.0], np.eye(2))
    assert grown.waiting == 2
    assert grown.ids.tolist() == [10, 11]
    assert "2 waiting" in repr(grown)
    with pytest.raises(InputError, match="no pose 20"):
        grown.pose(20)
    grown.add(11, 20, [1.0, 0, 0], np.eye(3))
    assert grown.waiting == 0
    assert np.allclose(grown.poses[:, 0], [0, 1, 2, 3])
    assert np.allclose(grown.landmarks, [[3, 1]])
    assert np.allclose(grown.pose(21), [3, 0, 0])


@SPACES
def test_covariances_of_the_batch(spatial):
    rng = np.random.default_rng(36)
    graph = random_graph(rng, 15, spatial=spatial, landmarks=2)
    grown = feed(graph)
    grown.optimize()
    batch = graph.optimize(start="given")
    for i, j in [(0, 0), (3, 3), (14, 14), (2, 9), (9, 2), (0, 5)]:
        for frame in ("base", "map"):
            expected = batch.covariance(i, j, frame=frame)
            assert np.allclose(grown.covariance(i, j, frame=frame), expected, rtol=1e-4, atol=1e-7)
    for m in range(2):
        assert np.allclose(grown.landmark_covariance(m), batch.landmark_marginals[m], rtol=1e-4)


def test_covariance_of_a_pose_put_off():
    grown = cs.IncrementalGraph()
    for k in range(3):
        grown.add(k, k + 1, [1.0, 0, 0], np.eye(3))
    batch = grown.to_graph().optimize()
    assert np.allclose(grown.covariance(3), batch.covariance(3))


def test_other_pose_and_axes_change_nothing():
    rng = np.random.default_rng(37)
    graph = random_graph(rng, 20)
    here, there = feed(graph), cs.IncrementalGraph([5.0, -2.0, 1.0], fixed=4)
    for (i, j), z, W in zip(graph.edges.tolist(), graph.motions, graph.information, strict=True):
        there.add(i, j, z, W)
    assert here.optimize().chi2 == pytest.approx(there.optimize().chi2, rel=1e-8)
    assert np.allclose(there.pose(4), [5, -2, 1])
    shown = [np.linalg.inv(T[0]) @ T[9] for T in (cs.pose_2d(xytheta=g.poses) for g in (here, there))]
    assert np.allclose(*shown, atol=1e-5)


@pytest.mark.slow
def test_public_graph():
    graph = cs.PoseGraph.read(shared_data() / "localization/posegraph/manhattanOlson3500_g2o.g2o")
    grown = feed(graph)
    assert grown.chi2 == pytest.approx(146.078729, rel=2e-3)
    assert grown.optimize().chi2 == pytest.approx(146.078729, rel=1e-7)


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ((0, 0, [1, 0, 0], np.eye(3)), "joins pose 0 to itself"),
        ((0.5, 1, [1, 0, 0], np.eye(3)), "whole number"),
        (("a", 1, [1, 0, 0], np.eye(3)), "whole number"),
        (([0, 1], 1, [1, 0, 0], np.eye(3)), "as many"),
        ((0, 1, [1, 0], np.eye(3)), "z has shape"),
        ((0, 1, [1, 0, np.nan], np.eye(3)), "finite"),
        ((0, 1, np.ones((4, 4)), np.eye(6)), "z"),
        ((0, 1, [[1, 0, 0]] * 2, np.eye(3)), "2 relative poses for 1"),
        ((0, 1, [1, 0, 0], np.eye(2)), "information"),
        ((0, 1, [1, 0, 0], -np.eye(3)), "negative"),
        ((0, 1, [1, 0, 0], np.diag([1, 1, 0])), "singular"),
        ((0, 1, [1, 0, 0], np.eye(3) + np.eye(3, k=1)), "symmetric"),
        ((0, 1, np.eye(4), np.eye(6)), "of space"),
    ],
)
def test_bad_edges_change_nothing(arguments, words):
    grown = cs.IncrementalGraph()
    grown.add(0, 1, [1.0, 0, 0], np.eye(3))
    with pytest.raises(CspaceError, match=words):
        grown.add(*arguments)
    assert repr(grown) == "<IncrementalGraph 2 poses, 1 edge in the plane>"


def test_bad_sightings():
    grown = cs.IncrementalGraph()
    with pytest.raises(InputError, match="empty"):
        grown.to_graph()
    grown.add(0, 1, [1.0, 0, 0], np.eye(3))
    with pytest.raises(InputError, match="point has shape"):
        grown.add_sighting(0, 0, [1.0], np.eye(2))
    with pytest.raises(InputError, match="radians"):
        grown.add_sighting(0, 0, [1.0, 90.0], np.eye(2), ranged=True)
    with pytest.raises(InputError, match="NaN"):
        grown.add_sighting(0, 0, [np.nan, 1.0], np.eye(2))
    with pytest.raises(InputError, match="of space"):
        grown.add_sighting(0, 0, [1.0, 1.0, 1.0], np.eye(3))
    with pytest.raises(InputError, match="no landmark 0"):
        grown.landmark_covariance(0)
    with pytest.raises(InputError, match="relinearize"):
        cs.IncrementalGraph(relinearize=-1)
