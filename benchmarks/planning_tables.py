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


def core(measured: Results) -> str:
    """Searches, simplification and edges in C++ beside VAMP."""
    head = ["robot", "what", "ours: median, mean, p95", "VAMP"]
    body = []
    for robot, title in ROBOTS.items():
        if robot not in measured:
            continue
        ours, peer = measured[robot], measured[robot]["vamp"]
        for label, own, other in (
            ("RRT-Connect, every motion proved [µs]", "rrt_connect", "rrt_connect"),
            ("RRT-Connect at samples [µs]", "at_samples", "rrt_connect"),
            ("with simplification, proved [µs]", "plan", "plan"),
            ("simplification alone [µs]", "simplify", "simplify"),
        ):
            cells = [
                ", ".join(f"{part[k]:.0f}" for k in ("median", "mean", "p95"))
                for part in (ours[own], peer[other])
            ]
            body.append([title, label, *cells])
        for label in ("proved", "sampled"):
            cells = [
                f"{part['free']:.0f}, {part['blocked']:.0f}"
                for part in (ours["edges_ns"][label], ours["edges_ns"]["vamp"])
            ]
            body.append([title, f"{label} edge: free, blocked [ns]", *cells])
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


def proofs(measured: Results) -> str:
    """Edges and paths that were judged."""
    head = ["robot", "what", "judged", "touch", "least clearance seen [µm]"]
    body = []
    for robot, title in ROBOTS.items():
        part = measured[robot]
        edges = {
            f"proved edges, {kind}": each for kind, each in part["judged"].items() if isinstance(each, dict)
        }
        paths = {PATHS[key]: each for key, each in part["paths"].items()}
        for label, each in (edges | paths).items():
            number = each.get("judged", each.get("paths"))
            body.append([title, label, f"{number:,}", str(each["touch"]), f"{1e6 * each['least']:,.1f}"])
    return table(head, body)


PATHS = {
    "plan": "paths, default planner",
    "aorrtc": "paths, AORRTC",
    "pose": "paths to a pose",
    "sampled": "paths of motions checked at samples, not proved",
}


def peers(measured: Results) -> str:
    """OMPL beside plans of ours."""
    head = [
        "checks of OMPL",
        "solved by both",
        "search: OMPL [µs]",
        "ours",
        "ratio",
        "simplified: OMPL [µs]",
        "ours",
    ]
    head += ["ratio", "median cost OMPL / ours", "checks"]
    body = []
    for case, part in measured["cases"].items():
        cells = [case, f"{part['both']} of {part['problems']}"]
        for key in ("search_us", "total_us"):
            each = part[key]
            cells += [f"{each['peer']:,.0f}", f"{each['ours']:.0f}", f"{each['ratio']:.0f}×"]
        costs = part["cost"]
        body.append([*cells, f"{costs['peer']:.2f} / {costs['ours']:.2f}", f"{part['checks']:.0f}"])
    note = measured.get("callback_us")
    words = (
        f"\n\nA check that OMPL calls in Python takes {note:.2g} µs before it checks anything."
        if note
        else ""
    )
    return table(head, body) + words


def covers(measured: Results) -> str:
    """Covers of meshes beside published spheres."""
    head = [
        "Panda",
        "spheres",
        "valid",
        "solved",
        "median [µs]",
        "against published",
        "motions",
        "µs per motion",
    ]
    body = []
    for key, each in measured["panda"].items():
        cells = [
            key,
            str(each["spheres"]),
            str(each["valid"]),
            str(each["solved"]),
            f"{each['us']['median']:.0f}",
        ]
        ratios = [f"{each[name]:.2f}×" for name in ("median_ratio", "motions_ratio", "us_of_a_motion_ratio")]
        body.append([*cells, *ratios])
    return table(head, body)


def unseen(measured: Results) -> str:
    """Arms of the catalogue in random scenes, and other seeds."""
    head = ["arm", "scenes", "found / no way found, random pairs", "found / not, ends of a walk"]
    head += ["median [µs], walk", "paths that touch", "verdicts unlike the judge's"]
    body = []
    for name, part in measured.get("arms", {}).items():
        cells = [name, str(part["scenes"])]
        for kind in ("random", "walk"):
            each = part[kind]
            cells.append(f"{each['ends'].get('found', 0)} / {len(each['open'])}")
        touch = part["random"]["touch"] + part["walk"]["touch"]
        verdicts = part["verdicts"]
        unlike = f"{verdicts['differ']} of {verdicts['rows']:,}, {verdicts['beyond_band']} beyond 5 µm"
        body.append([*cells, f"{part['walk']['us']['median']:.0f}", str(touch), unlike])
    texts = [table(head, body)]
    head = ["arm, thin obstacles", "proved edges", "judged", "touch", "least clearance seen [µm]"]
    body = [
        [name, kind, f"{each['judged']:,}", str(each["touch"]), f"{1e6 * each['least']:,.1f}"]
        for name, part in measured.get("edges", {}).items()
        for kind, each in part.items()
    ]
    texts.append(table(head, body))
    head = [
        "robot",
        "problems",
        "seed",
        "solved",
        "median [µs]",
        "mean",
        "p95",
        "median cost",
        "paths that touch",
    ]
    body = []
    for stage, title in HALVES.items():
        for robot, part in measured.get(stage, {}).items():
            for seed, each in part["seeds"].items():
                times = [f"{each['us'][key]:.0f}" for key in ("median", "mean", "p95")]
                cells = [ROBOTS[robot], title, seed, f"{each['solved']} of {part['valid']}", *times]
                body.append([*cells, f"{each['cost']['median']:.2f}", f"{part['touch']} with all seeds"])
    return "\n\n".join([*texts, table(head, body)])


HALVES = {"seeds": "those measured above", "other half": "the other half of the public set"}


PARTS: list[tuple[str, str, str, Callable[[Results], str]]] = [
    (
        "Plans of arms beside VAMP",
        "planning",
        "MotionBenchMaker problems (Chamzas et al. 2022) with published spheres; processor time, but for the"
        " lines that say wall. VAMP is compiled for each robot; cspace reads the robot when it runs.",
        plans,
    ),
    (
        "The same in C++",
        "planning_core",
        "Without Python, pinned to one core, in turn. On Fetch times are of the problems that both solve.",
        core,
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
    (
        "Proofs and paths, judged",
        "planning_proofs",
        "A judge that shares no code with the package (its own kinematics, double precision) looks at motions"
        " at a hundred times the resolution of samples. Edges: random ones that are proved, and some that"
        " were moved towards a blocked edge until the proof just holds.",
        proofs,
    ),
    (
        "Plans beside OMPL",
        "planning_peers",
        "RRT-Connect of OMPL 1.5.2 on Panda problems, with published spheres or meshes, all in C++; ours"
        " called from Python. Motions are checked at 1/32 rad or at OMPL's default. Scalar checks"
        " are our own, in double precision, with a ball around each link. Medians over the problems that both"
        " solved within 30 s; processor time.",
        peers,
    ),
    (
        "Plans beside OMPL's wheel",
        "planning_wheel",
        "The same planner of OMPL 2.0.1 as Python programs use it: it calls a function of Python for each"
        " check, which asks ours with the same spheres, or Pinocchio's with coal and a tree of boxes."
        " Motions are checked at 1/32 rad. Medians over the problems that both solved; processor time.",
        peers,
    ),
    (
        "Covers of meshes",
        "planning_covers",
        "The public collision meshes of the Panda, covered with a proof, beside published spheres.",
        covers,
    ),
    (
        "Unseen arms and other seeds",
        "planning_unseen",
        "Random scenes of boxes, cylinders and capsules around arms of the catalogue; pairs may have no"
        " way, the ends of a walk of free motions have one. Then MotionBenchMaker problems with other seeds.",
        unseen,
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
        "RRT-Connect in C++, median / mean and p95 against VAMP",
        "≤ 0.75× / ≤ 0.8×",
        "0.6× / 0.7×",
    )
    measured = results["planning_core"]
    if not measured or "vamp" not in measured["panda"]:
        return row(what, must, aim, "", None)
    ratios = [
        mean_ratio(measured, list(ROBOTS), "rrt_connect", "rrt_connect", k) for k in ("median", "mean", "p95")
    ]
    holds = ratios[0] <= 0.75 and max(ratios[1:]) <= 0.8
    text = "{:.2f}× / {:.2f}×, {:.2f}×, every motion proved".format(*ratios)
    return row(what, must, aim, text, holds, ratios[0] <= 0.6 and max(ratios[1:]) <= 0.7)


def edge_row(results: Results) -> Row:
    what = "sampled / proved edge against VAMP's sampled edge, geometric mean of three robots"
    must, aim = "≤ 0.7× / ≤ 1.0×", "0.55× / 0.7×"
    measured = results["planning_core"]
    if not measured or "vamp" not in measured["panda"]:
        return row(what, must, aim, "", None)

    def ratio(kind: str, part: str) -> float:
        edges = [measured[k]["edges_ns"] for k in ROBOTS]
        return float(np.exp(np.mean([np.log(each[kind][part] / each["vamp"][part]) for each in edges])))

    sampled, proved = (float(np.sqrt(ratio(k, "free") * ratio(k, "blocked"))) for k in ("sampled", "proved"))
    text = f"{sampled:.2f}× / {proved:.2f}× (free {ratio('proved', 'free'):.2f}×,"
    text += f" blocked {ratio('proved', 'blocked'):.2f}×)"
    return row(what, must, aim, text, sampled <= 0.7 and proved <= 1, sampled <= 0.55 and proved <= 0.7)


def simplify_row(results: Results) -> Row:
    what, must, aim = (
        "plan + simplify / simplification alone in C++, Panda and UR5",
        "≤ 0.67× / ≤ 0.5×",
        "0.45× / 0.3×",
    )
    measured = results["planning_core"]
    if not measured or "vamp" not in measured["panda"]:
        return row(what, must, aim, "", None)
    plan, short = (mean_ratio(measured, ["panda", "ur5"], k, k, "median") for k in ("plan", "simplify"))
    text = f"{plan:.2f}× / {short:.2f}× of the medians"
    return row(what, must, aim, text, plan <= 0.67 and short <= 0.5, plan <= 0.45 and short <= 0.3)


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
    must = "0 / ≤ 5 / 0 of 10⁵ a robot"
    measured = results["planning_proofs"]
    if not measured:
        return row(what, must, "", "", None)
    parts = [measured[k] for k in ROBOTS]
    beyond = sum(part["verdicts"]["outside_band"] for part in parts)
    rates = [1e4 * part["edges"]["undecided"] / part["edges"]["edges"] for part in parts]
    touch, judged = (sum(part["judged"][k] for part in parts) for k in ("touch", "judged"))
    least = 1e6 * min(part["judged"]["pressed"]["least"] for part in parts)
    text = f"{beyond} / {max(rates):.1f} / {touch} of {judged:,} judged, the closest at {least:.1f} µm"
    return row(what, must, "", text, beyond == 0 and max(rates) <= 5 and touch == 0)


def path_row(results: Results) -> Row:
    what, must = "returned paths that touch something at 100× the resolution: default, AORRTC, to poses", "0"
    measured = results["planning_proofs"]
    if not measured:
        return row(what, must, "", "", None)
    parts = [measured[k]["paths"][key] for k in ROBOTS for key in ("plan", "aorrtc", "pose")]
    touch, paths = (sum(part[k] for part in parts) for k in ("touch", "paths"))
    unproved = [measured[k]["paths"]["sampled"] for k in ROBOTS]
    others = sum(part["touch"] for part in unproved), sum(part["paths"] for part in unproved)
    text = f"{touch} of {paths:,} (of paths checked at samples {others[0]} of {others[1]:,})"
    return row(what, must, "", text, touch == 0)


def peer_row(results: Results) -> Row:
    what = "plan, simplified and proved, against OMPL's wheel, Panda: the same spheres / the same in coal"
    must = "≥ 150× / ≥ 1,500×"
    wheel, core = results["planning_wheel"], results["planning_peers"]
    if not wheel or not core:
        return row(what, must, "", "", None)
    cases = [wheel["cases"][key] for key in ("same spheres", "coal, same spheres")]
    spheres, coal = (case["total_us"]["ratio"] for case in cases)
    searches = [case["search_us"]["ratio"] for case in cases]
    in_core = [core["cases"][key]["total_us"]["ratio"] for key in ("spheres", "coal, same spheres")]
    text = f"{spheres:.0f}× / {coal:,.0f}×, the searches alone {searches[0]:.0f}× / {searches[1]:,.0f}×"
    text += f"; OMPL and its checks in C++ {in_core[0]:.0f}× / {in_core[1]:.0f}×"
    return row(what, must, "", text, spheres >= 150 and coal >= 1500)


def cover_row(results: Results) -> Row:
    what, must = "proved cover of the meshes (10 mm) against published spheres, Panda, median", "≤ 1.3×"
    measured = results["planning_covers"]
    if not measured:
        return row(what, must, "", "", None)
    parts = measured["panda"]
    part, boxes = parts["10 mm"], parts["10 mm, fingers of exact boxes"]
    text = f"{part['median_ratio']:.2f}×, {part['valid']} valid; with fingers of exact boxes"
    return row(what, must, "", f"{text} {boxes['median_ratio']:.2f}×", part["median_ratio"] <= 1.3)


def seed_row(results: Results) -> Row:
    what = "other seeds, and the other half of the public problems: solved of valid / paths that touch"
    must = "≥ 99.5 % / 0"
    measured = results["planning_unseen"]
    parts = [part for stage in HALVES for part in measured.get(stage, {}).items()] if measured else []
    if not parts:
        return row(what, must, "", "", None)
    solved, valid = dict.fromkeys(ROBOTS, 0), dict.fromkeys(ROBOTS, 0)
    for name, part in parts:
        solved[name] += sum(each["solved"] for each in part["seeds"].values())
        valid[name] += part["valid"] * len(part["seeds"])
    touch = sum(part["touch"] for _, part in parts)
    text = ", ".join(f"{title} {solved[name]:,} of {valid[name]:,}" for name, title in ROBOTS.items())
    holds = touch == 0 and all(solved[name] >= 0.995 * valid[name] for name in ROBOTS)
    return row(what, must, "", f"{text} / {touch}", holds)


def unseen_row(results: Results) -> Row:
    what = "unseen arms: known ways found / paths, proved edges that touch / verdicts beyond 5 µm"
    must = "all / 0 / 0"
    parts = results["planning_unseen"].get("arms", {}) if results["planning_unseen"] else {}
    if not parts:
        return row(what, must, "", "", None)
    solved = sum(part["walk"]["ends"].get("found", 0) for part in parts.values())
    scenes, rows = (
        sum(part["scenes"] for part in parts.values()),
        sum(p["verdicts"]["rows"] for p in parts.values()),
    )
    touch = sum(part[kind]["touch"] for part in parts.values() for kind in ("random", "walk"))
    edges = [each for part in results["planning_unseen"].get("edges", {}).values() for each in part.values()]
    judged, wrong = (sum(each[key] for each in edges) for key in ("judged", "touch"))
    beyond = sum(part["verdicts"]["beyond_band"] for part in parts.values())
    text = (
        f"{solved} of {scenes} on {len(parts)} arms / {touch}, {wrong} of {judged:,} / {beyond} of {rows:,}"
    )
    return row(what, must, "", text, solved == scenes and touch == wrong == beyond == 0)


def two_joint_row(results: Results) -> Row:
    what = "space of two joints, 25 edges: bitmap of 10⁶ cells / cells wrong / boundary and components"
    must, aim = "≤ 0.6 ms / 0 / ≤ 5 ms", "0.3 ms"
    measured = results["planning_two_joints"]
    if not measured:
        return row(what, must, aim, "", None)
    bitmap, space = (measured[key]["median"] for key in ("bitmap_ms", "space_ms"))
    text = f"{bitmap:.2f} ms / {measured['unlike']} / {space:.1f} ms, numpy {measured['brute_ms']:,.0f} ms"
    holds = bitmap <= 0.6 and measured["unlike"] == 0 and space <= 5.0
    return row(what, must, aim, text, holds, bitmap <= 0.3)


def field_row(results: Results) -> Row:
    what = "potential fields of arms: stops wrong or unnamed / A\\* with the potential unlike Dijkstra"
    must = "0 of 1,000 / 0"
    measured = results["planning_fields"]
    if not measured:
        return row(what, must, "", "", None)
    descents = [part["descents"] for part in measured.values() if isinstance(part, dict)]
    faults = sum(sum(part["faults"].values()) for part in descents)
    ends = sum(sum(part["ends"].values()) for part in descents)
    goals = sum(part["ends"].get("goal", 0) for part in descents)
    searches = [measured[arm]["searches"] for arm in ("planar_2r", "planar_3r")]
    found = [(part["A*, potential, w = 1"], part["solved"]) for part in searches]
    unlike = sum(each["differing"] + solved - each["shortest"] for each, solved in found)
    text = (
        f"{faults} of {ends:,} ({goals:,} arrive) / {unlike} of {sum(part['problems'] for part in searches)}"
    )
    return row(what, must, "", text, faults == 0 and unlike == 0)


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


ROWS = [
    search_row,
    edge_row,
    simplify_row,
    plan_row,
    solved_row,
    check_row,
    proof_row,
    path_row,
    goal_row,
    peer_row,
    cover_row,
    seed_row,
]
ROWS += [unseen_row, two_joint_row, field_row]
