"""Draws the figures of the pages on the subproblems: `python docs/figures/subproblems.py` writes them."""

from __future__ import annotations

from pathlib import Path

import matplotlib

matplotlib.use("Agg")

import matplotlib.pyplot as plt
import numpy as np

from cspace import subproblems as sp

HERE = Path(__file__).parent
INK, FAINT, BLUE, RED, GREEN = "#222222", "#bbbbbb", "#1f6fb2", "#c8442f", "#3a8f4d"
TURNS = np.linspace(0.0, 2 * np.pi, 181)


def rotate(k, theta, p):
    """Rot(k, θ) p for a unit axis k: (..., 3)."""
    theta = np.asarray(theta, dtype=float)[..., None]
    return p + np.sin(theta) * np.cross(k, p) + (1 - np.cos(theta)) * np.cross(k, np.cross(k, p))


def unit(v):
    v = np.asarray(v, dtype=float)
    return v / np.linalg.norm(v)


def panel(fig, position, title):
    ax = fig.add_subplot(2, 3, position, projection="3d")
    ax.set_axis_off()
    ax.set_title(title, fontsize=11, color=INK, y=1.0)
    ax.view_init(elev=24, azim=-62)
    return ax


def line(ax, points, **style):
    ax.plot(*np.asarray(points, dtype=float).T, **style)


def axis(ax, k, name, *, through=(0, 0, 0), color=INK, length=0.95):
    origin = np.asarray(through, dtype=float)
    ends = np.stack([origin - 0.35 * length * k, origin + length * k])
    line(ax, ends, color=color, lw=1.6)
    ax.text(*(ends[1] + 0.08 * k), name, color=color, fontsize=10)


def dot(ax, p, name="", *, color=INK, size=28, offset=(0.05, 0.0, 0.08)):
    ax.scatter(*np.asarray(p, dtype=float), color=color, s=size, depthshade=False)
    if name:
        ax.text(*(np.asarray(p) + offset), name, color=color, fontsize=10)


def fit(ax, reach=1.05):
    ax.set_box_aspect((1, 1, 1), zoom=1.35)
    ax.set(xlim=(-reach, reach), ylim=(-reach, reach), zlim=(-reach, reach))


def first(fig):
    ax = panel(fig, 1, "1  one point onto another")
    k, p = unit([0, 0, 1]), np.array([0.9, -0.2, 0.35])
    q = rotate(k, 1.9, p)
    axis(ax, k, "k")
    line(ax, rotate(k, TURNS, p), color=FAINT, lw=1)
    line(ax, rotate(k, np.linspace(0, 1.9, 60), p), color=GREEN, lw=2.2)
    for point, name, color in ((p, "$p_1$", BLUE), (q, "$p_2$", RED)):
        line(ax, [k * point[2], point], color=color, lw=0.9, ls="--")
        dot(ax, point, name, color=color)
    ax.text(*np.add(rotate(k, 0.95, p), [0.08, 0, 0.06]), r"$\theta$", color=GREEN, fontsize=11)
    fit(ax)


def second(fig):
    ax = panel(fig, 2, "2  two circles meet")
    k1, k2 = unit([0, 0, 1]), unit([0.9, -0.25, 0.3])
    meeting = unit([0.6, -0.55, 0.55])
    p, q = rotate(k1, -1.3, meeting), rotate(k2, 1.8, meeting)
    s = sp.subproblem_2(k1, k2, p, q)
    axis(ax, k1, "$k_1$", color=BLUE)
    axis(ax, k2, "$k_2$", color=RED)
    line(ax, rotate(k1, TURNS, p), color=BLUE, lw=1.2)
    line(ax, rotate(k2, TURNS, q), color=RED, lw=1.2)
    dot(ax, p, "$p_1$", color=BLUE)
    dot(ax, q, "$p_2$", color=RED)
    for theta in s.theta[: s.count, 0]:
        dot(ax, rotate(k1, theta, p), color=GREEN, size=60)
    fit(ax)


def third(fig):
    ax = panel(fig, 3, "3  to a given distance")
    k, p, q, d = unit([0, 0, 1]), np.array([0.85, 0.3, -0.2]), np.array([0.75, -0.75, 0.35]), 0.75
    axis(ax, k, "k")
    line(ax, rotate(k, TURNS, p), color=BLUE, lw=1.2)
    s = sp.subproblem_3(k, p, q, d)
    for theta in s.theta[: s.count]:
        x = rotate(k, theta, p)
        line(ax, [x, q], color=GREEN, lw=1.4)
        dot(ax, x, color=GREEN, size=60)
    v, u = np.meshgrid(np.linspace(0, np.pi, 19), np.linspace(0, 2 * np.pi, 37))
    ball = q[:, None, None] + d * np.stack([np.sin(v) * np.cos(u), np.sin(v) * np.sin(u), np.cos(v)])
    ax.plot_surface(*ball, color=RED, alpha=0.10, lw=0)
    dot(ax, p, "$p_1$", color=BLUE)
    dot(ax, q, "$p_2$", color=RED)
    middle = (rotate(k, s.theta[0], p) + q) / 2
    ax.text(*np.add(middle, [0.05, 0, 0.06]), "d", color=GREEN, fontsize=10)
    fit(ax)


def fourth(fig):
    ax = panel(fig, 4, "4  into a plane")
    k, p, h, d = unit([0, 0, 1]), np.array([0.85, 0.2, 0.1]), unit([0.8, -0.5, 0.5]), 0.35
    axis(ax, k, "k")
    line(ax, rotate(k, TURNS, p), color=BLUE, lw=1.2)
    e1 = unit(np.cross(h, k))
    e2 = np.cross(h, e1)
    corners = [d * h + 0.95 * (a * e1 + b * e2) for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
    ax.plot_trisurf(*np.array(corners).T, color=RED, alpha=0.14, lw=0)
    line(ax, [d * h, (d + 0.5) * h], color=RED, lw=1.4)
    ax.text(*((d + 0.55) * h), "h", color=RED, fontsize=10)
    s = sp.subproblem_4(h, k, p, d)
    for theta in s.theta[: s.count]:
        dot(ax, rotate(k, theta, p), color=GREEN, size=60)
    dot(ax, p, "p", color=BLUE, offset=(0.0, 0.0, -0.22))
    fit(ax)


def fifth(fig):
    ax = panel(fig, 5, "5  three turns, one meeting point")
    k1, k2, k3 = unit([0.1, 0, 1]), unit([0.2, 0.9, 0.4]), unit([0.9, -0.1, 0.5])
    p1, p2, p3, p4 = (
        np.array(v) for v in ((0.5, 0.1, 0.0), (0.0, 0.0, 0.0), (0.5, 0.1, 0.1), (0.0, 0.3, 0.35))
    )
    p0 = rotate(k2, 0.7, p3 + rotate(k3, -0.6, p4)) - rotate(k1, 0.9, p1)
    s = sp.subproblem_5(p0, p1, p2, p3, p4, k1, k2, k3)
    axis(ax, k1, "$k_1$", through=p0, color=BLUE, length=0.6)
    axis(ax, k2, "$k_2$", through=p2, color=RED, length=1.1)
    line(ax, p0 + rotate(k1, TURNS, p1), color=BLUE, lw=1.4)
    for theta in TURNS[::9]:
        line(ax, rotate(k2, theta, p3 + rotate(k3, TURNS, p4)), color=RED, lw=0.4, alpha=0.55)
    for t1, _, _ in s.theta[: s.count]:
        dot(ax, p0 + rotate(k1, t1, p1), color=GREEN, size=60)
    fit(ax, 0.85)


def sixth(fig):
    ax = fig.add_subplot(2, 3, 6)
    rng = np.random.default_rng(12)
    h, k, p = rng.normal(size=(3, 4, 3))
    d = np.array([0.4, -0.5])
    k /= np.linalg.norm(k, axis=1, keepdims=True)
    grid = np.linspace(-np.pi, np.pi, 361)
    one, two = np.meshgrid(grid, grid)
    for i, color in ((0, BLUE), (1, RED)):
        sides = [
            rotate(k[2 * i], one, p[2 * i]) @ h[2 * i],
            rotate(k[2 * i + 1], two, p[2 * i + 1]) @ h[2 * i + 1],
        ]
        ax.contour(one, two, sides[0] + sides[1] - d[i], levels=[0.0], colors=[color], linewidths=1.4)
    s = sp.subproblem_6(h, k, p, d)
    ax.plot(*s.theta[: s.count].T, "o", color=GREEN, ms=8)
    ax.set(xlim=(-np.pi, np.pi), ylim=(-np.pi, np.pi), aspect="equal")
    ax.set_xticks([-np.pi, 0, np.pi], ["−π", "0", "π"])
    ax.set_yticks([-np.pi, 0, np.pi], ["−π", "0", "π"])
    ax.set_xlabel(r"$\theta_1$", labelpad=1)
    ax.set_ylabel(r"$\theta_2$", labelpad=1)
    ax.set_title("6  two equations, two angles", fontsize=11, color=INK)


def main() -> None:
    fig = plt.figure(figsize=(11.5, 7.6))
    for draw in (first, second, third, fourth, fifth, sixth):
        draw(fig)
    fig.subplots_adjust(left=0.01, right=0.97, bottom=0.075, top=0.94, wspace=0.06, hspace=0.16)
    fig.savefig(HERE / "subproblems.png", dpi=110)


if __name__ == "__main__":
    main()
