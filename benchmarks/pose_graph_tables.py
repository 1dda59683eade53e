"""The part of the page on pose graphs, and its lines of what must hold."""

from __future__ import annotations

from typing import Any

from further_tables import table
from rows import Row, row

Results = dict[str, Any]
MEASURED = ["pose_graphs", "incremental_graphs", "false_loops"]
SPATIAL = ("parking-garage.g2o", "sphere2500.g2o")
NAMES = {"manhattanOlson3500_g2o.g2o": "M3500", "parking-garage.g2o": "parking-garage"}


def name_of(graph: str) -> str:
    return NAMES.get(graph, graph.removesuffix(".g2o"))


def section(results: Results) -> str:
    """Batch, growing graphs, false loops."""
    return "\n\n".join(
        [
            "### Pose graphs",
            batch_table(results["pose_graphs"]),
            growing_table(results["incremental_graphs"]),
            false_table(results["false_loops"]),
        ]
    )


def batch_table(measured: Results) -> str:
    if not measured:
        return "Public graphs: not measured."
    body = []
    for name, entry in measured["graphs"].items():
        contenders, least = entry["contenders"], entry["least_chi2"]
        cells = [name_of(name), f"{least:.9g}"]
        for method in ("cspace_given", "cspace_rotations", "gtsam_gauss_newton", "gtsam_levenberg_marquardt"):
            found = contenders[method]
            reached = found["chi2"] <= least * (1 + 1e-6)
            cells.append(f"{1e3 * found['median']:.1f}" if reached else f"χ² {found['chi2']:.3g}")
        body.append(cells)
    heading = ["to the optimum [ms]", "χ²", "**cspace**, start as given", "**cspace**, rotations first"]
    return table([*heading, "gtsam, Gauss–Newton", "gtsam, Levenberg–Marquardt"], body)


def growing_table(measured: Results) -> str:
    if not measured:
        return "Growing graphs: not measured."
    body = []
    for name, entry in measured.items():
        for contender, label in (("cspace", "**cspace**"), ("isam2", "gtsam, iSAM2")):
            found = entry[contender]
            excess = 100 * (found["chi2"] / entry["optimum"] - 1)
            times = [f"{found[key]:.2f}" for key in ("total_s", "median_ms", "p99_ms", "slowest_ms")]
            body.append([name_of(name), label, str(found["steps"]), *times, f"{excess:.3f} %"])
    heading = ["edge by edge", "", "steps", "total [s]", "median [ms]", "99 % [ms]", "slowest [ms]"]
    return table([*heading, "χ² above the optimum"], body)


def false_table(measured: list[Results]) -> str:
    if not measured:
        return "False loops: not measured."
    body = [
        [
            f"{found['graph']}, {100 * found['share']:.0f} % of the loops",
            "in groups" if found["grouped"] else "random",
            f"{found['median_m']:.3f} ({found['worst_m']:.3f})",
            f"{100 * found['lost']:.1f} %",
            str(found["kept"]),
            f"{found['seconds']:.1f}",
        ]
        for found in measured
    ]
    heading = ['false loops, `robust="dcs"`', "", "error [m], median (worst)", "true loops lost, worst"]
    return table([*heading, "false loops kept, worst", "time [s]"], body)


def factors(measured: Results, spatial: bool) -> dict[str, float]:
    """How many times faster than the better of both methods of gtsam."""
    return {
        name_of(name): entry["times_faster"]
        for name, entry in measured["graphs"].items()
        if (name in SPATIAL) == spatial and entry["times_faster"]
    }


def batch_row(results: Results, spatial: bool) -> Row:
    where = "space" if spatial else "the plane"
    what = f"pose graphs in {where}, against gtsam's better method, the worst graph"
    must, aim = (1.5, 3.0) if spatial else (4.0, 8.0)
    if not results["pose_graphs"]:
        return row(what, f"≥ {must:g}×", f"≥ {aim:g}×", "", None)
    found = factors(results["pose_graphs"], spatial)
    worst = min(found.values())
    text = ", ".join(f"{name} {factor:.1f}×" for name, factor in found.items())
    return row(what, f"≥ {must:g}×", f"≥ {aim:g}×", text, worst >= must, worst >= aim)


def growing_row(results: Results) -> Row:
    what, must, aim = (
        "incremental M3500, total / slowest step / χ²",
        "≤ 1.2 s / 15 ms / 0.2 %",
        "0.5 s / 8 ms",
    )
    measured = results["incremental_graphs"]
    if not measured:
        return row(what, must, aim, "", None)
    entry = measured["manhattanOlson3500_g2o.g2o"]
    found, excess = entry["cspace"], entry["cspace"]["chi2"] / entry["optimum"] - 1
    total, slowest = found["total_s"], found["slowest_ms"]
    text = f"{total:.2f} s / {slowest:.1f} ms / {100 * excess:.3f} %"
    holds = total <= 1.2 and slowest <= 15 and excess <= 2e-3
    return row(what, must, aim, text, holds, holds and total <= 0.5 and slowest <= 8)


def false_row(results: Results) -> Row:
    what = "50 % false loops, random and in groups, intel and M3500: error / true loops lost, the worst"
    measured = results["false_loops"]
    if not measured:
        return row(what, "≤ 0.05 m / 1 %", "≤ 0.01 m", "", None)
    found = [each for each in measured if each["share"] == 0.5 and each["graph"] in ("intel", "M3500")]
    error, lost = max(each["worst_m"] for each in found), max(each["lost"] for each in found)
    text = f"{error:.4f} m / {100 * lost:.2g} %"
    return row(what, "≤ 0.05 m / 1 %", "≤ 0.01 m", text, error <= 0.05 and lost <= 0.01, error <= 0.01)


def planar_row(results: Results) -> Row:
    return batch_row(results, False)


def spatial_row(results: Results) -> Row:
    return batch_row(results, True)


ROWS = [planar_row, spatial_row, growing_row, false_row]
