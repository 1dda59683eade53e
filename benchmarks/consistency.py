"""Consistency of filters: NEES in simulation, the mean over many runs at every time step.

Usage: python benchmarks/consistency.py [--runs 100] [--only ekf iekf …] [--save FILE] [--write]. A robot
drives an eight among 25 landmarks. The true starts have exactly the covariance that the filter is given,
odometry and readings have the noise of the models. NEES of a consistent filter is χ² with 3 degrees of
freedom, and the mean over 100 runs lies in [2.54, 3.50] for 95 % of the time steps (Bar-Shalom et al. 2001).
Printed: the share of steps inside, the least and the largest mean, and whether 90 % are inside and all in
[2.14, 4.05]; --write leaves them in benchmarks/results/consistency.json.

Runs are seeded; gates are open, as a rejected reading is no sample of its model.
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any, Final

import numpy as np

import cspace as cs
from cspace.localization import Landmarks, Log, RangeBearing, run_ekf_slam, run_fast_slam, simulate
from cspace.mobile import Odometry, RandomWalk

BAND: Final = (2.54, 3.50)
"""95 % of the means of 100 draws of χ² with 3 degrees of freedom."""
WIDE: Final = (2.14, 4.05)
"""In which all means must lie."""
INSIDE: Final = 0.9
NOISE: Final = RandomWalk(distance=1e-3, side=2e-4, turn=2e-3, drift=1e-3, rest=1e-6, rest_turn=1e-6)
SENSOR: Final = RangeBearing(range_sigma=0.1, bearing_sigma=0.02, most_range=6.0)
START: Final = np.diag([0.04, 0.04, 0.01])
OPEN: Final = 1 - 1e-12
RESULTS: Final = Path(__file__).resolve().parent / "results/consistency.json"


def drive(seconds: float, dt: float = 0.1) -> Any:
    """The true poses: an eight."""
    times = np.arange(0.0, seconds, dt)
    twists = np.stack([0.8 + 0 * times, 0 * times, 0.5 * np.cos(2 * np.pi * times / seconds)], axis=-1)
    return Odometry.from_twists(times, twists).dead_reckoning()


def draw_starts(runs: int, first: int) -> np.ndarray:
    """Errors of starts, of which the second moments are exactly START, (runs, 3).

    In SLAM nothing corrects the error of the start, so that a chance of the draws would stay for all steps.
    """
    xi = np.random.default_rng(first).standard_normal((runs, 3))
    L = np.linalg.cholesky(xi.T @ xi / runs)
    return xi @ np.linalg.inv(L).T @ np.linalg.cholesky(START).T


def make_log(seed: int, seconds: float, xi: np.ndarray) -> tuple[Log, np.ndarray]:
    """A log, and a start with the error ξ."""
    points = np.random.default_rng(7).uniform(-8, 8, size=(25, 2))
    log = simulate(
        drive(seconds), Landmarks(np.arange(25), points), sensor=SENSOR, noise=NOISE, period=1.0, rng=seed
    )
    return log, cs.to_xytheta(cs.pose_2d(xytheta=log.truth.poses[0]) @ cs.exp_se2(-xi))


def list_filters() -> dict[str, Callable[[Log, np.ndarray, int], Any]]:
    """Every filter as a function of a log, a start and a seed."""
    shared: dict[str, Any] = {
        "start_covariance": START,
        "sensor": SENSOR,
        "noise": NOISE,
        "gate": OPEN,
    }

    def on_map(name: str, log: Log, start: np.ndarray, seed: int) -> Any:
        return cs.localize(log, filter=name, start=start, **shared)

    def ekf_slam(linearization: str, log: Log, start: np.ndarray, seed: int) -> Any:
        return run_ekf_slam(log, linearization=linearization, start=start, **shared)

    def fast_slam(version: int, n: int, log: Log, start: np.ndarray, seed: int) -> Any:
        return run_fast_slam(log, version=version, n=n, rng=seed, start=start, **shared)

    filters = {name: partial(on_map, name) for name in ("ekf", "iekf", "ukf", "information")}
    names = {"invariant": "invariant", "first estimates": "first_estimate", "plain": "plain"}
    filters |= {f"EKF-SLAM, {text}": partial(ekf_slam, name) for text, name in names.items()}
    filters |= {f"FastSLAM {v}, 1000 particles": partial(fast_slam, v, 1000) for v in (1, 2)}
    return filters


def measure_nees(run: Callable[[Log, np.ndarray, int], Any], runs: int, seconds: float, first: int) -> Any:
    """The mean NEES of so many runs, at every time."""
    sums = 0.0
    for seed, xi in enumerate(draw_starts(runs, first), first):
        log, start = make_log(seed, seconds, xi)
        sums = sums + run(log, start, seed).nees(log.truth)
    return sums / runs


def judge(mean: np.ndarray) -> dict[str, Any]:
    """What the row of a table says."""
    inside = float(((mean > BAND[0]) & (mean < BAND[1])).mean())
    passes = inside >= INSIDE and mean.min() > WIDE[0] and mean.max() < WIDE[1]
    return {
        "inside": inside,
        "least": float(mean.min()),
        "largest": float(mean.max()),
        "mean": float(mean.mean()),
        "passes": bool(passes),
    }


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--runs", type=int, default=100)
    parser.add_argument("--seconds", type=float, default=40.0)
    parser.add_argument("--first", type=int, default=0, help="the first seed")
    parser.add_argument("--only", nargs="+")
    parser.add_argument("--save", type=Path)
    parser.add_argument("--write", action="store_true")
    options = parser.parse_args()
    rows = {}
    for name, run in list_filters().items():
        if options.only and not any(part in name for part in options.only):
            continue
        rows[name] = judge(measure_nees(run, options.runs, options.seconds, options.first))
        r = rows[name]
        print(
            f"{name:30s} inside {r['inside']:6.1%}  {r['least']:.2f} to {r['largest']:.2f}"
            f"  mean {r['mean']:.2f}  {'passes' if r['passes'] else 'fails'}",
            flush=True,
        )
    for path in [options.save, RESULTS if options.write else None]:
        if path:
            path.write_text(json.dumps(rows, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
