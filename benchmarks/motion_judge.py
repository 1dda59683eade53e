"""A judge of motions that shares no code with the package: benchmarks/cpp/judge_motions.cpp through ctypes.

The first use compiles it with $CXX (default c++) into a temporary folder. Joints and shapes are dictionaries
as in the shared data and in the catalogue's files: "xyz" and "rpy" or "quat_xyzw", radians and metres.
"""

from __future__ import annotations

import ctypes
import functools
import os
import subprocess
import tempfile
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any, Final

import numpy as np

SOURCE: Final = Path(__file__).resolve().parent / "cpp/judge_motions.cpp"

FINE: Final = 1.0 / 32.0 / 100.0
"""Samples are at most so far apart [L2 norm of the joints]: a hundred times the resolution of the planner."""

KINDS: Final = ("box", "sphere", "capsule", "cylinder")
MOTIONS: Final = {"fixed": 0, "revolute": 1, "continuous": 1, "prismatic": 2}

Rows = np.ndarray[Any, np.dtype[np.float64]]


@functools.cache
def load_library() -> ctypes.CDLL:
    """The compiled judge."""
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "libjudge.so"
        command = [os.environ.get("CXX", "c++"), "-std=c++17", "-O3", "-shared", "-fPIC", SOURCE, "-o", file]
        subprocess.run(command, check=True)
        library = ctypes.CDLL(str(file))
    library.judge_make.restype = ctypes.c_void_p
    library.judge_motions.restype = ctypes.c_long
    return library


class MotionJudge:
    """Capsules on links, pairs of links, and the obstacles of one scene at a time.

    joints: of the description, in any order; planned: names of those that q holds, in its order; bodies:
    link, ends a and b, radius; pairs: of links that are checked against each other.
    """

    def __init__(
        self,
        joints: Sequence[dict[str, Any]],
        planned: Sequence[str],
        bodies: Sequence[tuple[str, Any, Any, float]],
        pairs: Iterable[tuple[str, str]],
    ) -> None:
        self.dof = len(planned)
        frames = dict.fromkeys({j["parent"] for j in joints} - {j["child"] for j in joints}, 0)
        rows: list[tuple[int, int, int]] = []
        reals: list[Rows] = []
        travel = np.zeros(self.dof)
        left = list(joints)
        while left:
            j = left.pop(next(k for k, one in enumerate(left) if one["parent"] in frames))
            variable = planned.index(j["name"]) if j["name"] in planned else -1
            rows.append((frames[j["parent"]], MOTIONS[j["type"]], variable))
            axis = np.array(j.get("axis") or (0.0, 0.0, 1.0), float)
            reals.append(np.concatenate([j.get("xyz", (0, 0, 0)), rotation_of(j).ravel(), axis]))
            frames[j["child"]] = len(rows)
            if variable >= 0 and j["type"] == "prismatic":
                limit = j.get("limit", j)
                travel[variable] = max(abs(limit["lower"]), abs(limit["upper"]))
        at: dict[str, list[int]] = {}
        for k, (link, *_) in enumerate(bodies):
            at.setdefault(link, []).append(k)
        both = [(x, y) for a, b in pairs for x in at.get(a, []) for y in at.get(b, [])]
        self._library = load_library()
        self._handle = ctypes.c_void_p(
            self._library.judge_make(
                ctypes.c_int(self.dof),
                *(pointer(travel), ctypes.c_int(len(rows)), pointer(np.array(rows, np.intc))),
                *(pointer(np.concatenate(reals)), ctypes.c_int(len(bodies))),
                pointer(np.array([frames.get(link, 0) for link, *_ in bodies], np.intc)),
                pointer(np.array([[*a, *b, r] for _, a, b, r in bodies], float)),
                *(ctypes.c_int(len(both)), pointer(np.array(both, np.intc))),
            )
        )

    def __del__(self) -> None:
        self._library.judge_free(self._handle)

    def set_scene(self, objects: Sequence[dict[str, Any]]) -> None:
        """Obstacles: "type" of KINDS, "position", "quat_xyzw" or "rpy", and "size", "radius", "length"."""
        kinds = np.array([KINDS.index(o["type"]) for o in objects], np.intc)
        rows = [np.concatenate([o["position"], rotation_of(o).ravel(), size_of(o)]) for o in objects]
        values = np.array(rows, float)
        self._library.judge_scene(self._handle, ctypes.c_int(len(kinds)), pointer(kinds), pointer(values))

    def clearance(self, q: Rows) -> Rows:
        """The least distance [m] from a contact at configurations (n, dof)."""
        q = np.ascontiguousarray(q, float).reshape(-1, self.dof)
        found = np.empty(len(q))
        self._library.judge_clearance(self._handle, ctypes.c_long(len(q)), pointer(q), pointer(found))
        return found

    def look(self, a: Rows, b: Rows, fine: float = FINE) -> tuple[Rows, Rows, int]:
        """Of motions from a to b (n, dof): the least clearance seen [m], where, and the places looked at."""
        a, b = (np.ascontiguousarray(x, float).reshape(-1, self.dof) for x in (a, b))
        least, at = np.empty(len(a)), np.empty(len(a))
        arrays = [pointer(x) for x in (a, b)]
        places = self._library.judge_motions(
            *(self._handle, ctypes.c_long(len(a)), *arrays, ctypes.c_double(fine)),
            pointer(least),
            pointer(at),
        )
        return least, at, int(places)


def pointer(values: np.ndarray[Any, Any]) -> ctypes.c_void_p:
    return values.ctypes.data_as(ctypes.c_void_p)  # keeps the array alive


def rotation_of(given: dict[str, Any]) -> Rows:
    """The rotation (3, 3) of a quaternion or of fixed angles."""
    if "quat_xyzw" in given:
        x, y, z, w = given["quat_xyzw"]
        return np.array(
            [
                [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
            ]
        )
    roll, pitch, yaw = given.get("rpy", (0.0, 0.0, 0.0))
    cr, sr, cp, sp = np.cos(roll), np.sin(roll), np.cos(pitch), np.sin(pitch)
    cy, sy = np.cos(yaw), np.sin(yaw)
    return np.array(
        [
            [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
            [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
            [-sp, cp * sr, cp * cr],
        ]
    )


def size_of(given: dict[str, Any]) -> list[float]:
    """Half sizes of a box; radius and half length of the others."""
    if given["type"] == "box":
        return [x / 2 for x in given["size"]]
    return [given["radius"], given.get("length", 0.0) / 2, 0.0]
