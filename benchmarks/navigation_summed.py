"""How far the descent of a potential is locally optimal in the potential summed along its path.

Every descent that arrives among convex polygons is drawn tight: its points move across the path, coarse
pieces first, as long as the integral of U along it falls, and never through a wall. That finds the least
of the paths near it, of its own homotopy class. Writes benchmarks/results/navigation_summed.json: the
distribution of the least sum over that of the descent.
"""

from __future__ import annotations

import argparse
import json
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

import cspace as cs
import worlds

Array = npt.NDArray[np.float64]
LOOKS = 8
"""Places at which the potential of a piece is looked at."""


class Summed:
    """The integral of a potential along paths."""

    def __init__(self, world: Any, route: Any) -> None:
        self.world, self.goal = world, route.goal
        self.gains = {name: value for name, value in route.evidence.gains.items() if name != "step"}
        self.share = (np.arange(LOOKS) + 0.5) / LOOKS

    def pieces(self, a: Array, b: Array) -> Array:
        """∫ U ds of segments from a to b, (..., 2) [m] each: (...)."""
        at = a[..., None, :] + self.share[:, None] * (b - a)[..., None, :]
        heights = cs.navigation.potential(self.world, self.goal, at, **self.gains)
        return np.asarray(np.linalg.norm(b - a, axis=-1) * heights.mean(axis=-1))


def resampled(path: Array, count: int) -> Array:
    """A path of so many pieces of one length."""
    along = np.concatenate(([0], np.cumsum(np.linalg.norm(np.diff(path, axis=0), axis=1))))
    where = np.linspace(0, along[-1], count + 1)
    return np.stack([np.interp(where, along, path[:, k]) for k in (0, 1)], axis=1)


def tightened(summed: Summed, path: Array, rounds: int) -> Array:
    """Every second point moved across the path to where the pieces beside it sum least, then the others."""
    width = np.full(len(path), 0.25 * np.linalg.norm(path[1] - path[0]))
    for k in range(2 * rounds):
        at = np.arange(1 + k % 2, len(path) - 1, 2)
        if not len(at):
            continue
        before, after = path[at - 1], path[at + 1]
        across = (after - before)[:, ::-1] * (-1, 1)
        across /= np.maximum(np.linalg.norm(across, axis=1, keepdims=True), 1e-300)
        tried = path[at] + np.array([0, -1, 1])[:, None, None] * (width[at, None] * across)
        sums = summed.pieces(np.broadcast_to(before, tried.shape), tried)
        sums = sums + summed.pieces(tried, np.broadcast_to(after, tried.shape))
        best = np.argmin(sums, axis=0)
        path[at] = tried[best, np.arange(len(at))]
        width[at] *= np.where(best == 0, 0.6, 1.3)
    return path


def is_homotopic(world: Any, path: Array, other: Array) -> bool:
    """Whether no obstacle lies between two paths with the same ends."""
    loop = np.concatenate((path, other[-2::-1]))
    for rings in world.obstacles:
        spokes = loop - rings[0][0]
        a, b = spokes[:-1], spokes[1:]
        turns = np.arctan2(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0], np.sum(a * b, axis=1)).sum()
        if abs(turns) > 1:
            return False
    return True


def least_near(summed: Summed, path: Array) -> float:
    """The least sum that tightening the path finds, over that of the path."""
    own = float(summed.pieces(path[:-1], path[1:]).sum())
    least, first = own, path
    for count in (8, 16, 32, 64):
        tight = tightened(summed, resampled(path, count), 60)
        found = float(summed.pieces(tight[:-1], tight[1:]).sum())
        if found < least and is_homotopic(summed.world, first, tight):
            least, path = found, tight
    return least / own


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--descents", type=int, default=200)
    wanted = parser.parse_args().descents
    rng = np.random.default_rng(19)
    ratios: list[float] = []
    straight = asked = 0
    while len(ratios) < wanted:
        world = cs.PolygonWorld(worlds.convex_field(120, rng), (0, 0, worlds.SIDE, worlds.SIDE))
        for start, goal in worlds.ends_in(world, 20, rng):
            route = cs.navigate(world, start, goal, planner="potential_field")
            asked += 1
            if route and len(ratios) < wanted:
                ratios.append(least_near(Summed(world, route), route.path))
                straight += route.length < 1.001 * float(np.linalg.norm(np.subtract(goal, start)))
    found = np.array(ratios)
    result = {
        "asked": asked,
        "arrived": len(found),
        "straight": int(straight),
        "within 1 %": float(np.mean(found > 0.99)),
        "within 5 %": float(np.mean(found > 0.95)),
        "median": float(np.median(found)),
        "tenth": float(np.quantile(found, 0.1)),
        "least": float(found.min()),
    }
    into = Path(__file__).parent / "results" / "navigation_summed.json"
    into.write_text(json.dumps(result, indent=1) + "\n")


if __name__ == "__main__":
    main()
