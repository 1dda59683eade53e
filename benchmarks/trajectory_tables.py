"""The parts of the page on trajectories and Cartesian motion, and their lines of what must hold."""

from __future__ import annotations

from typing import Any

from further_tables import table
from rows import Row, row

Results = dict[str, Any]


def cell(entry: dict[str, float]) -> str:
    return f"{entry['median']:.2f} ({entry['p95']:.2f}, {entry['slowest']:.2f})"


def section(results: Results) -> str:
    """States, timing of paths, Cartesian motion."""
    parts = [states_table(results["trajectory"]), timing_table(results["path_timing"])]
    parts += [memory_table(results["timing_memory"]), cartesian_table(results["cartesian"])]
    return "\n\n".join(parts)


def states_table(measured: Results) -> str:
    if not measured:
        return "Motions from state to state: not measured."
    body = [
        [
            "from rest to rest" if kind == "rest" else "between moving states",
            f"{measured[kind]['ours_batch_us']:.1f}",
            f"{measured[kind]['ours_us']:.0f}",
            f"{measured[kind]['ruckig_us']:.1f}",
        ]
        for kind in ("rest", "moving")
    ]
    heading = [
        "seven joints, synchronised [µs]",
        "**cspace**, batch",
        "**cspace**, one call",
        "Ruckig, one call",
    ]
    return table(heading, body)


def time_and_excess(entry: dict[str, float] | None) -> str:
    if entry is None:
        return "—"
    excess = max(entry["over_velocity"], entry["over_acceleration"], 0.0)
    return f"{entry['us']:.0f} ({100 * excess:.2g} %)"


def timing_table(measured: Results) -> str:
    if not measured:
        return "Timing of paths: not measured."
    body = []
    for kind, label in (("uniform", "duration within 0.1 %"), ("automatic", "automatic grid")):
        for count, peers in measured[kind].items():
            cells = [time_and_excess(peers.get(peer)) for peer in ("cspace", "copp-py", "toppra")]
            body.append([f"{count} waypoints, {label}", *cells])
    heading = ["timing of splines, µs (limits exceeded by)", "**cspace**", "copp-py", "toppra"]
    tables = [table(heading, body)]
    if jerk := measured.get("jerk"):
        rows = [
            [name, f"{entry['intervals']:.0f}", f"{entry['us'] / 1e3:.1f}", f"{100 * entry['longer']:+.2f} %"]
            for name, entry in jerk.items()
        ]
        tables.append(table(["quintic splines with limits of jerk", "intervals", "ms", "duration"], rows))
    return "\n\n".join(tables)


def memory_table(measured: Results) -> str:
    if not measured:
        return "Memory of timing: not measured."
    body = [
        [name, f"{entry['MB']:.0f}", f"{entry['seconds']:.1f}", f"{entry['intervals']:,.0f}"]
        for name, entry in measured["rows"].items()
    ]
    return table(["10⁴ waypoints of seven joints", "MB, whole process", "s", "intervals"], body)


def cartesian_table(measured: Results) -> str:
    if not measured:
        return "Cartesian motion: not measured."
    line, move = measured["line"], measured["move"]
    body = [
        [
            "lines of a UR5e: all branches followed, ranked, the best timed",
            f"{line['arrived']} of {line['lines']}",
            cell(line["ms"]),
        ],
        *(
            [
                f"whole paths of {name}",
                f"{part['planned']} of {part['lines']} (least motion: {part['least_motion']})",
                f"{cell(part['ms'])}; on the clock of the wall {cell(part['wall_ms'])}",
            ]
            for name, part in measured["redundant"].items()
        ),
        [
            "`cs.move` of a Panda on MotionBenchMaker problems, with jerk limits",
            f"{move['within_limits']} of {move['problems']} within all limits",
            cell(move["ms"]),
        ],
    ]
    return table(["Cartesian motion, from Python", "arrive", "ms, median (95th percentile, slowest)"], body)


def state_row(results: Results) -> Row:
    what = (
        "state to state, seven synchronised joints, a batch against Ruckig's calls from Python: rest / moving"
    )
    measured = results["trajectory"]
    if not measured:
        return row(what, "≥ 3×", "≥ 8×", "", None)
    factors = [measured[kind]["ruckig_us"] / measured[kind]["ours_batch_us"] for kind in ("rest", "moving")]
    text = " / ".join(f"{factor:.2f}×" for factor in factors)
    return row(what, "≥ 3×", "≥ 8×", text, min(factors) >= 3.0, min(factors) >= 8.0)


def core_row(results: Results) -> Row:
    what = "the same in C++, one call against one of Ruckig's: rest / moving (with polynomials)"
    measured = (results["trajectory"] or {}).get("core")
    if not measured:
        return row(what, "≤ 1×", "≤ 0.4×", "", None)
    shares, made = (
        [measured[f"{name}, {kind}"] / measured[f"ruckig, {kind}"] for kind in ("at rest", "moving")]
        for name in ("states", "states with pieces")
    )
    text = " / ".join(f"{share:.2f}× ({whole:.2f}×)" for share, whole in zip(shares, made, strict=True))
    return row(what, "≤ 1×", "≤ 0.4×", text, max(shares) <= 1.0, max(shares) <= 0.4)


def jerk_row(results: Results) -> Row:
    what = "timing with jerk limits, default grid, against copp-py at 100 intervals: time / duration"
    measured = (results["path_timing"] or {}).get("jerk")
    if not measured:
        return row(what, "≤ 15 ms / not longer", "≤ 4 ms", "", None)
    ms = measured["cspace"]["us"] / 1e3
    peers = [entry for name, entry in measured.items() if name != "cspace"]
    shorter = min(entry["longer"] for entry in peers)
    fastest = min(entry["us"] for entry in peers) / 1e3
    text = f"{ms:.1f} ms (copp-py {fastest:.0f}) / {100 * shorter:.1f} % shorter"
    good = shorter >= 0.0
    return row(what, "≤ 15 ms / not longer", "≤ 4 ms", text, good and ms <= 15.0, good and ms <= 4.0)


def timing_row(results: Results) -> Row:
    what = (
        "timing of splines, duration within 0.1 %, the worst number of waypoints, against copp-py and toppra"
    )
    measured = results["path_timing"]
    if not measured:
        return row(what, "≥ 2×", "≥ 5×", "", None)
    factors = {
        count: min(peers[peer]["us"] for peer in peers if peer != "cspace") / peers["cspace"]["us"]
        for count, peers in measured["uniform"].items()
    }
    worst = min(factors, key=lambda count: factors[count])
    text = f"{factors[worst]:.1f}× ({worst} waypoints), best {max(factors.values()):.1f}×"
    return row(what, "≥ 2×", "≥ 5×", text, factors[worst] >= 2.0, factors[worst] >= 5.0)


def automatic_row(results: Results) -> Row:
    what = "the same on an automatic grid, 50 waypoints, against toppra"
    measured = results["path_timing"]
    if not measured:
        return row(what, "≥ 30×", "≥ 100×", "", None)
    peers = measured["automatic"]["50"]
    factor = peers["toppra"]["us"] / peers["cspace"]["us"]
    return row(what, "≥ 30×", "≥ 100×", f"{factor:.0f}×", factor >= 30.0, factor >= 100.0)


def torque_row(results: Results) -> Row:
    what = "timing with torque limits, Panda, 100 intervals"
    measured = results["path_timing"]
    if not measured:
        return row(what, "≤ 1 ms", "≤ 0.3 ms", "", None)
    ms = measured["torque"]["us"] / 1e3
    return row(what, "≤ 1 ms", "≤ 0.3 ms", f"{ms:.2f} ms", ms <= 1.0, ms <= 0.3)


def memory_row(results: Results) -> Row:
    what = "memory of timing 10⁴ waypoints, whole process, the worst kind of path, without / with jerk limits"
    measured = results["timing_memory"]
    if not measured:
        return row(what, "≤ 200 MB", "", "", None)
    worst = [
        max(entry["MB"] for name, entry in measured["rows"].items() if ("jerk" in name) == jerk)
        for jerk in (False, True)
    ]
    return row(what, "≤ 200 MB", "", f"{worst[0]:.0f} / {worst[1]:.0f} MB", max(worst) <= 200.0)


def line_row(results: Results) -> Row:
    what = "a line of a UR5e: all branches followed, ranked, the best timed, median"
    measured = results["cartesian"]
    if not measured:
        return row(what, "≤ 3 ms", "≤ 0.8 ms", "", None)
    ms = measured["line"]["ms"]["median"]
    return row(what, "≤ 3 ms", "≤ 0.8 ms", f"{ms:.2f} ms", ms <= 3.0, ms <= 0.8)


def redundant_row(results: Results) -> Row:
    what = "a redundant arm along a whole path, the worst arm, median"
    measured = results["cartesian"]
    if not measured:
        return row(what, "≤ 20 ms", "≤ 5 ms", "", None)
    medians = {name: part["ms"]["median"] for name, part in measured["redundant"].items()}
    worst = max(medians, key=lambda name: medians[name])
    text = f"{medians[worst]:.1f} ms ({worst}), panda {medians['panda']:.1f} ms"
    return row(what, "≤ 20 ms", "≤ 5 ms", text, medians[worst] <= 20.0, medians[worst] <= 5.0)


def move_row(results: Results) -> Row:
    what = "`cs.move` of a Panda with jerk limits, MotionBenchMaker problems, median"
    measured = results["cartesian"]
    if not measured:
        return row(what, "≤ 25 ms", "≤ 8 ms", "", None)
    ms = measured["move"]["ms"]["median"]
    return row(what, "≤ 25 ms", "≤ 8 ms", f"{ms:.1f} ms", ms <= 25.0, ms <= 8.0)


ROWS = [
    state_row,
    core_row,
    timing_row,
    automatic_row,
    torque_row,
    jerk_row,
    memory_row,
    line_row,
    redundant_row,
    move_row,
]
