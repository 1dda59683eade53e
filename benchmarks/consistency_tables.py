"""The part of the page on the consistency of filters, and its line of what must hold."""

from __future__ import annotations

from typing import Any

from further_tables import table
from rows import Row, row

Results = dict[str, Any]
MEASURED = ["consistency"]
EXEMPT = ("plain", "FastSLAM")
"""Filters that are known to be inconsistent; they are shown."""


def section(results: Results) -> str:
    """NEES of every filter in simulation."""
    measured = results["consistency"]
    if not measured:
        return "### Consistency\n\nNot measured."
    body = [
        [
            name,
            f"{100 * entry['inside']:.0f} %",
            f"{entry['least']:.2f} to {entry['largest']:.2f}",
            f"{entry['mean']:.2f}",
        ]
        for name, entry in measured.items()
    ]
    heading = ["NEES, the mean of 100 runs at each time step", "steps inside [2.54, 3.50]", "range", "mean"]
    return "### Consistency\n\n" + table(heading, body)


def nees_row(results: Results) -> Row:
    what = "NEES in simulation: steps inside [2.54, 3.50] / range of all, the worst filter"
    must = "≥ 90 % / [2.14, 4.05]"
    measured = results["consistency"] or {}
    found = {name: entry for name, entry in measured.items() if not any(part in name for part in EXEMPT)}
    if not found:
        return row(what, must, "", "", None)
    worst = min(found, key=lambda name: found[name]["inside"])
    low, high = min(e["least"] for e in found.values()), max(e["largest"] for e in found.values())
    text = f"{100 * found[worst]['inside']:.0f} % ({worst}) / {low:.2f} to {high:.2f} of {len(found)} filters"
    others = [name for name, entry in measured.items() if name not in found and not entry["passes"]]
    text += f"; not counted and outside: {', '.join(others)}" if others else ""
    return row(what, must, "", text, all(entry["passes"] for entry in found.values()))


ROWS = [nees_row]
