"""Draws the figures of the pages on poses: `python docs/figures/poses.py` writes them beside this file."""

from __future__ import annotations

from pathlib import Path

import matplotlib

matplotlib.use("Agg")

import matplotlib.pyplot as plt
import numpy as np

import cspace as cs

HERE = Path(__file__).parent
INK, FAINT, BLUE, RED, GREEN = "#222222", "#bbbbbb", "#1f6fb2", "#c8442f", "#3a8f4d"
FLAG = np.array([[0.0, 0.0], [0.9, 0.0], [0.9, 0.5], [0.45, 0.5], [0.45, 0.25], [0.0, 0.25]])


def draw_body(ax, T, color, *, alpha=1.0, label=None):
    """An L-shaped body whose frame is T, with the frame's origin as a dot."""
    outline = cs.transform_points_2d(T, FLAG)
    ax.fill(*outline.T, facecolor=color, edgecolor=color, alpha=0.22 * alpha, lw=0)
    ax.plot(*np.vstack([outline, outline[:1]]).T, color=color, alpha=alpha, lw=1.6)
    ax.plot(*T[:2, 2], "o", color=color, ms=4, alpha=alpha)
    if label:
        middle = cs.transform_points_2d(T, (0.675, 0.25))
        ax.annotate(label, middle, color=color, ha="center", va="center", fontsize=10)


def pole() -> None:
    """A planar displacement, the pole, and the motion about it."""
    fig, ax = plt.subplots(figsize=(6.4, 4.6))
    start = cs.pose_2d((1.6, 0.2), theta=0.2)
    end = cs.pose_2d((-0.6, 1.9), theta=2.1)
    move = end @ cs.inverse_pose_2d(start)
    c = cs.pole_of(move).point
    for t in np.linspace(0.0, 1.0, 7)[1:-1]:
        draw_body(ax, cs.interpolate_2d(start, end, t), FAINT)
    draw_body(ax, start, BLUE, label="start")
    draw_body(ax, end, RED, label="end")
    for corner in (FLAG[0], FLAG[2]):
        way = cs.transform_points_2d(cs.interpolate_2d(start, end, np.linspace(0, 1, 60)), corner)
        ax.plot(*way.T, color=GREEN, lw=1.0, ls="--")
        for p in (way[0], way[-1]):
            ax.plot(*np.stack([c, p]).T, color=FAINT, lw=0.9, zorder=0)
    ax.plot(*c, "o", color=INK, ms=7)
    ax.annotate("pole", c, xytext=(10, -14), textcoords="offset points", color=INK, fontsize=11)
    ax.set_aspect("equal")
    ax.set_xlabel("x [m]")
    ax.set_ylabel("y [m]")
    ax.spines[["top", "right"]].set_visible(False)
    fig.tight_layout()
    fig.savefig(HERE / "pole.png", dpi=150)


def draw_frame(ax, T, *, size=0.22, alpha=1.0):
    for k, color in enumerate((RED, GREEN, BLUE)):
        ax.plot(*np.stack([T[:3, 3], T[:3, 3] + size * T[:3, k]]).T, color=color, lw=1.5, alpha=alpha)


def draw_path(ax, between, start, end, title):
    for T in between(start, end, np.linspace(0.0, 1.0, 13)):
        draw_frame(ax, T, alpha=0.9)
    ax.plot(*between(start, end, np.linspace(0.0, 1.0, 100))[:, :3, 3].T, color=INK, lw=1.2)
    ax.set_title(title, fontsize=11, color=INK)
    ax.set_box_aspect((1, 1, 1))
    ax.set(xlim=(-0.9, 0.9), ylim=(-0.9, 0.9), zlim=(-0.1, 1.7), xlabel="x [m]", ylabel="y [m]")
    ax.set_zlabel("z [m]")
    ax.locator_params(nbins=4)
    ax.view_init(elev=24, azim=-57)


def screw() -> None:
    """Between the same two poses: along the screw, and with the origin on a straight line."""
    start = cs.pose((0.7, 0.0, 0.0))
    end = cs.Screw(axis=(0, 0, 1), point=(0, 0, 0), pitch=1.5 / 2.8, magnitude=2.8).pose() @ start
    fig = plt.figure(figsize=(9.6, 4.6))
    left = fig.add_subplot(1, 2, 1, projection="3d")
    draw_path(left, cs.interpolate, start, end, "interpolate: along the screw")
    s = cs.screw_of(end @ cs.inverse_pose(start))
    along = s.point + np.outer([-0.1, 1.7], s.axis)
    left.plot(*along.T, color=INK, lw=1.0, ls="-.")
    right = fig.add_subplot(1, 2, 2, projection="3d")
    draw_path(right, cs.interpolate_decoupled, start, end, "interpolate_decoupled: line and slerp")
    fig.subplots_adjust(left=0.0, right=0.96, bottom=0.06, top=0.94, wspace=0.08)
    fig.savefig(HERE / "screw.png", dpi=150)


if __name__ == "__main__":
    pole()
    screw()
