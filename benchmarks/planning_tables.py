"""The parts of the page on collision and planning of arms, and its lines of what must hold."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from further_tables import table
from rows import Row, row

Results = dict[str, Any]
ROBOTS = {"panda": "Panda", "ur5": "UR5", "fetch": "Fetch"}
NAMES = {
    "rrt_connect": "RRT-Connect",
    "rrt": "RRT",
    "rrt_star": r"RRT\*",
    "informed_rrt_star": r"informed RRT\*",
    "aorrtc": "AORRTC",
    "prm": "PRM",
    "lazy_prm": "lazy PRM",
    "prm_star": r"PRM\*",
}


def name_of(key: str) -> str:
    """The name of a planner with a number behind it."""
    planner, _, number = key.partition(" ")
    return f"{NAMES.get(planner, planner)} {number}".strip()


def plans(measured: Results) -> str:
    """RRT-Connect, plans and AORRTC beside VAMP."""
    head = ["robot", "planner", "solved", "median [µs]", "mean", "p95", "worst", "median cost"]
    body = []
    for robot, title in ROBOTS.items():
        if robot not in measured:
            continue
        part = measured[robot]
        peer = part.get("vamp", {})
        lines = [
            (
                "**cspace** RRT-Connect at samples, not simplified",
                part["rrt_connect"],
                part["rrt_connect"]["cost"],
            ),
            ("VAMP RRT-Connect", peer.get("rrt_connect"), peer.get("raw_cost")),
            ("**cspace** simplified, every edge proved", part["plan"], part["plan"]["cost"]),
            ("VAMP simplified", peer.get("plan"), peer.get("cost")),
            (f"**cspace** AORRTC, {measured['improve']} motions", part["aorrtc"], part["aorrtc"]["cost"]),
            ("**cspace** `cs.plan` in a new scene, wall", part["wall"], part["plan"]["cost"]),
        ]
        for label, times, cost in lines:
            if times:
                solved = times.get("solved", peer.get("solved"))
                numbers = [f"{times[key]:.0f}" for key in ("median", "mean", "p95", "worst")]
                body.append([title, label, f"{solved} of {part['valid']}", *numbers, f"{cost['median']:.2f}"])
    return table(head, body)


def trees(measured: Results) -> str:
    """Planners of one tree beside those of two."""
    head = [
        "planner and motions after the first path",
        "solved",
        "mean time [ms]",
        "median cost",
        "mean cost",
    ]
    part = measured["panda"]
    body = [
        [
            name_of(key),
            f"{each['solved']} of {part['problems']}",
            f"{each['mean_ms']:.3g}",
            f"{each['cost']['median']:.2f}",
            f"{each['cost']['mean']:.2f}",
        ]
        for key, each in part["planners"].items()
    ]
    return table(head, body)


def roadmaps(measured: Results) -> str:
    """Roadmaps beside RRT-Connect."""
    head = [
        "robot",
        "planner and samples",
        "solved",
        "new scene, median [µs]",
        "mean",
        "again, median [µs]",
        "mean",
    ]
    body = []
    for robot, title in ROBOTS.items():
        part = measured.get(robot, {})
        for key, each in part.get("planners", {}).items():
            times = [f"{each[when][what]:.0f}" for when in ("cold", "warm") for what in ("median", "mean")]
            body.append([title, name_of(key), f"{each['solved']} of {part['problems']}", *times])
    return table(head, body)


def fields(measured: Results) -> str:
    """Searches on grids, with and without a potential."""
    head = ["arm", "search", "solved", "mean cost ratio", "worst", "median expansions", "median [ms]"]
    body = []
    for arm in ("planar_2r", "planar_3r"):
        searches = measured[arm]["searches"]
        for key, each in searches.items():
            if isinstance(each, dict):
                numbers = [f"{each['mean_ratio']:.3f}", f"{each['worst_ratio']:.3f}"]
                solved = f"{searches['solved']} of {searches['problems']}"
                more = [f"{each['expansions']:.0f}", f"{each['median_ms']:.3g}"]
                body.append([arm, key.replace("*", r"\*"), solved, *numbers, *more])
    return table(head, body)


PARTS: list[tuple[str, str, str, Callable[[Results], str]]] = [
    (
        "Plans of arms beside VAMP",
        "planning",
        "MotionBenchMaker problems (Chamzas et al. 2022) with published spheres; processor time, but for the"
        " lines that say wall. VAMP is compiled for each robot; cspace reads the robot when it runs.",
        plans,
    ),
    (
        "One tree and two",
        "planning_trees",
        "60 Panda problems. Costs are those of the problems that all solved.",
        trees,
    ),
    ("Roadmaps", "planning_roadmaps", "One roadmap for all scenes of 60 problems.", roadmaps),
    (
        "Grids and potentials",
        "planning_fields",
        "Random problems of planar arms whose straight motion is blocked; reference: Dijkstra's search.",
        fields,
    ),
]


def section(results: Results) -> str:
    """All parts, those that were not measured with a word."""
    texts = []
    for title, name, about, build in PARTS:
        body = build(results[name]) if results[name] else "Not measured."
        texts.append(f"### {title}\n\n{about}\n\n{body}")
    return "\n\n".join(texts)


def mean_ratio(measured: Results, robots: list[str], ours: str, theirs: str, what: str) -> float:
    """The geometric mean of our times over the peer's."""
    ratios = [measured[k][ours][what] / measured[k]["vamp"][theirs][what] for k in robots]
    return float(np.exp(np.mean(np.log(ratios))))


def search_row(results: Results) -> Row:
    what, must, aim = (
        "RRT-Connect, median / mean and p95 against VAMP from C++",
        "≤ 0.75× / ≤ 0.8×",
        "0.6× / 0.7×",
    )
    measured = results["planning"]
    if not measured or "vamp" not in measured["panda"]:
        return row(what, must, aim, "", None)
    ratios = [
        mean_ratio(measured, list(ROBOTS), "rrt_connect", "rrt_connect", k) for k in ("median", "mean", "p95")
    ]
    holds = ratios[0] <= 0.75 and max(ratios[1:]) <= 0.8
    text = "{:.2f}× / {:.2f}×, {:.2f}×, called from Python".format(*ratios)
    return row(what, must, aim, text, holds, ratios[0] <= 0.6 and max(ratios[1:]) <= 0.7)


def plan_row(results: Results) -> Row:
    what = (
        "plan, simplified and proved, against VAMP's unproved, Panda and UR5: from Python / wall, new scene"
    )
    must, aim = "≤ 0.67× of VAMP in C++ / ≥ 5× faster than VAMP in Python (652 µs)", "0.45× / 7×"
    measured = results["planning"]
    if not measured or "vamp" not in measured["panda"]:
        return row(what, must, aim, "", None)
    ratio = mean_ratio(measured, ["panda", "ur5"], "plan", "plan", "median")
    faster = 652.0 / measured["panda"]["wall"]["median"]
    dearer = max(
        measured[k]["plan"]["cost"]["median"] / measured[k]["vamp"]["cost"]["median"]
        for k in ("panda", "ur5")
    )
    text = f"{ratio:.2f}×, median cost {dearer:.2f}× / {faster:.1f}×"
    holds = ratio <= 0.67 and faster >= 5 and dearer <= 1
    return row(what, must, aim, text, holds, ratio <= 0.45 and faster >= 7)


def solved_row(results: Results) -> Row:
    what, must, aim = "solved of valid: Panda, UR5 / Fetch", "all / ≥ 99.5 %", "all"
    measured = results["planning"]
    if not measured:
        return row(what, must, aim, "", None)
    counts = {k: (measured[k]["plan"]["solved"], measured[k]["valid"]) for k in ROBOTS}
    text = ", ".join(f"{solved} of {valid}" for solved, valid in counts.values())
    small = all(counts[k][0] == counts[k][1] for k in ("panda", "ur5"))
    holds = small and counts["fetch"][0] >= 0.995 * counts["fetch"][1]
    return row(what, must, aim, text, holds, holds and counts["fetch"][0] == counts["fetch"][1])


def check_row(results: Results) -> Row:
    what, must, aim = "one check from Python, Panda; batch on one core", "≤ 0.6 µs; ≥ 6 M/s", "10 M/s"
    measured = results["planning"]
    if not measured:
        return row(what, must, aim, "", None)
    checks = [measured[k]["checks"] for k in ROBOTS]
    singles = " / ".join(f"{c.get('one_random_us', c['one_us']):.2f}" for c in checks)
    batches = " / ".join(f"{c['rows_per_second'] / 1e6:.1f}" for c in checks)
    first = checks[0]
    holds = first.get("one_random_us", first["one_us"]) <= 0.6 and first["rows_per_second"] >= 6e6
    text = f"{singles} µs; {batches} M/s (Panda / UR5 / Fetch)"
    return row(what, must, aim, text, holds, first["rows_per_second"] >= 10e6)


def proof_row(results: Results) -> Row:
    what = "verdicts that differ from VAMP beyond 5 µm / edges undecided of 10⁴ / proved edges that touch"
    must = "0 / ≤ 5 / 0"
    measured = results["planning_proofs"]
    if not measured:
        return row(what, must, "", "", None)
    parts = [measured[k] for k in ROBOTS]
    beyond = sum(part["verdicts"]["outside_band"] for part in parts)
    rates = [1e4 * part["edges"]["undecided"] / part["edges"]["edges"] for part in parts]
    touch, judged = (sum(part["edges"][k] for part in parts) for k in ("touch", "judged"))
    text = f"{beyond} / {max(rates):.1f} / {touch} of {judged} judged"
    return row(what, must, "", text, beyond == 0 and max(rates) <= 5 and touch == 0)


def goal_row(results: Results) -> Row:
    what = "pose goal against one configuration, worst of Panda, UR5: median time / cost / solved"
    must, aim = "≤ 1.3× / ≤ 0.95× / not fewer", "1.1× / 0.9×"
    measured = results["planning_goals"]
    if not measured:
        return row(what, must, aim, "", None)
    parts = [measured[k] for k in ("panda", "ur5")]
    time, cost = (max(part["ratios"][k] for part in parts) for k in ("median_us", "median_cost"))
    fewer = sum(part["configuration"]["solved"] - part["pose"]["solved"] for part in parts)
    text = f"{time:.2f}× / {cost:.2f}× / {fewer} fewer"
    return row(
        what, must, aim, text, time <= 1.3 and cost <= 0.95 and fewer <= 0, time <= 1.1 and cost <= 0.9
    )


ROWS = [search_row, plan_row, solved_row, check_row, proof_row, goal_row]
