"""Planners that draw samples, beside OMPL: time, how often they arrive, how long and free their paths are.

Usage: python benchmarks/navigation_sampling.py [--queries 30]. OMPL asks a function of Python whether a state
is valid, as its users write it: here a look-up in a raster of 2,000 × 2,000 made beforehand, the cheapest
there is. Along a motion OMPL asks at one hundredth of the world's extent, which is its default. Writes
benchmarks/results/navigation_sampling.json.
"""

from __future__ import annotations

import argparse
import importlib.metadata
import importlib.util
import time
from collections.abc import Callable, Iterator
from itertools import pairwise
from typing import Any

import numpy as np

import cspace as cs
import run
import turns
import worlds
from chains import Array

CORNERS = 600
SIDE = worlds.SIDE
CELLS = 2000
PATIENCE = 5.0
"""Seconds for a planner that stops at the first path."""
Answer = tuple[Array | None, float]
"""Path and processor time [ms]."""


def ours(world: Any, planner: str, **more: Any) -> Callable[[Any, Any, int], Answer]:
    def ask(start: Array, goal: Array, seed: int) -> Answer:
        begin = time.process_time()
        route = cs.navigate(world, start, goal, planner=planner, rng=seed, **more)
        spent = 1e3 * (time.process_time() - begin)
        return (route.path if route else None), spent

    return ask


def theirs(image: bytes, planner: str, seconds: float) -> Callable[[Any, Any, int], Answer]:
    from ompl import base, geometric, util

    util.setLogLevel(util.LogLevel.LOG_NONE)
    scale = CELLS / SIDE

    def ask(start: Array, goal: Array, seed: int) -> Answer:
        space = base.RealVectorStateSpace(2)
        limits = base.RealVectorBounds(2)
        limits.setLow(0.0)
        limits.setHigh(SIDE)
        space.setBounds(limits)
        setup = geometric.SimpleSetup(space)
        valid = lambda state: image[int(state[1] * scale) * (CELLS + 1) + int(state[0] * scale)] == 0  # noqa: E731
        setup.setStateValidityChecker(valid)
        ends = [space.allocState() for _ in range(2)]
        for state, point in zip(ends, (start, goal), strict=True):
            state[0], state[1] = map(float, point)
        setup.setStartAndGoalStates(*ends)
        setup.setPlanner(getattr(geometric, planner)(setup.getSpaceInformation()))
        begin = time.process_time()
        setup.solve(seconds)
        spent = 1e3 * (time.process_time() - begin)
        if not setup.haveExactSolutionPath():
            return None, spent
        return np.array([(s[0], s[1]) for s in setup.getSolutionPath().getStates()]), spent

    return ask


def contenders(world: Any) -> Iterator[tuple[str, str, str, Callable[[Any, Any, int], Answer]]]:
    """What is asked, contender, version, how."""
    first, best = "a path", "a short path"
    yield first, "cspace rrt", cs.__version__, ours(world, "rrt")
    yield first, "cspace prm", cs.__version__, ours(world, "prm")
    for samples in (2_000, 20_000):
        label = f"cspace rrt_star, {samples:,} samples"
        yield best, label, cs.__version__, ours(world, "rrt_star", samples=samples)
    if importlib.util.find_spec("ompl"):
        version = importlib.metadata.version("ompl")
        image = raster(world)
        for planner in ("RRT", "RRTConnect", "PRM"):
            yield first, f"OMPL {planner}", version, theirs(image, planner, PATIENCE)
        for planner in ("RRTstar", "InformedRRTstar"):
            for seconds in (0.1, 1.0):
                label = f"OMPL {planner}, {seconds:g} s"
                yield best, label, version, theirs(image, planner, seconds)


def raster(world: Any) -> bytes:
    """Row after row, 0 where free; one row and column more, for states on the border."""
    blocked = world.to_grid(SIDE / CELLS).blocked
    return bytes(np.pad(blocked, ((0, 1), (0, 1)), mode="edge").astype(np.uint8).tobytes())


def measured(queries: int) -> Iterator[dict[str, Any]]:
    """All contenders on one world, question after question, contender after contender."""
    rng = np.random.default_rng(CORNERS)
    world = cs.PolygonWorld(worlds.convex_field(CORNERS, rng), (0, 0, SIDE, SIDE))
    ends = worlds.ends_in(world, queries, rng)
    shortest = [cs.navigate(world, *pair).length for pair in ends]
    asked = list(contenders(world))
    told: list[list[tuple[Array | None, float]]] = [[] for _ in asked]
    for seed, pair in enumerate(ends):
        for answers, (*_, ask) in zip(told, asked, strict=True):
            answers.append(ask(*pair, seed))
    for answers, (what, contender, version, _) in zip(told, asked, strict=True):
        spent = run.summary(1e6 * ms for _, ms in answers)
        pairs = [(path, true) for (path, _), true in zip(answers, shortest, strict=True) if path is not None]
        ratios = [np.hypot(*np.diff(path, axis=0).T).sum() / true for path, true in pairs]
        judged = {"arrived": len(pairs) / len(answers), "ratio": float(np.median(ratios))}
        judged["ratio_p95"] = float(np.percentile(ratios, 95))
        judged["enters"] = sum(not free(world, path) for path, _ in pairs) / max(len(pairs), 1)
        names = {"arm": f"{CORNERS} corners", "what": what, "contender": contender, "version": version}
        yield {**names, "items": 1, "time": spent, "judged": judged}


def free(world: Any, path: Array) -> bool:
    """Whether no leg enters an obstacle: each shortest path between its ends is the leg itself."""
    for a, b in pairwise(path):
        if not (world.is_free(a) and world.is_free(b)):
            return False
        if cs.navigate(world, a, b).length > np.hypot(*(b - a)) * (1 + 1e-12):
            return False
    return True


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--queries", type=int, default=30)
    options = parser.parse_args()
    busy = run.load()
    rows = list(measured(options.queries))
    for row in rows:
        print(row, flush=True)
    turns.write("navigation_sampling", rows, busy)


if __name__ == "__main__":
    main()
