"""Plans of the Panda beside OMPL's wheel, whose checks are called from Python: results/planning_wheel.json.

Usage: python benchmarks/planning_wheel.py [--repeat 3] [--step 7] [--seconds 30]. Needs the shared data
folder ($CSPACE_DATA, default ../shared/data) and `pip install ompl coal pin`.

This is OMPL as Python programs use it; planning_peers.py has it in C++. Its RRT-Connect samples motions at
1/32 rad. "same spheres" asks our own check, the quickest there is from Python, so that what is compared is
the planner and its calls. "coal, same spheres" asks Pinocchio's collision checks with coal's tree of boxes,
for every --step-th problem, once. Ours plans the same problems in turn with them. All times are those of the
thread's processor clock, the median of the rounds per problem, then over the problems that both solved.
"""

from __future__ import annotations

import argparse
import importlib.metadata
import json
import os
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any, Final

import coal
import numpy as np
import pinocchio as pin
from ompl import base, geometric, util

HERE = Path(__file__).resolve().parent
sys.path.append(str(HERE.parent / "tests"))

import cspace as cs  # noqa: E402
from collision.motion_bench import problems, published_robot  # noqa: E402
from cspace.planning import ArmSpace  # noqa: E402
from planning_peers import SAME, TURNS, compare, plan_ours  # noqa: E402

Check = Callable[[Any], bool]
COLUMNS: Final = ("solved", "valid", "search_us", "total_us", "raw_cost", "cost", "checks")


class PinocchioCheck:
    """The published spheres of a robot and a scene, checked by coal through Pinocchio."""

    def __init__(self, robot: cs.Robot, data: dict[str, Any], scene: cs.Scene) -> None:
        full = pin.buildModelFromXML(robot.to_urdf())
        held = [full.getJointId(name) for name in full.names[1:] if name not in data["planned_joints"]]
        self.model = pin.buildReducedModel(full, held, pin.neutral(full))
        self.data, self.geometry = self.model.createData(), pin.GeometryModel()
        links: dict[str, list[int]] = {}
        for k, sphere in enumerate(data["spheres"]):
            frame = self.model.getFrameId(sphere["link"])
            carried = self.model.frames[frame]
            place = carried.placement * pin.SE3(np.eye(3), np.array(sphere["center"], float))
            one = pin.GeometryObject(f"{k}", carried.parentJoint, frame, place, coal.Sphere(sphere["radius"]))
            links.setdefault(sphere["link"], []).append(self.geometry.addGeometryObject(one))
        obstacles = [
            self.geometry.addGeometryObject(
                pin.GeometryObject(shape.name, 0, 0, pin.SE3(np.asarray(shape.pose)), coal_shape(shape))
            )
            for shape in scene.obstacles
        ]
        spheres = [k for group in links.values() for k in group]
        pairs = [(k, other) for k in spheres for other in obstacles]
        for a, b in data["self_pairs_checked_by_vamp"]:
            pairs += [(k, other) for k in links.get(a, []) for other in links.get(b, [])]
        for pair in pairs:
            self.geometry.addCollisionPair(pin.CollisionPair(*pair))
        places = pin.GeometryData(self.geometry)
        self.manager = pin.TreeBroadPhaseManager_DynamicAABBTreeCollisionManager(
            self.model, self.geometry, places
        )

    def __call__(self, q: Any) -> bool:
        return not pin.computeCollisions(self.model, self.data, self.manager, q, True)


def coal_shape(shape: cs.Shape) -> Any:
    if isinstance(shape, cs.Box):
        return coal.Box(*map(float, shape.size))
    if isinstance(shape, cs.Sphere):
        return coal.Sphere(shape.radius)
    assert isinstance(shape, cs.Capsule)
    return coal.Capsule(shape.radius, shape.length)


def plan_theirs(check: Check, start: Any, goal: Any, limits: Any, given: argparse.Namespace) -> list[float]:
    """A row of COLUMNS: RRT-Connect and simplification with their defaults."""
    dof, count = len(start), 0
    space, bounds = base.RealVectorStateSpace(dof), base.RealVectorBounds(dof)
    for k in range(dof):
        bounds.setLow(k, float(limits.lower[k]))
        bounds.setHigh(k, float(limits.upper[k]))
    space.setBounds(bounds)
    information = base.SpaceInformation(space)
    simple, joints = geometric.SimpleSetup(information), range(dof)

    def is_free(state: Any) -> bool:
        nonlocal count
        count += 1
        return check(np.array([state[k] for k in joints]))

    information.setStateValidityChecker(is_free)
    information.setStateValidityCheckingResolution(SAME / space.getMaximumExtent())
    ends = space.allocState(), space.allocState()
    for state, q in zip(ends, (start, goal), strict=True):
        for k, value in enumerate(np.clip(q, limits.lower, limits.upper).tolist()):
            state[k] = value
    simple.setStartAndGoalStates(*ends)
    simple.setPlanner(geometric.RRTConnect(information))
    simple.setup()
    begin = time.thread_time_ns()
    simple.solve(given.seconds)
    searched = time.thread_time_ns() - begin
    if not simple.haveExactSolutionPath():
        return [0, 1, *[0.0] * 5]
    checks, raw = count, simple.getSolutionPath().length()
    begin = time.thread_time_ns()
    simple.simplifySolution()
    total = searched + time.thread_time_ns() - begin
    return [1, 1, searched / 1000.0, total / 1000.0, raw, simple.getSolutionPath().length(), checks]


def run_case(
    robot: cs.Robot, given: argparse.Namespace, step: int, rounds: int, check_of: Callable[[cs.Scene], Check]
) -> dict[str, Any]:
    """Medians of the peer's and of our plans, a part of the problems each in turn."""
    given_problems = [row for row in list(problems("panda"))[::step] if not robot.collides(row[3], row[2])]
    theirs, ours = [], []
    for turn in range(TURNS):
        part = given_problems[turn::TURNS]
        for _, _, scene, start, goals in part:
            check, goal = check_of(scene), np.atleast_2d(goals)[0]
            rows = [plan_theirs(check, start, goal, robot.limits, given) for _ in range(rounds)]
            theirs.append(np.median(rows, axis=0))
        spaces = [(ArmSpace(robot, scene), start, goals) for _, _, scene, start, goals in part]
        ours.append(plan_ours(spaces, list(range(len(part))), given.repeat))
    columns = dict(zip(COLUMNS, np.array(theirs).T, strict=True))
    return compare(columns, {key: np.concatenate([each[key] for each in ours]) for key in ours[0]})


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--repeat", type=int, default=3)
    parser.add_argument("--step", type=int, default=7)
    parser.add_argument("--seconds", type=float, default=30.0)
    given = parser.parse_args()
    os.environ.setdefault("CSPACE_DATA", str(HERE.parents[1] / "shared" / "data"))
    util.setLogLevel(util.LogLevel.LOG_NONE)
    util.RNG.setSeed(1)
    robot, data = published_robot("panda")
    peers = {name: importlib.metadata.version(name) for name in ("ompl", "coal", "pin")}
    results: dict[str, Any] = {"version": cs.__version__, "isa": cs._core.isa, "peers": peers}
    results |= {"seconds": given.seconds, "cases": {}}
    cases = {
        "same spheres": (1, given.repeat, lambda scene: lambda q: not robot.collides(q, scene)),
        "coal, same spheres": (given.step, 1, lambda scene: PinocchioCheck(robot, data, scene)),
    }
    for case, (step, rounds, check_of) in cases.items():
        results["cases"][case] = run_case(robot, given, step, rounds, check_of)
        print(case, json.dumps(results["cases"][case]), flush=True)
    (HERE / "results/planning_wheel.json").write_text(json.dumps(results, indent=1) + "\n")


if __name__ == "__main__":
    main()
