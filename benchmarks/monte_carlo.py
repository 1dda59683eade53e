"""Monte Carlo localisation: time of an update, and trials of kidnapping and global start on public logs.

Usage: python benchmarks/monte_carlo.py [--trials N] [--only time kidnapped global] [--seed S] [--write].
Prints the rows of the table; --write leaves them in benchmarks/results/monte_carlo.json. For each trial a
stretch of 20 updates is drawn, and the map is built from the corrected log without it. A trial counts if the
pose is right (0.5 m, 15°) from some update to the 20th. The map covers the stretch where 70 % of the ends of
its beams lie on walls of it. If it should not, scans from near the stretch are left out of the map too, from
half a metre on, until fewer do. The data are found through $CSPACE_DATA.
"""

from __future__ import annotations

import argparse
import json
import os
from bisect import bisect_left
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
HALF_METRES = range(1, 13)
"""Distances from the stretch that is tested, from which scans are left out."""
RESULTS = Path(__file__).resolve().parent / "results/monte_carlo.json"


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

    def __init__(self, log: str, kind: str) -> None:
        self.log, self.kind, self.right, self.total = log, kind, 0, 0
        self.updates, self.near, self.doubted, self.far, self.sure = 0, 0, 0, 0, 0
        self.first: list[int] = []
        self.covers: list[float] = []

    def row(self) -> dict[str, Any]:
        return {
            "log": self.log,
            "kind": self.kind,
            "right": self.right,
            "trials": self.total,
            "share": self.right / max(self.total, 1),
            "mean_first_update": float(np.mean(self.first)) if self.first else None,
            "updates": self.updates,
            "updates_near": self.near,
            "doubted_while_near": self.doubted,
            "updates_far": self.far,
            "sure_while_far": self.sure,
            "median_cover": float(np.median(self.covers)) if self.covers else None,
        }

    def wants(self, count: int, covered: bool) -> bool:
        """Whether trials are missing, on maps that cover the stretch or on others."""
        return self.total < count and covered != self.kind.endswith("not covered")

    def see(self, distance: float, status: str) -> None:
        """Notes what the filter says of itself: near the truth, and where it is not."""
        self.updates += 1
        self.near += distance < NEAR
        self.doubted += distance < NEAR and status != "localised"
        self.far += distance >= RIGHT[0]
        self.sure += distance >= RIGHT[0] and status == "localised"

    def add(self, good: list[bool], cover: float) -> None:
        self.total += 1
        self.covers.append(cover)
        wrong = np.flatnonzero(~np.array(good))
        last = int(wrong[-1]) + 1 if len(wrong) else 0
        if last < len(good):
            self.right += 1
            self.first.append(last + 1)


class Drives:
    """A log with corrected poses, of which stretches are tested."""

    def __init__(self, name: str) -> None:
        self.name, self.step = name, LOGS[name]
        self.log = cs.read_log(DATA / f"{name}-corrected.log.gz")
        self.times = self.log.scans.times
        self.poses = self.log.truth.at(self.times)
        self.odometry = self.log.odometry.dead_reckoning().at(self.times)
        self.whole = build_map(self.log, self.poses, np.ones(len(self.poses), bool))

    def rows(self, b: int) -> Any:
        """The scans of the updates of the stretch that begins at b."""
        return b + self.step * np.arange(1, UPDATES + 1)

    def leave_out(self, b: int, distance: float) -> Any:
        """Which scans make the map: not those of the stretch, nor those from nearer to it than a distance."""
        use = np.ones(len(self.poses), bool)
        use[max(0, b - 2) : b + UPDATES * self.step + 3] = False
        if distance > 0:
            for x, y in self.poses[self.rows(b), :2]:
                use &= np.hypot(self.poses[:, 0] - x, self.poses[:, 1] - y) >= distance
        return use

    def map_without(self, b: int, distance: float) -> tuple[Any, float, Any]:
        """The map, how much of the stretch it covers, and which scans made it."""
        use = self.leave_out(b, distance)
        # Evidence adds up: the whole map less that of the scans that are left out.
        out = build_map(self.log, self.poses, ~use)
        row, column = np.subtract(out.corner, self.whole.corner)
        rows, columns = out.shape
        sums = self.whole.sums.copy()
        sums[row : row + rows, column : column + columns] -= out.sums
        grid = cs.maps.EvidenceGrid(sums, self.whole.resolution, self.whole.anchor, self.whole.corner)
        return grid, measure_cover(grid.likelihood_field(), self.log, self.poses, self.rows(b)), use

    def maps(self, b: int, wants_other: bool) -> Any:
        """The map without the stretch; then, if it covers it and others are wanted, one that does not."""
        whole = self.map_without(b, 0.0)
        yield whole
        if whole[1] < COVERED or not wants_other:
            return
        made: dict[int, Any] = {}

        def is_other(half_metres: int) -> bool:
            made[half_metres] = self.map_without(b, 0.5 * half_metres)
            return bool(made[half_metres][1] < COVERED)

        at = bisect_left(HALF_METRES, True, key=is_other)
        if at < len(HALF_METRES):
            yield made[HALF_METRES[at]]


def run_trials(name: str, count: int, kinds: list[str], seed: int) -> list[dict[str, Any]]:
    """Trials on one log until each kind has as many as asked for, or ten times as many stretches were
    drawn."""
    drives, rng = Drives(name), np.random.default_rng(seed)
    made = [Trials(name, kind) for kind in kinds]
    for _ in range(10 * count):
        if all(trials.total >= count for trials in made):
            break
        a = int(rng.integers(len(drives.poses)))
        b = int(rng.integers(len(drives.poses) - (UPDATES + 1) * drives.step))
        if np.hypot(*(drives.poses[a] - drives.poses[b])[:2]) < 3.0:
            continue
        wants_other = any(trials.wants(count, False) for trials in made)
        for grid, cover, use in drives.maps(b, wants_other):
            for trials in made:
                if use[a] and trials.wants(count, cover >= COVERED):
                    run_trial(trials, drives, grid, a, b, cover)
    return [trials.row() for trials in made]


def run_trial(trials: Trials, drives: Drives, grid: Any, a: int, b: int, cover: float) -> None:
    """Settles at a, unless the start is unknown; continues at b."""
    start = None if trials.kind.startswith("global") else drives.poses[a]
    pf = cs.ParticleFilter(grid, start=start, rng=trials.total)
    if start is not None:
        for _ in range(SETTLED):
            pf.update(drives.log.scans[a])
    good = []
    for k in drives.rows(b):
        for j in range(k - drives.step, k):
            step = relate_rows(drives.odometry[j], drives.odometry[j + 1])
            pf.predict(step, drives.times[j + 1] - drives.times[j])
        pf.update(drives.log.scans[k])
        away = pf.pose - drives.poses[k]
        distance = float(np.hypot(*away[:2]))
        good.append(distance < RIGHT[0] and abs(float(wrap_angle(away[2]))) < RIGHT[1])
        trials.see(distance, pf.status)
    trials.add(good, cover)


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
    parser.add_argument("--write", action="store_true")
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
    for path in [given.save, RESULTS if given.write else None]:
        if path:
            path.write_text(json.dumps(rows, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
