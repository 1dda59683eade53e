"""Two links among three polygons: the exact configuration space, and a way through it."""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path

import numpy as np

import cspace as cs

POLYGONS = Path(__file__).with_name("two_links.txt")


def main() -> None:
    arm = cs.load_robot("planar_2r")
    polygons = cs.PolygonWorld.from_text(POLYGONS)  # three, one of them not convex
    space = cs.configuration_space(arm, polygons, link_radius=0.04)
    for number, component in enumerate(space.components):
        print(f"component {number}: {component.area:.3f} rad², proved: {component.proved}")
    kinds = {curve.kind for curve in space.boundaries}
    print(len(space.boundaries), "boundary curves:", ", ".join(sorted(kinds)))

    # Every IK solution of a position is a goal, and the nearest one that is connected is reached.
    start = np.array([-0.3, 0.5])
    goals = arm.ik(position=[-1.2, 1.25, 0.0]).q
    way = space.path(start, goals)
    print(way.reason, f"- {len(way.path)} points, {way.length:.3f} rad")
    assert all(space.free(start + t * (way.path[1] - start)) for t in np.linspace(0, 1, 50))

    # The same scene as a picture of a million cells.
    print(f"{space.bitmap(1000).mean():.2%} of all configurations collide")

    folder = Path(sys.argv[1] if len(sys.argv) > 1 else tempfile.mkdtemp())
    picture = cs.plot.configuration_space(space, start=start, goals=goals, path=way)
    cs.plot.save(picture, folder / "two_links.png")
    print("drawn into", folder)
    assert way


if __name__ == "__main__":
    main()
