"""Formats of pose graphs: what is written is read again, and known files have their known χ²."""

from __future__ import annotations

import gzip
from dataclasses import replace

import numpy as np
import pytest

import cspace as cs
from cspace.errors import InputError
from data import shared_data
from localization.graph.graphs import random_graph


def same(a, b):
    names = ("poses", "edges", "motions", "information", "landmarks", "sightings", "points", "fixed", "ids")
    for name in (*names, "ranged", "point_information", "landmark_ids"):
        assert np.allclose(getattr(a, name), getattr(b, name), atol=1e-12, equal_nan=True), name


@pytest.mark.parametrize("spatial", [False, True], ids=["plane", "space"])
def test_g2o_is_read_as_written(tmp_path, spatial):
    graph = random_graph(np.random.default_rng(2), spatial=spatial, landmarks=3)
    graph = replace(
        graph,
        fixed=(0, 4),
        fixed_landmarks=(1,),
        ids=np.arange(12) * 7 + 5,
        landmark_ids=(2**62, 2**62 + 9, 3),
    )
    order = np.argsort(graph.landmark_ids)  # a file is read in the order of its ids
    graph.to_g2o(tmp_path / "a.g2o")
    back = cs.PoseGraph.from_g2o(tmp_path / "a.g2o")
    assert np.array_equal(back.landmark_ids, graph.landmark_ids[order])
    back.to_g2o(tmp_path / "b.g2o")
    same(back, cs.PoseGraph.read(tmp_path / "b.g2o"))
    assert back.optimize().chi2 == pytest.approx(graph.optimize().chi2, rel=1e-9)


def test_bearings_are_written_and_ranges_refused(tmp_path):
    graph = random_graph(np.random.default_rng(3), landmarks=2)
    bearings = np.stack([np.full(8, np.nan), np.arctan2(graph.points[:, 1], graph.points[:, 0])], axis=1)
    seen = replace(graph, points=bearings, ranged=np.ones(8, bool), point_information=np.diag([1.0, 25.0]))
    seen.to_g2o(tmp_path / "a.g2o")
    same(seen, cs.PoseGraph.read(tmp_path / "a.g2o"))
    with pytest.raises(InputError, match="is a range"):
        replace(seen, points=np.abs(graph.points)).to_g2o(tmp_path / "b.g2o")
    with pytest.raises(InputError, match="names a pose and a landmark"):
        replace(graph, landmark_ids=(0, 99)).to_g2o(tmp_path / "b.g2o")
    assert not (tmp_path / "b.g2o").exists()


def test_toro_and_graph_have_their_own_order_and_inverse(tmp_path):
    W = np.array([[4.0, 0.5, 0.2], [0.5, 3.0, 0.1], [0.2, 0.1, 2.0]])
    for name, M in (("a.toro", W), ("a.graph", np.linalg.inv(W))):
        numbers = [M[0, 0], M[0, 1], M[1, 1], M[2, 2], M[0, 2], M[1, 2]]
        path = tmp_path / name
        path.write_text(
            "VERTEX2 0 0 0 0\nVERTEX2 1 1 0 0\nEDGE2 0 1 1 0 0.1 "
            + " ".join(f"{x:.17g}" for x in numbers)
            + "\n"
        )
        assert np.allclose(cs.PoseGraph.read(path).information[0], W)


def test_edges_without_vertices_and_compressed_files(tmp_path):
    path = tmp_path / "a.g2o.gz"
    path.write_bytes(gzip.compress(b"EDGE_SE2 3 9 1 0 0.5 1 0 0 1 0 1\n"))
    graph = cs.PoseGraph.read(path)
    assert list(graph.ids) == [3, 9]
    assert not graph.start_given
    assert np.allclose(graph.optimize().poses[1], [1, 0, 0.5])
    with pytest.raises(InputError, match="no poses"):
        graph.optimize(start="given")


KNOWN = {
    "manhattanOlson3500_g2o.g2o": 146.078729,
    "intel.g2o": 45.004233,
    "input_INTEL.g2o": 215.8381,
    "sphere2500.g2o": 1351.401930,
}


@pytest.mark.parametrize("name", KNOWN)
def test_public_graphs_reach_their_known_chi2(name):
    answer = cs.PoseGraph.read(shared_data() / "localization/posegraph" / name).optimize()
    assert answer, answer.reason
    assert answer.chi2 == pytest.approx(KNOWN[name], rel=1e-6)


def test_killian_is_zipped_and_has_scans():
    graph = cs.PoseGraph.read(shared_data() / "localization/posegraph/killian.g2o.zip")
    assert len(graph.poses) == 3873
    assert "ROBOTLASER1" in graph.notes[0]
    assert graph.optimize()


def test_angles_of_edge3_are_about_fixed_axes():
    """The file has edges without noise: composing them closes all loops."""
    graph = cs.PoseGraph.read(shared_data() / "localization/posegraph/sphere2500_groundtruth.txt")
    assert graph.optimize().chi2 < 1e-6


def test_victoria_park_converges_from_dead_reckoning():
    graph = cs.PoseGraph.read(shared_data() / "localization/victoria/victoria_park.txt")
    answer = graph.optimize()
    assert answer.chi2 == pytest.approx(6184.12, abs=0.01)
    assert answer.chi2 / answer.dof == pytest.approx(0.886, abs=1e-3)


@pytest.mark.parametrize("name", ["intel.g2o", "manhattanOlson3500_g2o.g2o"])
def test_half_of_the_loops_may_be_false(name):
    graph = cs.PoseGraph.read(shared_data() / "localization/posegraph" / name)
    truth = graph.optimize().poses
    loops = np.flatnonzero(~graph.consecutive)
    rng = np.random.default_rng(3)
    ends = rng.integers(0, len(truth), (3 * len(loops), 2))
    ends = ends[np.abs(ends[:, 0] - ends[:, 1]) > 1][: len(loops)]
    motions = np.concatenate(
        [rng.normal(size=(len(ends), 2)), rng.uniform(-np.pi, np.pi, (len(ends), 1))], axis=1
    )
    usual = np.median(graph.information[loops], axis=0)
    wrong = replace(
        graph,
        edges=np.concatenate([graph.edges, ends]),
        motions=np.concatenate([graph.motions, motions]),
        information=np.concatenate([graph.information, np.repeat(usual[None], len(ends), axis=0)]),
    )
    answer = wrong.optimize(robust="dcs")
    rejected = np.array([each.edge for each in answer.rejected])
    assert (rejected < len(graph.edges)).sum() <= 0.01 * len(loops)
    assert np.sqrt(((answer.poses - truth)[:, :2] ** 2).sum(axis=1).mean()) < 0.05
