"""Localisation on the public logs: position errors of filters and smoothers, and of dead reckoning.

Usage: python benchmarks/localization.py [--filters ekf iekf ukf information] [--save FILE] [--write].
Prints a row per log, RMSE [m] over the times of the odometry for which there is a truth. Odometry is
calibrated on the first half of each log, everything else is a default. --write leaves the rows in
benchmarks/results/localization.json. The data are found through $CSPACE_DATA.
"""

from __future__ import annotations

import argparse
import json
import os
from dataclasses import replace
from pathlib import Path
from time import process_time
from typing import Any

import numpy as np

import cspace as cs

DATA = Path(os.environ.get("CSPACE_DATA", "../shared/data")) / "localization"
LAG = 5.0
RESULTS = Path(__file__).resolve().parent / "results/localization.json"


def rmse(answer: Any, log: Any) -> float:
    """RMSE of the positions [m] at the times of the odometry with a truth."""
    error = (answer.at(log.odometry.times) - log.truth.at(log.odometry.times))[:, :2]
    return float(np.sqrt(np.nanmean((error**2).sum(axis=1))))


def measure_filters(robot: int, filters: list[str]) -> list[dict[str, Any]]:
    """A row per filter: errors of it and its smoothers, and processor seconds."""
    log = cs.read_log(DATA / "mrclam6", robot=robot)
    fit = cs.mobile.calibrate(log.odometry, log.truth)
    rows = []
    for name in filters:
        raw = cs.localize(log, filter=name)
        start = process_time()
        run = cs.localize(replace(log, odometry=fit.odometry), filter=name)
        filtered = process_time()
        past = run.smoothed()
        smoothed = process_time()
        row = {
            "log": f"MRCLAM 6, robot {robot}",
            "filter": name,
            "raw": rmse(raw, log),
            "calibrated": rmse(run, log),
        }
        row |= {"smoothed": rmse(past, log), "lagged": rmse(run.smoothed(lag=LAG), log)}
        row |= {"rejected": run.stats.rejected, "mean_nis": run.stats.mean_nis}
        rows.append(row | {"filter_s": filtered - start, "smoother_s": smoothed - filtered})
    return rows


def measure_calibration(name: str) -> dict[str, Any]:
    """Dead reckoning of the second half of a log, raw and calibrated on the first, after alignment."""
    log = cs.read_log(DATA / f"carmen/{name}-corrected.log.gz")
    fit = cs.mobile.calibrate(log.odometry, log.truth)
    raw, corrected = fit.held_out
    factors = {"distance": fit.distance, "turn": fit.turn, "drift": fit.drift}
    return {"log": name, "raw": raw, "corrected": corrected, **factors}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--filters", nargs="+", default=["ekf", "iekf", "ukf", "information"])
    parser.add_argument("--save", type=Path)
    parser.add_argument("--write", action="store_true")
    options = parser.parse_args()
    rows = [measure_calibration(name) for name in ("intel", "freiburg-079")]
    for robot in (1, 2, 3):
        rows += measure_filters(robot, options.filters)
    for row in rows:
        print(
            "  ".join(
                f"{key} {value:.3f}" if isinstance(value, float) else f"{value}" for key, value in row.items()
            )
        )
    means = {
        key: np.mean([row[key] for row in rows if "smoothed" in row]) for key in ("calibrated", "smoothed")
    }
    print(f"mean of the robots: filter {means['calibrated']:.3f} m, smoother {means['smoothed']:.3f} m")
    for path in [options.save, RESULTS if options.write else None]:
        if path:
            path.write_text(json.dumps(rows, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
