"""Draws the figures of the page on claims from its results: called by benchmarks/navigation_claims.py."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import matplotlib

matplotlib.use("Agg")

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes

import cspace as cs
from claims.families import FAMILIES, question
from claims.rows import ROWS

HERE = Path(__file__).parent
COLOURS = dict(zip(FAMILIES, plt.rcParams["axes.prop_cycle"].by_key()["color"], strict=False))
SHOWN = {"convex field": 4, "spiral": 4, "maze": 5, "U trap": 2, "narrow gap": 2, "degenerate": 4}
WAYS = {"any_angle": "tab:blue", "voronoi": "tab:green", "bug_2": "tab:red"}


def draw(results: dict[str, Any]) -> None:
    worlds(HERE / "claims_worlds.png")
    ways(results, HERE / "claims_ways.png")
    growth(results, HERE / "claims_time.png")


def worlds(path: Path) -> None:
    """Each family with a goal in reach and some ways there, and below it with a goal that is shut in."""
    figure, panels = plt.subplots(2, len(SHOWN), figsize=(13, 4.9), layout="constrained")
    for (family, size), column in zip(SHOWN.items(), panels.T, strict=True):
        for axes, shut in zip(column, (False, True), strict=True):
            asked = question(family, size, 1, shut)
            for rings in asked.obstacles:
                axes.add_patch(plt.Polygon(rings[0], color="0.75", lw=0))
                for hole in rings[1:]:
                    axes.add_patch(plt.Polygon(hole, color="white", lw=0))
            for planner, colour in (WAYS if not shut else {"bug_1": "tab:orange"}).items():
                route = cs.navigate(asked.world, asked.start, asked.goal, planner)
                axes.plot(*np.array(route.path).T, color=colour, lw=1, label=planner)
            axes.plot(*asked.start, "o", color="k", ms=4)
            axes.plot(*asked.goal, "*", color="k", ms=7)
            left, low, right, high = asked.bounds
            axes.set(xlim=(left, right), ylim=(low, high), aspect="equal", xticks=[], yticks=[])
        column[0].set_title(family, fontsize=10)
    panels[0, 0].set_ylabel("in reach")
    panels[1, 0].set_ylabel("shut in")
    handles = [line for axes in (panels[0, 0], panels[1, 0]) for line in axes.get_legend_handles_labels()[0]]
    figure.legend(handles=handles, ncols=4, loc="outside lower center", frameon=False)
    figure.savefig(path, dpi=90)
    plt.close(figure)


def ways(results: dict[str, Any], path: Path) -> None:
    """Of every way its length over the shortest, and its least clearance over that of the widest."""
    names = [name for name in ROWS if name in results["rows"]][::-1]
    figure, (left, right) = plt.subplots(
        1, 2, figsize=(11, 0.26 * len(names) + 1.4), sharey=True, layout="constrained"
    )
    for axes, key in ((left, "ratios"), (right, "shares")):
        for place, name in enumerate(names):
            strip(axes, place, results["rows"][name][key])
        axes.grid(axis="y", lw=0.4)
        axes.set_axisbelow(True)
    left.set(
        xscale="log", xlabel="length / shortest in the plane", yticks=range(len(names)), yticklabels=names
    )
    left.set_xticks([1, 1.5, 2, 3, 5, 10], ["1", "1.5", "2", "3", "5", "10"], minor=False)
    left.minorticks_off()
    right.set(xlabel="least clearance / that of the widest way", xlim=(-0.03, 1.05))
    handles = [plt.Line2D([], [], ls="", marker="o", color=c, label=f) for f, c in COLOURS.items()]
    figure.legend(handles=handles, ncols=len(COLOURS), loc="outside upper center", frameon=False)
    figure.savefig(path, dpi=90)
    plt.close(figure)


def strip(axes: Axes, place: int, values: dict[str, list[float]]) -> None:
    """One row of points, family by family, with a bar at the median of all."""
    rng = np.random.default_rng(0)
    every = [v for part in values.values() for v in part]
    for family, part in values.items():
        offsets = place + rng.uniform(-0.3, 0.3, len(part))
        axes.plot(part, offsets, "o", color=COLOURS[family], ms=2.5, alpha=0.6, mew=0)
    if every:
        axes.plot([np.median(every)] * 2, [place - 0.4, place + 0.4], color="k", lw=1.5)


def growth(results: dict[str, Any], path: Path) -> None:
    """Seconds over the size of the world, with the fitted line: a panel for each row."""
    names = [name for name in ROWS if name in results["rows"] and results["rows"][name]["growth"]]
    columns = 6
    lines = -(-len(names) // columns)
    figure, panels = plt.subplots(
        lines,
        columns,
        figsize=(13, 1.75 * lines),
        sharex="row",
        sharey=True,
        layout="constrained",
        squeeze=False,
    )
    for axes, name in zip(panels.flat, names, strict=False):
        points = results["rows"][name]["growth"]
        n, seconds = (np.array([p[k] for p in points], dtype=float) for k in ("n", "seconds"))
        slope, offset = np.polyfit(np.log(n), np.log(seconds), 1)
        axes.loglog(n, seconds, ".", ms=4)
        axes.loglog(n, np.exp(offset) * n**slope, lw=1)
        unit = "cells" if ROWS[name].world == "grid" else "corners"
        axes.set_title(f"{name}\n$n^{{{slope:.2f}}}$, {unit}", fontsize=8)
        axes.tick_params(labelsize=7)
        axes.set_xlim(5, 2e5)
    for axes in panels.flat[len(names) :]:
        axes.set_axis_off()
    for axes in panels[:, 0]:
        axes.set_ylabel("seconds", fontsize=8)
    figure.savefig(path, dpi=90)
    plt.close(figure)
