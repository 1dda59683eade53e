"""Pose graphs: time and χ² beside gtsam, from arrays in memory.

Usage: python benchmarks/pose_graphs.py [--rounds 5]. Writes benchmarks/results/pose_graphs.json.

Each contender runs in a process of its own, in turn, on one thread. Times are processor time: ours of the
whole call (start, order and all steps), theirs of the optimizer alone, without making its factors. Theirs
is the faster of Gauss-Newton and Levenberg-Marquardt that reaches the least χ² within 1e-6; both begin at
the poses of the file. χ² is computed again here, in plain numpy, by no code of either.
"""

from __future__ import annotations

import argparse
import importlib.metadata
import json
import os
import platform
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

import numpy as np

ROOT = Path(__file__).resolve().parents[1]
DATA = Path(os.environ.get("CSPACE_DATA") or ROOT.parent / "shared/data") / "localization/posegraph"
GRAPHS = (
    "manhattanOlson3500_g2o.g2o",
    "intel.g2o",
    "input_INTEL.g2o",
    "parking-garage.g2o",
    "sphere2500.g2o",
)
METHODS = ("cspace_given", "cspace_rotations", "gtsam_gauss_newton", "gtsam_levenberg_marquardt")
SAME = 1e-6
"""Relative difference up to which two values of χ² are the same."""


def read_arrays(name: str) -> Any:
    """The graph as the library reads it: both contenders get its arrays."""
    import cspace as cs

    return cs.PoseGraph.read(DATA / name)


def time_cspace(name: str, start: str) -> tuple[float, np.ndarray]:
    """Processor time of the optimization, and the poses."""
    graph = read_arrays(name)
    graph.optimize(start=start)  # warm
    begin = time.process_time()
    answer = graph.optimize(start=start)
    return time.process_time() - begin, answer.poses


def time_gtsam(name: str, method: str) -> tuple[float, np.ndarray]:
    """The same of gtsam; it may leave the poses worse than they were."""
    import gtsam

    graph = read_arrays(name)
    order = [3, 4, 5, 0, 1, 2] if graph.is_spatial else [0, 1, 2]
    make = gtsam.Pose3 if graph.is_spatial else (lambda row: gtsam.Pose2(*row))
    between = gtsam.BetweenFactorPose3 if graph.is_spatial else gtsam.BetweenFactorPose2
    equal = gtsam.NonlinearEqualityPose3 if graph.is_spatial else gtsam.NonlinearEqualityPose2
    factors, values = gtsam.NonlinearFactorGraph(), gtsam.Values()
    for (i, j), z, W in zip(graph.edges.tolist(), graph.motions, graph.information, strict=True):
        factors.add(between(i, j, make(z), gtsam.noiseModel.Gaussian.Information(W[np.ix_(order, order)])))
    factors.add(equal(0, make(graph.poses[0])))
    for k, row in enumerate(graph.poses):
        values.insert(k, make(row))
    newton = method == "gauss_newton"
    parameters = gtsam.GaussNewtonParams() if newton else gtsam.LevenbergMarquardtParams()
    parameters.setRelativeErrorTol(1e-9)
    kind = gtsam.GaussNewtonOptimizer if newton else gtsam.LevenbergMarquardtOptimizer
    begin = time.process_time()
    try:
        found = kind(factors, values, parameters).optimize()
    except RuntimeError:  # a singular system on its way
        return time.process_time() - begin, graph.poses
    seconds = time.process_time() - begin
    if graph.is_spatial:
        return seconds, np.array([found.atPose3(k).matrix() for k in range(len(graph.poses))])
    rows = [found.atPose2(k) for k in range(len(graph.poses))]
    return seconds, np.array([[row.x(), row.y(), row.theta()] for row in rows])


def judge_chi2(name: str, poses: np.ndarray) -> float:
    """Σ eᵀWe with e the twist of Z⁻¹ Xᵢ⁻¹ Xⱼ, in plain numpy."""
    graph = read_arrays(name)
    d = graph.dimension
    X, Z = (to_matrices(rows) for rows in (poses, graph.motions))
    E = np.linalg.inv(Z) @ np.linalg.inv(X[graph.edges[:, 0]]) @ X[graph.edges[:, 1]]
    R, t = E[:, :d, :d], E[:, :d, d]
    if d == 2:
        w = np.arctan2(R[:, 1, 0], R[:, 0, 0])
        half = w / 2
        k = np.where(np.abs(w) < 1e-6, 1.0, half / np.tan(np.where(w == 0, 1.0, half)))
        e = np.stack([k * t[:, 0] + half * t[:, 1], k * t[:, 1] - half * t[:, 0], w], axis=1)
    else:
        e = judge_log(R, t)
    return float(np.einsum("ni,nij,nj->", e, graph.information, e))


def judge_log(R: np.ndarray, t: np.ndarray) -> np.ndarray:
    """Twists of displacements of space, away from half turns."""
    axis = 0.5 * np.stack([R[:, 2, 1] - R[:, 1, 2], R[:, 0, 2] - R[:, 2, 0], R[:, 1, 0] - R[:, 0, 1]], axis=1)
    s, c = np.linalg.norm(axis, axis=1), 0.5 * (np.trace(R, axis1=1, axis2=2) - 1)
    angle = np.arctan2(s, c)
    w = axis * np.where(s < 1e-12, 1.0, angle / np.where(s == 0, 1.0, s))[:, None]
    safe = np.where(angle < 1e-4, 1.0, angle)
    rest = np.where(angle < 1e-4, 1 / 12, (1 - safe / 2 / np.tan(safe / 2)) / safe**2)
    wt = np.cross(w, t)
    return np.concatenate([t - 0.5 * wt + rest[:, None] * np.cross(w, wt), w], axis=1)


def to_matrices(rows: np.ndarray) -> np.ndarray:
    """Rows x, y, θ as matrices."""
    if rows.ndim == 3:
        return rows
    T = np.tile(np.eye(3), (len(rows), 1, 1))
    c, s = np.cos(rows[:, 2]), np.sin(rows[:, 2])
    T[:, 0, 0], T[:, 0, 1], T[:, 1, 0], T[:, 1, 1], T[:, :2, 2] = c, -s, s, c, rows[:, :2]
    return T


def run_contender(name: str, method: str) -> tuple[float, float]:
    """Seconds and χ² of one run, in a process of its own."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "found.npz"
        environment = os.environ | dict.fromkeys(("OMP_NUM_THREADS", "TBB_NUM_THREADS"), "1")
        subprocess.run(
            [sys.executable, __file__, "--contender", method, name, str(path)], check=True, env=environment
        )
        found = np.load(path)
        return float(found["seconds"]), judge_chi2(name, found["poses"])


def measure_graph(name: str, rounds: int) -> dict[str, Any]:
    """Median and slowest time of every contender, and its χ²."""
    runs: dict[str, list[tuple[float, float]]] = {method: [] for method in METHODS}
    for _ in range(rounds):
        for method in METHODS:
            runs[method].append(run_contender(name, method))
    found = {
        method: {
            "median": float(np.median([seconds for seconds, _ in each])),
            "slowest": max(seconds for seconds, _ in each),
            "chi2": each[-1][1],
        }
        for method, each in runs.items()
    }
    least = min(each["chi2"] for each in found.values())
    theirs = [
        each["median"]
        for method, each in found.items()
        if method.startswith("gtsam") and each["chi2"] <= least * (1 + SAME)
    ]
    ratio = min(theirs) / found["cspace_given"]["median"] if theirs else None
    return {"contenders": found, "least_chi2": least, "times_faster": ratio}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--contender", nargs=3)
    given = parser.parse_args()
    if given.contender:
        method, name, path = given.contender
        library, _, how = method.partition("_")
        seconds, poses = time_cspace(name, how) if library == "cspace" else time_gtsam(name, how)
        np.savez(path, seconds=seconds, poses=poses)
        return
    results = {}
    for name in GRAPHS:
        results[name] = measure_graph(name, given.rounds)
        for method, each in results[name]["contenders"].items():
            print(
                f"{name:28} {method:26} {1e3 * each['median']:8.1f} ms  chi2 {each['chi2']:.9g}", flush=True
            )
        print(f"{name:28} times faster: {results[name]['times_faster']}", flush=True)
    versions = {"gtsam": importlib.metadata.version("gtsam"), "python": platform.python_version()}
    document = {
        "machine": platform.processor() or platform.machine(),
        "versions": versions,
        "graphs": results,
    }
    path = ROOT / "benchmarks/results/pose_graphs.json"
    path.write_text(json.dumps(document, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
