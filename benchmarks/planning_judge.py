"""A judge of paths and edges that shares no code with the package: numpy in double, from the shared data.

Robots are the published spheres, scenes the MotionBenchMaker problems. A motion is looked at in intervals:
the clearance of the middle is compared with a bound on how far any sphere moves within the interval (levers
of joints times their travel; Schwarzer, Saha & Latombe 2005). What could touch is halved, down to intervals
shorter than FINE, whose middles are then samples at a hundred times the resolution of the planner.
"""

from __future__ import annotations

import gzip
import itertools
import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any, Final

import numpy as np

FINE: Final = 1.0 / 32.0 / 100.0
"""Samples are so far apart [L2 norm of the joints]."""

BAND: Final = 5e-6
"""Depth [m] up to which a contact may be rounding of floats."""

Rows = np.ndarray[Any, np.dtype[np.float64]]


class Judge:
    """The spheres of a robot and its problems, read from the data folder."""

    def __init__(self, name: str, data: Path) -> None:
        self.robot = json.loads((data / f"robot_{name}.json").read_text())
        text = gzip.decompress((data / f"mbm_{name}.json.gz").read_bytes())
        self.problems = [(group, row) for group, rows in json.loads(text)["problems"].items() for row in rows]
        self.radii = np.array([s["radius"] for s in self.robot["spheres"]])
        self.links = [s["link"] for s in self.robot["spheres"]]
        self.pairs = self._find_pairs()
        self.levers = self._find_levers()

    def _find_pairs(self) -> tuple[Rows, Rows]:
        """The pairs of spheres that are checked against each other."""
        at: dict[str, list[int]] = {}
        for k, link in enumerate(self.links):
            at.setdefault(link, []).append(k)
        found = [
            pair
            for a, b in self.robot["self_pairs_checked_by_vamp"]
            for pair in itertools.product(at.get(a, []), at.get(b, []))
        ]
        rows = np.array(found)
        return rows[:, 0], rows[:, 1]

    def _find_levers(self) -> Rows:
        """Per joint a bound on the distance of any sphere behind it from its axis [m]; 1 for slides."""
        lengths = {}
        for j in self.robot["joints"]:
            low, high = j.get("limit", {}).get("lower", 0.0), j.get("limit", {}).get("upper", 0.0)
            travel = max(abs(low), abs(high)) if j["type"] == "prismatic" else 0.0
            lengths[j["child"]] = (j["parent"], float(np.linalg.norm(j["xyz"])) + travel)
        levers = []
        for name in self.robot["planned_joints"]:
            joint = next(j for j in self.robot["joints"] if j["name"] == name)
            reach = 0.0
            for sphere in self.robot["spheres"]:
                link, far = sphere["link"], float(np.linalg.norm(sphere["center"])) + sphere["radius"]
                while link != joint["child"] and link in lengths:
                    link, far = lengths[link][0], far + lengths[link][1]
                reach = max(reach, far if link == joint["child"] else 0.0)
            levers.append(1.0 if joint["type"] == "prismatic" else reach)
        return np.array(levers)

    def place_spheres(self, q: Rows) -> Rows:
        """Centres (n, spheres, 3) at configurations (n, dof)."""
        n, joints = len(q), list(self.robot["joints"])
        roots = {j["parent"] for j in joints} - {j["child"] for j in joints}
        frames = {link: (np.tile(np.eye(3), (n, 1, 1)), np.zeros((n, 3))) for link in roots}
        while joints:
            j = joints.pop(next(k for k, one in enumerate(joints) if one["parent"] in frames))
            R, p = frames[j["parent"]]
            p, R = p + R @ np.array(j["xyz"], float), R @ rotation_of_rpy(*j["rpy"])
            if j["name"] in self.robot["planned_joints"]:
                value = q[:, self.robot["planned_joints"].index(j["name"])]
                axis = np.array(j["axis"], float)
                if j["type"] == "prismatic":
                    p = p + value[:, None] * (R @ axis)
                else:
                    R = R @ rotations_about(axis, value)
            frames[j["child"]] = (R, p)
        places = [
            frames[s["link"]][1] + frames[s["link"]][0] @ np.array(s["center"]) for s in self.robot["spheres"]
        ]
        return np.stack(places, axis=1)

    def clearance(self, problem: int, q: Rows) -> Rows:
        """The least distance from a contact [m] at configurations (n, dof) in the scene of a problem."""
        group, row = self.problems[problem]
        places = self.place_spheres(q)
        a, b = self.pairs
        gap = (np.linalg.norm(places[:, a] - places[:, b], axis=-1) - self.radii[a] - self.radii[b]).min(1)
        for given in row["objects"]:
            distance = distance_from(given, places, given["type"] == "cylinder" and group == "box")
            gap = np.minimum(gap, (distance - self.radii).min(1))
        return gap

    def find_contacts(self, problem: int, a: Rows, b: Rows) -> list[tuple[int, float, float]]:
        """Of edges from a to b (n, dof) the contacts deeper than BAND: edge, part of the way, clearance."""
        step = b - a
        motion = 2.0 * np.abs(step) @ self.levers  # of one sphere against another
        length = np.linalg.norm(step, axis=1)
        edge, middle, half = np.arange(len(a)), np.full(len(a), 0.5), np.full(len(a), 0.5)
        found = []
        while len(edge):
            gap = self._clearance_in_parts(problem, a[edge] + middle[:, None] * step[edge])
            touches = gap < -BAND
            found += [
                (int(e), float(t), float(g))
                for e, t, g in zip(edge[touches], middle[touches], gap[touches], strict=True)
            ]
            is_open = ~touches & (gap <= motion[edge] * half) & (2.0 * half * length[edge] > FINE)
            is_open &= ~np.isin(edge, edge[touches])
            edge, middle, half = edge[is_open], middle[is_open], half[is_open] / 2.0
            edge, half = np.repeat(edge, 2), np.repeat(half, 2)
            middle = np.repeat(middle, 2) + half * np.tile([-1.0, 1.0], len(middle))
        return found

    def _clearance_in_parts(self, problem: int, q: Rows, rows: int = 4096) -> Rows:
        """The same as clearance, in parts that fit the cache."""
        return np.concatenate([self.clearance(problem, q[k : k + rows]) for k in range(0, len(q), rows)])

    def judge_path(self, problem: int, path: Rows) -> list[tuple[int, float, float]]:
        """The contacts of a path (m, dof)."""
        return self.find_contacts(problem, path[:-1], path[1:])

    def __iter__(self) -> Iterator[int]:
        return iter(range(len(self.problems)))


def rotation_of_rpy(roll: float, pitch: float, yaw: float) -> Rows:
    """The rotation (3, 3) of fixed angles."""
    cr, sr, cp, sp = np.cos(roll), np.sin(roll), np.cos(pitch), np.sin(pitch)
    cy, sy = np.cos(yaw), np.sin(yaw)
    return np.array(
        [
            [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
            [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
            [-sp, cp * sr, cp * cr],
        ]
    )


def rotations_about(axis: Rows, angles: Rows) -> Rows:
    """Rotations (n, 3, 3) about a unit axis (Rodrigues)."""
    x, y, z = axis
    K = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    s, c = np.sin(angles)[:, None, None], np.cos(angles)[:, None, None]
    return np.asarray(np.eye(3) + s * K + (1 - c) * (K @ K))


def distance_from(given: dict[str, Any], points: Rows, as_box: bool) -> Rows:
    """Distances (…) of points (…, 3) from an object of a problem, 0 inside of boxes."""
    x, y, z, w = given.get("quat_xyzw", [0, 0, 0, 1])
    R = np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
    )
    local = (points - np.array(given["position"])) @ R
    if given["type"] == "sphere":
        return np.asarray(np.linalg.norm(local, axis=-1) - given["radius"])
    if given["type"] == "cylinder" and not as_box:
        local[..., 2] -= np.clip(local[..., 2], -given["length"] / 2, given["length"] / 2)
        return np.asarray(np.linalg.norm(local, axis=-1) - given["radius"])
    size = given["size"] if given["type"] == "box" else [2 * given["radius"]] * 2 + [given["length"]]
    return np.asarray(np.linalg.norm(np.maximum(np.abs(local) - np.array(size) / 2, 0.0), axis=-1))
