"""The parts of the page on navigation."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from further_tables import date, table

Measured = dict[str, Any]
TIMES = ("median", "p95", "p99")


def name_of(row: Measured) -> str:
    """Ours in bold."""
    label = f"{row['contender']} {row['version']}"
    return f"**cspace** {label.removeprefix('cspace ')}" if label.startswith("cspace") else label


def listed(measured: Measured, head: list[str], cells: Callable[[Measured], list[str]]) -> str:
    """The rows of a file in ms, and more columns."""
    if not measured:
        return "Not measured."
    columns = ["world", "asked", "contender", *(f"{key} [ms]" for key in TIMES), *head]
    body = []
    for row in measured["rows"]:
        times = [f"{row['time'][key] / 1000:.3g}" for key in TIMES]
        body.append([row["arm"], row["what"], name_of(row), *times, *cells(row)])
    return f"{date(measured)}\n\n{table(columns, body)}"


def grids(results: Measured) -> str:
    def cells(row: Measured) -> list[str]:
        off = row["judged"].get("off")
        return ["—" if off is None else f"{off:.0e}"]

    return listed(results["navigation_grid"], ["off the file"], cells)


def any_angle(results: Measured) -> str:
    def cells(row: Measured) -> list[str]:
        judged = row["judged"]
        return [f"{judged['wrong']} of {judged['lines']:,}", f"{row['made_ms']:.0f}"]

    return listed(results["navigation_any_angle"], ["lines wrong", "first call [ms]"], cells)


def polygons(results: Measured) -> str:
    def cells(row: Measured) -> list[str]:
        build = row["build_ms"]
        judged = row["judged"]
        built = f"{build['median']:.3g}" if build else "—"
        return [built, f"{judged['longer']} / {judged['shorter']}"]

    return listed(results["navigation_polygons"], ["built in [ms]", "longer / shorter"], cells)


def fields(results: Measured) -> str:
    def cells(row: Measured) -> list[str]:
        return ["; ".join(f"{key}: {value}" for key, value in row["judged"].items()) or "—"]

    return listed(results["navigation_fields"], ["how it ended"], cells)


def sampling(results: Measured) -> str:
    def cells(row: Measured) -> list[str]:
        judged = row["judged"]
        shares = [f"{100 * judged['arrived']:.0f} %", f"{judged['ratio']:.3f}", f"{judged['ratio_p95']:.3f}"]
        return [*shares, f"{100 * judged['enters']:.0f} %"]

    head = ["arrived", "length / shortest, median", "p95", "paths through obstacles"]
    return listed(results["navigation_sampling"], head, cells)


def bugs(results: Measured) -> str:
    measured = results["navigation_bugs"]
    if not measured:
        return "Not measured."
    keys = ["calls_median_us", "calls_p95_us", "core_median_us", "core_p95_us"]
    body = []
    for row in measured["rows"]:
        times = [f"{row[key]:.3g}" for key in keys]
        counts = [str(row[key]) for key in ("false_verdicts", "broken_bounds")]
        words = [row["family"].replace("_", " "), row["planner"], f"{row['worlds']:,}"]
        body.append([*words, *times, *counts, f"{row['mean_length_over_distance']:.2f}"])
    head = ["worlds", "planner", "number", "call [µs]", "p95", "compiled part [µs]", "p95", "false"]
    return table([*head, "bounds broken", "length / distance"], body)


def curves(results: Measured) -> str:
    rows = results["navigation_curves"]
    if not rows:
        return "Not measured."
    body = []
    for row in rows:
        batch = f"{row['batch_ns'] / 1000:.2f}" if row["batch_ns"] else "—"
        name = "**cspace**" if row["contender"] == "cspace" else row["contender"]
        counts = [f"{row[key]:,}" for key in ("questions", "longer", "shorter")]
        body.append([row["curve"].replace("_", "–"), name, f"{row['ns'] / 1000:.2f}", batch, *counts])
    head = ["curve", "contender", "call [µs]", "in a batch [µs]", "pairs of poses", "longer than ours"]
    return table([*head, "shorter"], body)


def large(results: Measured) -> str:
    measured = results["navigation_large"]
    if not measured:
        return "Not measured."
    body = []
    for row in measured["rows"]:
        planner = row["contender"].removeprefix("cspace ")
        if "failed" in row:
            why = row["failed"].splitlines()[-1] if row["failed"] else "failed"
            body.append([row["arm"], planner, why, *["—"] * 7])
            continue
        times = [f"{row[key]:.3g}" for key in ("built_ms", "first_ms", "ms", "worst_ms")]
        keys = ("bytes_per_cell", "kept_bytes_per_cell", "peak_bytes_per_cell")
        found = f"{row['found']} of {row['asked']}"
        body.append(
            [row["arm"], planner, found, *times, *(f"{row[key]:.2f}" for key in keys), f"{row['nodes']:,}"]
        )
    head = ["map", "planner", "found", "map made [ms]", "first call [ms]", "median [ms]", "worst [ms]"]
    head += ["map [bytes per cell]", "kept for queries", "most while asked", "nodes"]
    return f"{date(measured)}\n\n{table(head, body)}"


def degenerate(results: Measured) -> str:
    told = results["navigation_degenerate"]
    if not told:
        return "Not measured."
    words = ("right", "wrong", "raises", "hangs")
    body = [
        ["**cspace**", f"{told['cases']}", f"{told['passed']}", f"{told['cases'] - told['passed']}", "0", "0"]
    ]
    for name, counts in told["peers"].items():
        if name != "asked":
            asked = str(told["peers"]["asked"])
            body.append([name, asked, *(str(counts.get(word, 0)) for word in words)])
    return table(["contender", "cases", *words], body)


def section(results: Measured) -> str:
    """Everything measured of navigation."""
    return f"""Processor time of one call from Python. The contenders alternate on the same queries in one
process, unless noted otherwise. Written by `python benchmarks/navigation.py`. The queries on grids are
scenario lines of N. Sturtevant's maps. Data that a planner stores with a map was computed
before, for all contenders.

### Shortest paths on grids

{grids(results)}

### Any angle

{any_angle(results)}

### Among polygons

The obstacles are disjoint hexagons. "built" is the time from lists of corners to a graph that can be queried.
"longer / shorter" counts paths whose length differs from ours by more than 1e-9 of it.

{polygons(results)}

### Degenerate polygons

The cases of `tests/cases/polygons`: outlines that touch, overlap, repeat themselves or cross, and ends on
walls and in corners. The result of cspace counts as right if six planners are right, which includes reporting
faults. Other libraries were not tested on what they cannot represent: faults, holes of obstacles and, for
pyvisgraph, bounds.

{degenerate(results)}

### Clearance, and descents of a potential

cspace computes exact distances, the label of the nearest piece of wall, the cells of the diagram and its
branches. The table states what the others compute.

{fields(results)}

### Sampling-based planners

The world has 600 corners. OMPL tests states by a Python function, here a look-up in a raster, in its default
steps of a hundredth of the world along a motion. Whether a resulting path is free was tested exactly.

{sampling(results)}

### Without a map

{bugs(results)}

### Maps of 8,000 × 8,000 cells

"rooms" and "scattered" consist of copies of a map side by side, and "coast" is an enlarged map. Bytes are the
resident memory divided by the number of cells, without the array from which the map was made.

{large(results)}

### Curves for cars

{curves(results)}"""
