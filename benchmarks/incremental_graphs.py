"""Pose graphs that grow, edge by edge in the order of the file, beside gtsam's iSAM2.

Usage: python benchmarks/incremental_graphs.py [--rounds 3] [--write]. Writes
benchmarks/results/incremental_graphs.json. Processor time of the calls from Python, one thread; gtsam takes
the edges of each new pose in one update, and its estimate is computed after each. χ² is judged in plain
numpy.
"""

from __future__ import annotations

import argparse
import json
import time
from pathlib import Path
from typing import Any

import numpy as np

import cspace as cs
from pose_graphs import judge_chi2, read_arrays

RESULTS = Path(__file__).resolve().parent / "results"
GRAPHS = ("manhattanOlson3500_g2o.g2o", "intel.g2o")


def grow_ours(graph: Any) -> tuple[np.ndarray, list[float]]:
    """The poses at the end, and the seconds of each call."""
    grown, seconds = cs.IncrementalGraph(graph.poses[0], fixed=0), []
    rows = [*zip(graph.edges.tolist(), graph.motions, graph.information, strict=True)]
    for (i, j), z, W in rows:
        begin = time.process_time()
        grown.add(i, j, z, W)
        seconds.append(time.process_time() - begin)
    return grown.poses, seconds


def grow_gtsam(graph: Any) -> tuple[np.ndarray, list[float]]:
    """The same of iSAM2, one update per new pose."""
    import gtsam

    isam, seconds = gtsam.ISAM2(gtsam.ISAM2Params()), []
    factors, values = gtsam.NonlinearFactorGraph(), gtsam.Values()
    first = gtsam.Pose2(*graph.poses[0])
    factors.add(gtsam.NonlinearEqualityPose2(0, first))
    values.insert(0, first)
    known, waiting = {0}, sorted(range(len(graph.edges)), key=lambda k: int(graph.edges[k].max()))
    estimate = values
    for at, k in enumerate(waiting):
        i, j = graph.edges[k].tolist()
        noise = gtsam.noiseModel.Gaussian.Information(graph.information[k])
        z = gtsam.Pose2(*graph.motions[k])
        factors.add(gtsam.BetweenFactorPose2(i, j, z, noise))
        for new, old, step in ((j, i, z), (i, j, z.inverse())):
            if new not in known and old in known:
                before = values.atPose2(old) if values.exists(old) else estimate.atPose2(old)
                values.insert(new, before.compose(step))
                known.add(new)
        if at + 1 < len(waiting) and graph.edges[waiting[at + 1]].max() == max(i, j):
            continue
        begin = time.process_time()
        isam.update(factors, values)
        estimate = isam.calculateEstimate()
        seconds.append(time.process_time() - begin)
        factors, values = gtsam.NonlinearFactorGraph(), gtsam.Values()
    rows = [estimate.atPose2(k) for k in range(len(graph.poses))]
    return np.array([[row.x(), row.y(), row.theta()] for row in rows]), seconds


def measure(name: str, rounds: int) -> dict[str, Any]:
    """Per contender the least total of the rounds, its median, 99th percentile and slowest step, and χ²."""
    graph = read_arrays(name)
    found: dict[str, Any] = {"optimum": judge_chi2(name, graph.optimize().poses)}
    for contender, grow in (("cspace", grow_ours), ("isam2", grow_gtsam)):
        runs = [grow(graph) for _ in range(rounds)]
        poses, seconds = min(runs, key=lambda run: sum(run[1]))
        ms = 1e3 * np.array(seconds)
        found[contender] = {
            "steps": len(ms),
            "total_s": float(ms.sum() / 1e3),
            "median_ms": float(np.median(ms)),
            "p99_ms": float(np.percentile(ms, 99)),
            "slowest_ms": float(ms.max()),
            "chi2": judge_chi2(name, poses),
        }
    return found


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--write", action="store_true")
    given = parser.parse_args()
    results = {name: measure(name, given.rounds) for name in GRAPHS}
    print(json.dumps(results, indent=1))
    if given.write:
        (RESULTS / "incremental_graphs.json").write_text(json.dumps(results, indent=1) + "\n")


if __name__ == "__main__":
    main()
