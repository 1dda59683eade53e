"""Formats of pose graphs: what is written is read again, and known files have their known χ²."""

from __future__ import annotations

import gzip
from dataclasses import replace

import numpy as np
import pytest

import cspace as cs
from cspace.errors import InputError, LogError
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


@pytest.mark.slow
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


def write_space(path, graph, information, extra=""):
    """A g2o file of a graph in space, with the information as given, positive definite or not."""
    graph.to_g2o(path)
    upper, k, lines = np.triu_indices(6), 0, []
    for line in path.read_text().splitlines():
        words = line.split()
        if words[0] == "EDGE_SE3:QUAT":
            line = " ".join([*words[:10], *(f"{x:.17g}" for x in information[k][upper])])
            k += 1
        lines.append(line)
    path.write_text(extra + "\n".join(lines) + "\n")


def test_blocks_that_gtsam_transposed_are_turned_back(tmp_path):
    rng = np.random.default_rng(41)
    graph = random_graph(rng, spatial=True)
    J = rng.normal(size=(len(graph.edges), 6, 6))
    W = J @ np.swapaxes(J, 1, 2) + 0.05 * np.eye(6)
    turned = W.copy()
    turned[:, :3, 3:], turned[:, 3:, :3] = W[:, 3:, :3], W[:, :3, 3:]
    assert np.linalg.eigvalsh(turned)[:, 0].min() < 0
    write_space(tmp_path / "a.g2o", graph, turned)
    read = cs.PoseGraph.read(tmp_path / "a.g2o")
    assert np.allclose(read.information, W)
    assert "transposed" in read.notes[0]
    write_space(tmp_path / "b.g2o", graph, W)
    assert not cs.PoseGraph.read(tmp_path / "b.g2o").notes
    turned[0] = -np.eye(6)  # no way of reading makes this positive
    write_space(tmp_path / "c.g2o", graph, turned)
    with pytest.raises(LogError, match="positive"):
        cs.PoseGraph.read(tmp_path / "c.g2o")


@pytest.mark.parametrize("largest", [400.0, 0.01])
def test_matrices_of_graph_files_may_be_information(tmp_path, largest):
    """Variances of angles cannot exceed those of the uniform distribution on the circle."""
    path = tmp_path / "a.graph"
    path.write_text(f"EDGE2 0 1 1 0 0.1 100 0 100 {largest} 0 0\nEDGE2 1 2 1 0 0.1 100 0 100 {largest} 0 0\n")
    graph = cs.PoseGraph.read(path)
    angles = graph.information[:, 2, 2]
    assert np.allclose(angles, largest if largest > 1 else 1 / largest)
    assert bool(graph.notes) == (largest > 1)
    insisted = cs.PoseGraph.read(path, format="graph").information[:, 2, 2]
    assert np.allclose(insisted, 1 / largest)


def test_sensors_off_the_base_see_the_same_landmarks(tmp_path):
    rng = np.random.default_rng(42)
    graph = random_graph(rng, spatial=True, landmarks=3)
    T = cs.exp_se3(rng.uniform(-1, 1, 6))
    R, t = T[:3, :3], T[:3, 3]
    seen = replace(
        graph,
        points=(graph.points - t) @ R,
        point_information=R.T @ graph.point_information @ R,
    )
    seen.to_g2o(tmp_path / "a.g2o")
    mount = " ".join(f"{x:.17g}" for x in [*t, *cs.to_xyzw(R)])
    text = (tmp_path / "a.g2o").read_text()
    moved = text.replace("PARAMS_SE3OFFSET 0 0 0 0 0 0 0 1", f"PARAMS_SE3OFFSET 0 {mount}")
    (tmp_path / "b.g2o").write_text(moved)
    same(graph, cs.PoseGraph.read(tmp_path / "b.g2o"))
    (tmp_path / "c.g2o").write_text(moved.replace("PARAMS_SE3OFFSET 0 ", "PARAMS_SE3OFFSET 7 "))
    with pytest.raises(LogError, match="no sensor 0"):
        cs.PoseGraph.read(tmp_path / "c.g2o")


def test_what_relates_nothing_is_left_out_and_noted(tmp_path):
    path = tmp_path / "a.g2o"
    path.write_text(
        "# two poses\nPARAMS_CAMERACALIB 0 1 2 3\nVERTEX_SE2 0 0 0 0\nDATA_FEATURE_POINTXY 0 2 1 1 1 0 1\n"
        "VERTEX_SE2 1 1 0 0\nLASER_ROBOT_DATA a b c\n\nEDGE_SE2 0 1 1 0 0 1 0 0 1 0 1\n"
        "EDGE_SE2 0 1 1.2 0 0 1 0 0 1 0 1\n"
    )
    graph = cs.PoseGraph.read(path)
    assert len(graph.notes) == 3
    assert all("1 record" in note for note in graph.notes)
    assert np.allclose(graph.optimize().poses[1], [1.1, 0, 0])  # edges may repeat


def test_toro_has_bearings_with_ranges_and_edges_without_a_matrix(tmp_path):
    path = tmp_path / "a.graph"
    path.write_text("VERTEX2 0 0 0 0\nVERTEX2 1 1 0 0\nEDGE2 0 1 1 0 0\nBR 0 9 0.5 2 0.1 0.2\nEQUIV 0 1\n")
    graph = cs.PoseGraph.read(path)
    assert graph.ranged[0]
    assert np.allclose(graph.points[0], [2, 0.5])
    assert np.allclose(graph.point_information[0], np.diag([25, 100]))
    assert np.allclose(graph.information[0], np.eye(3))
    assert len(graph.notes) == 2
    assert np.allclose(graph.optimize().landmarks[0], 2 * np.array([np.cos(0.5), np.sin(0.5)]))
    path.write_text("EDGE3 0 1 1 0 0 0 0 0\n")
    assert np.allclose(cs.PoseGraph.read(path).information[0], np.eye(6))


def test_a_start_with_much_noise_converges():
    graph = cs.PoseGraph.read(shared_data() / "localization/posegraph/manhattanOlson3500_g2o.g2o")
    noise = np.random.default_rng(6).normal(0, [0, 0, 0.3], graph.motions.shape)
    noisy = replace(graph, motions=graph.motions + noise * graph.consecutive[:, None])
    answer = noisy.optimize()
    assert answer, answer.reason
    assert answer.stats["iterations"] <= 20
    assert answer.chi2 == pytest.approx(noisy.with_poses(answer.poses).optimize(start="given").chi2, rel=1e-9)
