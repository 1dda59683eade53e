"""Whether a planner needs a map: obstacles that its robot neither touched nor came near are taken away, and
it is asked again.

A robot that is shown what it feels or sees, and nothing else, walks the same way again.
"""

from __future__ import annotations

import itertools
from dataclasses import replace

import numpy as np

import cspace as cs
from claims.cells import NONE, Finding
from claims.judge import SPACING, ask
from claims.rows import NO, YES
from oracles.clearance import nearest

SAME = 1e-6
"""Two walks are one if no point of them differs by more [m]: walls are numbered anew."""
MARGIN = 0.05
"""More than points of a path that are SPACING apart can miss [m]."""


def needs_map(row, questions, navigate=cs.navigate):
    """A Finding: "yes" if a way changed although what was taken away was never in view."""
    tried = 0
    for question in questions:
        route = ask(row, question, navigate)
        if route is None or not len(route.path):
            continue
        for k in unseen(route.path, question.obstacles, row.senses):
            without = replace(question, obstacles=question.obstacles[:k] + question.obstacles[k + 1 :])
            again = ask(row, without, navigate)
            tried += 1
            if again is None or not same(route.path, again.path):
                return Finding(
                    YES, "its path depends on walls out of sight", f"{question.name}, obstacle {k}"
                )
    if not tried:
        return Finding(NONE)
    shown = f"what is nearer than {row.senses:g} m" if row.senses else "what it touches"
    return Finding(NO, f"the same walk without each of {tried} obstacles: it depends on {shown}")


def unseen(path, obstacles, reach):
    """The numbers of obstacles farther from a path (m, 2) than `reach`."""
    pieces = [
        np.linspace(p, q, max(2, int(np.ceil(np.hypot(*(q - p)) / SPACING)) + 1))
        for p, q in itertools.pairwise(path)
    ]
    points = np.vstack([path[:1], *pieces])
    away = [nearest(points, [np.asarray(ring, float) for ring in rings])[0].min() for rings in obstacles]
    return [k for k, distance in enumerate(away) if distance > reach + MARGIN]


def same(path, other):
    return len(path) == len(other) and bool(np.abs(path - other).max() <= SAME)
