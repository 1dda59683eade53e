"""Every scenario line of every map: exact lengths against the files, and against the compiled A* of others.

Usage: python benchmarks/navigation_exact.py [map …]. A way is so many straight and so many diagonal steps, so
lengths are compared as pairs of whole numbers. Writes benchmarks/results/navigation_exact.json.
"""

from __future__ import annotations

import argparse
import importlib.util
from typing import Any

import numpy as np

import cspace as cs
import navigation_grid
import run
import turns
import worlds
from chains import Array

PLANNERS = ("jump_point_search", "a_star", "dijkstra")
FEW = {"a_star": 200, "dijkstra": 40}
"""Lines of a map that slower searches are asked for."""
SINGLE = 2.0**-23
"""Files are printed from sums of single precision."""


def steps(path: Array) -> tuple[int, int]:
    """Straight and diagonal steps of a way (k, 2) in whole or half cells."""
    moves = np.abs(np.diff(path, axis=0))
    diagonal = moves.min(axis=1).sum()
    return round(float(moves.max(axis=1).sum() - diagonal)), round(float(diagonal))


def judged(name: str) -> dict[str, Any]:
    """One map: lines, and how many of them go wrong by planner."""
    grid, lines = worlds.grid(name), worlds.lines(name)
    ends, printed = worlds.centres(lines), told(name)
    row: dict[str, Any] = {"arm": name, "lines": len(ends)}
    truth = [(0, 0)] * len(ends)
    if importlib.util.find_spec("w9_pathfinding"):
        from peers import w9_

        prepare, step, read = w9_.ways(grid.blocked)
        for k, (a, b) in enumerate(zip(lines.start, lines.goal, strict=True)):
            truth[k] = steps(read(step(prepare(a[::-1], b[::-1]))).astype(float))
    for planner in PLANNERS:
        chosen = np.arange(len(ends))
        if planner in FEW:
            chosen = np.linspace(0, len(ends) - 1, min(FEW[planner], len(ends))).astype(int)
        differs = off = 0
        for k in chosen:
            route = cs.navigate(grid, *ends[k], planner=planner)
            differs += truth[k] != (0, 0) and steps(route.path) != truth[k]
            off += abs(route.length - printed[k][0]) > printed[k][1]
        row[planner] = {"asked": len(chosen), "differs": int(differs), "not_as_printed": int(off)}
    row["oracle"] = w9_.NAME if any(pair != (0, 0) for pair in truth) else None
    return row


def told(name: str) -> list[tuple[float, float]]:
    """What a file prints of each line: the length, and half of the last of its digits: six, or
    more where they are written."""
    text = (worlds.FOLDER / f"{name}.map.scen").read_text().splitlines()[1:]
    found = []
    for length in (line.split()[8] for line in text if line.strip()):
        whole, _, decimals = length.partition(".")
        found.append(
            (float(length), 0.5 * 10.0 ** -max(len(decimals), 6 - len(whole)) + float(length) * SINGLE)
        )
    return found


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("maps", nargs="*", default=navigation_grid.MAPS)
    options = parser.parse_args()
    busy, rows = run.load(), []
    for name in options.maps:
        rows.append(judged(name))
        print(rows[-1], flush=True)
    turns.write("navigation_exact", rows, busy)


if __name__ == "__main__":
    main()
