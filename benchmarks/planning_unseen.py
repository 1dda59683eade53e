"""Problems that no part of the package was tuned on: benchmarks/results/planning_unseen.json.

Usage: python benchmarks/planning_unseen.py [--scenes 200] [--rows 200] [--seeds 4] [--edges 100] [--stages
arms edges seeds]. Needs a C++ compiler, and for the seeds the shared data folder ($CSPACE_DATA, default
../shared/data).

Arms: random scenes of boxes, cylinders and capsules around five arms of the catalogue. In each, a plan
between two random free configurations, which may have no way, a plan along a random walk of free motions,
which has one, and verdicts of random configurations; then edges that are proved free, as in
planning_proofs.py. The judge, which also finds the walks, reads links, joints and capsules from the files of
the catalogue itself (motion_judge.py); of the package it takes the list of pairs that are allowed to touch.
Seeds: every MotionBenchMaker problem with other seeds of the search. Other half: the problems of VAMP's
repository that the shared data lacks, with the same seeds; --archives is its folder resources, with
NAME/problems.tar.bz2, and `pip install pyyaml` is needed. Times are those of the thread's processor clock.
"""

from __future__ import annotations

import argparse
import itertools
import json
import os
import sys
import tarfile
import time
from collections.abc import Iterator
from importlib import resources
from pathlib import Path
from typing import Any, Final

import numpy as np
import tomllib

HERE = Path(__file__).resolve().parent
sys.path.append(str(HERE.parent / "tests"))

import cspace as cs  # noqa: E402
from collision.motion_bench import ROBOTS, obstacle, published_robot  # noqa: E402
from cspace.planning import ArmSpace, RRTConnect  # noqa: E402
from motion_judge import MotionJudge, rotation_of  # noqa: E402
from planning_judge import BAND, Judge  # noqa: E402
from planning_proofs import PRESSED, press_edges, prove_edges  # noqa: E402
from planning_summary import summarize  # noqa: E402

ARMS: Final = {"ur5e": 0.85, "iiwa14": 0.8, "fr3": 0.8, "gen3": 0.9, "xarm7": 0.7}
"""The arms, and how far from the base obstacles stand at most [m]."""

EDGES: Final = {"random": 20_000, "walk": 1_048_576}
"""Motions after which a search gives up; the ends of a walk are known to have a way."""

STEPS: Final = 60
STEP: Final = 0.7
"""Motions of a walk that are tried, and their length [rad]."""

KEPT: Final = 1e-3
"""Clearance of the motions of a walk [m]."""

COARSE: Final = 1.0 / 32.0
"""Resolution at which the ends of a walk are seen to be blocked from its start [rad]."""

THIN: Final = 1e-4
"""Thickness of every other obstacle where edges are judged [m]."""

Given = dict[str, Any]


def read_arm(robot: cs.Robot, name: str) -> MotionJudge:
    """The judge of an arm of the catalogue, from its file."""
    text = (resources.files("cspace") / f"robots/catalogue/{name}.toml").read_text()
    given = tomllib.loads(text)
    bodies = []
    for link in given["links"]:
        for shape in link.get("collision", []):
            radius, length = [*shape["size"], 0.0][:2]
            half = rotation_of(shape) @ [0.0, 0.0, 0.5 * length]
            middle = np.array(shape.get("xyz", (0.0, 0.0, 0.0)))
            bodies.append((link["name"], middle - half, middle + half, radius))
    links = [link["name"] for link in given["links"]]
    allowed = {frozenset(pair[:2]) for pair in robot.collision.allowed}
    pairs = [pair for pair in itertools.combinations(links, 2) if frozenset(pair) not in allowed]
    return MotionJudge(given["joints"], robot.joint_names, bodies, pairs)


def random_obstacle(rng: np.random.Generator, reach: float, thin: bool) -> Given:
    """A box, a cylinder or a capsule somewhere around the arm; if thin, a plate, a disc or a wire."""
    at = rng.normal(size=3)
    at *= reach * rng.uniform(0.4, 1.1) / np.linalg.norm(at)
    given: Given = {"position": at, "rpy": rng.uniform(-np.pi, np.pi, 3)}
    kind = ("box", "cylinder", "capsule")[rng.integers(3)]
    size, radius, length = rng.uniform(0.02, 0.5, 3), rng.uniform(0.01, 0.12), rng.uniform(0.05, 0.6)
    if thin:
        size[rng.integers(3)] = THIN
        radius, length = (THIN / 2, length) if kind == "capsule" else (2.0 * radius, THIN)
    if kind == "box":
        return {**given, "type": kind, "size": size}
    return {**given, "type": kind, "radius": radius, "length": length}


def shape_of(given: Given) -> Any:
    """The same for the package."""
    T = cs.pose(given["position"], matrix=rotation_of(given))
    if given["type"] == "box":
        return cs.Box(given["size"], T)
    kind = cs.Cylinder if given["type"] == "cylinder" else cs.Capsule
    return kind(given["radius"], given["length"], T)


def random_problems(
    robot: cs.Robot, reach: float, count: int, thin: bool = False
) -> Iterator[tuple[list[Given], cs.Scene, Any, Any]]:
    """Random scenes with two free configurations."""
    rng = np.random.default_rng(sum(map(ord, robot.name)))
    while count:
        objects = [random_obstacle(rng, reach, thin and k % 2 == 0) for k in range(rng.integers(3, 13))]
        scene = cs.Scene([shape_of(given) for given in objects])
        q = robot.random_configuration(64, rng=rng)
        free = q[~robot.collides(q, scene)]
        if len(free) >= 2:
            yield objects, scene, free[0], free[1]
            count -= 1


def walk(judge: MotionJudge, robot: cs.Robot, start: Any, rng: np.random.Generator) -> Any:
    """The last place of a walk of motions that are free by the judge to which the straight motion is not."""
    places, way = [start], np.zeros(len(start))
    for _ in range(STEPS):
        way = 2.0 * way + rng.normal(size=len(start))
        way /= np.linalg.norm(way)
        following = np.clip(places[-1] + STEP * way, robot.limits.lower, robot.limits.upper)
        if judge.look(places[-1][None], following[None])[0][0] > KEPT:
            places.append(following)
        else:
            way *= 0.0
    rows = np.array(places)
    blocked = np.flatnonzero(judge.look(np.broadcast_to(start, rows.shape), rows, COARSE)[0] < 0.0)
    return rows[blocked[-1] if len(blocked) else -1]


class Tally:
    """Plans of one kind: how they end, their times, and what the judge sees on their paths."""

    def __init__(self) -> None:
        self.ends: dict[str, int] = {}
        self.times: list[float] = []
        self.open: list[int] = []
        self.touch, self.straight, self.least = 0, 0, np.inf

    def add(self, judge: MotionJudge, number: int, plan: Any, spent: float) -> None:
        self.ends[plan.status] = self.ends.get(plan.status, 0) + 1
        self.times.append(spent)
        if not plan:
            self.open.append(number)
            return
        gap = float(judge.look(plan.path[:-1], plan.path[1:])[0].min(initial=np.inf))
        self.touch += gap < 0.0
        self.straight += len(plan.path) == 2
        self.least = min(self.least, gap)

    def summary(self) -> dict[str, Any]:
        found = {"ends": self.ends, "open": self.open, "touch": self.touch, "straight": self.straight}
        return {**found, "least": self.least, "us": summarize(self.times)}


def measure_arm(name: str, count: int, rows: int) -> dict[str, Any]:
    """Plans and verdicts of an arm in random scenes, judged."""
    robot = cs.load_robot(name)
    judge = read_arm(robot, name)
    tallies = {kind: Tally() for kind in EDGES}
    differ, beyond, largest = 0, 0, 0.0
    for number, (objects, scene, start, goal) in enumerate(random_problems(robot, ARMS[name], count)):
        judge.set_scene(objects)
        q = robot.random_configuration(rows, rng=number)
        gap = judge.clearance(q)
        wrong = robot.collides(q, scene) != (gap < 0.0)
        differ += int(wrong.sum())
        beyond += int((wrong & (np.abs(gap) > BAND)).sum())
        largest = max(largest, float(np.abs(gap[wrong]).max(initial=0.0)))
        goals = {"random": goal, "walk": walk(judge, robot, start, np.random.default_rng(number))}
        for kind, tally in tallies.items():
            begin = time.thread_time_ns()
            plan = cs.plan(robot, start, goals[kind], scene, edges=EDGES[kind])
            tally.add(judge, number, plan, (time.thread_time_ns() - begin) / 1000.0)
    verdicts = {"rows": count * rows, "differ": differ, "beyond_band": beyond, "largest_clearance": largest}
    return {"scenes": count, "verdicts": verdicts} | {kind: each.summary() for kind, each in tallies.items()}


def judge_edges(name: str, count: int, each: int) -> dict[str, Any]:
    """Random edges that are proved free, and such that were pressed against a contact, in random scenes."""
    robot = cs.load_robot(name)
    judge = read_arm(robot, name)
    low, high = (np.clip(side, -np.pi, np.pi) for side in (robot.limits.lower, robot.limits.upper))
    rng = np.random.default_rng(23)
    found = {kind: {"judged": 0, "touch": 0, "least": np.inf} for kind in ("one radian", PRESSED)}
    for objects, scene, _, _ in random_problems(robot, ARMS[name], count, thin=True):
        judge.set_scene(objects)
        free, blocked = prove_edges(robot, scene, rng, (low, high), 1.0, each)
        for kind, edges in zip(found, (free, press_edges(robot, scene, free, blocked)), strict=True):
            least = judge.look(*edges)[0]
            found[kind]["judged"] += len(least)
            found[kind]["touch"] += int((least < 0.0).sum())
            found[kind]["least"] = min(found[kind]["least"], float(least.min(initial=np.inf)))
    return found


def measure_problems(name: str, judge: Judge, seeds: list[int]) -> dict[str, Any]:
    """All valid problems of the judge with each seed: solved, times [µs], paths that touch something."""
    robot, _ = published_robot(name)
    times: dict[int, list[float]] = {seed: [] for seed in seeds}
    costs: dict[int, list[float]] = {seed: [] for seed in seeds}
    planner, valid, touch, least = RRTConnect(), 0, 0, np.inf
    for problem, (group, given) in enumerate(judge.problems):
        scene = cs.Scene([obstacle(one, group == "box") for one in given["objects"]])
        space, start, goals = ArmSpace(robot, scene), given["start"], given["goals"]
        judge.set_problem(problem)
        if planner.plan(space, start, goals).status.startswith("invalid"):
            continue
        valid += 1
        for seed in seeds:
            begin = time.thread_time_ns()
            plan = planner.plan(space, start, goals, rng=seed)
            times[seed].append((time.thread_time_ns() - begin) / 1000.0)
            if plan:
                costs[seed].append(plan.cost)
                gap = judge.judge_path(plan.path)
                touch += gap < 0.0
                least = min(least, gap)
    found = {
        str(seed): {"solved": len(costs[seed]), "us": summarize(times[seed]), "cost": summarize(costs[seed])}
        for seed in seeds
    }
    return {"problems": len(judge.problems), "valid": valid, "touch": touch, "least": least, "seeds": found}


def read_archive(file: Path, planned: list[str]) -> dict[tuple[str, int], Given]:
    """The problems of an archive of MotionBenchMaker by set and number, as in the shared data."""
    import yaml

    found: dict[tuple[str, int], Given] = {}
    with tarfile.open(file) as archive:
        for member in archive.getmembers():
            if not member.isfile():
                continue
            group, name = Path(member.name).parent.name.rpartition("_")[0], Path(member.name).stem
            read = yaml.load(
                archive.extractfile(member), Loader=getattr(yaml, "CSafeLoader", yaml.SafeLoader)
            )
            problem = found.setdefault((group, int(name[-4:])), {})
            problem |= read_scene(read) if name.startswith("scene") else read_request(read, planned)
    return found


def read_request(given: Given, planned: list[str]) -> Given:
    """Start and goal."""
    state = given["start_state"]["joint_state"]
    start = dict(zip(state["name"], state["position"], strict=True))
    goal = {one["joint_name"]: one["position"] for one in given["goal_constraints"][0]["joint_constraints"]}
    return {"start": [start[name] for name in planned], "goals": [[goal[name] for name in planned]]}


def read_scene(given: Given) -> Given:
    """The first shape of each object."""
    objects = []
    for one in given["world"]["collision_objects"]:
        shape, place = one["primitives"][0], one["primitive_poses"][0]
        at, turn = compose(one["pose"], place) if "pose" in one else (place["position"], place["orientation"])
        sizes = {"type": shape["type"], "size": shape["dimensions"]}
        if shape["type"] == "cylinder":
            sizes = {"type": "cylinder", "length": shape["dimensions"][0], "radius": shape["dimensions"][1]}
        if shape["type"] == "sphere":
            sizes = {"type": "sphere", "radius": shape["dimensions"][0]}
        objects.append({"name": one["id"], "position": list(at), "quat_xyzw": list(turn), **sizes})
    return {"objects": objects}


def compose(first: Given, second: Given) -> tuple[Any, Any]:
    """Position and quaternion (x, y, z, w) of a pose given in the frame of another."""
    at = first["position"] + rotation_of({"quat_xyzw": first["orientation"]}) @ second["position"]
    (*u, a), (*v, b) = first["orientation"], second["orientation"]
    u, v = np.array(u), np.array(v)
    return at, [*(a * v + b * u + np.cross(u, v)), a * b - u @ v]


def other_half(judge: Judge, file: Path) -> None:
    """Gives the judge the problems that the shared data lacks; the others must be those of the data."""
    read = read_archive(file, judge.robot["planned_joints"])
    known = {(group, given["index"]): given for group, given in judge.problems}
    for key, given in known.items():
        ours, theirs = ([one["position"] for one in each["objects"]] for each in (given, read[key]))
        if given["start"] != read[key]["start"] or not np.allclose(sorted(ours), sorted(theirs), atol=1e-9):
            raise SystemExit(f"problem {key} of {file} is not that of the shared data")
    judge.problems = [(group, read[group, k]) for group, k in sorted(read) if (group, k) not in known]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--archives", type=Path)
    parser.add_argument("--scenes", type=int, default=200)
    parser.add_argument("--rows", type=int, default=200)
    parser.add_argument("--edges", type=int, default=100)
    parser.add_argument("--seeds", type=int, default=4)
    parser.add_argument("--stages", nargs="+", default=["arms", "edges", "seeds"])
    parser.add_argument("--arms", nargs="+", default=list(ARMS))
    parser.add_argument("--robots", nargs="+", default=list(ROBOTS))
    given = parser.parse_args()
    data = Path(os.environ.setdefault("CSPACE_DATA", str(HERE.parents[1] / "shared" / "data")))
    file = HERE / "results/planning_unseen.json"
    results: dict[str, Any] = json.loads(file.read_text()) if file.is_file() else {}
    results |= {"version": cs.__version__, "isa": cs._core.isa, "band": BAND}
    names = {"arms": given.arms, "edges": given.arms, "seeds": given.robots, "other half": given.robots}
    for stage in given.stages:
        for name in names[stage]:
            if stage == "arms":
                found = measure_arm(name, given.scenes, given.rows)
            elif stage == "edges":
                found = judge_edges(name, given.scenes, given.edges)
            else:
                judge, seeds = Judge(name, data / "planning"), [0, *range(1, given.seeds + 1)]
                if stage == "other half":
                    other_half(judge, given.archives / name / "problems.tar.bz2")
                found = measure_problems(name, judge, seeds)
            print(name, json.dumps(found), flush=True)
            results.setdefault(stage, {})[name] = found
            file.write_text(json.dumps(results, indent=1) + "\n")


if __name__ == "__main__":
    main()
