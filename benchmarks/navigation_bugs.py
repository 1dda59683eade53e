"""The planners without a map in world families with known answers: time, verdicts, bounds, length.

Usage: python benchmarks/navigation_bugs.py [--worlds 10000]. Writes benchmarks/results/navigation_bugs.json:
for each family and planner the median and 95th percentile of one call through Python and of its compiled
part [µs], false verdicts, broken bounds, and the mean length over the distance from start to goal.
"""

from __future__ import annotations

import argparse
import json
import platform
import time
from math import inf
from pathlib import Path

import numpy as np

import cspace as cs

RESULT = Path(__file__).resolve().parent / "results/navigation_bugs.json"
PLANNERS = [
    ("bug_1", {}),
    ("bug_2", {}),
    ("tangent_bug", {"range": 0.0}),
    ("tangent_bug", {"range": 2.0}),
    ("tangent_bug", {"range": inf}),
    ("voronoi_bug", {"range": 2.0}),
    ("voronoi_bug", {"range": inf}),
]
WARM = 4  # calls before one is measured, and that one
SHARE = 10  # Tangent Bug looks around in one world of so many


def convex_field(rng):
    """100 convex polygons apart from each other; every point between them is reachable."""
    polygons = []
    for k in range(100):
        n, turn, radius = rng.integers(3, 9), rng.uniform(0, 6), rng.uniform(0.2, 0.48)
        angles = turn + 2 * np.pi * np.arange(n) / n
        polygons.append((k % 10 + 0.5, k // 10 + 0.5) + radius * np.c_[np.cos(angles), np.sin(angles)])
    return polygons, (0, 0, 10, 10), (0.01, rng.uniform(0.01, 9.99)), (9.99, rng.uniform(0.01, 9.99)), True


def box(low, high):
    return np.array([low, (high[0], low[1]), high, (low[0], high[1])], dtype=float)


def spiral(rng):
    """Out of a spiral wall of 2 to 10 turns."""
    at, walls, turns = np.zeros(2), [], int(rng.integers(2, 11))
    for leg in range(4 * turns):
        end = at + (2 + 2 * (leg // 2)) * np.array([(1, 0), (0, 1), (-1, 0), (0, -1)])[leg % 4]
        walls.append(box(np.minimum(at, end) - 0.1, np.maximum(at, end) + 0.1))
        at = end
    size = 4.0 * turns + 4
    return walls, (-size, -size, size, size), (1, 1), (rng.uniform(-2, 2), size - 1), True


def cells(blocked, rng):
    """A world of blocked cells, its start and goal the middles of free ones; cells hang together by sides."""
    rows, columns = blocked.shape
    free = np.argwhere(~blocked)
    start, goal = (tuple(map(int, free[k])) for k in rng.integers(len(free), size=2))
    seen, stack = {start}, [start]
    while stack:
        r, c = stack.pop()
        for nr, nc in ((r + 1, c), (r - 1, c), (r, c + 1), (r, c - 1)):
            if 0 <= nr < rows and 0 <= nc < columns and not blocked[nr, nc] and (nr, nc) not in seen:
                seen.add((nr, nc))
                stack.append((nr, nc))
    squares = [box((c, r), (c + 1, r + 1)) for r, c in np.argwhere(blocked)]
    middles = [(c + 0.5, r + 0.5) for r, c in (start, goal)]
    return squares, (0, 0, columns, rows), *middles, goal in seen


def scattered_cells(rng):
    n = int(rng.integers(6, 25))
    return cells(rng.random((n, n)) < rng.uniform(0.1, 0.5), rng)


def comb(rng):
    blocked = np.zeros((12, 21), dtype=bool)
    blocked[1:, 1::4] = blocked[:-1, 3::4] = True
    return cells(blocked, rng)


def nested_rings(rng):
    n = int(rng.integers(7, 20))
    row, column = np.indices((n, n))
    blocked = np.minimum(np.minimum(row, column), n - 1 - np.maximum(row, column)) % 2 == 1
    if rng.random() < 0.6:
        blocked[rng.integers(n)] = False
    return cells(blocked, rng)


FAMILIES = [convex_field, spiral, scattered_cells, comb, nested_rings]


def keeps_bound(route, perimeters):
    """Whether a walk of Bug 1 or Bug 2 is as short as promised; of others nothing is promised."""
    if route.planner not in {"bug_1", "bug_2"}:
        return True
    D, met = float(np.linalg.norm(route.goal - route.start)), route.evidence.rings
    if route.planner == "bug_1":
        return len(set(met)) == len(met) and route.length <= (D + 1.5 * perimeters[met].sum()) * (1 + 1e-12)
    return route.length <= (D + perimeters[met].sum()) * (1 + 1e-12)


def measured(family, count):
    """The rows of a family: one for each planner."""
    rng = np.random.default_rng([FAMILIES.index(family), 1])
    rows = [{"calls": [], "core": [], "ratio": [], "false": 0, "broken": 0} for _ in PLANNERS]
    for number in range(count):
        polygons, bounds, start, goal, reachable = family(rng)
        world = cs.PolygonWorld(polygons, bounds=bounds)
        perimeters = np.array([np.linalg.norm(r - np.roll(r, 1, axis=0), axis=1).sum() for r in world.walls])
        for row, (planner, options) in zip(rows, PLANNERS, strict=True):
            if planner == "tangent_bug" and number % SHARE:
                continue
            for _ in range(WARM):  # the first call sorts the walls into cells
                begin = time.perf_counter()
                route = cs.navigate(world, start, goal, planner=planner, **options)
                passed = time.perf_counter() - begin
            row["calls"].append(1e6 * passed)
            row["core"].append(1e6 * route.stats.seconds)
            row["false"] += bool(route) != reachable or route.status == "undetermined"
            row["broken"] += not keeps_bound(route, perimeters)
            if route and (D := np.linalg.norm(route.goal - route.start)) > 0:
                row["ratio"].append(route.length / D)
    return rows


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("--worlds", type=int, default=10_000)
    count = parser.parse_args().worlds // len(FAMILIES)
    table = []
    for family in FAMILIES:
        for (planner, options), row in zip(PLANNERS, measured(family, count), strict=True):
            name = planner + "".join(f" {key} {value:g}" for key, value in options.items())
            entry = {"family": family.__name__, "planner": name, "worlds": len(row["calls"])}
            for part in ("calls", "core"):
                low, high = np.percentile(row[part], [50, 95])
                entry |= {f"{part}_median_us": round(float(low), 2), f"{part}_p95_us": round(float(high), 2)}
            entry |= {"false_verdicts": int(row["false"]), "broken_bounds": int(row["broken"])}
            table.append(entry | {"mean_length_over_distance": round(float(np.mean(row["ratio"])), 3)})
            print(json.dumps(table[-1]), flush=True)
    machine = {"machine": platform.machine(), "python": platform.python_version(), "cspace": cs.__version__}
    RESULT.write_text(json.dumps({"about": machine, "rows": table}, indent=1) + "\n")


if __name__ == "__main__":
    main()
