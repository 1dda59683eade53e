"""The published robots and their problems for a judge that shares no code with the package.

Robots are the published spheres, scenes the MotionBenchMaker problems, read from the shared data. Motions are
judged by motion_judge.py; the clearance of configurations is computed once more in numpy, so that the two
implementations can be compared.
"""

from __future__ import annotations

import gzip
import itertools
import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any, Final

import numpy as np

from motion_judge import FINE, MotionJudge, Rows, rotation_of

BAND: Final = 5e-6
"""Depth [m] up to which a contact may be rounding of floats."""


class Judge:
    """The spheres of a robot and its problems, read from the data folder."""

    def __init__(self, name: str, data: Path) -> None:
        self.robot = json.loads((data / f"robot_{name}.json").read_text())
        text = gzip.decompress((data / f"mbm_{name}.json.gz").read_bytes())
        self.problems = [(group, row) for group, rows in json.loads(text)["problems"].items() for row in rows]
        self.radii = np.array([s["radius"] for s in self.robot["spheres"]])
        self.links = [s["link"] for s in self.robot["spheres"]]
        self.pairs = self._find_pairs()
        bodies = [(s["link"], s["center"], s["center"], s["radius"]) for s in self.robot["spheres"]]
        pairs = self.robot["self_pairs_checked_by_vamp"]
        self.motions = MotionJudge(self.robot["joints"], self.robot["planned_joints"], bodies, pairs)

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

    def place_spheres(self, q: Rows) -> Rows:
        """Centres (n, spheres, 3) at configurations (n, dof)."""
        n, joints = len(q), list(self.robot["joints"])
        roots = {j["parent"] for j in joints} - {j["child"] for j in joints}
        frames = {link: (np.tile(np.eye(3), (n, 1, 1)), np.zeros((n, 3))) for link in roots}
        while joints:
            j = joints.pop(next(k for k, one in enumerate(joints) if one["parent"] in frames))
            R, p = frames[j["parent"]]
            p, R = p + R @ np.array(j["xyz"], float), R @ rotation_of(j)
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

    def set_problem(self, problem: int) -> None:
        """The scene of the motions that are judged next."""
        group, row = self.problems[problem]
        self.motions.set_scene([read_object(given, group == "box") for given in row["objects"]])

    def judge_path(self, path: Rows, fine: float = FINE) -> float:
        """The least clearance [m] seen on a path (m, dof) in the scene that was set."""
        return float(self.motions.look(path[:-1], path[1:], fine)[0].min(initial=np.inf))

    def __iter__(self) -> Iterator[int]:
        return iter(range(len(self.problems)))


def rotations_about(axis: Rows, angles: Rows) -> Rows:
    """Rotations (n, 3, 3) about a unit axis (Rodrigues)."""
    x, y, z = axis
    K = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    s, c = np.sin(angles)[:, None, None], np.cos(angles)[:, None, None]
    return np.asarray(np.eye(3) + s * K + (1 - c) * (K @ K))


def read_object(given: dict[str, Any], as_box: bool) -> dict[str, Any]:
    """An obstacle as VAMP reads it: cylinders are capsules, or boxes."""
    if given["type"] != "cylinder":
        return given
    size = [2 * given["radius"], 2 * given["radius"], given["length"]]
    return {**given, "type": "box" if as_box else "capsule", "size": size}


def distance_from(given: dict[str, Any], points: Rows, as_box: bool) -> Rows:
    """Distances (…) of points (…, 3) from an object of a problem, 0 inside of boxes."""
    local = (points - np.array(given["position"])) @ rotation_of(given)
    if given["type"] == "sphere":
        return np.asarray(np.linalg.norm(local, axis=-1) - given["radius"])
    if given["type"] == "cylinder" and not as_box:
        local[..., 2] -= np.clip(local[..., 2], -given["length"] / 2, given["length"] / 2)
        return np.asarray(np.linalg.norm(local, axis=-1) - given["radius"])
    size = given["size"] if given["type"] == "box" else [2 * given["radius"]] * 2 + [given["length"]]
    return np.asarray(np.linalg.norm(np.maximum(np.abs(local) - np.array(size) / 2, 0.0), axis=-1))
