"""The part of the page on the consistency of filters, and its line of what must hold."""

from __future__ import annotations

from typing import Any

from further_tables import table
from rows import Row, row

Results = dict[str, Any]
MEASURED = ["consistency"]
EXEMPT = "EKF-SLAM, plain"
"""Known to be inconsistent; it is shown."""


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
    what = "NEES of every filter in simulation, steps inside [2.54, 3.50] / inside [2.14, 4.05]; plain exempt"
    found = {name: entry for name, entry in (results["consistency"] or {}).items() if name != EXEMPT}
    if not found:
        return row(what, "≥ 90 % / all", "", "", None)
    passing = {name: entry for name, entry in found.items() if entry["passes"]}
    text = f"{len(passing)} of {len(found)} filters"
    if passing:
        least = min(entry["inside"] for entry in passing.values())
        low, high = min(e["least"] for e in passing.values()), max(e["largest"] for e in passing.values())
        text += f", these with {100 * least:.0f} % or more, {low:.2f} to {high:.2f}"
    outside = [f"{name} {100 * e['inside']:.0f} %" for name, e in found.items() if name not in passing]
    text += f"; outside: {'; '.join(outside)}" if outside else ""
    return row(what, "≥ 90 % / all", "", text, not outside)


ROWS = [nees_row]
