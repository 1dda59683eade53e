"""One planner, one question: what it answered, and how that stands to the truth."""

from __future__ import annotations

from fractions import Fraction
from itertools import pairwise

import numpy as np

import cspace as cs
from cspace.errors import InputError
from oracles.clearance import is_free, nearest, rings_of
from oracles.segments import enters

SPACING = 0.1
"""How far apart the points of a path are at which its clearance is measured [m]."""
ACROSS = 0.25
SIDEWAYS = 16
"""Every so many metres along a path clearance is looked at across it, so many such steps to either side."""
LARGEST = 40
"""Clearance is compared in worlds no wider than this [m]: that of the widest way is found by brute force."""
HAIR = 1e-12
"""A part of a path inside an obstacle that is no longer than this [m] is the rounding of a crossing."""


def ask(row, question, navigate=cs.navigate, **more):
    """The route of a row's planner; None where it refuses the world by name."""
    world = question.world
    cells = {"resolution": 1.0} if row.world == "grid" and world.kind == "polygons" else {}
    try:
        options = {**row.options, **more, **({"rng": question.seed} if row.draws else {})}
        return navigate(world, question.start, question.goal, row.planner, **cells, **options)
    except InputError:
        if not row.some:
            raise
        return None


def judge(row, question, route):
    """A record of plain values: the question, the verdict beside the true one, and ratios to what is best."""
    record = {"row": row.name, "family": question.family, "size": question.size, "seed": question.seed}
    record |= {"question": question.name, "reachable": not question.shut}
    if row.world == "grid":
        record["reachable_on_cells"] = bool(np.isfinite(question.moves[0]))
    if route is None:
        return record | {"status": "refused"}
    record |= {"status": route.status, "nodes": int(route.stats.nodes), "fault": fault(route, question)}
    if route and not record["fault"] and not question.shut:
        record["ratio"] = route.length / question.length
        if row.world == "grid":
            record["moves"] = route.length / question.moves[row.options.get("metric") == "manhattan"]
        if row.planner == "wavefront":
            record["moves"] = route.length / question.moves[1]
        if question.bounds[2] <= LARGEST:
            record["clearance"] = least_clearance(route.path, question)
            record["middle"] = middle(route.path, question)
            record["widest"], record["of_ends"] = question.widest, question.clearance_of_ends
        if row.planner == "brushfire":
            record["of_cells"] = least_of_cells(route.path, question) / question.widest_on_cells
    if (bound := BOUNDS.get(row.planner)) and not record["fault"]:
        record["bound"] = route.length / bound(route)
    return record


def fault(route, question):
    """What is wrong with a path, in words; None for nothing."""
    path = np.asarray(route.path)
    if not len(path):
        return "found, but without a path" if route else None
    if not np.array_equal(path[0], question.start):
        return "does not begin at the start"
    if route and not np.array_equal(path[-1], question.goal):
        return "does not end at the goal"
    walked = float(np.hypot(*np.diff(path, axis=0).T).sum())
    if np.isfinite(route.length) and abs(walked - route.length) > 1e-9 * (1 + walked):
        return f"is {walked:.9g} m long, not {route.length:.9g} m"
    return enters_wall(path, question)


def enters_wall(path, question):
    """Where a path enters an obstacle: segments with walls no farther than half their length are looked at in
    fractions."""
    a, b = path[:-1], path[1:]
    half = np.hypot(*(b - a).T) / 2
    away, _ = nearest((a + b) / 2, rings_of(question.world))
    clear = away > half * (1 + 1e-9) + 1e-9
    if not is_free(((a + b) / 2)[clear], question.world).all():
        return "lies inside an obstacle"
    for p, q in zip(a[~clear], b[~clear], strict=True):
        if place := enters([p, q], question.obstacles, question.bounds, slack=HAIR):
            return f"enters an obstacle {place}"
    return None


def least_clearance(path, question):
    """The least distance of a path from walls, at points of it that are SPACING apart."""
    pieces = [path[:1]]
    for p, q in pairwise(path):
        count = max(2, int(np.ceil(np.hypot(*(q - p)) / SPACING)) + 1)
        pieces.append(np.linspace(p, q, count)[1:])
    return float(nearest(np.vstack(pieces), rings_of(question.world))[0].min())


def middle(path, question):
    """The clearance of a path over the largest across it at the same place, in the middle of the path."""
    legs = np.diff(path, axis=0)
    lengths = np.hypot(*legs.T)
    legs, starts, lengths = legs[lengths > 0], path[:-1][lengths > 0], lengths[lengths > 0]
    if not len(legs):
        return 1.0
    ends = np.cumsum(lengths)
    along = np.arange(ACROSS / 2, ends[-1], ACROSS)
    leg = np.searchsorted(ends, along)
    unit = legs[leg] / lengths[leg, None]
    points = starts[leg] + (along - ends[leg] + lengths[leg])[:, None] * unit
    normal = np.stack([-unit[:, 1], unit[:, 0]], axis=1)
    offsets = ACROSS * np.arange(-SIDEWAYS, SIDEWAYS + 1)
    across = points[:, None] + offsets[:, None] * normal[:, None]
    free = is_free(across.reshape(-1, 2), question.world).reshape(across.shape[:2])
    away = nearest(across.reshape(-1, 2), rings_of(question.world))[0].reshape(free.shape)
    here = SIDEWAYS
    away[:, here + 1 :] *= np.logical_and.accumulate(free[:, here + 1 :], axis=1)
    away[:, here - 1 :: -1] *= np.logical_and.accumulate(free[:, here - 1 :: -1], axis=1)
    return float(np.median(away[:, here] / np.maximum(away.max(axis=1), HAIR)))


def least_of_cells(path, question):
    """The least clearance of the centres that a path over cells passes."""
    pieces = [np.linspace(p, q, max(2, round(np.abs(q - p).max()) + 1)) for p, q in pairwise(path)]
    columns, rows = np.floor(np.vstack([path[:1], *pieces])).astype(int).T
    return float(question.clearance_of_cells[rows, columns].min())


def bound_of_bug_1(route):
    """D + 3/2 of the perimeters met (Lumelsky & Stepanov 1987)."""
    met = perimeters(route.world)[route.evidence.rings]
    return distance(route) + 1.5 * met.sum()


def bound_of_bug_2(route):
    """D + half of each perimeter for each crossing with the line from start to goal, and once around the ring
    that shuts the goal in."""
    total = distance(route)
    for ring, perimeter in zip(route.world.walls, perimeters(route.world), strict=True):
        total += perimeter * ((line_crossings(ring, route.start, route.goal) + 1) // 2)
    return total


BOUNDS = {"bug_1": bound_of_bug_1, "bug_2": bound_of_bug_2}


def distance(route):
    return float(np.hypot(*(route.goal - route.start)))


def perimeters(world):
    return np.array([np.hypot(*(ring - np.roll(ring, 1, axis=0)).T).sum() for ring in world.walls])


def line_crossings(ring, start, goal):
    """How often a segment crosses a ring, moved by a hair to the side on which it does so more often."""
    exact = [tuple(map(Fraction, map(float, p))) for p in (start, goal, *ring)]
    p, q, corners = exact[0], exact[1], exact[2:]
    side = [(q[0] - p[0]) * (c[1] - p[1]) - (q[1] - p[1]) * (c[0] - p[0]) for c in corners]
    counts = []
    for above in (lambda s: s > 0, lambda s: s >= 0):
        count = 0
        for k, (a, b) in enumerate(zip(corners, corners[1:] + corners[:1], strict=True)):
            if above(side[k]) != above(side[(k + 1) % len(side)]):
                ends = [(b[0] - a[0]) * (e[1] - a[1]) - (b[1] - a[1]) * (e[0] - a[0]) for e in (p, q)]
                count += ends[0] * ends[1] <= 0
        counts.append(count)
    return max(counts)
