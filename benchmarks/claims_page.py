"""The text of docs/claims.md: the table of claims, from benchmarks/results/claims.json."""

from __future__ import annotations

import json
import sys
from collections.abc import Iterable, Sequence
from pathlib import Path
from statistics import median
from textwrap import fill
from typing import Any

ROOT = Path(__file__).resolve().parents[1]
sys.path.append(str(ROOT / "tests"))

from claims.families import FAMILIES, STEP  # noqa: E402
from claims.notes import NOTES  # noqa: E402
from claims.rows import ROWS  # noqa: E402
from claims.scaling import CACHES  # noqa: E402

RESULT = ROOT / "benchmarks/results/claims.json"
PAGE = ROOT / "docs/claims.md"
FIGURES = {"shortest": "#lengths-and-clearances", "clearance": "#lengths-and-clearances", "cost": "#growth"}
COLUMNS = {
    "map": "needs a map",
    "complete": "complete",
    "shortest": "shortest",
    "clearance": "clearance",
    "cost": "time grows as",
    "nodes": "nodes grow as",
}
NUMBERS = ("no", "one", "two", "three", "four", "five", "six", "seven", "eight", "nine", "ten")
PLURALS = {
    "convex field": "convex fields",
    "spiral": "spirals",
    "maze": "mazes",
    "U trap": "U traps",
    "narrow gap": "narrow gaps",
    "degenerate": "degenerate polygons that touch, overlap and have collinear corners",
    "touching corner": "corners on a slanted edge",
    "costly bait": "baits near the goal on a long way",
    "two gaps": "walls with a narrow and a wide gap",
}
RESTS = ("map", "complete", "shortest", "clearance", "bound", "cost")


def load() -> dict[str, Any]:
    results: dict[str, Any] = json.loads(RESULT.read_text(encoding="utf-8"))
    return results


def markdown(header: list[str], rows: list[list[str]]) -> str:
    lines = [header, ["---"] * len(header), *rows]
    return "\n".join("| " + " | ".join(cells) + " |" for cells in lines)


def ordered(results: dict[str, Any], lecture: bool) -> list[str]:
    return [name for name, row in ROWS.items() if row.claim.lecture == lecture and name in results["rows"]]


def notes_of(results: dict[str, Any]) -> list[tuple[str, str]]:
    """Every cell that is not what is claimed, in the order of the table."""
    every = [*ordered(results, True), *ordered(results, False)]
    return [(name, column) for name in every for column in COLUMNS if differs(results["rows"][name], column)]


def differs(row: dict[str, Any], column: str) -> bool:
    claim = row["claimed"].get(column)
    return claim is not None and claim != row["found"][column]["word"]


def cell(results: dict[str, Any], name: str, column: str) -> str:
    row = results["rows"][name]
    word, claim = row["found"][column]["word"], row["claimed"].get(column)
    if claim is None:
        return word
    if column == "cost" and claim == word:
        return f"{claim} ✓, {row['found'][column]['detail'].split(';')[0]}"
    if claim == word:
        return f"{word} ✓"
    return (
        f"**{word}**, claimed: {claim} [[{notes_of(results).index((name, column)) + 1}]](#where-they-differ)"
    )


def table(results: dict[str, Any], lecture: bool) -> str:
    rows = [[name, *(cell(results, name, c) for c in COLUMNS)] for name in ordered(results, lecture)]
    heads = [f"[{title}]({FIGURES[c]})" if c in FIGURES else title for c, title in COLUMNS.items()]
    return markdown(["planner", *heads], rows)


def bounds(results: dict[str, Any]) -> str:
    """Whether the bounds on walks held."""
    found = {name: row["found"]["bound"] for name, row in results["rows"].items()}
    told = [f"`{name}`: {f['word']}, {f['detail']}" for name, f in found.items() if f["word"] != "—"]
    return f"Bounds on the length of a walk were checked in every run: {'; '.join(told)}."


def bugs(results: dict[str, Any]) -> str:
    """In which share of the questions of each family each bug walked less."""
    first, second = (results["rows"][name]["ratios"] for name in ("bug_1", "bug_2"))
    rows = []
    for family in first:
        pairs = list(zip(first[family], second[family], strict=True))
        shares = [sum(wins) / len(pairs) for wins in ([a > b for a, b in pairs], [a < b for a, b in pairs])]
        medians = [f"×{median(values[family]):.3g}" for values in (first, second)]
        rows.append([family, *medians, *(f"{100 * share:.0f} %" for share in shares)])
    return markdown(["family", "Bug 1, median", "Bug 2", "Bug 2 walks less", "Bug 1 walks less"], rows)


def differences(results: dict[str, Any]) -> str:
    lines = []
    for k, (name, column) in enumerate(notes_of(results), 1):
        finding = results["rows"][name]["found"][column]
        told = NOTES.get((name, column), "")
        lines.append(f"{k}. `{name}`, {COLUMNS[column]}: {finding['detail']}. {told}".rstrip())
    return "\n".join(lines) or "Nowhere."


def evidence(results: dict[str, Any]) -> str:
    blocks = []
    for name in [*ordered(results, True), *ordered(results, False)]:
        row = results["rows"][name]
        lines = [f"**{name}**, {row['questions']} questions{told_options(name)}"]
        for column in RESTS:
            finding = row["found"][column]
            if not finding["detail"]:
                continue
            example = f" ({finding['example']})" if finding["example"] else ""
            lines.append(f"- {COLUMNS.get(column, column)}: {finding['word']}; {finding['detail']}{example}")
        blocks.append("\n".join([lines[0], "", *lines[1:]]))
    return "\n\n".join(blocks)


def told_options(name: str) -> str:
    options = ROWS[name].options
    return f", with {', '.join(f'`{k}={v!r}`' for k, v in options.items())}" if options else ""


def name_families(families: Iterable[str]) -> str:
    """The families of worlds as a list in a sentence."""
    *first, last = (PLURALS[family] for family in families)
    return f"{', '.join(first)} and {last}" if first else last


def name_later(families: Sequence[str]) -> str:
    """The families that tests have and the results of the page do not, as a sentence."""
    if not families:
        return ""
    return f"The tests have {NUMBERS[len(families)]} more: {name_families(families)}."


def page(results: dict[str, Any]) -> str:
    about, measured = results["about"], results["rows"]["bug_1"]["ratios"]
    later = [family for family in FAMILIES if family not in measured]
    return f"""# Claims

*What textbooks claim about each planner, compared with its results*

Generated by `benchmarks/navigation_claims.py` from `benchmarks/results/claims.json`; do not edit.

Every planner receives the same queries in {NUMBERS[len(measured)]} families of worlds with integer
coordinates:
{fill(f"{name_families(measured)}. {name_later(later)}", 110)}
Half of the goals are enclosed. Every cell of the table is computed from the results and from oracles that
share no code with the planners. The tests compute the cells again on some of the queries. They also break
planners on purpose and check that the cells change.

![the families of worlds, with a reachable goal and an enclosed one](figures/claims_worlds.png)

- **needs a map**: obstacles that the robot neither touched nor approached are removed one by one. "no" means
  that the path did not change.
- **complete**: whether each verdict is correct. An exact oracle in integers decides which goals can be
  reached. "To resolution": paths are missed where the cells are too coarse. "With samples": more samples
  miss fewer paths. "In some worlds": other worlds are undetermined.
- **shortest**: compared with the exact length of the shortest path in the plane, or over the same cells.
- **clearance**: "widest" if no path has a larger least clearance, to {STEP:g} m, by brute force over a fine
  raster. "In the middle" if at most places of the path no point across it is farther from walls.
- **time, nodes**: the exponent $p$ of $n^p$, fitted over six sizes or more, with its 95 % confidence
  interval. $n$ is the number of corners, or of cells, of a convex field. Time is the processor time to
  construct the world and to answer one query. A claimed growth is confirmed if the exponent does not
  significantly exceed the claimed one over these sizes, with {CACHES:g} allowed for caches.

✓ marks a claim that was confirmed. Measured {about["date"]} on {about["processor"]}.

## The ten of the lecture

Planners and their options are explained on the [page of navigation](navigation.md). {bounds(results)}

The claim of the lecture that the potential field is locally optimal in the potential summed along its path is
[measured on the page of the lecture](lectures/navigation.md#the-potential-field).

{table(results, True)}

## Other planners

The claims about these planners are from the papers listed on the page of navigation.

{table(results, False)}

## Bug 1 against Bug 2

According to the claim, Bug 2 is usually better than Bug 1. Bug 1 is better where the line to the goal crosses
many turns of a spiral.

{bugs(results)}

## Where they differ

{differences(results)}

## Lengths and clearances

![lengths over the shortest, and clearances over the widest, of every path found](figures/claims_ways.png)

## Growth

![time against the size of the world, with fitted exponents](figures/claims_time.png)

## Evidence

A query in brackets is the decisive one, or the worst.

{evidence(results)}
"""
