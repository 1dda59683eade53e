"""Landmark SLAM: time of a step beside the Robotics Toolbox and PythonRobotics, errors on public logs.

Usage: python benchmarks/landmark_slam.py [--toolbox PYTHON] [--pythonrobotics FOLDER] [--rounds 3] [--save
FILE] [--write]. PYTHON is an interpreter with roboticstoolbox-python, FOLDER a checkout of PythonRobotics. A
step is what a user calls from Python: a prediction and an update. --write leaves the rows in
benchmarks/results/landmark_slam.json.

- EKF-SLAM, one reading per step, all landmarks on the map before. The step of the toolbox also simulates the
  robot and its sensor; the time of that alone is printed beside it.
- FastSLAM, 100 particles, the world of PythonRobotics (8 landmarks, of which each step sees some): the same
  inputs and readings for both.
- MRCLAM 6 without its map, Victoria Park: errors after alignment, of poses to the truth (of Victoria Park to
  the optimum of the pose graph) and of landmarks.

Contenders run in processes of their own, turn by turn, on one thread; medians over all steps of all rounds.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
import tempfile
from dataclasses import replace
from pathlib import Path
from time import perf_counter
from typing import Any, Final

import numpy as np

DATA = Path(os.environ.get("CSPACE_DATA", "../shared/data")) / "localization"
SIZES: Final = (100, 300)
STEPS: Final = 200
RESULTS: Final = Path(__file__).resolve().parent / "results/landmark_slam.json"
ONE_THREAD: Final = dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"), "1")
BEACONS: Final = [[10, -2], [15, 10], [15, 15], [10, 20], [3, 15], [-5, 20], [-5, 5], [-10, 15]]
BEACON_STEPS: Final = 150
DT: Final = 0.1


def turn_of(angle: Any) -> Any:
    """An angle in (−π, π]."""
    return np.arctan2(np.sin(angle), np.cos(angle))


def time_ekf(count: int) -> dict[str, Any]:
    """Seconds of our steps with so many landmarks."""
    from cspace.localization import EkfSlam, RangeBearing

    rng = np.random.default_rng(0)
    points = rng.uniform(-20, 20, (count, 2))
    slam = EkfSlam(sensor=RangeBearing(0.1, np.radians(1.0)))
    see = np.stack([np.arange(count), np.hypot(*points.T), np.arctan2(*points.T[::-1])], axis=-1)
    slam.update(see)
    pose, seconds = np.zeros(3), []
    for k in range(STEPS):
        increment = np.array([0.1, 0.0, 0.03])
        pose += [0.1 * np.cos(pose[2]), 0.1 * np.sin(pose[2]), 0.03]
        offset = points[k % count] - pose[:2]
        bearing = turn_of(np.arctan2(offset[1], offset[0]) - pose[2] + rng.normal() * np.radians(1.0))
        reading = np.array([[k % count, np.hypot(*offset) + 0.1 * rng.normal(), bearing]])
        begin = perf_counter()
        slam.predict(increment, DT)
        slam.update(reading)
        seconds.append(perf_counter() - begin)
    return {"seconds": seconds, "error": float(np.hypot(*(slam.pose - pose)[:2]))}


def time_toolbox(count: int) -> dict[str, Any]:
    """Seconds of the steps of the Robotics Toolbox, and of what they simulate."""
    from roboticstoolbox import EKF, Bicycle, LandmarkMap, RandomPath, RangeBearingSensor

    V, W = np.diag([0.02, np.radians(0.5)]) ** 2, np.diag([0.1, np.radians(1.0)]) ** 2
    robot = Bicycle(covar=V, animation=None)
    robot.control = RandomPath(workspace=20, seed=0)
    sensor = RangeBearingSensor(robot, LandmarkMap(count, workspace=20, seed=0), covar=W, seed=0)
    ekf = EKF(robot=(robot, V), P0=np.diag([0.05, 0.05, 0.01]) ** 2, sensor=(sensor, W), history=False)
    robot.init(), sensor.init(), ekf.init()
    while len(ekf._landmarks) < count:
        ekf.step()
    seconds, simulated = [], []
    for _ in range(STEPS):
        begin = perf_counter()
        ekf.step()
        between = perf_counter()
        robot.step(), sensor.reading()
        seconds.append(between - begin)
        simulated.append(perf_counter() - between)
    return {"seconds": seconds, "simulated": simulated}


def make_beacon_world(seed: int) -> tuple[np.ndarray, list[np.ndarray], np.ndarray]:
    """Inputs v, ω with noise, readings range, bearing, number, and true poses."""
    rng, pose, beacons = np.random.default_rng(seed), np.zeros(3), np.array(BEACONS, float)
    inputs, readings, truth = [], [], []
    for _ in range(BEACON_STEPS):
        pose = pose + np.array([DT * np.cos(pose[2]), DT * np.sin(pose[2]), 0.1 * DT])
        offset = beacons - pose[:2]
        far = np.hypot(*offset.T)
        seen = np.flatnonzero(far <= 20.0)
        noise = rng.normal(size=(len(seen), 2)) * [0.3, np.radians(2.0)]
        bearing = turn_of(np.arctan2(offset[seen, 1], offset[seen, 0]) - pose[2] + noise[:, 1])
        readings.append(np.stack([far[seen] + noise[:, 0], bearing, seen]))
        inputs.append([1.0 + 0.3 * rng.normal(), 0.1 + np.radians(5.0) * rng.normal()])
        truth.append(pose)
    return np.array(inputs), readings, np.array(truth)


def time_particles(version: int) -> dict[str, Any]:
    """Seconds of our steps with 100 particles, and the mean error of the pose."""
    from cspace.localization import FastSlam, RangeBearing
    from cspace.mobile import RandomWalk

    inputs, readings, truth = make_beacon_world(1)
    noise = RandomWalk(0, 0, 0, 0, 0.009, 0.0008)  # of the inputs, per second
    slam = FastSlam(n=100, version=version, sensor=RangeBearing(0.3, np.radians(2.0)), noise=noise, rng=0)
    seconds, errors = [], []
    for (v, w), z, pose in zip(inputs, readings, truth, strict=True):
        increment, rows = np.array([v * DT, 0.0, w * DT]), np.ascontiguousarray(z[[2, 0, 1]].T)
        begin = perf_counter()
        slam.predict(increment, DT)
        slam.update(rows)
        found = slam.pose
        seconds.append(perf_counter() - begin)
        errors.append(np.hypot(*(found - pose)[:2]))
    return {"seconds": seconds, "error": float(np.mean(errors))}


def time_pythonrobotics(version: int) -> dict[str, Any]:
    """The same of PythonRobotics, found on the path."""
    import importlib

    theirs = importlib.import_module(f"SLAM.FastSLAM{version}.fast_slam{version}")
    inputs, readings, truth = make_beacon_world(1)
    step = getattr(theirs, f"fast_slam{version}")
    np.random.seed(0)  # noqa: NPY002  what they draw from
    particles = [theirs.Particle(len(BEACONS)) for _ in range(theirs.N_PARTICLE)]
    seconds, errors = [], []
    for u, z, pose in zip(inputs, readings, truth, strict=True):
        begin = perf_counter()
        particles = step(particles, u.reshape(2, 1), z)
        found = theirs.calc_final_state(particles)[:, 0]
        seconds.append(perf_counter() - begin)
        errors.append(np.hypot(*(found - pose)[:2]))
    return {"seconds": seconds, "error": float(np.mean(errors))}


CONTENDERS: Final = {
    "ekf": time_ekf,
    "toolbox": time_toolbox,
    "particles": time_particles,
    "pythonrobotics": time_pythonrobotics,
}


def run_contender(name: str, number: int, python: str, path: str = "") -> dict[str, Any]:
    """One run in a process of its own."""
    environment = os.environ | ONE_THREAD | {"MPLBACKEND": "Agg"}
    if path:
        environment["PYTHONPATH"] = path
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "found.json"
        command = [python, __file__, "--contender", name, str(number), str(file)]
        subprocess.run(command, check=True, env=environment, cwd=folder)
        return dict(json.loads(file.read_text(encoding="utf-8")))


def compare(ours: str, theirs: str, number: int, rounds: int, python: str, path: str) -> dict[str, Any]:
    """Medians [µs] of both, in turn."""
    runs: dict[str, list[dict[str, Any]]] = {ours: [], theirs: []}
    for _ in range(rounds):
        runs[ours].append(run_contender(ours, number, sys.executable))
        runs[theirs].append(run_contender(theirs, number, python, path))
    row: dict[str, Any] = {"number": number}
    for name, each in runs.items():
        for part in ("seconds", "simulated"):
            if part in each[0]:
                values = np.concatenate([run[part] for run in each]) * 1e6
                row[f"{name} {part}"] = [float(np.median(values)), float(np.percentile(values, 95))]
        if "error" in each[0]:
            row[f"{name} error"] = each[0]["error"]
    row["times faster"] = row[f"{theirs} seconds"][0] / row[f"{ours} seconds"][0]
    return row


def align(points: np.ndarray, onto: np.ndarray) -> Any:
    """The least-squares motion of the plane that moves points onto others."""
    a, b = points - points.mean(0), onto - onto.mean(0)
    U, _, Vt = np.linalg.svd(b.T @ a)
    R = U @ np.diag([1.0, np.linalg.det(U @ Vt)]) @ Vt
    return lambda p: (p - points.mean(0)) @ R.T + onto.mean(0)


def judge(run: Any, times: np.ndarray, truth: np.ndarray, landmarks: Any) -> dict[str, Any]:
    """RMSE of positions and landmarks [m] after alignment of the positions."""
    known = ~np.isnan(truth[:, 0])
    found = run.at(times)[known, :2]
    move = align(found, truth[known])
    row = {"poses": float(np.sqrt(((move(found) - truth[known]) ** 2).sum(1).mean()))}
    if len(run.landmarks) and set(run.landmarks.names.tolist()) <= set(landmarks.names.tolist()):
        points = landmarks.points[landmarks.rows_of(run.landmarks.names)]
        row["landmarks"] = float(np.sqrt(((move(run.landmarks.points) - points) ** 2).sum(1).mean()))
    s = run.stats
    row |= {"count": len(run.landmarks), "rejected": s.rejected, "mean_nis": s.mean_nis, "seconds": s.seconds}
    return row | {"lost": float(run.lost.mean()), "status": run.status}


def measure_logs() -> list[dict[str, Any]]:
    """Errors on MRCLAM 6 without its map, and on Victoria Park."""
    import cspace as cs
    from cspace.localization import Landmarks, RangeBearing, run_ekf_slam, run_fast_slam
    from cspace.mobile import RandomWalk

    ways: dict[str, Any] = {
        "EKF, invariant": lambda log, **more: run_ekf_slam(log, **more),
        "EKF, first estimates": lambda log, **more: run_ekf_slam(log, linearization="first_estimate", **more),
        "EKF, plain": lambda log, **more: run_ekf_slam(log, linearization="plain", **more),
        "FastSLAM 1": lambda log, **more: run_fast_slam(log, version=1, rng=1, **more),
        "FastSLAM 2": lambda log, **more: run_fast_slam(log, version=2, rng=1, **more),
    }
    rows = []
    for robot in (1, 2, 3):
        log = cs.read_log(DATA / "mrclam6", robot=robot)
        log = replace(log, odometry=cs.mobile.calibrate(log.odometry, log.truth).odometry)
        times = log.odometry.times
        for name, way in ways.items():
            row = judge(way(log), times, log.truth.at(times)[:, :2], log.landmarks)
            rows.append({"log": f"MRCLAM 6, robot {robot}", "filter": name} | row)
    path = DATA / "victoria/victoria_park.txt"
    log, graph = cs.read_log(path), cs.PoseGraph.read(path)
    best = graph.optimize()
    more = {"sensor": RangeBearing(0.63, 0.03), "noise": RandomWalk(0, 0, 0, 0, 1e-4, 2e-5)}
    marks = Landmarks(graph.landmark_ids, best.landmarks)
    for name, way in ways.items():
        row = judge(way(log, **more), log.odometry.times, best.poses[:, :2], marks)
        rows.append({"log": "Victoria Park", "filter": name} | row)
    return rows


def show(row: dict[str, Any]) -> None:
    """A row as a line."""
    parts = []
    for key, value in row.items():
        text = f"{value:.3g}" if isinstance(value, float) else str(value)
        if isinstance(value, list):
            text = f"{value[0]:.1f} (p95 {value[1]:.1f}) µs"
        parts.append(f"{key} {text}")
    print("  ".join(parts), flush=True)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--toolbox", metavar="PYTHON")
    parser.add_argument("--pythonrobotics", metavar="FOLDER")
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--no-logs", action="store_true")
    parser.add_argument("--save", type=Path)
    parser.add_argument("--write", action="store_true")
    parser.add_argument("--contender", nargs=3, metavar=("NAME", "NUMBER", "FILE"), help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.contender:
        name, number, file = options.contender
        Path(file).write_text(json.dumps(CONTENDERS[name](int(number))), encoding="utf-8")
        return
    rows = []
    if options.toolbox:
        for count in SIZES:
            rows.append(compare("ekf", "toolbox", count, options.rounds, options.toolbox, ""))
            show(rows[-1])
    if options.pythonrobotics:
        for version in (1, 2):
            python = sys.executable
            rows.append(
                compare(
                    "particles", "pythonrobotics", version, options.rounds, python, options.pythonrobotics
                )
            )
            show(rows[-1])
    for row in [] if options.no_logs else measure_logs():
        rows.append(row)
        show(row)
    for path in [options.save, RESULTS if options.write else None]:
        if path:
            path.write_text(json.dumps(rows, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
