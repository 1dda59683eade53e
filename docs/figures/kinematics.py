"""Draws the figures of the page on kinematics: `python docs/figures/kinematics.py` writes them here."""

from __future__ import annotations

from pathlib import Path

import matplotlib

matplotlib.use("Agg")

import matplotlib.pyplot as plt
import numpy as np

import cspace as cs

HERE = Path(__file__).parent
INK, FAINT, BLUE, RED = "#222222", "#bbbbbb", "#1f6fb2", "#c8442f"


def planar(*lengths, lower=None, upper=None):
    """An arm with joints about z and links along x at zero."""
    points = [[sum(lengths[:i]), 0, 0] for i in range(len(lengths))]
    T_zero = cs.pose((sum(lengths), 0, 0))
    axes = [[0, 0, 1]] * len(lengths)
    return cs.Robot(cs.model.from_screws(axes, points, T_zero, lower=lower, upper=upper))


def joints_of(robot, q):
    """The places of the joints and of the tip."""
    return robot.fk_all(q)[1:, :2, 3]


def finish(ax, title):
    ax.set_aspect("equal")
    ax.set_title(title, color=INK, fontsize=10)
    ax.spines[["top", "right"]].set_visible(False)
    ax.set_xlabel("x [m]")


def ellipses() -> None:
    """The velocity ellipse along a motion from folded to stretched."""
    robot = planar(0.6, 0.4)
    fig, ax = plt.subplots(figsize=(7.2, 4.4))
    bends = np.radians([160, 115, 70, 30, 0])
    circle = np.linspace(0, 2 * np.pi, 200)
    for k, bend in enumerate(bends):
        q = np.array([np.radians([175, 163, 112, 55, 8][k]), -bend])
        directions, radii = robot.manipulability_ellipsoid(q, rows=("vx", "vy"))
        arm = joints_of(robot, q)
        shade = 0.25 + 0.75 * k / (len(bends) - 1)
        ax.plot(*arm.T, "-o", color=INK, alpha=shade, lw=2.2, ms=4, zorder=2)
        outline = arm[-1][:, None] + 0.2 * directions @ (radii[:, None] * [np.cos(circle), np.sin(circle)])
        ax.fill(*outline, facecolor=BLUE, alpha=0.18, lw=0, zorder=1)
        ax.plot(*outline, color=RED if radii[1] < 1e-9 else BLUE, lw=1.4, zorder=3)
        w = robot.manipulability(q, rows=("vx", "vy"))
        outward = arm[-1] / np.linalg.norm(arm[-1])
        clear = 0.2 * np.linalg.norm(radii * (outward @ directions)) + 0.03
        align = "left" if outward[0] > 0.3 else "right" if outward[0] < -0.3 else "center"
        ax.annotate(f"w = {w:.2f}", arm[-1] + clear * outward, color=INK, fontsize=9, ha=align)
    finish(ax, "what unit joint velocities give at the tip (a fifth of the size); flat, red: singular")
    ax.set_ylabel("y [m]")
    fig.tight_layout()
    fig.savefig(HERE / "ellipses.png", dpi=150)


def workspace() -> None:
    """Three planar arms: sampled points and the exact boundary."""
    third = np.pi / 3
    arms = [
        ("two joints, no limits", planar(0.6, 0.35), [0.5, 1.2]),
        ("±60°, 0 … 120°", planar(0.6, 0.35, lower=[-third, 0.0], upper=[third, 2 * third]), [0.3, 0.9]),
        (
            "three joints, ±60° each",
            planar(0.4, 0.3, 0.25, lower=[-third] * 3, upper=[third] * 3),
            [-0.4, 0.7, 0.9],
        ),
    ]
    fig, axes = plt.subplots(1, 3, figsize=(10.5, 3.9))
    for ax, (title, robot, q) in zip(axes, arms, strict=True):
        space = robot.workspace(4000, rng=3)
        ax.plot(*space.points[:, :2].T, ".", color=FAINT, ms=1.5, zorder=0)
        for curve in space.boundary:
            ax.plot(curve[:, 0], curve[:, 1], color=BLUE, lw=1.8, zorder=2)
        ax.plot(*joints_of(robot, np.array(q)).T, "-o", color=INK, lw=2.2, ms=4, zorder=3)
        finish(ax, f"{title}: {space.area:.2f} m²")
    axes[0].set_ylabel("y [m]")
    fig.tight_layout()
    fig.savefig(HERE / "reach.png", dpi=150)


if __name__ == "__main__":
    ellipses()
    workspace()
