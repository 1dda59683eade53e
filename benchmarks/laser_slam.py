"""Laser SLAM on the public logs, and the time of a scan match.

Usage: python benchmarks/laser_slam.py [--save FILE] [--write]. Prints a row per log: the error of each stage
against the corrected poses of the log (RMSE after alignment, `cs.ate`), with the wall time and the processor
time of its one thread; from the raw odometry of the log. The corrected poses are those of another program,
not a truth. --write leaves the rows in benchmarks/results/laser_slam.json. The data are found through
$CSPACE_DATA.
"""

from __future__ import annotations

import argparse
import json
import os
from pathlib import Path
from time import perf_counter, process_time
from typing import Any

import numpy as np

import cspace as cs

DATA = Path(os.environ.get("CSPACE_DATA", "../shared/data")) / "localization/carmen"
LOGS = ("intel", "freiburg-079")
MATCHES = 200
RESULTS = Path(__file__).resolve().parent / "results/laser_slam.json"


def measure_log(name: str) -> dict[str, Any]:
    """Errors [m] by stage, relative errors, and seconds of wall and processor time."""
    log = cs.read_log(DATA / f"{name}-corrected.log.gz")
    begin, processor = perf_counter(), process_time()
    found = cs.slam(log)
    row: dict[str, Any] = {"log": name, "scans": len(found), "seconds": perf_counter() - begin}
    row["processor_seconds"] = process_time() - processor
    row |= {stage: cs.ate(poses, log.truth, align="se2").rmse for stage, poses in found.stages.items()}
    row |= {f"rpe_{d}": cs.rpe(found, log.truth, delta=float(d), unit="m").rmse for d in (1, 10)}
    return row | {"accepted": found.stats.accepted, "rejected": found.stats.rejected}


def measure_matches() -> dict[str, Any]:
    """Processor milliseconds of a match within ±0.8 m and ±15° on the map of other scans, and how many are
    right."""
    log = cs.read_log(DATA / "intel-corrected.log.gz")
    poses = log.truth.at(log.scans.times)
    known = np.isfinite(poses[:, 0])
    held_out = np.arange(len(poses)) % 10 == 5
    grid = cs.maps.EvidenceGrid.from_scans(
        log.scans.subset(known & ~held_out), poses[known & ~held_out], 0.05
    )
    field = grid.likelihood_field(0.1)
    rng, times, right = np.random.default_rng(1), [], 0
    rows = np.flatnonzero(known & held_out)[:MATCHES]
    for row in rows:
        points = log.scans.points(row)
        guess = poses[row] + rng.uniform(-1, 1, 3) * [0.6, 0.6, 0.2]
        begin = process_time()
        match = cs.match_scan(points, field, guess=guess, window=(0.8, np.radians(15)))
        times.append(1e3 * (process_time() - begin))
        right += bool(np.hypot(*(match.pose - poses[row])[:2]) < 0.15)
    return {
        "matches": len(rows),
        "right": right,
        "median_ms": float(np.median(times)),
        "p95_ms": float(np.percentile(times, 95)),
    }


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--save", type=Path)
    parser.add_argument("--write", action="store_true")
    given = parser.parse_args()
    rows = [measure_log(name) for name in LOGS] + [measure_matches()]
    for row in rows:
        print("  ".join(f"{k} {v:.4g}" if isinstance(v, float) else f"{k} {v}" for k, v in row.items()))
    for path in [given.save, RESULTS if given.write else None]:
        if path:
            path.write_text(json.dumps(rows, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
