"""The tables on docs/planning.md, from the results of the benchmarks; tools/pages.py writes them."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

from further_tables import table
from planning_tables import NAMES, ROBOTS

Results = dict[str, Any]
FOLDER = Path(__file__).resolve().parent / "results"
SEARCHES = {
    "Dijkstra": "Dijkstra",
    "breadth first": "breadth first",
    "A*": r"A\*, distance",
    "A*, potential, w = 1.5": r"A\*, potential, $w = 1.5$",
    "best first, distance": "best first, distance",
    "best first, potential": "best first, potential",
}
BUDGETS = (1000, 5000, 20000)
TREES = ("rrt_connect", "rrt", "rrt_star", "informed_rrt_star", "aorrtc")
ROADMAPS = ("lazy_prm 1000", "lazy_prm 4000", "lazy_prm 10000", "prm_star 10000", "prm 4000")


def times(part: Results) -> str:
    """Median, mean and 95th percentile [µs]."""
    return " / ".join(f"{part[key]:.0f}" for key in ("median", "mean", "p95"))


def plans(measured: Results) -> str:
    """Plans of three robots beside VAMP."""

    def solved(part: Results) -> str:
        return f"{part['plan']['solved']}, {part['vamp']['solved']} of {part['valid']}"

    def costs(part: Results) -> str:
        return f"{part['plan']['cost']['median']:.2f}, {part['vamp']['cost']['median']:.2f}"

    def improved(part: Results) -> str:
        return f"{part['aorrtc']['cost']['median']:.2f}, {part['aorrtc']['median'] / 1000:.1f}"

    rows: dict[str, Callable[[Results], str]] = {
        "solved of valid, ours and VAMP": solved,
        "search alone, sampled, ours": lambda part: times(part["rrt_connect"]),
        "search alone, VAMP": lambda part: times(part["vamp"]["rrt_connect"]),
        "whole plan, every motion proved, ours": lambda part: times(part["plan"]),
        "search and simplification, VAMP": lambda part: times(part["vamp"]["plan"]),
        "`cs.plan` in a new scene, wall": lambda part: times(part["wall"]),
        "median cost, ours and VAMP": costs,
        f"AORRTC with `improve={measured['improve']}`: median cost, time in ms": improved,
    }
    return table(
        ["", *ROBOTS.values()],
        [[name, *(cell(measured[robot]) for robot in ROBOTS)] for name, cell in rows.items()],
    )


def goals(measured: Results) -> str:
    """Goals that are poses beside the configurations of the problems."""
    ratios = {"median_us": "median time", "mean_us": "mean time", "median_cost": "median cost"}
    parts = [measured[robot] for robot in ROBOTS]
    solved = [f"{p['pose']['solved']}, {p['configuration']['solved']} of {p['valid']}" for p in parts]
    return table(
        ["", *ROBOTS.values()],
        [
            ["solved of valid, pose and configuration", *solved],
            *(
                [f"{name}, pose over configuration", *(f"{part['ratios'][key]:.2f}" for part in parts)]
                for key, name in ratios.items()
            ),
        ],
    )


def trees(measured: Results) -> str:
    """One tree beside two, at equal numbers of motions after the first path."""
    planners = measured["panda"]["planners"]
    body = []
    for name in TREES:
        budgets = [] if name in planners else BUDGETS
        found = [planners[f"{name} {budget}"] for budget in budgets] or [planners[name]]
        cells = [
            ", ".join(map(str, budgets)),
            *(", ".join(f"{each['cost'][what]:.2f}" for each in found) for what in ("median", "mean")),
            ", ".join(f"{each['mean_ms']:.2g}" for each in found),
        ]
        body.append([NAMES[name], str(found[-1]["solved"]), *cells])
    return table(["", "solved", "`improve=`", "median cost", "mean cost", "mean time in ms"], body)


def roadmaps(measured: Results) -> str:
    """Roadmaps beside RRT-Connect, on the problems of the Panda."""
    part = measured["panda"]
    planners, building = part["planners"], part["building"]

    def pair(each: Results, when: str) -> str:
        return f"{each[when]['median']:.0f} / {each[when]['mean']:.0f}"

    trees_alone = planners["rrt_connect"]
    body = [
        ["RRT-Connect", f"{trees_alone['solved']} of {part['problems']}", pair(trees_alone, "cold"), "", ""]
    ]
    for name in ROADMAPS:
        planner, _, samples = name.partition(" ")
        each, made = planners[name], building.get(name, building[f"lazy_prm {samples}"])
        body.append(
            [
                f"`{planner}`, {int(samples):,} samples",
                f"{each['solved']}",
                pair(each, "cold"),
                pair(each, "warm"),
                f"{made['seconds']:.2f}",
            ]
        )
    return table(["", "solved", "new scene", "again", "made in [s]"], body)


def searches(measured: Results) -> str:
    """Searches on grids by the distance and by a potential."""
    parts = [measured[arm]["searches"] for arm in ("planar_2r", "planar_3r")]

    def cells(each: Results) -> list[str]:
        ratios = each["mean_ratio"], each["worst_ratio"]
        exact = max(ratios) < 1.0 + 1e-6
        return ["1, 1" if exact else "{:.2f}, {:.2f}".format(*ratios), f"{each['expansions']:.0f}"]

    head = ["search", "two joints: cost", "expansions", "three joints: cost", "expansions"]
    body = [
        [title, *(cell for part in parts for cell in cells(part[name]))] for name, title in SEARCHES.items()
    ]
    return table(head, body)


PARTS: dict[str, tuple[str, Callable[[Results], str]]] = {
    "measured: plans": ("planning", plans),
    "measured: goals": ("planning_goals", goals),
    "measured: trees": ("planning_trees", trees),
    "measured: roadmaps": ("planning_roadmaps", roadmaps),
    "measured: searches": ("planning_fields", searches),
}


def parts() -> dict[str, str]:
    """The tables by the markers on the page."""
    return {
        marker: build(json.loads((FOLDER / f"{name}.json").read_text(encoding="utf-8")))
        for marker, (name, build) in PARTS.items()
    }
