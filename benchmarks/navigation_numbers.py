"""The rows on navigation of the table of what must hold."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from rows import Row, row

Results = dict[str, Any]
EXACT, COSTS = "shortest way by eight moves", "cheapest way over cells of costs 1 … 5"
CELLS = 8000
TOUCHED = 64
"""Bytes that a query may take for each place it touches."""


def entries(results: Results, file: str, **wanted: str) -> list[dict[str, Any]]:
    """The rows of a file that have these values."""
    measured = results[f"navigation_{file}"].get("rows", [])
    return [r for r in measured if all(r.get(key) == value for key, value in wanted.items())]


def median(results: Results, file: str, **wanted: str) -> float | None:
    """Of the time [µs] of the first row that has these values."""
    found = entries(results, file, **wanted)
    return float(found[0]["time"]["median"]) if found else None


def raced(results: Results, arm: str, what: str, planner: str) -> tuple[float, float, str] | None:
    """Our median [µs], that of the best peer, and its name."""
    mine = median(results, "grid", arm=arm, what=what, contender=f"cspace {planner}")
    others = [
        r for r in entries(results, "grid", arm=arm, what=what) if not r["contender"].startswith("cspace")
    ]
    if mine is None or not others:
        return None
    best = min(others, key=lambda r: float(r["time"]["median"]))
    return mine, float(best["time"]["median"]), best["contender"]


def said(race: tuple[float, float, str]) -> str:
    mine, theirs, name = race
    return f"{theirs / mine:.1f}× ({mine / 1000:.3g} against {theirs / 1000:.3g} ms of {name})"


def grid_row(results: Results) -> Row:
    race = raced(results, "brc202d", EXACT, "jump_point_search")
    what = "shortest way over the grid brc202d, median"
    mine, theirs = race[:2] if race else (1e9, 0.0)
    holds, aimed = theirs >= 20 * mine, mine <= 120
    return row(what, "≥ 20× the better peer", "≤ 0.12 ms", said(race) if race else "", holds, aimed)


def bad_row(results: Results) -> Row:
    jump = raced(results, "random-400-33", EXACT, "jump_point_search")
    maps = sorted({r["arm"] for r in entries(results, "grid")})
    costly = {name: raced(results, name, COSTS, "a_star") for name in maps}
    texts = [f"random-400-33 {said(jump)}"] if jump else []
    texts += [f"A\\* on costs, {name} {said(race)}" for name, race in costly.items() if race]
    holds = bool(jump) and jump[1] >= 2 * jump[0]
    holds &= all(theirs >= mine for mine, theirs, _ in filter(None, costly.values()))
    what = "jump points' bad case; plain A\\* on costs"
    return row(what, "≥ 2×; not slower", "", "; ".join(texts), holds)


def arena_row(results: Results) -> Row:
    race = raced(results, "arena", EXACT, "jump_point_search")
    text = f"{race[0]:.1f} against {race[1]:.1f} µs of {race[2]}" if race else ""
    return row("arena, one Python call", "≤ 6 µs", "", text, (race or (9.0,))[0] <= 6)


def exact_row(results: Results) -> Row:
    found = entries(results, "exact")
    lines = sum(r["lines"] for r in found)
    asked = [r[name] for r in found for name in ("jump_point_search", "a_star", "dijkstra")]
    differs, printed = (sum(a[key] for a in asked) for key in ("differs", "not_as_printed"))
    oracle = next((r["oracle"] for r in found if r["oracle"]), None)
    against = f"{differs} differ from {oracle}'s A\\* in whole numbers of steps, " if oracle else ""
    text = f"{lines:,} lines of {len(found)} maps: {against}{printed} from the files" if found else ""
    holds = len(found) >= 10 and differs == printed == 0 and oracle is not None
    return row("every scenario line of every map", "exact, and as printed", "", text, holds)


def any_angle_row(results: Results) -> Row:
    times = {r["arm"]: float(r["time"]["median"]) for r in entries(results, "any_angle")}
    judged = [r["judged"] for r in entries(results, "any_angle")]
    wrong, lines = (sum(j[key] for j in judged) for key in ("wrong", "lines"))
    wide, small = times.get("brc202d", 1e9), times.get("arena", 1e9)
    text = f"{wide / 1000:.3f} ms / {small:.1f} µs, {wrong} of {lines:,} lines wrong" if judged else ""
    what = "shortest path at any angle, brc202d / arena, median"
    holds = wide <= 350 and small <= 4 and not wrong
    return row(what, "≤ 0.35 ms / 4 µs, exact on every line", "≤ 0.25 ms", text, holds, wide <= 250)


def visibility_row(results: Results) -> Row:
    texts, builds, queries = [], [], []
    for corners in (600, 1200):
        found = entries(results, "polygons", arm=f"{corners} corners")
        mine = [r for r in found if r["contender"] == "cspace visibility_graph"]
        for r in mine:
            builds.append(r["build_ms"]["median"])
            queries.append(r["time"]["median"] / 1000)
            peers = [
                f"{p['contender']} {p['build_ms']['median'] / 1e3:.1f} s, {p['time']['median'] / 1000:.0f} ms"
                for p in found
                if p is not r and p["build_ms"]
            ]
            beside = f" ({', '.join(peers)})" if peers else ""
            texts.append(f"{corners}: {builds[-1]:.1f} ms and {queries[-1]:.3f} ms{beside}")
    done = len(builds) == 2
    holds = done and builds[0] <= 20 and builds[1] <= 50 and max(queries) <= 0.3
    aimed = done and builds[0] <= 15 and builds[1] <= 35 and max(queries) <= 0.15
    what = "visibility graph of 600 / 1,200 corners, built from polygons; a query"
    return row(what, "≤ 20 / 50 ms; ≤ 0.3 ms", "≤ 15 / 35 ms; 0.15 ms", "; ".join(texts), holds, aimed)


def brushfire_row(results: Results) -> Row:
    found = entries(results, "fields", arm="brc202d")
    texts = [f"{r['contender']} {r['time']['median'] / 1000:.1f} ms ({r['what']})" for r in found]
    mine = median(results, "fields", arm="brc202d", contender="cspace brushfire")
    return row(
        "brushfire, brc202d", "≤ 12 ms with labels and graph", "", "; ".join(texts), (mine or 1e9) <= 12e3
    )


def bugs_row(results: Results) -> Row:
    found = [r for r in entries(results, "bugs") if r["planner"] in ("bug_1", "bug_2")]
    worlds = {name: sum(r["worlds"] for r in found if r["planner"] == name) for name in ("bug_1", "bug_2")}
    false, broken = (sum(r[key] for r in found) for key in ("false_verdicts", "broken_bounds"))
    times = [
        f"{r['family'].replace('_', ' ')} {r['calls_median_us']:.0f} µs"
        for r in sorted(found, key=lambda r: -float(r["calls_median_us"]))[:3]
    ]
    text = f"{false} false, {broken} bounds broken; slowest {', '.join(times)}" if found else ""
    holds = min(worlds.values()) >= 10_000 and not false and not broken
    aimed = all(r["calls_median_us"] <= 50 for r in found)
    what = "Bug 1 / Bug 2 on 10,000 random and adversarial worlds, median of a family"
    return row(what, "0 false verdicts, no bound broken", "≤ 50 µs each", text, holds, aimed)


def potential_row(results: Results) -> Row:
    found = entries(results, "fields", what="descent")
    texts = [
        f"{r['arm']} {r['time']['median']:.0f} µs, 99 of 100 in {r['time']['p99']:.0f} µs" for r in found
    ]
    bad = sum(r["judged"]["unclassified"] + r["judged"]["false"] for r in found)
    text = f"{'; '.join(texts)}; {bad} stops unclassified or false" if found else ""
    holds = bad == 0 and all(r["time"]["p99"] <= 5000 for r in found)
    return row("potential field", "≤ 5 ms, every stop classified", "", text, holds)


def degenerate_row(results: Results) -> Row:
    told = results["navigation_degenerate"]
    cases, passed = told.get("cases", 0), told.get("passed", 0)
    peers = told.get("peers", {})
    beside = [
        f"{name} {n.get('right', 0)} of {peers['asked']}" for name, n in peers.items() if name != "asked"
    ]
    text = "; ".join([f"{passed} of {cases}", *beside]) if cases else ""
    return row("suite of degenerate polygons", "100 % of 200", "", text, passed == cases >= 200)


def large_row(results: Results) -> Row:
    texts, holds = [], True
    for r in entries(results, "large"):
        planner = r["contender"].removeprefix("cspace ")
        if "failed" in r:
            texts.append(
                f"{r['arm']}, {planner}: {r['failed'].splitlines()[-1] if r['failed'] else 'failed'}"
            )
            holds = False
            continue
        touched = TOUCHED * r["nodes"] / CELLS**2
        holds &= r["bytes_per_cell"] <= 1 and r["kept_bytes_per_cell"] <= 1 + touched
        holds &= r["found"] == r["asked"]
        sizes = f"{r['bytes_per_cell']:.2f} bytes per cell, {r['kept_bytes_per_cell']:.2f} kept after queries"
        texts.append(f"{r['arm']}, {planner}: {sizes}, {r['ms']:.0f} ms")
    what = f"maps of {CELLS:,} × {CELLS:,} cells: the map, what a query leaves behind, its time"
    return row(what, "answers; ≤ 1 byte per cell, and what a query touches", "", "; ".join(texts), holds)


ROWS: list[Callable[[Results], Row]] = [
    grid_row,
    bad_row,
    arena_row,
    exact_row,
    any_angle_row,
    visibility_row,
    brushfire_row,
    bugs_row,
    potential_row,
    degenerate_row,
    large_row,
]
