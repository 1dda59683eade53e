"""Draws the figure of the page on pose graphs: `python docs/figures/pose_graphs.py` writes it here."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import matplotlib

matplotlib.use("Agg")

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.patches import Ellipse

HERE = Path(__file__).parent
INK, FAINT, BLUE, RED = "#222222", "#999999", "#1f6fb2", "#c8442f"
SPREAD = 3.0
"""The ellipses are of so many standard deviations."""


def run_page() -> dict[str, Any]:
    """The names of the page, after its first blocks."""
    names: dict[str, Any] = {}
    text = (HERE.parent / "pose-graphs.md").read_text(encoding="utf-8")
    for block in re.findall(r"```python\n(.*?)```", text, re.S)[:4]:
        exec(block, names)
    return names


def draw_path(ax: Any, poses: np.ndarray, color: str, label: str) -> None:
    ax.plot(poses[:, 0], poses[:, 1], "-", color=color, lw=1.2, label=label)


def draw_edges(ax: Any, poses: np.ndarray, edges: Any, color: str) -> None:
    for i, j in edges:
        ax.plot(*poses[[i, j], :2].T, ":", color=color, lw=1.2)


def draw_ellipses(ax: Any, answer: Any) -> None:
    for k in range(0, len(answer.poses), 3):
        values, vectors = np.linalg.eigh(answer.covariance(k, frame="map")[:2, :2])
        size = 2 * SPREAD * np.sqrt(np.maximum(values, 0.0))
        angle = np.degrees(np.arctan2(vectors[1, 1], vectors[0, 1]))
        ax.add_patch(
            Ellipse(answer.poses[k, :2], size[1], size[0], angle=angle, fc=BLUE, ec=BLUE, alpha=0.25, lw=0.6)
        )


def pose_graphs() -> None:
    """Odometry, the optimized poses with ellipses, and the answers with false loops."""
    page = run_page()
    fig, axes = plt.subplots(1, 3, figsize=(9.6, 3.5), layout="constrained")
    titles = ("odometry", "optimized, ellipses of 3σ", "with two false loops")
    for ax, title in zip(axes, titles, strict=True):
        draw_path(ax, page["truth"], FAINT, "truth")
        ax.set_title(title, fontsize=10, color=INK)
        ax.set_aspect("equal")
        ax.tick_params(labelsize=8)
    draw_path(axes[0], page["drift"], RED, "odometry")
    draw_edges(axes[0], page["drift"], page["loops"], INK)
    draw_path(axes[1], page["answer"].poses, BLUE, "optimized")
    draw_ellipses(axes[1], page["answer"])
    draw_path(axes[2], page["plain"].poses, RED, "all edges")
    draw_path(axes[2], page["robust"].poses, BLUE, 'robust="dcs"')
    for ax in axes:
        ax.legend(fontsize=7, loc="center", frameon=False)
    fig.savefig(HERE / "pose_graphs.png", dpi=110)


if __name__ == "__main__":
    pose_graphs()
