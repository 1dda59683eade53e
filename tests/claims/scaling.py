"""How time and expanded nodes grow with the size of the world: exponents, fitted over at least six sizes."""

from __future__ import annotations

import time
from dataclasses import dataclass

import numpy as np
from scipy.stats import t as student

import cspace as cs
from claims.cells import NONE, Finding
from claims.families import field_to_cross
from claims.judge import ask
from claims.rows import LINEAR, LOG_LINEAR, SQUARE

SIZES = (4, 6, 8, 12, 17, 24, 32)
"""Rasters of convex fields: 70 to 4,500 corners, 1,600 to 102,400 cells."""
SEEDS = 2
FEWEST = 6
"""Over fewer sizes no exponent is fitted."""
TURNS = 3
"""The least of so many times is taken: what else runs only adds."""
PATIENCE = 3.0
"""A size that takes longer than this [s] is the last."""
CONFIDENCE = 0.95
CACHES = 0.1
"""How much faster a time may grow than is claimed: larger worlds fit less into a processor's caches."""

CURVES = {
    LINEAR: lambda n: n,
    LOG_LINEAR: lambda n: n * np.log(n),
    SQUARE: lambda n: n**2 * np.log(n),
}


@dataclass(frozen=True)
class Growth:
    """An exponent with half the width of its confidence interval."""

    exponent: float
    within: float
    points: int
    slope_claimed: float | None = None

    def __str__(self):
        return f"n^{self.exponent:.2f} ± {self.within:.2f}"


def measure(row, sizes=SIZES, seeds=SEEDS, navigate=cs.navigate, clock=time.process_time):
    """A list of {n, seconds, nodes}: n is the number of corners, or of cells. The time is that of making a
    world and asking it one question."""
    points = []
    for size in sizes:
        for seed in range(seeds):
            asked = field_to_cross(size, seed)
            times = []
            for _ in range(TURNS):
                fresh = Fresh(asked, row.world)
                began = clock()
                route = ask(row, fresh, navigate)
                times.append(clock() - began)
                if times[-1] > PATIENCE / 3:
                    break
            if route is None:
                continue
            n = asked.blocked.size if row.world == "grid" else asked.corners
            points.append({"size": size, "n": int(n), "seconds": min(times), "nodes": int(route.stats.nodes)})
        if points and points[-1]["seconds"] > PATIENCE:
            break
    return points


class Fresh:
    """A question whose world is made when it is asked."""

    def __init__(self, asked, kind):
        self.asked, self.kind, self.seed = asked, kind, asked.seed
        self.start, self.goal = asked.start, asked.goal
        self.blocked = asked.blocked

    @property
    def world(self):
        if self.kind == "grid":
            return cs.OccupancyGrid(self.blocked)
        return cs.PolygonWorld(self.asked.obstacles, self.asked.bounds)


def fit(points, key, claimed=None):
    """The slope of log(value) over log(n) by least squares; None for fewer than six sizes."""
    n, value = (np.array([p[k] for p in points], dtype=float) for k in ("n", key))
    if len({p["size"] for p in points}) < FEWEST or (value <= 0).any():
        return None
    x, y = np.log(n), np.log(value)
    slope, offset = np.polyfit(x, y, 1)
    left = y - slope * x - offset
    error = np.sqrt((left @ left) / (len(x) - 2) / ((x - x.mean()) ** 2).sum())
    expected = None if claimed is None else float(np.polyfit(x, np.log(CURVES[claimed](n)), 1)[0])
    quantile = student.ppf((1 + CONFIDENCE) / 2, len(x) - 2)
    return Growth(float(slope), float(quantile * error), len(x), expected)


def cost(row, points, key="seconds"):
    """A Finding whose word is the claimed curve where the growth does not exceed it, else the exponent."""
    claimed = row.claim.cost if key == "seconds" else None
    growth = fit(points, key, claimed)
    if growth is None:
        return Finding(NONE)
    if growth.slope_claimed is None:
        return Finding(str(growth))
    if growth.exponent - growth.within <= growth.slope_claimed + CACHES:
        return Finding(claimed, f"{growth}; {claimed} would be n^{growth.slope_claimed:.2f} here")
    return Finding(str(growth), f"more than {claimed}, which would be n^{growth.slope_claimed:.2f} here")
