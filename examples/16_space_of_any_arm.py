"""Two joints of a seven-joint arm: what is free, proved; and how much of the whole space is."""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path

import numpy as np

import cspace as cs


def main() -> None:
    robot = cs.load_robot("panda")
    scene = cs.Scene.load(Path(__file__).with_name("cell.toml"))
    space = cs.configuration_space(robot, scene)
    ready = robot.named_poses["ready"]

    # A slice: the second and the fourth joint move, the others are held.
    part = space.slice((1, 3), at=ready)
    low, high = part.free_bounds
    print(part)
    print(f"between {low:.2%} and {high:.2%} of the slice is free, proved")
    for number, name in enumerate(part.obstacles):
        print(f"{name}: {(part.obstacle_map == number).mean():.2%}")
    i, j = np.argwhere(part.is_proved & ~part.bitmap)[0]
    q = part.configurations()[i, j]
    assert space.blocked_by(q) is None

    # A projection: can the other joints be set so that these two are free?
    shadow = space.project((1, 3), samples=64, including=ready)
    print(shadow)
    assert shadow.is_free.any()

    # The volume: the free share of all seven dimensions, and what blocks the rest.
    volume = space.volume(50_000)
    print(volume)

    folder = Path(sys.argv[1] if len(sys.argv) > 1 else tempfile.mkdtemp())
    cs.plot.save(cs.plot.space_slice(part), folder / "slice.png")
    cs.plot.save(cs.plot.space_projection(shadow, q=ready), folder / "projection.png")
    print("drawn into", folder)


if __name__ == "__main__":
    main()
