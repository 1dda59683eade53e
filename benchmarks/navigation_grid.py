"""Ways over grids: the benchmark maps of N. Sturtevant, the same scenario lines for every contender.

Usage: python benchmarks/navigation_grid.py [--rounds 5] [--lines 100] [map …]. Reads the maps from
$CSPACE_DATA/navigation/grid and writes benchmarks/results/navigation_grid.json.
"""

from __future__ import annotations

import argparse
import importlib.metadata
import importlib.util
from collections.abc import Iterator
from typing import Any

import numpy as np

import cspace as cs
import run
import turns
import worlds
from chains import Array
from turns import Question

MAPS = ("arena", "brc202d", "den520d", "AcrosstheCape", "Berlin_1_256", "64room_000", "room-400-40")
MAPS += ("random-400-33", "maze-100-1", "maze-400-4")


def length(cells: Array) -> float:
    """Of a way through cells (k, 2), along rows, columns and diagonals."""
    return float(np.hypot(*np.diff(cells, axis=0).T).sum()) if len(cells) > 1 else np.inf


def ours(name: str, what: str, grid: Any, lines: Any, planner: str, costs: Array | None = None) -> Question:
    """One whole call of the package per line."""
    ends = worlds.centres(lines)
    more = {} if costs is None else {"costs": costs}

    def step(line: Any) -> Any:
        return cs.navigate(grid, line[0], line[1], planner=planner, **more)

    judged = {} if costs is not None else worst(lines, [step(line).length for line in ends])
    return Question(name, what, f"cspace {planner}", cs.__version__, step, ends, judged=judged)


def peer(
    name: str, what: str, module: str, lines: Any, made: Any, label: str, judge: bool = True
) -> Question:
    """A peer's own call per line, its input as it likes it."""
    prepare, step, read = made
    inputs = [prepare(a[::-1], b[::-1]) for a, b in zip(lines.start, lines.goal, strict=True)]
    version = importlib.metadata.version(module)
    judged = worst(lines, [length(read(step(line))) for line in inputs]) if judge else {}
    return Question(name, what, label, version, step, inputs, judged=judged)


def worst(lines: Any, lengths: list[float]) -> dict[str, float]:
    """How far lengths are from what the files print, at most, over the length."""
    return {"off": float(np.max(np.abs(np.array(lengths) - lines.length) / np.maximum(lines.length, 1)))}


def questions(name: str, count: int) -> Iterator[Question]:
    """What is asked on one map: exact lengths by eight moves, and the cheapest way where cells have costs."""
    grid, every = worlds.grid(name), worlds.lines(name)
    chosen = np.linspace(0, len(every.length) - 1, min(count, len(every.length))).astype(int)
    lines = type(every)(*(field[chosen] for field in every))
    costs = np.random.default_rng(0).integers(1, 6, grid.shape).astype(float)
    exact, costly = "shortest way by eight moves", "cheapest way over cells of costs 1 … 5"
    for planner in ("jump_point_search", "a_star"):
        yield ours(name, exact, grid, lines, planner)
    yield ours(name, costly, grid, lines, "a_star", costs)
    if importlib.util.find_spec("w9_pathfinding"):
        from peers import w9_

        for search in ("AStar", "BiAStar"):
            made = w9_.ways(grid.blocked, None, search)
            yield peer(name, exact, w9_.PACKAGE, lines, made, f"{w9_.NAME} {search}")
            made = w9_.ways(grid.blocked, costs, search)
            yield peer(name, costly, w9_.PACKAGE, lines, made, f"{w9_.NAME} {search}", judge=False)
    if importlib.util.find_spec("nano_astar"):
        from peers import nano_astar_

        made = nano_astar_.ways(grid.blocked)
        yield peer(name, exact, nano_astar_.PACKAGE, lines, made, nano_astar_.NAME)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--lines", type=int, default=100)
    parser.add_argument("maps", nargs="*", default=MAPS)
    options = parser.parse_args()
    busy = run.load()
    rows = []
    for name in options.maps:
        rows += turns.every_input(list(questions(name, options.lines)), options.rounds)
    turns.write("navigation_grid", rows, busy)


if __name__ == "__main__":
    main()
