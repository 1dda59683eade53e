"""From here to there through a map: every planner asked the same question, and what each promises."""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path

import cspace as cs

YARD = Path(__file__).with_name("yard.txt")


def main() -> None:
    world = cs.PolygonWorld.from_text(YARD)
    start, goal = (1, 1), (9, 9)

    # The shortest path, exactly; then everyone else.
    shortest = cs.navigate(world, start, goal)
    print(shortest.path.round(3).tolist(), shortest.reason)
    routes = [cs.navigate(world, start, goal, planner) for planner in cs.navigation.PLANNERS]
    for route in routes:
        ratio = route.length / shortest.length
        print(f"{route.planner:20} {ratio:6.3f} × the shortest, {route.stats.nodes} nodes")

    # The court in the first shed has no door: the answer is no, and says why.
    inside = cs.navigate(world, start, (3.5, 3.5), "bug_2")
    print(inside.status, "-", inside.reason)

    # A robot with a body keeps its radius from every wall.
    wide = cs.navigate(world, start, goal, radius=0.3)
    print(f"{wide.length - shortest.length:.3f} m longer for a robot of 30 cm")

    folder = Path(sys.argv[1] if len(sys.argv) > 1 else tempfile.mkdtemp())
    cs.plot.save(cs.plot.routes(routes), folder / "yard.png")
    print("drawn into", folder)
    assert all(routes)
    assert not inside


if __name__ == "__main__":
    main()
