"""A car backs into a free place, a controller drives the way, and a robot sweeps the park at night."""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path

import numpy as np

import cspace as cs

nav = cs.navigation


def car_park() -> cs.OccupancyGrid:
    """Two rows of parked cars with a lane between them and one place left, 40 × 20 m."""
    blocked = np.zeros((100, 200), dtype=bool)
    blocked[[0, -1], :] = blocked[:, [0, -1]] = True
    for left in range(7, 200, 15):
        blocked[3:27, left : left + 10] = True
        if left != 127:
            blocked[70:94, left : left + 10] = True
    return cs.OccupancyGrid(blocked, resolution=0.2)


def main() -> None:
    park, car = car_park(), nav.Car()
    gate, place = (3.0, 10.0, 0.0), (26.6, 17.5, -np.pi / 2)

    # Without the other cars: the shortest curve with reverse gear.
    print(nav.reeds_shepp(gate, place, car.turning_radius))

    # Among them: a search over poses. The car touches nothing on the way; arcs wider than the tightest
    # leave its steering something to correct with.
    route = nav.hybrid_a_star(park, gate, place, vehicle=car, radius=5.0)
    print(route.reason, route.stats)

    # A controller that sees only the path drives it in a simulator that knows the park.
    run = nav.follow(route, "pure_pursuit", vehicle=car, world=park, speed=1.0, lookahead=1.5)
    print(run.reason, f"at most {np.abs(run.cross_track).max():.3f} m beside the path")

    swept = nav.coverage(park, (3.0, 10.0), width=1.0)
    print(swept.reason)

    folder = Path(sys.argv[1] if len(sys.argv) > 1 else tempfile.mkdtemp())
    cs.plot.save(cs.plot.drive(route), folder / "parking.png")
    cs.plot.save(cs.plot.coverage(swept), folder / "sweep.png")
    print("drawn into", folder)
    assert route
    assert run
    assert swept


if __name__ == "__main__":
    main()
