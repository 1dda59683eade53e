"""Draws the figure of the page on tracking: `python docs/figures/tracking.py` writes it here."""

from __future__ import annotations

from pathlib import Path

import matplotlib

matplotlib.use("Agg")

import matplotlib.pyplot as plt
import numpy as np

import cspace as cs

HERE = Path(__file__).parent
INK, FAINT, BLUE, RED = "#222222", "#999999", "#1f6fb2", "#c8442f"
MARKS = {"limit": "o", "singularity": "s", "unreachable": "X", "jump": "^"}


def line():
    """The robot and the path of the page."""
    ahead = (0.0, np.pi / 2, 0.0)  # the flange points along x
    first, last = cs.pose([-0.3, -0.5, -0.5], rpy=ahead), cs.pose([-0.7, -0.1, -0.2], rpy=ahead)
    poses = cs.spatial.interpolate_decoupled(first, last, np.linspace(0, 1, 100))
    return cs.load_robot("crx10ia"), poses


def tracking() -> None:
    """The angles of every joint on every branch, and where the branches end."""
    robot, poses = line()
    track = robot.track(poses)
    fig, axes = plt.subplots(2, 3, figsize=(8.6, 4.6), sharex=True)
    for j, ax in enumerate(axes.flat):
        for branch in track:
            best = branch is track.best
            style = dict(color=BLUE if branch else FAINT, lw=2.6 if best else 1.2, zorder=3 if best else 2)
            ends = [*range(len(branch.q))] + ([] if branch else [branch.end])
            angles = branch.q[:, j] if branch else np.append(branch.q[:, j], branch.last[j])
            ax.plot(ends, np.degrees(angles), **style)
            if not branch:
                held = branch.joint == robot.joint_names[j] or branch.cause != "limit"
                ax.plot(
                    branch.end,
                    np.degrees(branch.last[j]),
                    MARKS[branch.cause],
                    color=RED if branch.cause == "limit" else INK,
                    mfc=(RED if branch.cause == "limit" else INK) if held else "white",
                    ms=5,
                    zorder=4,
                )
        ax.set_title(robot.joint_names[j], color=INK, fontsize=9)
        ax.spines[["top", "right"]].set_visible(False)
        ax.tick_params(labelsize=8)
    for ax in axes[1]:
        ax.set_xlabel("pose", fontsize=9)
    for ax in axes[:, 0]:
        ax.set_ylabel("angle [°]", fontsize=9)
    fig.tight_layout()
    fig.savefig(HERE / "tracking.png", dpi=110)
    plt.close(fig)


if __name__ == "__main__":
    tracking()
