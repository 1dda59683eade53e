"""One row of the table of claims: asked, judged, timed, and turned into cells."""

from __future__ import annotations

from dataclasses import asdict

import cspace as cs
from claims import cells, scaling, sight
from claims.families import FAMILIES, goal_on_wall, question
from claims.judge import ask, judge

SIZES = (1, 2, 3, 4, 5)
SEEDS = 4
FEWER = {"maze": (2, 3, 4, 5)}
"""A maze has at least four rooms."""
COLUMNS = ("map", "complete", "shortest", "clearance", "bound", "cost", "nodes")


def questions(sizes=SIZES, seeds=SEEDS, families=FAMILIES):
    """Of each family, size and seed one with a goal that can be reached and one that is shut in; of the
    smallest size of each family one with a goal on a wall, too."""
    asked = []
    for family in families:
        for size in (fit := [size for size in sizes if size in FEWER.get(family, sizes)]):
            for seed in range(seeds):
                asked += [question(family, size, seed, shut) for shut in (False, True)]
                if size == fit[0]:
                    asked.append(goal_on_wall(asked[-2]))
    return asked


def questions_of_sight(seeds=3):
    """Worlds from which obstacles are taken away."""
    worlds = (("convex field", 3), ("convex field", 5), ("maze", 3), ("maze", 5), ("maze", 8))
    return [question(family, size, k) for family, size in worlds for k in range(seeds)]


def records(row, asked, navigate=cs.navigate, **more):
    """What a row's planner answered, judged; planners on cells are asked where both ends are cells."""
    fit = [q for q in asked if row.world == "polygons" or q.on_cells]
    return [judge(row, q, ask(row, q, navigate, **more)) for q in fit]


def findings(row, asked, seen, sizes=scaling.SIZES, navigate=cs.navigate, clock=None):
    """(cells by column, records, points of growth) of one row."""
    told = records(row, asked, navigate)
    fewer = records(row, asked, navigate, **row.few) if row.few else []
    timing = {} if clock is None else {"clock": clock}
    points = scaling.measure(row, row.sizes or sizes, navigate=navigate, **timing) if sizes else []
    found = {
        "map": sight.needs_map(row, seen, navigate),
        "complete": cells.complete(row, told, fewer),
        "shortest": cells.shortest(row, told, fewer),
        "clearance": cells.clearance(row, told),
        "bound": cells.bound(row, told),
        "cost": scaling.cost(row, points),
        "nodes": scaling.cost(row, points, "nodes"),
    }
    return found, told, points


def claimed(row):
    """The words that are claimed of a row, by column."""
    words = {name: getattr(row.claim, name) for name in ("map", "complete", "shortest", "clearance", "cost")}
    words["shortest"] = words["shortest"] and words["shortest"].format(row.promise)
    return {column: word for column, word in words.items() if word is not None}


def disagreements(row, found):
    """The columns in which a claimed word is not the one that was found."""
    return [column for column, word in claimed(row).items() if found[column].word != word]


def result(row, asked, seen, sizes=scaling.SIZES):
    """Everything of a row that the page and its figures show, as plain values."""
    found, told, points = findings(row, asked, seen, sizes)
    ratios = {family: [] for family in FAMILIES}
    shares = {family: [] for family in FAMILIES}
    for r in told:
        if "ratio" in r:
            ratios[r["family"]].append(round(r["ratio"], 4))
            if 0 < r.get("widest", 0) < r["of_ends"]:
                shares[r["family"]].append(round(r["clearance"] / r["widest"], 4))
    growth = [{**p, "seconds": float(f"{p['seconds']:.4g}")} for p in points]
    return {
        "planner": row.planner,
        "claimed": claimed(row),
        "found": {column: asdict(finding) for column, finding in found.items()},
        "questions": len(told),
        "ratios": ratios,
        "shares": shares,
        "growth": growth,
    }
