"""The suite of degenerate polygons (tests/cases/polygons): how many of its cases a contender gets right.

Usage: python benchmarks/navigation_degenerate.py. A case with a way is right if its length is, to 1e-12 of it
for ours and 1e-6 for others, and one without if that is said. Of ours every planner whose verdict is never
open has to be right, and faults have to be named. Packages that know no holes, bounds or walls without
thickness get what they can take. Writes benchmarks/results/navigation_degenerate.json.
"""

from __future__ import annotations

import contextlib
import importlib.metadata
import importlib.util
import json
import math
import signal
import sys
from collections import Counter
from collections.abc import Callable
from itertools import pairwise
from pathlib import Path
from typing import Any

HERE = Path(__file__).resolve().parent
RESULT = HERE / "results/navigation_degenerate.json"
sys.path.insert(0, str(HERE.parent / "tests"))

import cspace as cs  # noqa: E402
import polygon_cases  # noqa: E402
import run  # noqa: E402

SHORTEST = ("any_angle", "visibility_graph")
CERTAIN = (*SHORTEST, "exact_cells", "bug_1", "bug_2", "tangent_bug")
PATIENCE = 5
"""Seconds that a package gets for a case."""


def ours(case: Any) -> bool:
    """Whether every planner that is certain is right, or the fault is named."""
    try:
        world = case.world()
        routes = [cs.navigate(world, case.start, case.goal, name) for name in CERTAIN]
    except cs.CspaceError as error:
        return case.verdict == "error" and all(words in str(error) for words in case.says)
    if any(route.status != case.verdict for route in routes):
        return False
    lengths = [route.length for route in routes if route and route.planner in SHORTEST]
    return all(math.isclose(length, case.length, rel_tol=1e-12, abs_tol=1e-15) for length in lengths)


def extremity(case: Any) -> float:
    """The length that extremitypathfinder finds; infinite where it finds no way."""
    import extremitypathfinder

    xmin, ymin, xmax, ymax = case.bounds or case.world().bounds
    environment = extremitypathfinder.PolygonEnvironment()
    outline = [(xmin, ymin), (xmax, ymin), (xmax, ymax), (xmin, ymax)]
    environment.store(outline, [clockwise(rings[0]) for rings in case.obstacles], validate=False)
    path, length = environment.find_shortest_path(tuple(case.start), tuple(case.goal))
    return float(length) if path else math.inf


def clockwise(ring: list[list[float]]) -> list[tuple[float, float]]:
    corners = [(float(x), float(y)) for x, y in ring]
    area = sum(a[0] * b[1] - a[1] * b[0] for a, b in zip(corners, [*corners[1:], corners[0]], strict=True))
    return corners[::-1] if area > 0 else corners


def pyvis(case: Any) -> float:
    """The length that pyvisgraph finds; infinite where it finds no way."""
    import pyvisgraph

    graph = pyvisgraph.VisGraph()
    graph.build(
        [[pyvisgraph.Point(*p) for p in rings[0]] for rings in case.obstacles], workers=1, status=False
    )
    path = graph.shortest_path(pyvisgraph.Point(*case.start), pyvisgraph.Point(*case.goal))
    return math.fsum(math.hypot(a.x - b.x, a.y - b.y) for a, b in pairwise(path)) if path else math.inf


def peer(case: Any, length: Callable[[Any], float]) -> str:
    """ "right", "wrong", "raises" or "hangs"."""

    def late(*_: object) -> None:
        raise TimeoutError

    signal.signal(signal.SIGALRM, late)
    signal.alarm(PATIENCE)
    try:
        found = length(case)
    except TimeoutError:
        return "hangs"
    except Exception:
        return "raises"
    finally:
        signal.alarm(0)
    right = math.isclose(found, case.length, rel_tol=1e-6, abs_tol=1e-12)
    return "right" if right else "wrong"


def main() -> None:
    every = polygon_cases.polygon_cases()
    passed = [ours(case) for case in every]
    told: dict[str, Any] = {"machine": run.machine(), "cases": len(every), "passed": sum(passed)}
    told["failed"] = [case.shows for case, good in zip(every, passed, strict=True) if not good]
    asked = [case for case in every if case.verdict != "error"]
    told["peers"] = {"asked": len(asked)}
    for package, length in {"extremitypathfinder": extremity, "pyvisgraph": pyvis}.items():
        if importlib.util.find_spec(package):
            with contextlib.redirect_stderr(None):
                counts = Counter(peer(case, length) for case in asked)
            told["peers"][f"{package} {importlib.metadata.version(package)}"] = dict(sorted(counts.items()))
    RESULT.write_text(json.dumps(told, indent=1, ensure_ascii=False) + "\n", encoding="utf-8")
    print(told)


if __name__ == "__main__":
    main()
