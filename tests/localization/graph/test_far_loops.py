"""False loops where true ones start out far from dead reckoning, with honest information."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

import cspace as cs


def test_loops_far_from_dead_reckoning_are_kept():
    rng = np.random.default_rng(61)
    n, deviations = 600, np.array([0.05, 0.05, 0.02])
    truth = [np.eye(3)]
    for turn in rng.choice([0, 0, 0, np.pi / 2, -np.pi / 2], n - 1):
        truth.append(truth[-1] @ cs.pose_2d(xytheta=[1.0, 0.0, turn]))
    T = np.array(truth)
    near = np.argwhere(np.triu(np.linalg.norm(T[:, None, :2, 2] - T[None, :, :2, 2], axis=2) < 1.5, 21))
    true = near[rng.choice(len(near), 300, replace=False)]
    chain = np.stack([np.arange(n - 1), np.arange(1, n)], axis=1)
    edges = np.concatenate([chain, true])
    noise = cs.pose_2d(xytheta=rng.normal(0, deviations, (len(edges), 3)))
    motions = cs.to_xytheta(np.linalg.inv(T[edges[:, 0]]) @ T[edges[:, 1]] @ noise)
    false = np.sort(rng.choice(n, (300, 2)), axis=1)
    false = false[false[:, 1] - false[:, 0] > 30]
    graph = cs.PoseGraph(
        poses=np.zeros((n, 3)),
        edges=np.concatenate([edges, false]),
        motions=np.concatenate([motions, rng.normal(0, [0.5, 0.5, 0.3], (len(false), 3))]),
        information=np.diag(deviations**-2.0),
    )
    rejected = {loop.edge for loop in graph.optimize(robust="dcs").rejected}
    assert len(rejected & set(range(len(edges)))) <= 3
    assert len(set(range(len(edges), len(graph.edges))) - rejected) <= 1


def make_street(rng: np.random.Generator, scale: float, *, groups: int) -> tuple[cs.PoseGraph, int]:
    """Two rounds of a square, each place seen again, and behind these edges groups of false loops that agree.

    The information of all is `scale` times the true one. Also the number of true edges.
    """
    n, deviations = 240, np.array([0.02, 0.02, 0.01])
    truth = [np.eye(3)]
    for k in range(n - 1):
        truth.append(truth[-1] @ cs.pose_2d(xytheta=[1.0, 0.0, np.pi / 2 if k % 30 == 29 else 0.0]))
    T = np.array(truth)
    chain = np.stack([np.arange(n - 1), np.arange(1, n)], axis=1)
    seen = np.stack([np.arange(0, 120), np.arange(120, 240)], axis=1)
    edges = np.concatenate([chain, seen])
    motions = np.linalg.inv(T[edges[:, 0]]) @ T[edges[:, 1]]
    motions = motions @ cs.pose_2d(xytheta=rng.normal(0, deviations, (len(edges), 3)))
    pairs, places = [], []
    for _ in range(groups):
        i = int(rng.integers(0, 95))
        j = i + 126  # six steps on, in the second round
        place = np.linalg.inv(T[i]) @ T[j] @ cs.pose_2d(xytheta=[0.9, -0.7, 0.25])
        for k in range(12):
            first, second = (np.linalg.inv(T[at]) @ T[at + k] for at in (i, j))
            pairs.append((i + k, j + k))
            places.append(np.linalg.inv(first) @ place @ second)
    graph = cs.PoseGraph(
        poses=cs.to_xytheta(T),
        edges=np.concatenate([edges, np.array(pairs, int).reshape(-1, 2)]),
        motions=cs.to_xytheta(np.concatenate([motions, np.array(places).reshape(-1, 3, 3)])),
        information=scale * np.diag(deviations**-2.0),
    )
    return graph, len(edges)


def test_groups_of_false_loops_near_the_truth_are_rejected_whatever_the_scale_of_the_information():
    for seed in range(4):
        for scale in (1.0, 0.02):
            graph, true = make_street(np.random.default_rng(seed), scale, groups=1)
            rejected = {loop.edge for loop in graph.optimize(robust="dcs", start="given").rejected}
            assert rejected >= set(range(true, len(graph.edges)))
            assert len(rejected & set(range(true))) <= 2


def test_true_loops_are_kept_where_there_are_no_false_ones():
    for seed in range(4):
        for scale in (1.0, 0.02):
            graph, _ = make_street(np.random.default_rng(seed), scale, groups=0)
            assert len(graph.optimize(robust="dcs", start="given").rejected) <= 1


def test_no_kept_loop_pulls_more_than_its_limit_and_no_rejected_one_fits():
    for seed in range(4):
        graph, _ = make_street(np.random.default_rng(seed), 0.02, groups=1)
        answer = graph.optimize(robust="dcs", start="given")
        limit = answer.rejected[0].limit
        rejected = np.array([loop.edge for loop in answer.rejected])
        used = np.ones(len(graph.edges), bool)
        used[rejected] = False

        def solve(mask: np.ndarray, graph: cs.PoseGraph = graph, start: np.ndarray = answer.poses) -> float:
            return part(graph, mask).with_poses(start).optimize(start="given").chi2

        best = solve(used)
        for k in np.flatnonzero(used & ~graph.consecutive)[::9]:
            assert best - solve(used & (np.arange(len(used)) != k)) <= 1.01 * limit
        for k in rejected[::5]:
            assert solve(used | (np.arange(len(used)) == k)) - best >= 0.99 * limit


def part(graph: cs.PoseGraph, mask: np.ndarray) -> cs.PoseGraph:
    return replace(
        graph, edges=graph.edges[mask], motions=graph.motions[mask], information=graph.information[mask]
    )
