"""Maps of 8,000 × 8,000 cells: what the map object takes beside its input, and what a question takes.

Usage: python benchmarks/navigation_large.py [--patience 300]. Maps of N. Sturtevant are laid out side by side
or enlarged. Every planner runs in a fresh process, whose resident memory is read before and after (Linux
alone). Writes benchmarks/results/navigation_large.json.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np

import cspace as cs
import run
import turns
import worlds
from chains import Array

SIDE = 8000
KINDS = {"rooms": "room-400-40", "coast": "AcrosstheCape", "scattered": "random-400-33"}
PLANNERS = ("jump_point_search", "any_angle")
QUESTIONS = 3


def cells(kind: str) -> Array:
    """Blocked cells (8000, 8000): rooms and scattered cells side by side, a coast enlarged."""
    small = worlds.grid(KINDS[kind]).blocked
    if kind == "coast":
        times = SIDE // len(small) + 1
        small = np.repeat(np.repeat(small, times, axis=0), times, axis=1)
    copies = [-(-SIDE // n) for n in small.shape]
    return np.ascontiguousarray(np.tile(small, copies)[:SIDE, :SIDE])


def memory(word: str = "VmRSS") -> float:
    """Resident memory [bytes]; word: VmHWM for the most that there has been."""
    for line in Path("/proc/self/status").read_text().splitlines():
        if line.startswith(word + ":"):
            return 1024.0 * int(line.split()[1])
    raise LookupError(word)


def ends(grid: Any, rng: np.random.Generator) -> tuple[Any, Any]:
    """Two free cells' centres, in opposite corners of the map."""
    found = []
    for low, high in ((0, SIDE // 10), (SIDE - SIDE // 10, SIDE)):
        while True:
            row, column = rng.integers(low, high, 2)
            if not grid.blocked[row, column]:
                found.append((float(column) + 0.5, float(row) + 0.5))
                break
    return found[0], found[1]


def one(kind: str, planner: str) -> dict[str, Any]:
    """A map and a planner, in a process of their own."""
    blocked = cells(kind)
    before = memory()
    begin = time.process_time()
    grid = cs.OccupancyGrid(blocked)
    built = time.process_time() - begin
    locked = memory() - before
    rng = np.random.default_rng(3)
    asked = [ends(grid, rng) for _ in range(QUESTIONS)]
    Path("/proc/self/clear_refs").write_text("5")  # the most that there has been counts from here
    before = memory()
    spent, statuses, touched = [], [], []
    for start, goal in asked:
        begin = time.process_time()
        route = cs.navigate(grid, start, goal, planner=planner)
        spent.append(time.process_time() - begin)
        statuses.append(route.status)
        touched.append(route.stats.nodes)
    told = {"arm": kind, "what": f"{SIDE:,} × {SIDE:,} cells", "contender": f"cspace {planner}"}
    told |= {"version": cs.__version__, "built_ms": 1e3 * built, "bytes_per_cell": locked / SIDE**2}
    told |= {
        "first_ms": 1e3 * spent[0],
        "ms": 1e3 * float(np.median(spent[1:])),
        "worst_ms": 1e3 * max(spent[1:]),
    }
    told |= {"kept_bytes_per_cell": (memory() - before) / SIDE**2}
    told |= {"peak_bytes_per_cell": (memory("VmHWM") - before) / SIDE**2}
    return told | {"found": statuses.count("found"), "asked": len(asked), "nodes": int(np.median(touched))}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--one", nargs=2, metavar=("MAP", "PLANNER"))
    parser.add_argument("--patience", type=float, default=300.0)
    options = parser.parse_args()
    if options.one:
        print(json.dumps(one(*options.one)))
        return
    busy, rows = run.load(), []
    for kind in KINDS:
        for planner in PLANNERS:
            command = [sys.executable, __file__, "--one", kind, planner]
            row: dict[str, Any] = {"arm": kind, "contender": f"cspace {planner}"}
            try:
                done = subprocess.run(command, capture_output=True, text=True, timeout=options.patience)
                row |= json.loads(done.stdout) if done.returncode == 0 else {"failed": done.stderr[-300:]}
            except subprocess.TimeoutExpired:
                row |= {"failed": f"no answer within {options.patience:g} s"}
            rows.append(row)
            print(json.dumps(row), flush=True)
    turns.write("navigation_large", rows, busy)


if __name__ == "__main__":
    main()
