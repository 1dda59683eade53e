"""Monte Carlo localisation: time of an update, and trials of kidnapping and global start on public logs.

Usage: python benchmarks/monte_carlo.py [--trials N] [--only time kidnapped global] [--seed S]. Prints the
rows of the table. For each trial the map is built from the corrected log without the stretch that is tested;
a trial counts if the pose is right (0.5 m, 15°) from some update to the 20th. The map covers the stretch
where 70 % of the ends of its beams lie on walls of it. The data are found through $CSPACE_DATA.
"""

from __future__ import annotations

import argparse
import json
import os
from pathlib import Path
from time import process_time
from typing import Any

import numpy as np

import cspace as cs
from cspace.localization.filters.rows import relate_rows
from cspace.math.wrapping import wrap_angle

DATA = Path(os.environ.get("CSPACE_DATA", "../shared/data")) / "localization/carmen"
LOGS = {"intel": 1, "freiburg-079": 5}
"""Scans per update: half a metre on both."""
UPDATES, SETTLED = 20, 5
RIGHT, NEAR = (0.5, np.radians(15.0)), 0.3
COVERED, ON_WALL, REACH = 0.7, 100, 20.0


def measure_update(particles: int = 10_000, beams: int = 60) -> dict[str, Any]:
    """Milliseconds of a prediction and an update on one core, where all particles are near each other."""
    log = cs.read_log(DATA / "intel-corrected.log.gz")
    poses = log.truth.at(log.scans.times)
    grid = build_map(log, poses, np.ones(len(poses), bool))
    scanner = cs.LaserScanner(beams=beams)
    start = poses[300]
    pf = cs.ParticleFilter(grid, sensor=scanner, n=particles, most=particles, start=start, rng=7)
    spent = []
    for k in range(300, 360):
        begin = process_time()
        if k > 300:
            pf.predict(relate_rows(poses[k - 1], poses[k]), 1.0)
        pf.update(log.scans[k])
        spent.append(1e3 * (process_time() - begin))
    return {
        "what": f"update, {particles} × {beams}",
        "median_ms": float(np.median(spent[5:])),
        "p95_ms": float(np.quantile(spent[5:], 0.95)),
    }


def build_map(log: Any, poses: Any, use: Any) -> Any:
    """The map of the scans that are used."""
    kept = np.flatnonzero(use)
    return cs.maps.EvidenceGrid.from_scans(log.scans.subset(kept), poses[kept], resolution=0.05)


def measure_cover(field: Any, log: Any, poses: Any, rows: Any) -> float:
    """The share of the ends of beams that lie on walls of the map."""
    shares = []
    for k in rows:
        ends = log.scans.points(k)
        ends = ends[np.hypot(*ends.T) < REACH]
        p = ends @ cs.rotation_2d(poses[k, 2]).T + poses[k, :2]
        cells = np.floor((p - field.origin) / field.resolution).astype(int)
        inside = ((cells >= 0) & (cells < field.scores.shape[::-1])).all(axis=1)
        column, row = np.where(inside[:, None], cells, 0).T
        shares.append(float(np.mean(inside & (field.scores[row, column] > ON_WALL))))
    return float(np.mean(shares))


class Trials:
    """Counts of one kind of trial."""

    def __init__(self, what: str) -> None:
        self.what, self.right, self.total = what, 0, 0
        self.near, self.doubted = 0, 0
        self.first: list[int] = []

    def row(self) -> dict[str, Any]:
        share = self.right / max(self.total, 1)
        doubt = self.doubted / max(self.near, 1)
        first = float(np.mean(self.first)) if self.first else float("nan")
        return {"what": self.what, "right": self.right, "trials": self.total, "share": share,
                "first_update": first, "doubted_while_near": doubt, "updates_near": self.near}  # fmt: skip

    def add(self, good: list[bool]) -> None:
        self.total += 1
        wrong = np.flatnonzero(~np.array(good))
        last = int(wrong[-1]) + 1 if len(wrong) else 0
        if last < len(good):
            self.right += 1
            self.first.append(last + 1)


def run_trials(name: str, count: int, kinds: list[str], seed: int) -> list[dict[str, Any]]:
    """Trials on one log until each kind has as many as asked for, or a hundred times as many stretches were
    drawn."""
    log = cs.read_log(DATA / f"{name}-corrected.log.gz")
    poses, step = log.truth.at(log.scans.times), LOGS[name]
    odometry = log.odometry.dead_reckoning().at(log.scans.times)
    rng, drawn = np.random.default_rng(seed), 0
    made = {kind: Trials(f"{name}: {kind}") for kind in kinds}
    while any(trials.total < count for trials in made.values()) and drawn < 100 * count:
        drawn += 1
        a, b = int(rng.integers(len(poses))), int(rng.integers(len(poses) - (UPDATES + 1) * step))
        if np.hypot(*(poses[a] - poses[b])[:2]) < 3.0:
            continue
        use = np.ones(len(poses), bool)
        use[max(0, b - 2) : b + UPDATES * step + 3] = False
        grid = build_map(log, poses, use)
        rows = b + step * np.arange(1, UPDATES + 1)
        covered = measure_cover(grid.likelihood_field(), log, poses, rows) >= COVERED
        for kind, trials in made.items():
            if trials.total >= count or covered != (not kind.endswith("not covered")):
                continue
            start = None if kind.startswith("global") else poses[a]
            run_trial(trials, grid, log, poses, odometry, a, b, step, start)
    return [trials.row() for trials in made.values()]


def run_trial(
    trials: Trials, grid: Any, log: Any, poses: Any, odometry: Any, a: int, b: int, step: int, start: Any
) -> None:
    """Settles at a, unless the start is unknown; continues at b."""
    pf = cs.ParticleFilter(grid, start=start, rng=trials.total)
    if start is not None:
        for _ in range(SETTLED):
            pf.update(log.scans[a])
    good = []
    for k in range(b + step, b + UPDATES * step + 1, step):
        for j in range(k - step, k):
            pf.predict(relate_rows(odometry[j], odometry[j + 1]), log.scans.times[j + 1] - log.scans.times[j])
        pf.update(log.scans[k])
        away = pf.pose - poses[k]
        distance = float(np.hypot(*away[:2]))
        good.append(distance < RIGHT[0] and abs(float(wrap_angle(away[2]))) < RIGHT[1])
        trials.near += distance < NEAR
        trials.doubted += distance < NEAR and pf.status != "localised"
    trials.add(good)


KINDS = {
    "kidnapped": ["kidnapped, covered", "kidnapped, not covered"],
    "global": ["global start, covered"],
}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--trials", type=int, default=100, help="of each kind and log")
    parser.add_argument("--only", nargs="+", choices=["time", *KINDS], default=["time", *KINDS])
    parser.add_argument("--logs", nargs="+", choices=list(LOGS), default=list(LOGS))
    parser.add_argument("--seed", type=int, default=5)
    parser.add_argument("--save", type=Path)
    given = parser.parse_args()
    rows = [measure_update()] if "time" in given.only else []
    kinds = [kind for only in given.only for kind in KINDS.get(only, [])]
    for name in given.logs if kinds else []:
        rows += run_trials(name, given.trials, kinds, given.seed)
    for row in rows:
        print(
            "  ".join(
                f"{key} {value:.4g}" if isinstance(value, float) else f"{key} {value}"
                for key, value in row.items()
            )
        )
    if given.save:
        given.save.write_text(json.dumps(rows, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
