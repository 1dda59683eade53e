"""Draws the figures of the page on closed loops: `python docs/figures/closed_loops.py` writes them here."""

from __future__ import annotations

from pathlib import Path

import matplotlib

matplotlib.use("Agg")

import matplotlib.pyplot as plt
import numpy as np

import cspace as cs
from cspace.mechanisms import Delta, FourBar, SliderCrank, Stewart

HERE = Path(__file__).parent


def draw_four_bar() -> None:
    """Both assembly modes, and a full turn of the crank with the dead points of the rocker."""
    linkage = FourBar(ground=1.0, crank=0.3, coupler=0.9, rocker=0.7)
    modes = linkage.assembly_modes({"crank": 0.9})
    figure, (left, right) = plt.subplots(
        1, 2, figsize=(10.5, 4.2), dpi=120, layout="constrained", width_ratios=[1, 1.15]
    )
    cs.plot.mechanism(linkage, modes.q, ax=left, title="both assembly modes of a four-bar, crank at 0.9 rad")
    turns = np.linspace(0.0, 2.0 * np.pi, 361)
    motion = linkage.follow({"crank": turns}, linkage.assembly_modes({"crank": 0.0}).q[0])
    qd = linkage.velocities(motion.q, {"crank": np.ones(len(turns))})
    right.plot(turns, motion.q[:, 2], label="rocker [rad]")
    right.plot(turns, qd[:, 2], label="its velocity by that of the crank")
    for q in linkage.dead_points("rocker"):
        if q[2] > 0:
            right.axvline(q[0] % (2.0 * np.pi), color="0.6", linestyle="--", linewidth=1.0)
    right.axhline(0.0, color="0.8", linewidth=0.8)
    right.set(xlabel="crank [rad]", ylabel="rocker [rad]; velocity ratio [rad/rad]", xlim=(0.0, 2.0 * np.pi))
    right.set_title("a full turn; dashed: dead points of the rocker", fontsize=9, loc="left")
    right.legend(fontsize=8)
    figure.savefig(HERE / "four_bar.png")
    plt.close(figure)


def draw_others() -> None:
    """A slider-crank, a delta robot and a Stewart platform."""
    engine = SliderCrank(crank=0.4, rod=0.8, offset=0.1)
    delta = Delta(base_radius=0.2, platform_radius=0.06, arm=0.25, rod=0.6)
    platform = Stewart.of_radii(base_radius=0.5, platform_radius=0.3, height=0.6)
    figure = plt.figure(figsize=(12.0, 4.2), dpi=120)
    flat = figure.add_axes((0.06, 0.16, 0.27, 0.62))
    left, right = (figure.add_axes((x, 0.02, 0.28, 0.86), projection="3d") for x in (0.36, 0.68))
    cs.plot.mechanism(engine, engine.assembly_modes({"crank": 1.1}).q, ax=flat)
    flat.set(ylim=(-0.35, 0.75))
    place = {"x": 0.05, "y": -0.03, "z": -0.55}
    cs.plot.mechanism(delta, delta.assembly_modes(place).q[0], ax=left)
    pose = platform.pose_coordinates(cs.pose((0.05, 0.0, 0.62), rpy=(0.15, -0.1, 0.2)))
    cs.plot.mechanism(platform, platform.assembly_modes(pose).q[0], ax=right)
    for x, title in ((0.06, "slider-crank"), (0.4, "delta robot"), (0.72, "Stewart platform")):
        figure.text(x, 0.86, title, fontsize=11)
    figure.savefig(HERE / "mechanisms.png")
    plt.close(figure)


if __name__ == "__main__":
    draw_four_bar()
    draw_others()
