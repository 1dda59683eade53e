"""Maps and searches of them on the public laser logs: where a scan fits the whole map, and how long it takes.

Usage: python benchmarks/map_search.py [--every N] [--beams N] [--save FILE] [--write]. Every tenth scan is
held out of the map, which is made at the corrected poses with 5 cm cells; every Nth of those is searched on
it. Prints how often the right pose (0.5 m, 10°) is the first and among three, and processor times on one
core; --write leaves them in benchmarks/results/map_search.json. The data are found through $CSPACE_DATA.
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
from cspace.localization import search_pose

DATA = Path(os.environ.get("CSPACE_DATA", "../shared/data")) / "localization/carmen"
LOGS = ("intel", "freiburg-079")
RESULTS = Path(__file__).resolve().parent / "results/map_search.json"
NEAR, FAR = 0.1, 20.0
"""Ranges [m] that are used."""
LONGEST_GAP = 0.5
"""Between the ends of two beams [m] what counts as seen when beams are chosen evenly along it."""
FEWEST = 30
"""Beams of a scan that is searched."""


def choose_ends(ends: np.ndarray, most: int) -> np.ndarray:
    """At most so many ends of beams, evenly along the line through them."""
    far = np.hypot(*ends.T)
    ends = ends[(far > NEAR) & (far < FAR)]
    if len(ends) <= most:
        return ends
    steps = np.minimum(np.hypot(*np.diff(ends, axis=0).T), LONGEST_GAP)
    along = np.concatenate([[0.0], np.cumsum(steps)])
    rows = np.searchsorted(along, np.linspace(0.0, along[-1], most))
    return ends[np.unique(np.minimum(rows, len(ends) - 1))]


def are_right(poses: np.ndarray, truth: np.ndarray) -> np.ndarray:
    """Which poses (k, 3) are those of the truth (3,)."""
    off = poses - truth
    turn = (off[:, 2] + np.pi) % (2 * np.pi) - np.pi
    return (np.hypot(off[:, 0], off[:, 1]) < 0.5) & (np.abs(turn) < np.radians(10))


def measure(name: str, every: int, beams: int) -> dict[str, Any]:
    """The row of one log."""
    log = cs.read_log(DATA / f"{name}-corrected.log.gz")
    scans, poses = log.scans, log.truth.at(log.scans.times)
    held_out = np.arange(len(scans)) % 10 == 5
    start = process_time()
    evidence = cs.maps.EvidenceGrid.from_scans(scans.subset(~held_out), poses[~held_out], max_range=30.0)
    mapped = process_time()
    field = evidence.likelihood_field()
    made = process_time()
    one, three, first, among = [], [], 0, 0
    for k in np.flatnonzero(held_out)[::every]:
        ends = choose_ends(scans.points(k), beams)
        if len(ends) < FEWEST:
            continue
        begin = process_time()
        search_pose(ends, field, most=1, least_score=0.3)
        middle = process_time()
        right = are_right(search_pose(ends, field, least_score=0.3).poses, poses[k])
        three.append(process_time() - middle)
        one.append(middle - begin)
        first += bool(right[:1].any())
        among += bool(right.any())
    row = {"log": name, "cells": evidence.shape, "map_s": mapped - start, "field_s": made - mapped}
    row |= {"scans": len(one), "first": first, "among_three": among}
    for which, times in (("one", one), ("three", three)):
        row |= {
            f"{which}_median_ms": 1e3 * float(np.median(times)),
            f"{which}_p95_ms": 1e3 * float(np.quantile(times, 0.95)),
        }
    return row


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--every", type=int, default=1)
    parser.add_argument("--beams", type=int, default=180)
    parser.add_argument("--save", type=Path)
    parser.add_argument("--write", action="store_true")
    given = parser.parse_args()
    rows = [measure(name, given.every, given.beams) for name in LOGS]
    for row in rows:
        print({key: round(value, 3) if isinstance(value, float) else value for key, value in row.items()})
    for path in [given.save, RESULTS if given.write else None]:
        if path:
            path.write_text(json.dumps(rows, indent=1, default=float) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
