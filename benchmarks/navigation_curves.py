"""Dubins and Reeds–Shepp curves beside their peers: time of one call, and whose curves are longer.

Usage: python benchmarks/navigation_curves.py [--rounds 5] [--python ompl=PATH …]. Every contender runs in a
fresh process, by the interpreter named for it (the peers' packages are ompl, rsplan, dubins and reeds-shepp;
the last two build on Python 3.7 alone). Writes benchmarks/results/navigation_curves.json.
"""

from __future__ import annotations

import argparse
import json
import math
import random
import subprocess
import sys
import time
from pathlib import Path

HERE = Path(__file__).resolve().parent
RESULT = HERE / "results/navigation_curves.json"
CONTENDERS = ["cspace", "ompl", "rsplan", "dubins", "reeds_shepp"]
COUNT, SLOW = 20_000, {"rsplan": 2_000}
LONGER = 1e-6


def problems() -> list[list[tuple[float, float, float]]]:
    """Pairs of poses: on a lattice of whole numbers and eighths of a turn, near, apart and far."""
    rng = random.Random(1)
    made = []
    for k in range(COUNT):
        size = [0.0, 0.5, 3.0, 12.0][k % 4]
        pair: list[tuple[float, float, float]] = []
        for _ in range(2):
            if size == 0:
                x, y, turn = rng.randint(-4, 4), rng.randint(-4, 4), rng.randint(-4, 4)
                pair.append((float(x), float(y), turn * math.pi / 4))
            else:
                x, y = rng.uniform(-size, size), rng.uniform(-size, size)
                pair.append((x, y, rng.uniform(-math.pi, math.pi)))
        made.append(pair)
    return made


def calls(name: str) -> dict:
    """The functions of a contender by kind of curve: (start, goal) → length for a radius of 1."""
    if name == "cspace":
        from cspace import navigation

        return {
            "dubins": lambda a, b: navigation.dubins_distance(a, b, 1.0),
            "reeds_shepp": lambda a, b: navigation.reeds_shepp_distance(a, b, 1.0),
        }
    if name == "ompl":
        from ompl import base

        def distance(space):
            first, second = space.allocState(), space.allocState()

            def call(a, b):
                for state, pose in ((first, a), (second, b)):
                    state.setX(pose[0])
                    state.setY(pose[1])
                    state.setYaw(pose[2])
                return space.distance(first, second)

            return call

        return {
            "dubins": distance(base.DubinsStateSpace(1.0)),
            "reeds_shepp": distance(base.ReedsSheppStateSpace(1.0)),
        }
    if name == "rsplan":
        import rsplan

        return {"reeds_shepp": lambda a, b: rsplan.path(a, b, 1.0, 0.0, 0.1, 0.0).total_length}
    if name == "dubins":
        import dubins

        return {"dubins": lambda a, b: dubins.shortest_path(a, b, 1.0).path_length()}
    import reeds_shepp

    return {"reeds_shepp": lambda a, b: reeds_shepp.path_length(a, b, 1.0)}


def rows(name: str, pairs: list) -> dict:
    """Nanoseconds per row of a batch, where a contender takes batches."""
    if name != "cspace":
        return {}
    import numpy as np

    from cspace import navigation

    starts, goals = np.array(pairs).transpose(1, 0, 2)
    found = {}
    for kind in ("dubins", "reeds_shepp"):
        call = getattr(navigation, kind + "_distance")
        times = []
        for _ in range(15):
            begin = time.perf_counter()
            call(starts, goals, 1.0)
            times.append(1e9 * (time.perf_counter() - begin) / len(pairs))
        found[kind] = sorted(times)[7]
    return found


def contend(name: str, rounds: int) -> None:
    """Times one contender and writes what it found to standard output."""
    pairs = problems()[: SLOW.get(name, COUNT)]
    told = {"ns": {}, "lengths": {}, "batch_ns": rows(name, pairs)}
    for kind, call in calls(name).items():
        told["lengths"][kind] = [call(a, b) for a, b in pairs]
        times = []
        for _ in range(rounds):
            begin = time.perf_counter()
            for a, b in pairs:
                call(a, b)
            times.append(1e9 * (time.perf_counter() - begin) / len(pairs))
        told["ns"][kind] = sorted(times)[rounds // 2]
    json.dump(told, sys.stdout)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--contender", choices=CONTENDERS)
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--python", action="append", default=[], metavar="NAME=PATH")
    given = parser.parse_args()
    if given.contender:
        return contend(given.contender, given.rounds)
    pythons = dict(one.split("=", 1) for one in given.python)
    told = {}
    for name in CONTENDERS:
        command = [
            pythons.get(name, sys.executable),
            __file__,
            "--contender",
            name,
            "--rounds",
            str(given.rounds),
        ]
        done = subprocess.run(command, capture_output=True, text=True)
        if done.returncode == 0:
            told[name] = json.loads(done.stdout)
    result = []
    for name, one in told.items():
        for kind, lengths in one["lengths"].items():
            ours = told["cspace"]["lengths"][kind]
            over = [a - b for a, b in zip(lengths, ours)]  # noqa: B905 (a contender may do fewer)
            result.append(
                {
                    "contender": name,
                    "curve": kind,
                    "ns": round(one["ns"][kind]),
                    "batch_ns": round(one["batch_ns"].get(kind, 0)) or None,
                    "questions": len(lengths),
                    "longer": sum(d > LONGER for d in over),
                    "shorter": sum(d < -LONGER for d in over),
                    "largest_difference": max(map(abs, over)),
                }
            )
    RESULT.write_text(json.dumps(result, indent=1) + "\n", encoding="utf-8")
    for row in result:
        sys.stdout.write(json.dumps(row) + "\n")


if __name__ == "__main__":
    main()
