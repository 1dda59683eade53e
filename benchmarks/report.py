"""Writes the tables, the plot and docs/benchmarks.md from what the benchmarks left in benchmarks/results/.

Usage: python benchmarks/report.py [--check]
"""

from __future__ import annotations

import json
import sys
from dataclasses import asdict
from pathlib import Path
from typing import Any

HERE = Path(__file__).resolve().parent
RESULTS = HERE / "results"
PAGE = HERE.parent / "docs/benchmarks.md"
sys.path.insert(0, str(HERE))

import age  # noqa: E402
import arms  # noqa: E402
import completeness_table  # noqa: E402
import dynamics_tables  # noqa: E402
import further_tables  # noqa: E402
import localization_tables  # noqa: E402
import navigation_tables  # noqa: E402
import numbers_table  # noqa: E402
import planning_tables  # noqa: E402
import simulation_tables  # noqa: E402
import trajectory_tables  # noqa: E402
from rows import Row  # noqa: E402

NAMES = {
    "cspace_": "**cspace**",
    "eaik_": "EAIK",
    "ik_geo_": "ik-geo",
    "ssik_": "ssik",
    "ur_analytic": "ur-analytic-ik",
    "pinocchio_": "Pinocchio",
    "toolbox": "Robotics Toolbox",
}
NAVIGATION = ["grid", "any_angle", "polygons", "fields", "sampling", "bugs", "large", "curves", "exact"]
NAVIGATION += ["degenerate"]
PLANNING = [name for _, name, *_ in planning_tables.PARTS] + ["planning_goals", "planning_two_joints"]


def measured_names() -> list[str]:
    """The results that the page shows."""
    names = [*arms.SETS, "cpp", "recorded", "install", "derived", "completeness", "seven", "following"]
    return [
        *names,
        "building",
        "soundness",
        *(f"navigation_{part}" for part in NAVIGATION),
        *PLANNING,
        "dynamics",
        "simulation",
        "trajectory",
        "path_timing",
        "timing_memory",
        "cartesian",
        *localization_tables.MEASURED,
    ]


def load() -> dict[str, Any]:
    """Everything measured, by the name of its file; what was not measured is empty."""

    def read(name: str) -> Any:
        path = RESULTS / f"{name}.json"
        return json.loads(path.read_text(encoding="utf-8")) if path.exists() else {}

    results = {name: read(name) for name in measured_names()}
    results["older"] = age.older(measured_names())
    results["measurements"] = results["measurements"] or {"machine": {}, "imports": {}, "rows": []}
    return results


def markdown(header: list[str], rows: list[list[str]]) -> str:
    lines = [header, ["---"] * len(header), *rows]
    return "\n".join("| " + " | ".join(cells) + " |" for cells in lines)


def verdict(row: Row) -> str:
    if row.holds is None:
        return "not measured"
    return ("aim reached" if row.aimed else "holds") if row.holds else "**missed**"


def numbers_section(results: dict[str, Any]) -> str:
    rows = [[r.what, r.must, r.aim, r.measured, verdict(r)] for r in numbers_table.table(results)]
    return markdown(["what", "must", "aim", "measured", "verdict"], rows)


def microseconds(entry: dict[str, float] | None, key: str = "median") -> str:
    return "—" if not entry else f"{entry[key]:.3g}"


def share(entry: dict[str, Any] | None) -> str:
    return "—" if not entry else f"{100 * entry['found'] / entry['true']:.2f} %"


def ik_cells(row: dict[str, Any]) -> list[str]:
    name = NAMES[row["contender"]]
    if "refused" in row:
        return [name, f"refused: {row['refused']}", *["—"] * 9]
    judged = row.get("judged") or {}
    random = judged.get("random")
    return [
        f"{name} {row['version']}",
        microseconds(row["call"]),
        microseconds(row["call"], "p95"),
        microseconds(row["read"]),
        microseconds(row["batch"]),
        share(random),
        share(judged.get("near_1e-4")),
        share(judged.get("near_1e-6")),
        "—" if not random else f"{random['residual']:.0e}",
        "—" if not random else str(random["wrong"]),
        f"{1000 * row['setup_seconds']:.2g}",
    ]


def forward_cells(row: dict[str, Any]) -> list[str]:
    judged = (row.get("judged") or {}).get("random")
    return [
        f"{NAMES[row['contender']]} {row['version']}",
        microseconds(row["call"]),
        microseconds(row["call"], "p95"),
        microseconds(row["read"]),
        microseconds(row["batch"]),
        "—" if not judged else f"{judged['residual']:.0e}",
    ]


def sections(results: dict[str, Any]) -> str:
    """The tables of all contenders, task by task and arm by arm."""
    rows = results["measurements"]["rows"]
    head = ["contender", "call", "p95", "call + read", "batch", "found", "found at 1e-4", "found at 1e-6"]
    head += ["residual", "wrong answers", "set-up [ms]"]
    texts = []
    for arm, title in numbers_table.ARMS.items():
        shown = [r for r in rows if (r["arm"], r["task"]) == (arm, "ik") and offered(r)]
        if shown:
            texts.append(
                f"### Inverse kinematics, {title}\n\n" + markdown(head, [ik_cells(r) for r in shown])
            )
    for task, title in (
        ("fk", "Forward kinematics"),
        ("jacobian", "Jacobian"),
        ("fk_jacobian", "Both in one call"),
    ):
        for arm, name in numbers_table.ARMS.items():
            shown = [r for r in rows if (r["arm"], r["task"]) == (arm, task) and "ready" in r]
            if shown:
                columns = ["contender", "call", "p95", "call + read", "batch", "error"]
                texts.append(
                    f"### {title}, {name}\n\n" + markdown(columns, [forward_cells(r) for r in shown])
                )
    return "\n\n".join(texts)


def set_section(results: dict[str, Any], name: str) -> str:
    """One table of all contenders on all arms of a set."""
    rows = [row for row in results[name].get("rows", []) if offered(row)]
    if not rows:
        return "Not measured."
    head = ["arm", "contender", "call", "p95", "p99", "call + read", "batch", "found", "found at 1e-4"]
    head += ["found at 1e-6", "residual", "wrong answers", "set-up [ms]"]
    derives = name == "general"
    head += ["derived [s]"] if derives else []
    body = []
    for row in rows:
        cells = ik_cells(row)
        tail = microseconds(row["call"], "p99") if "ready" in row else "—"
        derived = results["derived"].get(row["arm"]) if row["contender"] == "ssik_" else None
        if derives:
            cells.append("—" if derived is None else f"{derived:.0f}")
        body.append([arms.TITLES[row["arm"]], *cells[:3], tail, *cells[3:]])
    return f"{taken(results[name])}\n\n{markdown(head, body)}"


def taken(measured: dict[str, Any]) -> str:
    """When a set was measured and how busy the machine was."""
    date, load, cores = measured["machine"]["date"], measured["load"], measured["machine"]["cores"]
    busy = load is not None and load > 1.25 * cores
    note = f", while {load} processes shared its {cores} cores, which lengthens the tails" if busy else ""
    random, near = measured.get("counts", (1000, 200))
    return f"Measured {date}{note}; {random} random poses, {near} at each distance from a singularity."


def offered(row: dict[str, Any]) -> bool:
    return row.get("refused") != "does not offer this"


def imports_section(results: dict[str, Any]) -> str:
    found = results["measurements"]["imports"]
    cells = [
        [NAMES.get(k, k), "—" if v is None else f"{v:.3f}"] for k, v in sorted(found.items(), key=by_value)
    ]
    return markdown(["package", "import [s]"], cells)


def by_value(item: tuple[str, float | None]) -> float:
    return item[1] if item[1] is not None else float("inf")


def cpp_section(results: dict[str, Any]) -> str:
    cells = [[name, f"{e['median']:.3g}", f"{e['p95']:.3g}"] for name, e in results["cpp"].items()]
    return markdown(["C++ benchmark", "median [ns]", "p95 [ns]"], cells) if cells else "Not measured."


def page(results: dict[str, Any]) -> str:
    """The text of docs/benchmarks.md."""
    machine = ", ".join(f"{k} {v}" for k, v in results["measurements"]["machine"].items())
    return f"""# Benchmarks

Generated by `benchmarks/report.py` from `benchmarks/results/`; do not edit.

Each contender runs in a separate process, pinned to one core, on the same seeded problems: 1000 random poses,
and 200 poses at each distance from a singularity. The contenders alternate after a warm-up. Times are medians
in µs per call.

- "call" is the bare call, with the input in the form that the contender prefers.
- "call + read" includes the conversion of the result to arrays.
- "batch" is the processor time per item of one call with many items on one core.
- "found" is the share of the true solutions that a contender returned. The true solutions are those that any
  contender returned and Newton's method confirmed.
- "wrong answers" do not reach the pose within 1e-6.

All results are checked by a forward kinematics in plain numpy that belongs to no contender. The page includes
the cases in which cspace is slower or misses a target.

Machine: {machine}.

{age.section(results["older"])}

## Requirements

{numbers_section(results)}

## Contenders

![Time per call and share of the solutions found](../benchmarks/results/ik.png)

{sections(results)}

## Six joints in general position

These arms have no closed form. Each call is timed separately by its processor time. "batch" is a mean, which
slow poses raise above the median of a call. ssik includes the equations that it derived for these arms.
"derived" is the processor time of this derivation, which a new arm needs once. EAIK and the closed forms of
ik-geo refuse these arms. ik-geo also has a class for general arms with six joints, a search in two variables.
It took 19 to 78 ms per pose and found no solution for 20 random poses of each of these arms, so it is
omitted. Robotics Toolbox had not finished the derivation of its equations for JACO 2 after a minute.

{set_section(results, "general")}

## Calibrated arms, and a locked seventh joint

Every axis and every point of the nominal arm is disturbed by normal deviates of the stated size [rad, m]. One
joint of the iiwa 14 is locked. Its joint 4 is absent, because locking it fixes the distance from shoulder to
wrist, and no pose then has finitely many solutions. A contender that is not ready within its time limit is
marked. ssik derives equations for such an arm. In a trial, this took more than two minutes of processor time
for the first arm. Its solutions were then wrong by 7e-4, and none of 30 configurations was found within 1e-5.
Near some singularities of an iiwa with a locked joint, the rounding of a pose moves the configuration by up
to 0.02 rad. There no contender finds the solutions of another one to 5e-7.

{set_section(results, "calibrated")}

## Arms with prismatic joints

{set_section(results, "slides")}

## Seven joints

Times are processor time in µs per value, goal or configuration. For a locked joint and for the swivel, all
branches are listed. "answers" is their mean number, because some values of the locked joint do not reach the
goal. Each joint of a seed differs by the stated amount from the configuration that generated the goal, or the
seed is random within the limits. A result is right if it is at least as near to the seed as that
configuration, by the sum of squares. ssik receives the seed and this measure and returns one solution.
Feasible intervals are right if they contain the value of the joint that generated the goal.

{further_tables.seven(results["seven"])}

## Paths and descents

A path is timed per pose and branch. A descent ends at an error of 1e-9. It ignores limits and uses one start
without restarts. "reached" counts results within 1e-6. Pinocchio provides the Jacobian and the logarithm. The
loop around them, damped least squares with full steps, is written in Python, as its users write it.

{further_tables.following(results["following"])}

## Building a solver

The processor time of the first call on a new robot minus that of a second call: every six-joint arm of the
catalogue, calibrated arms, and an arm with special axes that is solved through perturbed arms.

{further_tables.building(results["building"])}

## False solutions

A false solution misses its goal by more than 1e-9. The goals are poses of random configurations, of joints at
or near multiples of 90°, and of singular configurations and configurations up to 1e-3 from them. The poses of
the latter are also moved away from the base and towards it. Further goals are far out of reach, or combine a
reachable position with an orientation that may be unreachable there.

{further_tables.soundness(results["soundness"])}

## Completeness

{completeness_table.section(results["completeness"])}

## Navigation

{navigation_tables.section(results)}

## Collision and planning of arms

{planning_tables.section(results)}

## Dynamics

URDF files of example-robot-data; arguments and outputs are prepared; processor time [ns], median (95th
percentile), in turns in one process.

{dynamics_tables.section(results)}

## Simulation

The Panda of example-robot-data without friction, steps of a millisecond, from Python; processor time per step
and row [ns], median (95th percentile), in turns in one process.

{simulation_tables.section(results)}

## Trajectories and Cartesian motion

Processor time, from Python. Motions from state to state and splines are random, of seven joints; peers in
turns on the same problems.

{trajectory_tables.section(results)}

## Localisation and SLAM

Processor time on one thread, from arrays in memory; χ² is computed again in plain numpy.

{localization_tables.section(results)}

## Import

The processor time of a new interpreter that imports the package, minus that of one that imports nothing.

{imports_section(results)}

## C++

{cpp_section(results)}
"""


def plot(results: dict[str, Any], path: Path) -> None:
    """Inverse kinematics: time per call against the share of solutions found next to singularities."""
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    colours = dict(zip(NAMES, plt.rcParams["axes.prop_cycle"].by_key()["color"], strict=False))
    figure, panels = plt.subplots(1, 3, figsize=(11, 3.4), sharey=True, layout="constrained")
    for axes, (arm, title) in zip(panels, numbers_table.ARMS.items(), strict=True):
        rows = [
            r
            for r in results["measurements"]["rows"]
            if (r["arm"], r["task"]) == (arm, "ik") and r.get("judged")
        ]
        rows.sort(key=lambda r: r["read"]["median"], reverse=True)
        for place, row in enumerate(rows):
            near = row["judged"]["near_1e-6"]
            text = f" {row['read']['median']:.3g} µs, {100 * near['found'] / near['true']:.1f} %"
            axes.barh(place, row["read"]["median"], color=colours[row["contender"]])
            axes.text(row["read"]["median"], place, text, va="center", fontsize=8)
            name = NAMES[row["contender"]].strip("*")
            axes.text(0.033, place, name, va="center", ha="left", fontsize=8, color="white", weight="bold")
        axes.set(title=title, xscale="log", yticks=[], xlim=(0.03, 3e4), xlabel="µs per pose, answers read")
        axes.spines[["top", "right", "left"]].set_visible(False)
    figure.suptitle(
        "All solutions of a pose: time, and share found at 1e-6 rad from a singularity", fontsize=11
    )
    figure.savefig(path, dpi=150)
    plt.close(figure)


def main() -> int:
    if "--check" not in sys.argv[1:]:
        age.record(measured_names())
    results = load()
    text = page(results)
    if "--check" in sys.argv[1:]:
        return int(PAGE.read_text(encoding="utf-8") != text)
    PAGE.write_text(text, encoding="utf-8")
    rows = [asdict(row) for row in numbers_table.table(results)]
    (RESULTS / "numbers.json").write_text(
        json.dumps(rows, indent=1, ensure_ascii=False) + "\n", encoding="utf-8"
    )
    plot(results, RESULTS / "ik.png")
    return 0


if __name__ == "__main__":
    sys.exit(main())
