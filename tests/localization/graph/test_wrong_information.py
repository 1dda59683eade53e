"""Robust methods where the information of all measurements is too large by the same factor."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import cspace as cs
from localization.graph.graphs import log, move, numbers

SHAPES = ("streets", "circle", "sphere", "towers")


def walk(shape: str, n: int, rng: np.random.Generator) -> np.ndarray:
    """Matrices of poses along a walk that comes back to its places."""
    if shape in ("streets", "towers"):
        size = 3 if shape == "streets" else 6
        found = [np.eye(size // 3 + 2)]
        for _ in range(n - 1):
            step = np.zeros(size)
            step[0] = 1.0
            turn = np.zeros(size)
            turn[rng.integers(size // 2 if size == 6 else 2, size)] = rng.choice(
                [0, 0, 0, np.pi / 2, -np.pi / 2]
            )
            turn[: size // 2 if size == 6 else 2] = 0.0
            found.append(move(move(found[-1], step), turn))
        return np.array(found)
    if shape == "circle":
        step = np.array([0.5, 0.0, 6 * np.pi / n])
        found = [np.eye(3)]
        for _ in range(n - 1):
            found.append(move(found[-1], step))
        return np.array(found)
    down, around = np.pi * np.linspace(0.05, 0.95, n), 20 * np.pi * np.arange(n) / n
    z = np.stack([np.sin(down) * np.cos(around), np.sin(down) * np.sin(around), np.cos(down)], axis=1)
    y = np.stack([-np.sin(around), np.cos(around), np.zeros(n)], axis=1)
    T = np.tile(np.eye(4), (n, 1, 1))
    T[:, :3, :3] = np.stack([np.cross(y, z), y, z], axis=2)
    T[:, :3, 3] = 5 * z
    return T


def make_graph(shape: str, factor: float, share: float, rng: np.random.Generator) -> tuple[cs.PoseGraph, int]:
    """A walk with loops, of which a share is false; the information is so many times the true one.

    Also the number of true edges, which come first.
    """
    n, loops = 200, 120
    T = walk(shape, n, rng)
    d = T.shape[1] - 1
    size = 3 if d == 2 else 6
    deviations = np.r_[np.full(d, 0.04), np.full(size - d, 0.02)]
    away = np.linalg.norm(T[:, None, :d, d] - T[None, :, :d, d], axis=2)
    near = np.argwhere(np.triu(away < 2.5, 10))
    seen = near[rng.choice(len(near), min(loops, len(near)), replace=False)]
    pairs = np.concatenate([np.stack([np.arange(n - 1), np.arange(1, n)], axis=1), seen])
    motions = [
        move(np.linalg.inv(T[i]) @ T[j], deviations * rng.normal(size=size)) for i, j in pairs.tolist()
    ]
    wrong = []
    while len(wrong) < round(share / (1 - share) * len(seen)):
        i, j = np.sort(rng.integers(0, n, 2)).tolist()
        place = move(np.eye(d + 1), rng.normal(size=size))
        if j - i > 10 and np.linalg.norm(log(np.linalg.inv(place) @ np.linalg.inv(T[i]) @ T[j])) > 1.5:
            wrong.append((i, j))
            motions.append(place)
    return cs.PoseGraph(
        poses=np.array([numbers(np.eye(d + 1))] * n),
        edges=np.concatenate([pairs, np.array(wrong, int).reshape(-1, 2)]),
        motions=np.array([numbers(Z) for Z in motions]),
        information=factor * np.diag(deviations**-2.0),
    ), len(pairs)


def rejected(graph: cs.PoseGraph, robust: str) -> set[int]:
    return {loop.edge for loop in graph.optimize(robust=robust).rejected}


def in_millimetres(graph: cs.PoseGraph) -> cs.PoseGraph:
    """The same graph, with lengths in mm."""
    d, size = graph.dimension, graph.information.shape[1]
    units = np.r_[np.full(d, 1e-3), np.ones(size - d)]
    poses, motions = graph.poses.copy(), graph.motions.copy()
    for array in (poses, motions):
        (array[:, :3, 3] if graph.is_spatial else array[:, :2])[...] *= 1e3
    return replace(
        graph, poses=poses, motions=motions, information=units[:, None] * graph.information * units
    )


@pytest.mark.slow
@pytest.mark.parametrize("share", [0.0, 0.5])
@pytest.mark.parametrize("factor", [1.0, 10.0, 100.0])
@pytest.mark.parametrize("shape", SHAPES)
def test_true_loops_stay_and_false_ones_go_whatever_the_factor(shape, factor, share):
    for seed in range(3):
        graph, true = make_graph(shape, factor, share, np.random.default_rng([seed, SHAPES.index(shape)]))
        answer = graph.optimize(robust="dcs")
        gone = {loop.edge for loop in answer.rejected}
        assert answer
        assert len(gone & set(range(true))) <= 2
        assert gone >= set(range(true, len(graph.edges)))
        assert 0.5 * factor < answer.chi2 / answer.dof < 1.5 * factor


@pytest.mark.slow
@pytest.mark.parametrize("factor", [1.0, 30.0])
@pytest.mark.parametrize("shape", SHAPES)
def test_units_change_no_decision(shape, factor):
    graph, _ = make_graph(shape, factor, 0.4, np.random.default_rng(7))
    assert len(rejected(graph, "dcs") ^ rejected(in_millimetres(graph), "dcs")) <= 1


@pytest.mark.parametrize("robust", ["gnc", "best"])
def test_other_robust_methods_know_the_factor_too(robust):
    graph, true = make_graph("circle", 50.0, 0.3, np.random.default_rng(3))
    gone = rejected(graph, robust)
    assert gone >= set(range(true, len(graph.edges)))
    assert len(gone & set(range(true))) <= 2


@pytest.mark.slow
@pytest.mark.parametrize("shape", SHAPES)
def test_false_loops_alone_are_all_rejected(shape):
    """Other information does not explain them; two or three agree by chance, or with what odometry errs."""
    for seed in range(3):
        graph, true = make_graph(shape, 1.0, 0.5, np.random.default_rng([seed, 9]))
        used = np.r_[np.flatnonzero(graph.consecutive), np.arange(true, len(graph.edges))]
        false = replace(
            graph, edges=graph.edges[used], motions=graph.motions[used], information=graph.information[used]
        )
        kept = set(np.flatnonzero(~false.consecutive).tolist()) - rejected(false, "dcs")
        assert len(kept) <= 3


@pytest.mark.parametrize("robust", ["dcs", "gnc", "best"])
@pytest.mark.parametrize("factor", [1.0, 100.0])
def test_false_sightings_go_and_landmarks_are_found(robust, factor):
    """Also where the first sighting of a landmark is false, from which dead reckoning had placed it."""
    for seed in range(4):
        rng = np.random.default_rng([seed, 11])
        n, step = 60, np.array([0.5, 0.0, 0.2])
        T = np.array([cs.exp_se2(k * step) for k in range(n)])
        places = rng.uniform(-3, 8, (6, 2))
        seen = np.array([(k, m) for k in range(n) for m in range(6)])
        points = np.einsum("kji,kj->ki", T[seen[:, 0], :2, :2], places[seen[:, 1]] - T[seen[:, 0], :2, 2])
        points += rng.normal(0, 0.02, points.shape)
        false = np.unique(np.r_[rng.choice(len(seen), 50, replace=False), 2])
        points[false] += rng.choice([-1, 1], (len(false), 2)) * rng.uniform(1, 4, (len(false), 2))
        noise = cs.exp_se2(rng.normal(0, 0.01, (n - 1, 3)))
        answer = cs.PoseGraph(
            poses=np.zeros((n, 3)),
            edges=np.stack([np.arange(n - 1), np.arange(1, n)], axis=1),
            motions=cs.to_xytheta(cs.exp_se2(step) @ noise),
            information=factor * 1e4 * np.eye(3),
            landmarks=np.zeros((6, 2)),
            sightings=seen,
            points=points,
            point_information=factor * np.eye(2) / 0.02**2,
        ).optimize(robust=robust)
        gone = set(answer.rejected_sightings.tolist())
        assert answer
        assert gone >= set(false.tolist())
        assert len(gone - set(false.tolist())) <= 3
        assert np.abs(answer.landmarks - places).max() < 0.1
