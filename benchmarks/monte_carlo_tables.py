"""The part of the page on Monte Carlo localisation, and its lines of what must hold."""

from __future__ import annotations

from typing import Any

from further_tables import table
from rows import Row, row

Results = dict[str, Any]
MEASURED = ["monte_carlo"]
COVERED, OTHER, GLOBAL = "kidnapped, covered", "kidnapped, not covered", "global start, covered"
LABELS = {
    COVERED: "kidnapped, the map covers the drive",
    OTHER: "kidnapped, it does not",
    GLOBAL: "start unknown",
}
NAMES = {"intel": "Intel", "freiburg-079": "Freiburg 079"}


def section(results: Results) -> str:
    """Trials on public logs."""
    return "\n\n".join(["### Monte Carlo localisation", trials_table(trials_of(results))])


def trials_of(results: Results) -> list[Results]:
    return [entry for entry in results["monte_carlo"] or [] if "kind" in entry]


def trials_table(trials: list[Results]) -> str:
    if not trials:
        return "Trials: not measured."
    body = [
        [
            f"{NAMES[entry['log']]}, {LABELS[entry['kind']]}",
            f"{100 * entry['median_cover']:.0f} %",
            f"{entry['right']} of {entry['trials']}",
            f"{entry['mean_first_update']:.1f}",
            f"{100 * entry['doubted_while_near'] / max(entry['updates_near'], 1):.1f} %",
            f"{100 * entry['sure_while_far'] / entry['updates']:.1f} %",
        ]
        for entry in trials
    ]
    heading = [
        "20 updates on a stretch that the map was made without",
        "of it on the map",
        "right at the end",
    ]
    heading += ["from update", "doubted within 0.3 m", "sure beyond 0.5 m"]
    return table(heading, body)


def time_row(results: Results) -> Row:
    what = "Monte Carlo update, 10⁴ particles × 60 beams, one core"
    found = [entry for entry in results["monte_carlo"] or [] if "median_ms" in entry]
    if not found:
        return row(what, "≤ 2 ms", "≤ 1.2 ms", "", None)
    spent = found[0]["median_ms"]
    return row(what, "≤ 2 ms", "≤ 1.2 ms", f"{spent:.2f} ms", spent <= 2.0, spent <= 1.2)


def share_row(results: Results, kind: str, must: float, aim: float) -> Row:
    what = f"{LABELS[kind]}, right from some update to the 20th, both maps"
    found = [entry for entry in trials_of(results) if entry["kind"] == kind]
    goals = f"≥ {100 * must:g} %", f"≥ {100 * aim:g} %"
    if not found:
        return row(what, *goals, "", None)
    right, total = (sum(entry[key] for entry in found) for key in ("right", "trials"))
    text = f"{100 * right / total:.1f} % of {total}"
    return row(what, *goals, text, right >= must * total and total >= 200, right >= aim * total)


def doubt_row(results: Results) -> Row:
    what = "`lost` or `ambiguous` said within 0.3 m of the truth, the worst log"
    found: dict[str, list[int]] = {}
    for entry in trials_of(results):
        counts = found.setdefault(entry["log"], [0, 0])
        counts[0] += entry["doubted_while_near"]
        counts[1] += entry["updates_near"]
    if not found:
        return row(what, "≤ 2 %", "", "", None)
    shares = {NAMES[log]: doubted / max(near, 1) for log, (doubted, near) in found.items()}
    text = ", ".join(f"{log} {100 * share:.1f} %" for log, share in shares.items())
    return row(what, "≤ 2 %", "", text, max(shares.values()) <= 0.02)


def covered_row(results: Results) -> Row:
    return share_row(results, COVERED, 0.97, 0.99)


def other_row(results: Results) -> Row:
    return share_row(results, OTHER, 0.90, 0.97)


def global_row(results: Results) -> Row:
    return share_row(results, GLOBAL, 0.97, 0.99)


ROWS = [time_row, covered_row, other_row, global_row, doubt_row]
