"""The cells of the table of claims, computed from records: a word each, with what it rests on.

Nothing here knows what is claimed: the same words stand in `claims.rows`, and a test compares them.
"""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass

import numpy as np

from claims.families import FAMILIES, STEP
from claims.rows import (
    CELLS,
    FOUR,
    KEPT,
    NO,
    OVER_CELLS,
    SAMPLES,
    SHORTEST,
    SOME,
    TENDS,
    WIDEST,
    WIDEST_CELLS,
    WITHIN,
    YES,
)

EQUAL = 1e-9
"""Relative: lengths are sums of rounded square roots."""
WRONG = "WRONG"
NONE = "—"
NEAR = 1.02
"""The median path of a planner that tends to the shortest is no longer than this many times it."""
MOSTLY = 0.9
"""A way keeps to the middle if its clearance is at least this share of the largest across it, along
half of it in half of all questions."""


@dataclass(frozen=True)
class Finding:
    """What was found of one claim."""

    word: str
    detail: str = ""
    """Numbers behind the word."""
    example: str = ""
    """A question that decides, where the word is not the best that there is."""


def complete(row, records, fewer=()):
    """Whether the verdict is the true one on every question."""
    judged = [r for r in records if r["status"] != "refused"]
    for r in judged:
        if r["fault"]:
            return Finding(WRONG, f"its path {r['fault']}", r["question"])
        if r["status"] == "found" and not r["reachable"]:
            return Finding(WRONG, "found a way where there is none", r["question"])
        if r["status"] == "unreachable" and r["reachable"] and r.get("reachable_on_cells", True):
            return Finding(WRONG, "denied that there is a way", r["question"])
    wrong = [r for r in judged if (r["status"] == "found") != r["reachable"]]
    missed = wrong + [r for r in judged if not r["reachable"] and r["status"] != "unreachable"]
    said = counted(records)
    if any(r["status"] == "local_minimum" for r in missed):
        return Finding(NO, said, next(r["question"] for r in missed if r["reachable"]))
    if row.draws and (lost := share_missed(fewer)) > share_missed(judged):
        lost, left = (f"{100 * share:.3g} %" for share in (lost, share_missed(judged)))
        return Finding(SAMPLES, f"missed {lost} of the paths with few samples, {left} with many; {said}")
    if row.some and (lost := {r["family"] for r in records if r["status"] in ("refused", "undetermined")}):
        decided = [family for family in FAMILIES if family not in lost]
        return Finding(SOME, f"every {' and '.join(decided)} decided; {said}" if decided else said)
    if missed:
        return Finding(CELLS, said, missed[0]["question"])
    return Finding(YES, said)


def share_missed(records):
    reachable = [r["status"] != "found" for r in records if r["reachable"]]
    return float(np.mean(reachable)) if reachable else 0.0


def counted(records):
    """The verdicts, counted."""
    counts = Counter(r["status"] for r in records)
    total = sum(counts.values())
    return ", ".join(f"{k.replace('_', ' ')} {v}" for k, v in counts.most_common()) + f" of {total}"


def shortest(row, records, fewer=()):
    """Lengths of paths relative to the shortest: in the plane, over cells, or within a factor."""
    ratios, moves = values(records, "ratio"), values(records, "moves")
    if not len(ratios):
        return Finding(NONE)
    detail = f"median ×{spelled(np.median(ratios))}, maximum ×{spelled(ratios.max())}"
    worst = max((r for r in records if "ratio" in r), key=lambda r: r["ratio"])["question"]
    if ratios.min() < 1 - EQUAL:
        return Finding(WRONG, "shorter than the shortest way", worst)
    if ratios.max() <= 1 + EQUAL:
        return Finding(SHORTEST, f"of {len(ratios)} paths")
    if len(moves) and moves.max() <= 1 + EQUAL and moves.min() >= 1 - EQUAL:
        return Finding(FOUR if row.planner == "wavefront" else OVER_CELLS, f"in the plane {detail}", worst)
    if row.promise and moves.max() <= row.promise * (1 + EQUAL):
        most = f"over cells ×{spelled(np.median(moves))}, ×{spelled(moves.max())} at most"
        return Finding(WITHIN.format(row.promise), most, worst)
    before = values(fewer, "ratio")
    if row.draws and len(before) and np.median(ratios) < min(np.median(before), NEAR):
        return Finding(TENDS, f"×{spelled(np.median(before))} with few samples, with many {detail}", worst)
    return Finding(NO, detail, worst)


def clearance(row, records):
    """How the least clearance of ways stands to that of the widest, where not the ends themselves are what is
    nearest to walls."""
    judged = [r for r in records if 0.5 - STEP < r.get("widest", 0) < r["of_ends"] - STEP]
    if not judged:
        return Finding(NONE)
    shares = np.array([r["clearance"] / r["widest"] for r in judged])
    detail = f"median {spelled(np.median(shares))} of the widest, minimum {spelled(shares.min())}"
    worst = judged[int(shares.argmin())]["question"]
    if all(r["clearance"] >= r["widest"] - STEP for r in judged):
        return Finding(WIDEST, f"of {len(judged)} paths, to {STEP:g} m")
    on_cells = values(records, "of_cells")
    if len(on_cells) and on_cells.min() >= 1 - EQUAL:
        return Finding(WIDEST_CELLS, f"of {len(on_cells)} paths; in the plane {detail}", worst)
    central = values(records, "middle")
    detail += (
        f"; half of a path has at least {spelled(np.median(central))} of the largest clearance across it"
    )
    return Finding(KEPT if np.median(central) >= MOSTLY else NO, detail, worst)


def bound(row, records):
    """Whether the bound on the length of a walk held in every run."""
    ratios = values(records, "bound")
    if not len(ratios):
        return Finding(NONE)
    worst = max((r for r in records if "bound" in r), key=lambda r: r["bound"])["question"]
    if ratios.max() > 1 + EQUAL:
        return Finding(WRONG, f"×{spelled(ratios.max())} the bound", worst)
    return Finding("holds", f"up to ×{spelled(ratios.max())} in {len(ratios)} walks", worst)


def values(records, key):
    return np.array([r[key] for r in records if key in r])


def spelled(value):
    """A ratio with as many digits as tell."""
    return f"{value:.3g}" if value >= 1.0995 or value <= 1 - 5e-4 else f"{value:.4g}"
