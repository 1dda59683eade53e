"""Shortest paths among polygons: the visibility graph built and asked, beside packages for Python.

Usage: python benchmarks/navigation_polygons.py [--corners 600 1200] [--rounds 3] [--queries 40]. Every
contender gets the same disjoint convex polygons; a build goes from their corners to a graph that can be
asked. Peers take seconds for that, so that theirs is done once. Writes
benchmarks/results/navigation_polygons.json.
"""

from __future__ import annotations

import argparse
import gc
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
from cspace.navigation import visibility_graph
from turns import Question

BOUNDS = (0.0, 0.0, worlds.SIDE, worlds.SIDE)
BUILDS = 15
"""Of ours, each from a fresh list of polygons."""
Made = tuple[Callable[[Any], Any], Callable[[Any], float], list[Any]]


def build_ours(polygons: list[Array]) -> Any:
    world = cs.PolygonWorld(polygons, BOUNDS)
    visibility_graph.visibility_graph(world)
    return world


def build_pyvisgraph(polygons: list[Array], ends: list[Any]) -> tuple[float, Made]:
    """Seconds to build, and how it is asked."""
    import pyvisgraph

    given = [[pyvisgraph.Point(*map(float, corner)) for corner in ring] for ring in polygons]
    graph = pyvisgraph.VisGraph()
    begin = time.process_time()
    graph.build(given, workers=1, status=False)
    seconds = time.process_time() - begin
    asked = [tuple(pyvisgraph.Point(*map(float, p)) for p in pair) for pair in ends]

    def length(path: Any) -> float:
        return float(sum(np.hypot(a.x - b.x, a.y - b.y) for a, b in pairwise(path)))

    return seconds, (lambda pair: graph.shortest_path(*pair), length, asked)


def build_extremity(polygons: list[Array], ends: list[Any]) -> tuple[float, Made]:
    """Seconds to build, and how it is asked."""
    import extremitypathfinder

    xmin, ymin, xmax, ymax = BOUNDS
    outline = [(xmin, ymin), (xmax, ymin), (xmax, ymax), (xmin, ymax)]
    holes = [[tuple(map(float, corner)) for corner in ring[::-1]] for ring in polygons]
    environment = extremitypathfinder.PolygonEnvironment()
    begin = time.process_time()
    environment.store(outline, holes, validate=False)
    if not environment.prepared:
        environment.prepare()
    seconds = time.process_time() - begin
    asked = [tuple(tuple(map(float, p)) for p in pair) for pair in ends]
    return seconds, (lambda pair: environment.find_shortest_path(*pair), lambda found: float(found[1]), asked)


PEERS = {"pyvisgraph": build_pyvisgraph, "extremitypathfinder": build_extremity}


def ours(polygons: list[Array], ends: list[Any], name: str) -> Iterator[tuple[Question, list[float]]]:
    """The graph, and beside it the search that needs none."""
    spent = []
    for _ in range(BUILDS):
        gc.collect()
        begin = time.process_time()
        world = build_ours(polygons)
        spent.append(1e3 * (time.process_time() - begin))
    for planner in ("visibility_graph", "any_angle"):
        asked = [tuple(tuple(map(float, p)) for p in pair) for pair in ends]

        def step(pair: Any, planner: str = planner) -> Any:
            return cs.navigate(world, pair[0], pair[1], planner=planner)

        judged = {"lengths": [step(pair).length for pair in asked]}
        label = f"cspace {planner}"
        question = Question(name, "shortest path", label, cs.__version__, step, asked, judged=judged)
        yield question, spent if planner == "visibility_graph" else []


def measured(corners: int, queries: int, rounds: int) -> list[dict[str, Any]]:
    """All contenders on one world."""
    rng = np.random.default_rng(corners)
    polygons = worlds.convex_field(corners, rng)
    ends = worlds.ends_in(cs.PolygonWorld(polygons, BOUNDS), queries, rng)
    name = f"{corners} corners"
    asked = list(ours(polygons, ends, name))
    for peer, build in PEERS.items():
        if importlib.util.find_spec(peer):
            seconds, (step, length, inputs) = build(polygons, ends)
            judged = {"lengths": [length(step(pair)) for pair in inputs]}
            version = importlib.metadata.version(peer)
            made = Question(name, "shortest path", peer, version, step, inputs, judged=judged)
            asked.append((made, [1e3 * seconds]))
    true = np.array(asked[0][0].judged["lengths"])
    for question, _ in asked:
        off = np.array(question.judged["lengths"]) / true - 1
        question.judged = {"longer": int((off > 1e-9).sum()), "shorter": int((off < -1e-9).sum())}
    rows = turns.every_input([question for question, _ in asked], rounds)
    for row, (_, spent) in zip(rows, asked, strict=True):
        low, high = np.percentile(spent, [50, 95]) if spent else (None, None)
        row["build_ms"] = {"median": low, "p95": high} if spent else None
    return rows


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--corners", type=int, nargs="*", default=(600, 1200))
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--queries", type=int, default=40)
    options = parser.parse_args()
    busy = run.load()
    rows = [row for n in options.corners for row in measured(n, options.queries, options.rounds)]
    turns.write("navigation_polygons", rows, busy)


if __name__ == "__main__":
    main()
