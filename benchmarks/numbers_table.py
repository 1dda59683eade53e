"""The table of what must hold: each row with its bound, its aim, what was measured and whether it holds."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

ARMS = {"ur5e": "UR5e", "puma560": "PUMA 560", "kr6_r900": "KR6"}
Results = dict[str, Any]


@dataclass(frozen=True)
class Row:
    """A line of the table. holds and aimed are None where nothing was measured or no aim is set."""

    what: str
    must: str
    aim: str
    measured: str
    holds: bool | None
    aimed: bool | None


def find(results: Results, arm: str, task: str, contender: str) -> dict[str, Any] | None:
    """The measurements of a contender; None where it refused or was not run."""
    for row in results["measurements"]["rows"]:
        if (row["arm"], row["task"], row["contender"]) == (arm, task, contender) and "ready" in row:
            return dict(row)
    return None


def pairs(results: Results, task: str, peer: str) -> list[tuple[str, dict[str, Any], dict[str, Any]]]:
    """Arm, our row and the peer's row wherever both were measured."""
    found = [(arm, find(results, arm, task, "cspace_"), find(results, arm, task, peer)) for arm in ARMS]
    return [(arm, ours, theirs) for arm, ours, theirs in found if ours and theirs]


def ours(results: Results, task: str) -> list[tuple[str, dict[str, Any]]]:
    found = [(arm, find(results, arm, task, "cspace_")) for arm in ARMS]
    return [(arm, row) for arm, row in found if row]


def row(what: str, must: str, aim: str, measured: str, holds: bool | None, aimed: bool | None = None) -> Row:
    return Row(what, must, aim, measured or "not measured", holds if measured else None, aimed)


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
    text = "; ".join(f"{arm} {e['found']}/{e['true']}" for arm, e in entries.items())
    holds = all(e["found"] == e["true"] for e in entries.values())
    return row("all solutions of the recorded poses", "100 %", "", text, holds)


def near_row(results: Results) -> Row:
    judged = [entry["judged"]["near_1e-6"] for _, entry in ours(results, "ik") if entry["judged"]]
    found, true = sum(e["found"] for e in judged), sum(e["true"] for e in judged)
    text = f"{100 * found / true:.2f} % ({found}/{true})" if true else ""
    return row("recovered at 1e-6 rad from singularities", "≥ 99.9 %", "", text, found >= 0.999 * true)


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


ROWS: list[Callable[[Results], Row]] = [
    single_row,
    batch_row,
    scalar_row,
    residual_row,
    recorded_row,
    near_row,
    fk_row,
    jacobian_row,
    forward_batch_row,
    import_row,
    install_row,
]


def table(results: Results) -> list[Row]:
    return [build(results) for build in ROWS]
