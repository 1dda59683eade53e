"""Draws the figure of the page on redundancy: `python docs/figures/redundancy.py` writes it here."""

from __future__ import annotations

from pathlib import Path

import matplotlib

matplotlib.use("Agg")

import matplotlib.pyplot as plt
import numpy as np

import cspace as cs

HERE = Path(__file__).parent
INK, FAINT, BLUE, RED = "#222222", "#dddddd", "#1f6fb2", "#c8442f"


def reached(robot, T, joint, n=2000):
    """Which branches exist at n values of a joint, limits aside."""
    values = np.linspace(robot.limits.lower[joint], robot.limits.upper[joint], n)
    there = np.zeros((n, 8), dtype=bool)
    for row, value in zip(there, values, strict=True):
        row[list(robot.ik(T, locked={joint: value})._branch_numbers)] = True
    return values, there


def intervals() -> None:
    """The feasible intervals of joint 7 of a Panda, over where its branches exist at all."""
    robot = cs.load_robot("panda")
    T = robot.fk([0.3, 0.4, -0.2, -1.9, 0.3, 2.1, 0.6])
    found = robot.redundancy(T)
    values, there = reached(robot, T, 6)
    fig, ax = plt.subplots(figsize=(8.4, 3.6))
    for b in range(8):
        ax.fill_between(values, b + 0.72, b + 1.28, where=there[:, b], color=FAINT, lw=0, step="mid")
    for interval in found:
        row = interval.branch
        ax.plot([interval.lower, interval.upper], [row, row], color=BLUE, lw=5, solid_capstyle="butt")
        for value, end in zip((interval.lower, interval.upper), interval.ends, strict=True):
            ax.plot(
                value, row, "o" if end == "fold" else "|", color=RED, ms=5 if end == "fold" else 13, mew=2
            )
    ax.set_yticks(range(1, 9))
    ax.set_ylabel("branch")
    ax.set_xlabel("panda_joint7 [rad]")
    ax.set_xlim(robot.limits.lower[6], robot.limits.upper[6])
    ax.spines[["top", "right"]].set_visible(False)
    ax.set_title(
        "grey: the branch exists; blue: within all limits; bar: a joint at its limit; dot: a fold",
        color=INK,
        fontsize=9,
    )
    fig.savefig(HERE / "redundancy.png", dpi=140, bbox_inches="tight")


if __name__ == "__main__":
    intervals()
