"""The parts of the page on seven joints, paths and descents, building, and false solutions."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any

import arms

Measured = dict[str, Any]
NAMES = {"cspace_": "**cspace**", "ssik_": "ssik", "pinocchio_": "Pinocchio"}
SLOWEST = 12
"""Arms that the table of building shows."""


def table(head: list[str], body: Iterable[list[str]]) -> str:
    return "\n".join("| " + " | ".join(cells) + " |" for cells in [head, ["---"] * len(head), *body])


def date(measured: Measured) -> str:
    """When it was measured and how busy the machine was."""
    load, cores = measured["load"], measured["machine"]["cores"]
    busy = load is not None and load > 1.25 * cores
    return f"Measured {measured['machine']['date']}" + (
        f", while {load} processes shared its {cores} cores." if busy else "."
    )


def share(value: float | None) -> str:
    return "—" if value is None else f"{100 * value:.1f} %"


def number(value: float | None, form: str) -> str:
    return "—" if value is None else format(value, form)


def times(row: Measured) -> list[str]:
    return [f"{row['time'][key]:.3g}" for key in ("median", "p95", "p99")]


def begin(row: Measured) -> list[str]:
    return [arms.TITLES[row["arm"]], row["what"], f"{NAMES[row['contender']]} {row['version']}", *times(row)]


def listed(measured: Measured, head: list[str], cells: Callable[[Measured], list[str]]) -> str:
    if not measured:
        return "Not measured."
    columns = ["arm", "asked", "contender", "median", "p95", "p99", *head]
    body = ([*begin(row), *cells(row["judged"])] for row in measured["rows"])
    return f"{date(measured)}\n\n{table(columns, body)}"


def seven(measured: Measured) -> str:
    def cells(judged: Measured) -> list[str]:
        right = judged.get("near", judged.get("holds"))
        return [number(judged.get("answers"), ".2f"), share(right), number(judged.get("residual"), ".0e")]

    return listed(measured, ["answers", "right", "residual"], cells)


def following(measured: Measured) -> str:
    def cells(judged: Measured) -> list[str]:
        branches = number(judged.get("branches"), "d")
        return [branches, share(judged.get("reached")), number(judged.get("residual"), ".0e")]

    return listed(measured, ["branches", "reached", "residual"], cells)


def building(measured: Measured) -> str:
    """The slowest arms."""
    if not measured:
        return "Not measured."
    rows = sorted(measured["rows"], key=lambda row: -float(row["median"]))
    body = [[row["arm"], f"{row['median']:.1f}", f"{row['max']:.1f}"] for row in rows[:SLOWEST]]
    rest = f"The other {len(rows) - len(body)} arms take less." if len(rows) > len(body) else ""
    return f"{date(measured)} {rest}\n\n{table(['arm', 'median [ms]', 'most [ms]'], body)}"


def tallies(results: Measured) -> dict[str, Measured]:
    """Kind of goal → sums over all arms, and the worst residual and time of any."""
    found: dict[str, Measured] = {}
    for kinds in (kinds for sizes in results.values() for kinds in sizes.values()):
        for kind, counts in kinds.items():
            sums = found.setdefault(kind, dict.fromkeys(counts, 0))
            for key, value in counts.items():
                worst = key in ("residual", "seconds")
                sums[key] = max(sums[key], value) if worst else sums[key] + value
    return found


def soundness(results: Measured) -> str:
    if not results:
        return "Not measured."
    head = ["goals", "number", "solutions", "false", "crashes", "hangs", "worst residual"]
    head.append("slowest fifty, per goal [ms]")
    body = []
    for kind, sums in tallies(results).items():
        counts = [f"{sums[key]:,}" for key in ("goals", "solutions", "false", "crashes", "hangs")]
        body.append([kind, *counts, f"{sums['residual']:.0e}", f"{1000 * sums['seconds']:.3g}"])
    return f"Asked of {len(results)} six-joint arms, nominal and disturbed.\n\n{table(head, body)}"
