"""False loops where true ones start out far from dead reckoning, with honest information."""

from __future__ import annotations

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
