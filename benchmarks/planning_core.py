"""Plans and checks of arms in C++, without Python, beside VAMP: benchmarks/results/planning_core.json.

Usage: python benchmarks/planning_core.py PROGRAM [--vamp FOLDER] [--repeat 5] [--robots panda ur5 fetch].
PROGRAM: bench_plans, built with -DCSPACE_BENCHMARKS=ON (benchmarks/cpp). Needs the shared data folder
($CSPACE_DATA, default ../shared/data). FOLDER: see planning.py; vamp_NAME also times edges. Both read the
same files, are pinned to one core, and run in turn; times are those of the processor clock, the median of
the rounds per problem.
"""

from __future__ import annotations

import argparse
import json
import os
import re
import subprocess
import sys
import tempfile
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import numpy as np

HERE = Path(__file__).resolve().parent
sys.path.append(str(HERE.parent / "tests"))

import cspace as cs  # noqa: E402
from collision.motion_bench import ROBOTS, problems, published_robot  # noqa: E402
from planning_summary import summarize  # noqa: E402

EDGES, EDGE_LENGTH = 96, 1.0
"""Random edges per problem, and their length [rad] before they are clipped to the bounds."""

OURS = {"rrt_connect": "proved_us", "at_samples": "sampled_us", "plan": "plan_us", "simplify": "simplify_us"}
"""Columns of our lines."""

Lines = list[dict[str, str]]


def write_row(numbers: Iterable[Any]) -> str:
    """Numbers in one line; every digit counts."""
    return " ".join(repr(float(x)) if isinstance(x, float) else str(int(x)) for x in numbers)


def write_robot(name: str, path: Path) -> None:
    """A robot as bench_plans reads it."""
    geometry = published_robot(name)[0].collision
    parts = [geometry.lower, geometry.joints, geometry.links, geometry.spheres, geometry.pairs]
    rows = [write_row(map(len, parts)), *map(write_row, geometry.joints)]
    rows += [write_row(geometry.lower), write_row(geometry.upper), write_row(geometry.link_bodies)]
    for ball, link in zip(geometry.spheres, geometry.sphere_links, strict=True):
        rows.append(write_row([*ball, int(link)]))
    rows += map(write_row, geometry.pairs)
    path.write_text("\n".join(rows) + "\n")


def upright(R: np.ndarray, half: np.ndarray) -> tuple[np.ndarray, np.ndarray] | None:
    """The axes of a box in an order in which the last one is z; None if none is vertical."""
    for k in range(3):
        if abs(abs(R[2, k]) - 1) < 1e-12:
            order = [(k + 1) % 3, (k + 2) % 3, k]
            R, half = R[:, order] * ([1, -1, -1] if R[2, k] < 0 else [1, 1, 1]), half[order]
            R[:2, 2], R[2, :2], R[2, 2] = 0, 0, 1
            return R, half
    return None


def write_shape(shape: Any) -> str:
    """A line of an obstacle: upright ones are named so, since the peer checks them faster."""
    place, R = shape.pose[:3, 3], shape.pose[:3, :3]
    if isinstance(shape, cs.Sphere):
        return "sphere " + write_row(map(float, [*place, shape.radius]))
    if isinstance(shape, cs.Capsule):
        along = R[:, 2] * shape.length
        is_upright = abs(abs(R[2, 2]) - 1) < 1e-12
        if is_upright:
            along[:2] = 0
        numbers = [*(place - along / 2), *along, shape.radius]
        return ("zcapsule " if is_upright else "capsule ") + write_row(map(float, numbers))
    half = np.array(shape.size) / 2
    turned = upright(R, half)
    R, half = turned or (R, half)
    return ("zbox " if turned else "box ") + write_row(map(float, [*place, *R.T.ravel(), *half]))


def write_problems(name: str, path: Path) -> int:
    """All problems of a robot as both programs read them; how many."""
    rows = []
    count = 0
    for group, index, scene, start, goals in problems(name):
        count += 1
        goals = np.atleast_2d(goals)
        rows.append(f"problem {group} {index} {len(goals)} {len(scene)}")
        rows.append("start " + write_row(map(float, start)))
        rows += ["goal " + write_row(map(float, goal)) for goal in goals]
        rows += [write_shape(shape) for shape in scene.obstacles]
    path.write_text(f"robot {name} {len(start)} {count}\n" + "\n".join(rows) + "\n")
    return count


def write_edges(name: str, count: int, path: Path) -> None:
    """Random edges in the bounds of a robot."""
    bounds = published_robot(name)[1]["bounds_used_by_vamp"]
    lower, upper = np.float32(bounds["lower"]), np.float32(bounds["upper"])
    rng = np.random.default_rng(20)
    a = lower + (upper - lower) * rng.random((EDGES * count, len(lower)), dtype=np.float32)
    way = rng.normal(size=a.shape)
    b = np.clip(a + EDGE_LENGTH * way / np.linalg.norm(way, axis=1, keepdims=True), lower, upper)
    np.stack([a, b], axis=1).astype(np.float32).tofile(path)


def run(*command: str | Path) -> list[str]:
    """The lines that a program prints, on the last core."""
    core = str(max(os.sched_getaffinity(0)))
    words = ["taskset", "-c", core, *map(str, command)]
    return subprocess.run(words, capture_output=True, text=True, check=True).stdout.splitlines()


def read_lines(lines: list[str]) -> Lines:
    """Rows by the titles of the first line."""
    titles = lines[0].lstrip("# ").split()
    return [dict(zip(titles, line.split(), strict=True)) for line in lines[1:] if not line.startswith("#")]


def column(rounds: list[Lines], title: str) -> np.ndarray:
    """The median of the rounds per problem."""
    return np.median([[float(row[title]) for row in lines] for lines in rounds], axis=0)


def is_solved(lines: Lines) -> np.ndarray:
    """Which problems are valid and solved."""
    return np.array([row["valid"] == row["solved"] == "1" for row in lines])


def summarize_plans(ours: list[Lines], peer: list[Lines]) -> dict[str, Any]:
    """Times [µs] over the problems that all solved, and the mean over those that we solved."""
    solved = is_solved(ours[0])
    shared = solved & is_solved(peer[0]) if peer else solved
    results: dict[str, Any] = {"solved": int(solved.sum()), "shared": int(shared.sum())}
    for key, title in OURS.items():
        times = column(ours, title)
        results[key] = summarize(times[shared].tolist()) | {"mean_of_solved": float(times[solved].mean())}
    for key, title in (("raw_cost", "cost_raw"), ("cost", "cost")):
        results[key] = summarize(column(ours, title)[shared].tolist())
    if peer:
        search, whole = column(peer, "rrt_median_us")[shared], column(peer, "total_median_us")[shared]
        columns = {
            "rrt_connect": search,
            "plan": whole,
            "simplify": whole - search,
            "raw_cost": column(peer, "cost_raw")[shared],
            "cost": column(peer, "cost_simplified")[shared],
        }
        results["vamp"] = {key: summarize(each.tolist()) for key, each in columns.items()}
        results["vamp"]["solved"] = int(is_solved(peer[0]).sum())
    return results


def read_edge_times(lines: list[str]) -> dict[str, list[float]]:
    """What is measured → ns per edge of all, free and blocked ones."""
    return {line.split()[0]: [float(x) for x in re.findall(r"ns ([\d.]+)", line)] for line in lines}


def measure(name: str, program: Path, vamp: Path | None, repeat: int, folder: Path) -> dict[str, Any]:
    """All of one robot."""
    robot, file, edges = folder / "robot.txt", folder / "problems.txt", folder / "edges.bin"
    write_robot(name, robot)
    write_edges(name, write_problems(name, file), edges)
    ours, peer, rates = [], [], []
    times: dict[str, list[list[float]]] = {}
    for _ in range(repeat):
        ours.append(read_lines(run(program, "plan", robot, file, "1")))
        checked = read_edge_times(run(program, "edges", robot, file, edges, "3"))
        rates.append(float(run(program, "rows", robot, file, "9")[0].split()[1]))
        if vamp:
            other = vamp / f"vamp_{name}"
            peer.append(read_lines(run(other, "plan", file, "1")))
            checked["vamp"] = read_edge_times(run(other, "edges", file, edges, "3"))["edges"]
        for key, each in checked.items():
            times.setdefault(key, []).append(each)
    results = summarize_plans(ours, peer)
    results["rows_per_second"] = float(np.median(rates))
    results["edges_ns"] = {
        key: dict(zip(("all", "free", "blocked"), np.median(each, axis=0).tolist(), strict=True))
        for key, each in times.items()
    }
    return results


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("program", type=Path)
    parser.add_argument("--vamp", type=Path)
    parser.add_argument("--repeat", type=int, default=5)
    parser.add_argument("--robots", nargs="+", default=list(ROBOTS))
    given = parser.parse_args()
    os.environ.setdefault("CSPACE_DATA", str(HERE.parents[1] / "shared" / "data"))
    results: dict[str, Any] = {"version": cs.__version__, "isa": cs._core.isa}
    for name in given.robots:
        with tempfile.TemporaryDirectory() as folder:
            results[name] = measure(name, given.program, given.vamp, given.repeat, Path(folder))
        print(name, json.dumps(results[name], indent=1), flush=True)
    (HERE / "results/planning_core.json").write_text(json.dumps(results, indent=1) + "\n")


if __name__ == "__main__":
    main()
