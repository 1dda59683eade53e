"""Draws the figures of the page on the C-space of two links: `python docs/figures/two_joint_space.py`."""

from __future__ import annotations

from pathlib import Path

import matplotlib

matplotlib.use("Agg")

import cspace as cs

HERE = Path(__file__).parent
POLYGONS = HERE.parents[1] / "examples/two_links.txt"


def main() -> None:
    arm = cs.load_robot("planar_2r")
    space = cs.configuration_space(arm, cs.PolygonWorld.from_text(POLYGONS), link_radius=0.04)
    start, goals = [-0.3, 0.5], arm.ik(position=[-1.2, 1.25, 0.0]).q
    way = space.path(start, goals)
    artists = cs.plot.configuration_space(space, start=start, goals=goals, path=way)
    cs.plot.save(artists, HERE / "two_joint_space.png", dpi=120)
    posts = [[(x - 0.1, -0.1), (x + 0.1, -0.1), (x + 0.1, 0.1), (x - 0.1, 0.1)] for x in (0.6, -0.6)]
    between = cs.configuration_space(arm, posts)
    artists = cs.plot.configuration_space(between, start=[1.57, 0.0], goals=[[-1.57, 0.0]])
    cs.plot.save(artists, HERE / "two_posts.png", dpi=80)


if __name__ == "__main__":
    main()
