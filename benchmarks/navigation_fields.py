"""Clearance and its diagram on a grid beside distance transforms, and the descent of a potential.

Usage: python benchmarks/navigation_fields.py [--rounds 15] [--queries 200].
Ours lights a fire at every
wall of a fresh grid: exact clearance, the label of the nearest piece of wall, the diagram and its branches.
scipy and edt make the distances alone, scikit-image distances and a skeleton without labels or graph. The
potential's descents run in convex fields and among traps. Writes benchmarks/results/navigation_fields.json.
"""

from __future__ import annotations

import argparse
import importlib.metadata
import importlib.util
from collections import Counter
from collections.abc import Iterator
from typing import Any

import numpy as np

import cspace as cs
import run
import turns
import worlds
from chains import Array
from turns import Question

MAPS = ("arena", "brc202d", "random-400-33")
FRESH = 3
"""Calls in a round: each of ours gets a grid that nothing is kept with."""
RESTS = {"goal", "minimum", "saddle", "crease", "wall"}


def fires(name: str) -> Iterator[Question]:
    """All contenders on one map."""
    blocked = worlds.grid(name).blocked
    free = np.ascontiguousarray(~blocked)
    padded = np.pad(free, 1)
    whole, part = "clearance, labels, diagram and its graph", "distances"

    def ours(cells: Array) -> Any:
        return cs.navigation.brushfire_diagram(cs.OccupancyGrid(cells))

    yield Question(name, whole, "cspace brushfire", cs.__version__, ours, [blocked] * FRESH)
    if importlib.util.find_spec("edt"):
        import edt

        yield peer(name, part, "edt", lambda cells: edt.edt(cells, black_border=True), free)
    if importlib.util.find_spec("scipy"):
        from scipy import ndimage

        yield peer(name, part, "scipy", ndimage.distance_transform_edt, padded)
        both = "distances and the nearest blocked cell"
        yield peer(
            name,
            both,
            "scipy",
            lambda cells: ndimage.distance_transform_edt(cells, return_indices=True),
            padded,
        )
    if importlib.util.find_spec("skimage"):
        from skimage import morphology

        skeleton = "distances and a skeleton"
        yield peer(
            name,
            skeleton,
            "scikit-image",
            lambda cells: morphology.medial_axis(cells, return_distance=True),
            padded,
        )


def peer(name: str, what: str, package: str, step: Any, cells: Array) -> Question:
    return Question(name, what, package, importlib.metadata.version(package), step, [cells] * FRESH)


def trap(rng: np.random.Generator) -> tuple[Any, Array, Array]:
    """A U that opens to the start's side, the goal behind it."""
    x, y = rng.uniform(35, 50), rng.uniform(30, 60)
    deep, high = rng.uniform(8, 20), rng.uniform(8, 20)
    corners = [(0, -high), (deep, -high), (deep, high), (0, high), (0, high - 2), (deep - 2, high - 2)]
    corners += [(deep - 2, 2 - high), (0, 2 - high)]
    world = cs.PolygonWorld([np.array(corners) + np.array((x, y))], (0, 0, worlds.SIDE, worlds.SIDE))
    return world, np.array((rng.uniform(5, 30), y)), np.array((rng.uniform(80, 95), y + rng.uniform(-1, 1)))


def field(rng: np.random.Generator) -> tuple[Any, Array, Array]:
    """Among fifty convex polygons."""
    world = cs.PolygonWorld(worlds.convex_field(300, rng), (0, 0, worlds.SIDE, worlds.SIDE))
    return (world, *worlds.ends_in(world, 1, rng)[0])


def descents(name: str, make: Any, count: int) -> Question:
    """Down the potential in many worlds; judged by how the descents ended."""
    rng = np.random.default_rng(7)
    inputs = [make(rng) for _ in range(count)]

    def step(given: Any) -> Any:
        return cs.navigate(given[0], given[1], given[2], planner="potential_field")

    routes = [step(given) for given in inputs]
    ends = Counter(route.evidence.kind for route in routes)
    judged: dict[str, Any] = {f"rest at {kind}": n for kind, n in sorted(ends.items())}
    judged["unclassified"] = sum(route.evidence.kind not in RESTS for route in routes)
    judged["false"] = sum(bool(route) != bool(np.allclose(route.path[-1], route.goal)) for route in routes)
    return Question(name, "descent", "cspace potential_field", cs.__version__, step, inputs, judged=judged)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--rounds", type=int, default=15)
    parser.add_argument("--queries", type=int, default=200)
    options = parser.parse_args()
    busy, rows = run.load(), []
    for name in MAPS:
        rows += turns.every_input(list(fires(name)), options.rounds)
    asked = [descents("convex field", field, options.queries), descents("U trap", trap, options.queries)]
    rows += turns.every_input(asked, 5)
    turns.write("navigation_fields", rows, busy)


if __name__ == "__main__":
    main()
