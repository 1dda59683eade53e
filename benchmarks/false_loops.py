"""Pose graphs with false loops, random and in agreeing groups: errors to the clean answer, and what was lost.

Usage: python benchmarks/false_loops.py [--seeds 3] [--shares 0.5 0.8] [--write]. Writes
benchmarks/results/false_loops.json. A false loop joins two random poses with the motion of a true one; groups
agree: they repeat one false place along ten to twenty poses. All start from the odometry. "walk" is a random
walk on streets with honest information.
"""

from __future__ import annotations

import argparse
import json
import time
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

import cspace as cs
from pose_graphs import read_arrays

RESULTS = Path(__file__).resolve().parent / "results"
GRAPHS = {"intel": "intel.g2o", "M3500": "manhattanOlson3500_g2o.g2o", "CSAIL": "CSAIL.g2o", "walk": ""}
APART = 30
"""Poses between the ends of a false loop, at least."""


def make_walk(poses: int = 1500, loops: int = 900) -> Any:
    """A walk of metre steps with right angles, and loops to places nearby."""
    rng = np.random.default_rng(5)
    turns = rng.choice([0, 0, 0, np.pi / 2, -np.pi / 2], poses - 1)
    truth = [np.eye(3)]
    for turn in turns:
        truth.append(truth[-1] @ cs.pose_2d(xytheta=[1.0, 0.0, turn]))
    T = np.array(truth)
    near = np.linalg.norm(T[:, None, :2, 2] - T[None, :, :2, 2], axis=2) < 1.5
    pairs = np.argwhere(np.triu(near, 21))
    pairs = pairs[rng.choice(len(pairs), loops, replace=False)]
    edges = np.concatenate([np.stack([np.arange(poses - 1), np.arange(1, poses)], axis=1), pairs])
    deviations = np.array([0.05, 0.05, 0.02])
    noise = cs.pose_2d(xytheta=rng.normal(0, deviations, (len(edges), 3)))
    motions = cs.to_xytheta(np.linalg.inv(T[edges[:, 0]]) @ T[edges[:, 1]] @ noise)
    return cs.PoseGraph(
        poses=np.zeros((poses, 3)), edges=edges, motions=motions, information=np.diag(deviations**-2.0)
    )


def add_false(graph: Any, clean: np.ndarray, share: float, grouped: bool, rng: np.random.Generator) -> Any:
    """The graph with false loops behind its edges, so many that they are that share of all loops."""
    loops = graph.motions[~graph.consecutive]
    wanted = round(len(loops) * share / (1 - share))
    truth, n = cs.pose_2d(xytheta=clean), len(graph.poses)
    edges: list[tuple[int, int]] = []
    motions: list[np.ndarray] = []
    while len(edges) < wanted:
        length = int(rng.integers(10, 21)) if grouped else 1
        i, j = np.sort(rng.integers(0, n - length, 2)).tolist()
        if j - i < APART:
            continue
        place = cs.pose_2d(xytheta=loops[rng.integers(len(loops))] + rng.normal(0, [0.1, 0.1, 0.05]))
        for k in range(length):
            first, second = (np.linalg.inv(truth[at]) @ truth[at + k] for at in (i, j))
            error = cs.pose_2d(xytheta=rng.normal(0, [0.01, 0.01, 0.005]))
            edges.append((i + k, j + k))
            motions.append(cs.to_xytheta(np.linalg.inv(first) @ place @ second @ error))
    information = np.median(graph.information[~graph.consecutive], axis=0)
    return replace(
        graph,
        edges=np.concatenate([graph.edges, edges[:wanted]]),
        motions=np.concatenate([graph.motions, motions[:wanted]]),
        information=np.concatenate([graph.information, np.broadcast_to(information, (wanted, 3, 3))]),
    )


def align_error(a: np.ndarray, b: np.ndarray) -> float:
    """RMSE [m] of positions after the best rigid alignment."""
    A, B = a[:, :2] - a[:, :2].mean(axis=0), b[:, :2] - b[:, :2].mean(axis=0)
    U, _, V = np.linalg.svd(A.T @ B)
    R = U @ np.diag([1.0, np.linalg.det(U @ V)]) @ V
    return float(np.sqrt(((B @ R.T - A) ** 2).sum(axis=1).mean()))


def measure(name: str, share: float, grouped: bool, seeds: int) -> dict[str, Any]:
    """The worst and the median of the seeds."""
    graph = read_arrays(GRAPHS[name]) if GRAPHS[name] else make_walk()
    clean, k, runs = graph.optimize().poses, len(graph.edges), []
    for seed in range(seeds):
        spoiled = add_false(graph, clean, share, grouped, np.random.default_rng(100 + seed))
        begin = time.process_time()
        answer = spoiled.optimize(robust="dcs")
        seconds = time.process_time() - begin
        rejected = np.array([loop.edge for loop in answer.rejected])
        true, false = int((~graph.consecutive).sum()), len(spoiled.edges) - k
        lost, kept = int((rejected < k).sum()), false - int((rejected >= k).sum())
        runs.append((align_error(clean, answer.poses), lost / true, kept, seconds))
    errors, lost_shares, kept_counts, times = zip(*runs, strict=True)
    return {
        "graph": name,
        "share": share,
        "grouped": grouped,
        "seeds": seeds,
        "median_m": float(np.median(errors)),
        "worst_m": max(errors),
        "lost": max(lost_shares),
        "kept": max(kept_counts),
        "seconds": float(np.median(times)),
    }


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seeds", type=int, default=3)
    parser.add_argument("--shares", type=float, nargs="+", default=[0.5, 0.8])
    parser.add_argument("--graphs", nargs="+", default=list(GRAPHS))
    parser.add_argument("--write", action="store_true")
    given = parser.parse_args()
    results = []
    for name in given.graphs:
        for share in given.shares:
            for grouped in (False, True):
                results.append(measure(name, share, grouped, given.seeds))
                print(json.dumps(results[-1]), flush=True)
    if given.write:
        (RESULTS / "false_loops.json").write_text(json.dumps(results, indent=1) + "\n")


if __name__ == "__main__":
    main()
