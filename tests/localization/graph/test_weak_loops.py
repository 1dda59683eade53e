"""Loops into parts of a graph that nothing else measures well, while other loops have heavy tails."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import cspace as cs

SCALE = 0.02
"""Of the information, in the true one."""


def make_graph(rng: np.random.Generator) -> cs.PoseGraph:
    """Two rounds of a square, where one loop in twelve errs four times as much; then a walk without any."""
    n, seen, deviations = 280, 120, np.array([0.02, 0.02, 0.01])
    truth = [np.eye(3)]
    for k in range(n - 1):
        truth.append(truth[-1] @ cs.pose_2d(xytheta=[1.0, 0.0, np.pi / 2 if k % 30 == 29 else 0.0]))
    T = np.array(truth)
    chain = np.stack([np.arange(n - 1), np.arange(1, n)], axis=1)
    loops = np.stack([np.arange(seen), np.arange(seen, 2 * seen)], axis=1)
    edges = np.concatenate([chain, loops])
    noise = rng.normal(0, deviations, (len(edges), 3))
    noise[n - 1 :: 12] *= 4.0
    motions = np.linalg.inv(T[edges[:, 0]]) @ T[edges[:, 1]] @ cs.pose_2d(xytheta=noise)
    return cs.PoseGraph(
        poses=cs.to_xytheta(T),
        edges=edges,
        motions=cs.to_xytheta(motions),
        information=SCALE * np.diag(deviations**-2.0),
    )


@pytest.mark.parametrize("seed", range(12))
def test_the_end_of_a_walk_follows_loops_within_its_covariance_only(seed):
    rng = np.random.default_rng(70 + seed)
    graph = make_graph(rng)
    clean = graph.optimize(start="given")
    last = len(graph.poses) - 1
    scale = clean.chi2 / graph.dof
    root = np.linalg.cholesky(scale * (clean.covariance(last) + np.linalg.inv(graph.information[0])))
    axis = rng.normal(size=3)
    axis /= np.linalg.norm(axis)
    for sigma, is_kept in ((1.5, True), (7.0, False)):
        place = cs.pose_2d(xytheta=clean.poses[last]) @ cs.exp_se2(sigma * root @ axis)
        first = np.linalg.inv(cs.pose_2d(xytheta=clean.poses[0]))
        more = replace(
            graph,
            edges=np.concatenate([graph.edges, [(0, last)]]),
            motions=np.concatenate([graph.motions, [cs.to_xytheta(first @ place)]]),
            information=graph.information[0],
        )
        answer = more.optimize(robust="dcs", start="given")
        rejected = {loop.edge for loop in answer.rejected}
        assert (len(graph.edges) not in rejected) == is_kept
        assert len(rejected - {len(graph.edges)}) <= 4
