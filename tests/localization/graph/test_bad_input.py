"""What is wrong with a graph is named, with a remedy; files with their line."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import cspace as cs
from cspace.errors import CspaceError, InputError, InputTypeError, LogError, UnknownNameError
from localization.graph.graphs import random_graph

V = "VERTEX_SE2 {} 0 0 0\n"
E = "EDGE_SE2 0 1 1 0 0 1 0 0 1 0 1\n"


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"edges": [(0, 0)], "motions": [[0, 0, 0]], "information": np.eye(3)}, "to itself"),
        ({"edges": [(0, 99)], "motions": [[0, 0, 0]], "information": np.eye(3)}, "99 at row 0"),
        ({"edges": [(0.5, 1)], "motions": [[0, 0, 0]]}, "whole numbers"),
        ({"information": -np.eye(3)}, "negative at row 0"),
        ({"information": np.diag([1, 1, 0])}, "singular at row 0"),
        ({"information": np.triu(np.ones((3, 3))) + 5 * np.eye(3)}, "not symmetric"),
        ({"poses": np.full((12, 3), np.nan)}, "finite"),
        ({"poses": np.zeros((12, 4))}, "x, y, θ"),
        ({"motions": np.zeros((2, 3))}, "one per edge"),
        ({"fixed": (77,)}, "outside of 0 to 11"),
        ({"ids": [1] * 12}, "twice"),
        ({"points": np.full((8, 2), np.nan)}, "NaN"),
        ({"points": np.full((8, 2), 90.0), "ranged": np.ones(8, bool)}, "radians"),
    ],
)
def test_faults_of_arrays_are_named(changes, message):
    graph = random_graph(np.random.default_rng(1), landmarks=2)
    with pytest.raises(CspaceError, match=message):
        replace(graph, **changes)


def test_parts_with_nothing_fixed_are_named():
    graph = cs.PoseGraph(
        np.zeros((4, 3)), [(0, 1), (2, 3)], np.zeros((2, 3)), np.eye(3), ids=[10, 11, 12, 13]
    )
    with pytest.raises(InputError, match=r"2 parts.*pose 12"):
        graph.optimize()
    assert replace(graph, fixed=(0, 2)).optimize()
    lonely = replace(graph, fixed=(0, 2), landmarks=np.zeros((1, 2)))
    with pytest.raises(InputError, match="landmark 14"):
        lonely.optimize()


def test_what_is_not_determined_is_named():
    graph = cs.PoseGraph(
        poses=np.zeros((2, 3)),
        edges=[(0, 1)],
        motions=[[1, 0, 0]],
        information=np.eye(3),
        landmarks=[[3.0, 4.0]],
        sightings=[(0, 0)],
        points=[[np.nan, 0.3]],
        ranged=[True],
        point_information=np.eye(2),
        landmark_ids=[77],
    )
    answer = graph.optimize(start="given")
    assert answer.status == "singular"
    assert "landmark 77" in answer.reason
    with pytest.raises(InputError, match="no covariances"):
        _ = answer.marginals


@pytest.mark.parametrize(
    ("keywords", "error", "message"),
    [
        ({"method": "gauss"}, UnknownNameError, "gauss_newton"),
        ({"start": "odometri"}, UnknownNameError, "odometry"),
        ({"robust": "dsc"}, UnknownNameError, "dcs"),
        ({"kernel": "hubert"}, UnknownNameError, "huber"),
        ({"robust": "dcs", "kernel": "huber"}, InputTypeError, "exclude"),
        ({"trusted": [1, 0]}, InputError, "bool"),
        ({"time_limit": -1}, InputError, "time_limit"),
        ({"max_iterations": 0}, InputError, "max_iterations"),
    ],
)
def test_faults_of_keywords_are_named(keywords, error, message):
    with pytest.raises(error, match=message):
        random_graph(np.random.default_rng(1)).optimize(**keywords)


@pytest.mark.parametrize(
    ("text", "line", "message"),
    [
        ("", None, "no lines"),
        ("hello 1 2\n", 1, "begins no pose graph"),
        (V.format(0) + "VERTEX_BLOB 1\n", 2, "no record 'VERTEX_BLOB'"),
        (V.format(0) + V.format(0), 2, "second time"),
        (V.format(0) + E, 2, "no vertex 1"),
        (V.format(0) + V.format(1) + E[:-4], 3, "cut"),
        (V.format(0) + "VERTEX_SE2 1 0 nan 0\n", 2, "finite"),
        (V.format(0) + "VERTEX_SE2 1 0 x 0\n", 2, "no number"),
        (V.format(0) + "VERTEX_SE2 -1 0 0 0\n", 2, "no id"),
        (V.format(0) + V.format(1) + "EDGE_SE2 1 1 1 0 0 1 0 0 1 0 1\n", 3, "itself"),
        (V.format(0) + V.format(1) + "EDGE_SE2 0 1 1 0 0 1 0 0 1 0 -1\n", 3, "negative"),
        (V.format(0) + V.format(1) + "EDGE_SE2 0 1 1 0 0 1 0 0 1 0 0\n", 3, "singular"),
        ("VERTEX_SE3:QUAT 0 0 0 0 0 0 0 0\n", 1, "quaternion is zero"),
        (V.format(0) + "FIX 9\n", 2, "FIX names vertex 9"),
        (V.format(0) + "VERTEX_SE3:QUAT 1 0 0 0 0 0 0 1\n", None, "one kind"),
    ],
)
def test_faults_of_files_are_named_with_their_line(tmp_path, text, line, message):
    path = tmp_path / "graph.g2o"
    path.write_text(text)
    with pytest.raises(LogError, match=message) as caught:
        cs.PoseGraph.read(path)
    assert caught.value.line == line
    assert str(path) in str(caught.value)


def test_a_graph_cannot_be_changed():
    graph = random_graph(np.random.default_rng(1))
    with pytest.raises(ValueError, match="read-only"):
        graph.poses[0, 0] = 1.0


@pytest.mark.parametrize("given", [{"width": 2.0}, {"width": 2.0, "robust": "gnc"}, {"trusted": [True] * 3}])
@pytest.mark.parametrize("start", [None, "given"])
def test_options_without_effect_are_refused(given, start):
    graph = cs.PoseGraph(np.zeros((3, 3)), [(0, 1), (1, 2), (0, 2)], np.zeros((3, 3)), np.eye(3))
    with pytest.raises(InputTypeError, match=next(iter(given))):
        graph.optimize(start=start, **given)
    assert graph.optimize(start="odometry", trusted=[True, True, False])
    assert graph.optimize(kernel="huber", width=2.0)
    assert graph.optimize(robust="dcs", width=2.0, trusted=[True, True, False])


@pytest.mark.parametrize("robust", [None, "dcs", "gnc", "best"])
@pytest.mark.parametrize("empty", [[], np.zeros((0, 3, 3)), np.eye(3)])
def test_a_pose_alone_is_a_graph(robust, empty):
    answer = cs.PoseGraph(poses=[[1, 2, 0.5]], edges=[], motions=[], information=empty).optimize(
        robust=robust
    )
    assert answer
    assert np.array_equal(answer.poses, [[1, 2, 0.5]])
