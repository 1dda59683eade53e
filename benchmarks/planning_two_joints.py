"""The configuration space of two joints beside a brute force over cells: results/planning_two_joints.json.

Usage: python benchmarks/planning_two_joints.py. Times are the least and the median processor time of a call
from Python, everything included. The scene has five pentagons, 25 edges, around an arm with links of 1 m and
0.8 m that are 5 cm thick; the brute force tests every cell of the bitmap by the distance between segments in
numpy.
"""

from __future__ import annotations

import json
import statistics
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

import cspace as cs

HERE = Path(__file__).resolve().parent
CELLS = 1000
ROWS = 20
"""Rows of cells that the brute force tests at a time."""
LINKS = (1.0, 0.8)
LINK_RADIUS = 0.05


def make_arm() -> cs.Robot:
    """Two links."""
    T = np.eye(4)
    T[0, 3] = sum(LINKS)
    return cs.Robot.from_screws([[0, 0, 1]] * 2, [[0, 0, 0], [LINKS[0], 0, 0]], T)


def make_scene() -> list[Any]:
    """Five pentagons on a circle."""
    corners = 0.4 * np.pi * np.arange(5)
    ring = 0.2 * np.column_stack([np.cos(corners), np.sin(corners)])
    return [ring + 1.3 * np.array([np.cos(1.25 * k + 0.3), np.sin(1.25 * k + 0.3)]) for k in range(5)]


def measure(call: Callable[[], object], count: int = 60) -> tuple[float, float]:
    """The least and the median processor time of a call [ms]."""
    call()
    times = []
    for _ in range(count):
        start = time.process_time()
        call()
        times.append(time.process_time() - start)
    return 1e3 * min(times), 1e3 * statistics.median(times)


def cross(u: Any, v: Any) -> Any:
    return u[..., 0] * v[..., 1] - u[..., 1] * v[..., 0]


def point_to_segments(p: Any, a: Any, b: Any) -> Any:
    """Distances of points (..., 2) from segments a–b that broadcast with them."""
    way = b - a
    part = np.clip(np.sum((p - a) * way, axis=-1) / np.sum(way**2, axis=-1), 0, 1)
    return np.linalg.norm(p - a - part[..., None] * way, axis=-1)


def check_every_cell(scene: list[Any], q1: Any, q2: Any) -> Any:
    """Whether the arm collides at every cell, by distances between segments and pentagons."""
    first = np.broadcast_to(q1[:, None], (len(q1), len(q2)))
    angle = first + q2
    elbow = LINKS[0] * np.stack([np.cos(first), np.sin(first)], axis=-1)
    tip = elbow + LINKS[1] * np.stack([np.cos(angle), np.sin(angle)], axis=-1)
    blocked = np.zeros(first.shape, dtype=bool)
    for p, r in ((np.zeros_like(elbow), elbow), (elbow, tip)):
        for ring in scene:
            a, b = ring, np.roll(ring, -1, axis=0)
            P, R = p[..., None, :], r[..., None, :]
            touch = (cross(R - P, a - P) * cross(R - P, b - P) < 0) & (
                cross(b - a, P - a) * cross(b - a, R - a) < 0
            )
            near = np.minimum.reduce(
                [
                    point_to_segments(P, a, b),
                    point_to_segments(R, a, b),
                    point_to_segments(a, P, R),
                ]
            )
            inside = (cross(b - a, R - a) > 0).all(axis=-1)
            blocked |= touch.any(axis=-1) | (near <= LINK_RADIUS).any(axis=-1) | inside
    return blocked


def count_unlike(space: Any, scene: list[Any]) -> tuple[int, float]:
    """Cells that differ from the brute force, and its processor time [ms]."""
    q1, q2 = space.cells(CELLS)
    bitmap = space.bitmap(CELLS)
    start, unlike = time.process_time(), 0
    for k in range(0, CELLS, ROWS):
        unlike += int(np.sum(check_every_cell(scene, q1[k : k + ROWS], q2) != bitmap[k : k + ROWS]))
    return unlike, 1e3 * (time.process_time() - start)


def measure_space() -> dict[str, Any]:
    """Times [ms] and cells."""
    arm, scene = make_arm(), make_scene()
    space = cs.configuration_space(arm, scene, link_radius=LINK_RADIUS)
    least, median = measure(lambda: space.bitmap(CELLS))
    unlike, brute_ms = count_unlike(space, scene)

    def both() -> object:
        fresh = cs.configuration_space(arm, scene, link_radius=LINK_RADIUS)
        return fresh.boundaries, fresh.components

    whole_least, whole = measure(both)
    return {
        "cells": CELLS**2,
        "edges": sum(map(len, scene)),
        "bitmap_ms": {"median": median, "least": least},
        "unlike": unlike,
        "brute_ms": brute_ms,
        "space_ms": {"median": whole, "least": whole_least},
        "components": len(space.components),
        "proved": sum(component.proved for component in space.components),
        "path_ms": measure(lambda: space.path([1.0, 0.5], [-2.0, -0.5]))[1],
    }


def main() -> None:
    results = {"version": cs.__version__, "isa": cs._core.isa, **measure_space()}
    print(json.dumps(results, indent=1))
    (HERE / "results/planning_two_joints.json").write_text(json.dumps(results, indent=1) + "\n")


if __name__ == "__main__":
    main()
