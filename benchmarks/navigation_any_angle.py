"""Shortest paths at any angle over grids, by Polyanya: time of a call, and every line against what is known.

Usage: python benchmarks/navigation_any_angle.py [--rounds 3]. The exact lengths are those of
$CSPACE_DATA/navigation/mesh. No package for Python offers an any-angle search that is exact, so nobody stands
beside it. Writes benchmarks/results/navigation_any_angle.json.
"""

from __future__ import annotations

import argparse
import time
from typing import Any

import numpy as np

import cspace as cs
import run
import turns
import worlds
from turns import Question

MAPS = ("arena", "brc202d", "AcrosstheCape")
PRINTED = ((1000.0, 6e-10), (np.inf, 6e-9))
"""Up to which length [m] a file is true to how much."""


def asked(name: str) -> tuple[Question, float]:
    """All lines of a map, and how long what is kept with the map took to make [ms]."""
    grid, lines = worlds.grid(name), worlds.lines(name)
    ends = [  # Polyanya's authors read a line's cells as the corners of cells
        (tuple(map(float, a)), tuple(map(float, b))) for a, b in zip(lines.start, lines.goal, strict=True)
    ]

    def step(line: Any) -> Any:
        return cs.navigate(grid, line[0], line[1], planner="any_angle")

    begin = time.process_time()
    step(ends[0])
    made = 1e3 * (time.process_time() - begin)
    true = np.loadtxt(worlds.DATA / f"mesh/anyangle_{name}.txt")
    off = np.abs(np.array([step(line).length for line in ends]) - true)
    digits = np.select([true < below for below, _ in PRINTED], [digit for _, digit in PRINTED])
    judged = {"lines": len(true), "wrong": int((off > digits).sum()), "off": float(off.max())}
    question = Question(name, "any angle", "cspace any_angle", cs.__version__, step, ends, judged=judged)
    return question, made


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--rounds", type=int, default=3)
    options = parser.parse_args()
    busy, rows = run.load(), []
    for name in MAPS:
        question, made = asked(name)
        [row] = turns.every_input([question], options.rounds)
        rows.append(row | {"made_ms": made})
    turns.write("navigation_any_angle", rows, busy)


if __name__ == "__main__":
    main()
