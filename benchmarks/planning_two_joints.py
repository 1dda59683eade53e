"""The configuration space of two joints: bitmap, boundary and components, beside a brute force over cells.

Run `python benchmarks/planning_two_joints.py`. Times are the least and the median processor time of a call
from Python, everything included. The scene has five pentagons, 25 edges, around an arm with links of 1 m and
0.8 m that are 5 cm thick; the brute force tests every cell of a coarser bitmap by the distance between
segments in numpy.
"""

from __future__ import annotations

import platform
import statistics
import time
from collections.abc import Callable
from typing import Any

import numpy as np

import cspace as cs
from rows import Row, row

CELLS = 1000
BRUTE_CELLS = 120
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


def rows_of_table() -> list[Row]:
    """What must hold, and what was measured."""
    arm, scene = make_arm(), make_scene()
    space = cs.configuration_space(arm, scene, link_radius=LINK_RADIUS)
    least, median = measure(lambda: space.bitmap(CELLS))
    q1, q2 = space.cells(BRUTE_CELLS)
    start = time.process_time()
    brute = check_every_cell(scene, q1, q2)
    brute_ms = 1e3 * (time.process_time() - start) * (CELLS / BRUTE_CELLS) ** 2
    differing = int(np.sum(brute != space.bitmap(BRUTE_CELLS)))

    def both() -> object:
        fresh = cs.configuration_space(arm, scene, link_radius=LINK_RADIUS)
        return fresh.boundaries, fresh.components

    whole_least, whole = measure(both)
    path = measure(lambda: space.path([1.0, 0.5], [-2.0, -0.5]))[1]
    proved = all(component.proved for component in space.components)
    return [
        row(
            f"bitmap, {CELLS} × {CELLS} cells, 25 edges", "0.6 ms", "0.3 ms",
            f"{median:.3f} ms (least {least:.3f})", median <= 0.6, median <= 0.3,
        ),
        row("cells unlike a brute force", "0", "", f"{differing} of {BRUTE_CELLS**2}", differing == 0),
        row("brute force in numpy, same cells", "", "", f"{brute_ms:,.0f} ms", None),
        row(
            "space, boundary and components", "5 ms", "", f"{whole:.2f} ms (least {whole_least:.2f})",
            whole <= 5.0,
        ),
        row("components proved", "all", "", str(proved), proved),
        row("path between two configurations", "", "", f"{path:.2f} ms", None),
    ]  # fmt: skip


def main() -> None:
    print(f"cspace {cs.__version__}, {platform.machine()}, Python {platform.python_version()}")
    for each in rows_of_table():
        verdict = {None: "", True: "holds", False: "FAILS"}[each.holds]
        aimed = {None: "", True: ", aim reached", False: ", aim missed"}[each.aimed]
        bounds = f"must {each.must}" if each.must else ""
        print(f"{each.what:42} {each.measured:28} {bounds:12} {verdict}{aimed}")


if __name__ == "__main__":
    main()
