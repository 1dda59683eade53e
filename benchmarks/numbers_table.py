"""The table of what must hold: each row with its bound, its aim, what was measured and whether it holds."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any

import arms
import dynamics_tables
import further_tables
import localization_tables
import navigation_numbers
import planning_tables
import simulation_tables
import trajectory_tables
from arms import CLASSIC as ARMS
from rows import Row, row

Results = dict[str, Any]


def find(results: Results, arm: str, task: str, contender: str) -> dict[str, Any] | None:
    """The measurements of a contender; None where it refused or was not run."""
    for name in arms.SETS:
        for entry in results[name].get("rows", []):
            names = (entry["arm"], entry["task"], entry["contender"])
            if names == (arm, task, contender) and "ready" in entry:
                return dict(entry)
    return None


def pairs(results: Results, task: str, peer: str) -> list[tuple[str, dict[str, Any], dict[str, Any]]]:
    """Arm, our row and the peer's row wherever both were measured."""
    found = [(arm, find(results, arm, task, "cspace_"), find(results, arm, task, peer)) for arm in ARMS]
    return [(arm, ours, theirs) for arm, ours, theirs in found if ours and theirs]


def ours(results: Results, task: str, names: Iterable[str] = ARMS) -> list[tuple[str, dict[str, Any]]]:
    found = [(arm, find(results, arm, task, "cspace_")) for arm in names]
    return [(arm, row) for arm, row in found if row]


def ratio_row(results: Results, what: str, task: str, peer: str, must: float, aim: float) -> Row:
    """Their time over ours, for the bare call and for the call with its answer read; the worst of all
    counts."""
    texts, worst = [], []
    for arm, mine, theirs in pairs(results, task, peer):
        ratios = [theirs[key]["median"] / mine[key]["median"] for key in ("call", "read")]
        texts.append(
            f"{ARMS[arm]} {ratios[0]:.1f}× ({mine['call']['median']:.2f} against "
            f"{theirs['call']['median']:.2f} µs), with answers read {ratios[1]:.1f}×"
        )
        worst.append(min(ratios))
    low = min(worst, default=0.0)
    name = {"eaik_": "EAIK", "pinocchio_": "Pinocchio"}[peer]
    return row(what, f"≥ {must:g}× {name}", f"≥ {aim:g}×", "; ".join(texts), low >= must, low >= aim)


def single_row(results: Results) -> Row:
    return ratio_row(results, "all branches, one Python call", "ik", "eaik_", 3, 6)


def batch_row(results: Results) -> Row:
    texts, ratios, times = [], [], []
    for arm, mine, theirs in pairs(results, "ik", "eaik_"):
        if not mine["batch"]:
            continue
        best = min(theirs[key]["median"] for key in ("call", "batch") if theirs.get(key))
        time = mine["batch"]["median"]
        texts.append(f"{ARMS[arm]} {time:.3f} µs per pose, {best / time:.0f}×")
        ratios.append(best / time)
        times.append(time)
    holds, aimed = min(ratios, default=0) >= 20, max(times, default=1) <= 0.12
    what = "the same in a batch of 10⁵ on one core"
    return row(what, "≥ 20× EAIK's best", "≤ 0.12 µs per pose", "; ".join(texts), holds, aimed)


def scalar_row(results: Results) -> Row:
    found = {arm: results["cpp"].get(f"ik {arm}") for arm in ARMS}
    times = {arm: entry["median"] / 1000 for arm, entry in found.items() if entry}
    text = "; ".join(f"{ARMS[arm]} {time:.2f} µs" for arm, time in times.items())
    worst = max(times.values(), default=9.0)
    return row("the same in C++, scalar", "≤ 1.0 µs", "≤ 0.5 µs", text, worst <= 1.0, worst <= 0.5)


def residual_row(results: Results) -> Row:
    judged = [(arm, entry["judged"]) for arm, entry in ours(results, "ik") if entry["judged"]]
    random = [entry["random"]["residual"] for _, entry in judged]
    near = [entry["near_1e-4"]["residual"] for _, entry in judged]
    text = f"{max(random):.1e} / {max(near):.1e}" if judged else ""
    holds = max(random, default=1) <= 1e-12 and max(near, default=1) <= 1e-9
    return row("residual, random poses / within 1e-4 rad of singular", "≤ 1e-12 / ≤ 1e-9", "", text, holds)


def recorded_row(results: Results) -> Row:
    entries = results["recorded"]
    found, true = (sum(e[key] for e in entries.values()) for key in ("found", "true"))
    lost = [f"{arm} {e['found']}/{e['true']}" for arm, e in entries.items() if e["found"] < e["true"]]
    text = "; ".join([f"{found}/{true} on {len(entries)} arms", *lost]) if entries else ""
    return row("all solutions of the recorded poses", "100 %", "", text, found == true)


def near_row(results: Results) -> Row:
    judged = [entry["judged"]["near_1e-6"] for _, entry in ours(results, "ik") if entry["judged"]]
    found, true = sum(e["found"] for e in judged), sum(e["true"] for e in judged)
    text = f"{100 * found / true:.2f} % ({found}/{true})" if true else ""
    return row("recovered at 1e-6 rad from singularities", "≥ 99.9 %", "", text, found >= 0.999 * true)


def general_row(results: Results) -> Row:
    texts, ratios, times = [], [], []
    for arm, mine in ours(results, "ik", arms.GENERAL):
        theirs = find(results, arm, "ik", "ssik_")
        if theirs:
            ratio = min(theirs[key]["median"] / mine[key]["median"] for key in ("call", "read"))
            times.append(mine["call"]["median"])
            ratios.append(ratio)
            texts.append(
                f"{arms.TITLES[arm]} {times[-1]:.1f} against {theirs['call']['median']:.0f} µs, {ratio:.0f}×"
            )
    what = "six joints in general position, one Python call, median"
    holds, aimed = min(ratios, default=0) >= 20, max(times, default=99) <= 10
    return row(what, "≥ 20× ssik", "≤ 10 µs", "; ".join(texts), holds, aimed)


def tail_row(results: Results) -> Row:
    times = {arm: entry["call"]["p99"] for arm, entry in ours(results, "ik", arms.GENERAL)}
    text = "; ".join(f"{arms.TITLES[arm]} {time:.0f} µs" for arm, time in times.items())
    worst = max(times.values(), default=999)
    return row("the same, 99 of 100 calls", "≤ 100 µs", "≤ 30 µs", text, worst <= 100, worst <= 30)


def calibrated_row(results: Results) -> Row:
    found = ours(results, "ik", arms.CALIBRATED | arms.LOCKED)
    times = {arm: entry["call"]["median"] for arm, entry in found}
    text = "; ".join(f"{arms.TITLES[arm]} {time:.1f} µs" for arm, time in times.items())
    worst = max(times.values(), default=999)
    what = "calibrated arms, iiwa with a locked joint, one Python call, median"
    return row(what, "≤ 30 µs", "≤ 10 µs", text, worst <= 30, worst <= 10)


def examined(results: Results, kind: str) -> list[dict[str, Any]]:
    """Every run of the completeness test on this kind of poses."""
    return [run[kind] for sizes in results["completeness"].values() for run in sizes.values()]


def missed_row(results: Results) -> Row:
    entries = examined(results, "random")
    missed, poses = (sum(e[key] for e in entries) for key in ("missed", "poses"))
    text = f"{missed} of {poses:,}" if poses else ""
    what = "generating configuration missed, every six-joint arm, nominal and calibrated"
    return row(what, "≤ 1 in 10⁵", "0", text, missed * 1e5 <= poses, missed == 0)


def singular_row(results: Results) -> Row:
    texts, holds = [], True
    for kind, bound in (("1e-02", 1.0), ("1e-04", 0.999), ("1e-06", 0.995)):
        entries = examined(results, kind)
        missed, poses = (sum(e[key] for e in entries) for key in ("missed", "poses"))
        if poses:
            texts.append(f"{poses - missed:,} of {poses:,}")
            holds &= poses - missed >= bound * poses
    what = "generating configuration recovered at 1e-2 / 1e-4 / 1e-6 rad from singularities, the same arms"
    return row(what, "100 / ≥ 99.9 / ≥ 99.5 %", "", " / ".join(texts), holds)


def false_row(results: Results) -> Row:
    entries = [e for kind in ("random", "1e-02", "1e-04", "1e-06") for e in examined(results, kind)]
    false = sum(e["false"] for e in entries)
    worst = max((e["residual"] for e in entries), default=1.0)
    text = f"{worst:.0e} / {false}" if entries else ""
    what = "worst residual / falsely certified, the same runs"
    return row(what, "≤ 1e-9 / 0", "", text, worst <= 1e-9 and false == 0)


def seven_times(results: Results, what: str, key: str = "median") -> dict[str, float]:
    """Arm with seven joints → our median [µs]; key: or another share of the calls."""
    rows = results["seven"].get("rows", [])
    mine = [r for r in rows if (r["what"], r["contender"]) == (what, "cspace_")]
    return {arms.TITLES[r["arm"]]: r["time"][key] for r in mine}


def sample_row(results: Results) -> Row:
    sweep = seven_times(results, "joint 7 locked: 1000 values for a goal")
    each = seven_times(results, "joint 7 locked: a value for each goal")
    text = "; ".join(f"{arm} {time:.2f} µs, of many goals {each[arm]:.2f} µs" for arm, time in sweep.items())
    what = "seven joints, one locked: all branches, per sample"
    times = {arm: max(time, each[arm]) for arm, time in sweep.items()}
    panda, iiwa = (times.get(arms.SEVEN[arm], 9.0) for arm in ("panda", "iiwa14"))
    holds, aimed = panda <= 1 and iiwa <= 0.6, panda <= 0.15 and iiwa <= 0.1
    return row(what, "≤ 1 µs Panda, ≤ 0.6 µs iiwa", "≤ 0.15 / 0.1 µs", text, holds, aimed)


def nearest_row(results: Results) -> Row:
    texts, near = [], []
    for seed, batch in (("0.05 rad away", ""), ("random", ""), ("0.05 rad away", ", batch")):
        times = seven_times(results, f"nearest to a seed {seed}{batch}")
        texts += [f"{arm}, seed {seed}{batch}, {time:.1f} µs" for arm, time in times.items()]
        near += list(times.values())
    what = "seven joints, nearest of all to a seed"
    return row(what, "≤ 3 µs", "", "; ".join(texts), max(near, default=99) <= 3)


def intervals_row(results: Results) -> Row:
    asked = "feasible intervals of joint 7"
    times, tails = (seven_times(results, asked, key) for key in ("median", "p95"))
    text = "; ".join(f"{arm} {time:.0f} µs, 95 of 100 in {tails[arm]:.0f} µs" for arm, time in times.items())
    time = times.get(arms.SEVEN["panda"], 999.0)
    return row(
        "exact feasible intervals, Panda, median", "≤ 400 µs", "≤ 100 µs", text, time <= 400, time <= 100
    )


def building_row(results: Results) -> Row:
    times = {entry["arm"]: entry["median"] for entry in results["building"].get("rows", [])}
    named = {name: times[name] for name in ("jaco2", "crx10ia", "ur5e+1e-3", "neighbours") if name in times}
    slow = {name: time for name, time in times.items() if time > 20 and name not in named}
    titles = {**arms.TITLES, "neighbours": "an arm solved through perturbed arms"}
    parts = [f"{titles.get(name, name)} {time:.1f} ms" for name, time in {**named, **slow}.items()]
    what = f"building a solver, {len(times)} arms"
    return row(what, "≤ 20 ms", "", "; ".join(parts), max(times.values(), default=99) <= 20)


def sound_row(results: Results) -> Row:
    tallies = further_tables.tallies(results["soundness"]).values()
    goals, *bad = (sum(t[key] for t in tallies) for key in ("goals", "false", "crashes", "hangs"))
    text = f"{' / '.join(map(str, bad))} of {goals:,}" if goals else ""
    what = "false solutions (residual > 1e-9) / crashes / hangs in random and adversarial calls"
    holds = None if goals < 10**6 and not any(bad) else not any(bad)
    return row(what, "0 / 0 / 0 of 10⁶", "", text, holds)


def fk_row(results: Results) -> Row:
    return ratio_row(results, "forward kinematics, one call", "fk", "pinocchio_", 1.5, 2)


def jacobian_row(results: Results) -> Row:
    return ratio_row(results, "Jacobian, one call", "jacobian", "pinocchio_", 1.5, 2)


def forward_batch_row(results: Results) -> Row:
    found = ours(results, "fk_jacobian")
    times = {arm: 1000 * entry["batch"]["median"] for arm, entry in found if entry["batch"]}
    text = "; ".join(f"{ARMS[arm]} {time:.0f} ns" for arm, time in times.items())
    worst = max(times.values(), default=1e9)
    what = "FK + Jacobian, batch, one core, per configuration"
    return row(what, "≤ 60 ns", "≤ 34 ns", text, worst <= 60, worst <= 34)


def import_row(results: Results) -> Row:
    seconds = results["measurements"]["imports"].get("cspace_")
    text = f"{seconds:.3f} s" if seconds is not None else ""
    return row("`import cspace`", "≤ 0.15 s", "", text, (seconds or 0) <= 0.15)


def install_row(results: Results) -> Row:
    entry = results["install"]
    if not entry:
        return row("build from source / wheel / installed with numpy", "", "", "", None)
    minutes, wheel, installed = entry["build_seconds"] / 60, entry["wheel_mb"], entry["installed_mb"]
    return row(
        "build from source on 2 cores / wheel / installed with numpy",
        "≤ 4 min / ≤ 8 MB / ≤ 80 MB",
        "",
        f"{minutes:.1f} min / {wheel:.1f} MB / {installed:.0f} MB",
        minutes <= 4 and wheel <= 8 and installed <= 80,
    )


def first_command_row(results: Results) -> Row:
    seconds = (results["install"] or {}).get("first_command_seconds")
    text = "" if seconds is None else f"{seconds:.0f} s"
    name = "README's first command from a wheel, empty environment, no compiler"
    return row(name, "≤ 20 s", "", text, None if seconds is None else seconds <= 20)


ROWS: list[Callable[[Results], Row]] = [
    single_row,
    batch_row,
    scalar_row,
    residual_row,
    recorded_row,
    near_row,
    general_row,
    tail_row,
    calibrated_row,
    missed_row,
    singular_row,
    false_row,
    sound_row,
    building_row,
    sample_row,
    nearest_row,
    intervals_row,
    fk_row,
    jacobian_row,
    forward_batch_row,
    import_row,
    install_row,
    first_command_row,
]


def table(results: Results) -> list[Row]:
    return [
        build(results)
        for build in [
            *ROWS,
            *navigation_numbers.ROWS,
            *planning_tables.ROWS,
            *dynamics_tables.ROWS,
            *trajectory_tables.ROWS,
            *simulation_tables.ROWS,
            *localization_tables.ROWS,
        ]
    ]
