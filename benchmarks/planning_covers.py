"""Plans with a proved cover of the public Panda meshes beside those with the published spheres.

Usage: python benchmarks/planning_covers.py [--repeat 5] [--covers 0.02 0.01 0.005]. Needs the shared data
folder ($CSPACE_DATA, default ../shared/data) and the meshes of `pip install example-robot-data`. Writes
benchmarks/results/planning_covers.json.

The robot with meshes has the joints, limits and allowed pairs of the published one, whose fingers stand 65 mm
from the middle. The description has boxes for its fingers, which checks take exactly; the covers take the
mesh of a finger instead, and one line has the boxes. Times are those of the thread's processor clock, the
median of the rounds per problem; both robots plan in turn. Ratios are over the problems that are valid for
both.
"""

from __future__ import annotations

import argparse
import dataclasses
import json
import os
import sys
import time
from pathlib import Path
from typing import Any, Final

import numpy as np

HERE = Path(__file__).resolve().parent
sys.path.append(str(HERE.parent / "tests"))

import cspace as cs  # noqa: E402
from collision.motion_bench import problems, published_robot  # noqa: E402
from cspace.model import Geometry, Mesh  # noqa: E402
from cspace.planning import ArmSpace, RRTConnect  # noqa: E402
from planning_summary import summarize  # noqa: E402

MESHES: Final = "cmeel.prefix/share/example-robot-data/robots/panda_description/urdf/panda.urdf"
"""Where the wheel of example-robot-data puts the description."""


TURNS: Final = {"panda_leftfinger": 0.0, "panda_rightfinger": np.pi}
"""The fingers, and how the mesh of a finger is turned about z there."""


def find_description() -> Path:
    """The URDF file of the public description."""
    for folder in map(Path, sys.path):
        if (folder / MESHES).is_file():
            return folder / MESHES
    raise SystemExit("the Panda's meshes are missing: pip install example-robot-data")


def meshed_robot(published: cs.Robot, cover: float, boxes: bool = False) -> cs.Robot:
    """The published robot with the collision meshes of the public description, covered within `cover` [m].

    boxes: whether the fingers are the exact boxes of that description, not the mesh of a finger.
    """
    file = find_description()
    given = cs.load_robot(file, tip="panda_hand").description.links
    shapes = {link.name: link.collision for link in given}
    for name, turn in {} if boxes else TURNS.items():
        mesh = Mesh(str(file.parents[1] / "meshes/collision/finger.stl"))
        shapes[name] = (Geometry("mesh", origin=cs.pose([0.0, 0.0, 0.0], rpy=[0.0, 0.0, turn]), mesh=mesh),)
    tree = published.description
    links = tuple(dataclasses.replace(link, collision=shapes.get(link.name, ())) for link in tree.links)
    return cs.Robot(dataclasses.replace(tree, links=links), tip=published.tip, cover=cover)


def measure(robots: dict[str, cs.Robot], repeat: int) -> dict[str, Any]:
    """Times [µs], problems that are valid and solved, and per cover the ratios to the published spheres."""
    planner = RRTConnect()
    given = [(scene, start, goals) for _, _, scene, start, goals in problems("panda")]
    spaces = {key: [ArmSpace(robot, scene) for scene, _, _ in given] for key, robot in robots.items()}
    times: dict[str, list[list[float]]] = {key: [[] for _ in given] for key in robots}
    plans = {
        key: [planner.plan(space, *each[1:]) for space, each in zip(spaces[key], given, strict=True)]
        for key in robots
    }
    for _ in range(repeat):
        for k, (_, start, goals) in enumerate(given):
            for key in robots:
                if plans[key][k].status.startswith("invalid"):
                    continue
                begin = time.thread_time_ns()
                planner.plan(spaces[key][k], start, goals)
                times[key][k].append((time.thread_time_ns() - begin) / 1000.0)
    results: dict[str, Any] = {}
    first = next(iter(robots))
    for key, robot in robots.items():
        shared = [k for k in range(len(given)) if plans[key][k] and plans[first][k]]
        mine, theirs = (np.array([np.median(times[name][k]) for k in shared]) for name in (key, first))
        motions = {name: np.array([plans[name][k].stats["edges"] for k in shared]) for name in (key, first)}
        results[key] = {
            "spheres": len(robot.collision.spheres),
            "solids": len(robot.collision.solids),
            "pairs": len(robot.collision.pairs),
            "valid": sum(bool(row) for row in times[key]),
            "solved": sum(bool(plan) for plan in plans[key]),
            "shared": len(shared),
            "us": summarize(mine.tolist()),
            "median_ratio": float(np.median(mine) / np.median(theirs)),
            "mean_ratio": float(mine.mean() / theirs.mean()),
            "median_of_ratios": float(np.median(mine / theirs)),
            "median_cost_ratio": float(
                np.median([plans[key][k].cost for k in shared])
                / np.median([plans[first][k].cost for k in shared])
            ),
            "motions_ratio": float(np.median(motions[key]) / np.median(motions[first])),
            "mean_motions_ratio": float(np.mean(motions[key]) / np.mean(motions[first])),
            "us_of_a_motion": float(np.median(mine / motions[key])),
            "us_of_a_motion_ratio": float(
                np.median(mine / motions[key]) / np.median(theirs / motions[first])
            ),
        }
    return results


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--repeat", type=int, default=5)
    parser.add_argument("--covers", type=float, nargs="+", default=[0.02, 0.01, 0.005])
    given = parser.parse_args()
    os.environ.setdefault("CSPACE_DATA", str(HERE.parents[1] / "shared" / "data"))
    published, _ = published_robot("panda")
    robots = {"published": published}
    for cover in given.covers:
        robots[f"{1e3 * cover:g} mm"] = meshed_robot(published, cover)
    robots["10 mm, fingers of exact boxes"] = meshed_robot(published, 0.01, boxes=True)
    results = {"version": cs.__version__, "isa": cs._core.isa, "panda": measure(robots, given.repeat)}
    print(json.dumps(results, indent=1))
    (HERE / "results/planning_covers.json").write_text(json.dumps(results, indent=1) + "\n")


if __name__ == "__main__":
    main()
