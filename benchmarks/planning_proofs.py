"""What plans and proofs are worth, judged from outside: benchmarks/results/planning_proofs.json.

Usage: python benchmarks/planning_proofs.py [--edges 100000] [--vamp FOLDER] [--robots panda ur5 fetch]
[--stages edges judged verdicts paths] [--planners plan aorrtc pose sampled]. Results are added to those of
earlier runs. Needs the shared data folder ($CSPACE_DATA, default ../shared/data) and a C++ compiler; FOLDER
as of planning.py, with rows/NAME_rows.bin: float32 configurations, as many for each problem.

Paths: every path of the planners on the valid problems, judged at a hundred times the resolution; "pose"
plans to the pose of the goal. Edges: random ones of one radian, proved free, blocked or undecided. Judged: as
many edges that are proved free, judged in the same way: a third of one radian, a third of four, and a third
that was moved towards a blocked edge until the proof just holds. Verdicts: of configurations, beside those of
VAMP on the same spheres.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
import tempfile
from collections import Counter
from pathlib import Path
from typing import Any, Final

import numpy as np

HERE = Path(__file__).resolve().parent
sys.path.append(str(HERE.parent / "tests"))

import cspace as cs  # noqa: E402
from collision.motion_bench import ROBOTS, problems, published_robot  # noqa: E402
from cspace.planning import AORRTC, ArmSpace, Plan, RRTConnect  # noqa: E402
from motion_judge import Rows  # noqa: E402
from planning_judge import BAND, Judge  # noqa: E402

PLANNERS = {
    "plan": RRTConnect(),
    "aorrtc": AORRTC(improve=2000),
    "sampled": RRTConnect(search="sampled", certify=False),
}
"""Those whose paths are judged, beside plans to poses; the last one checks its motions at samples alone."""

LENGTHS: Final = {"one radian": 1.0, "four radians": 4.0}
"""Of the random edges [rad or m, L2 norm of the joints]."""

PRESSED: Final = "pressed"
"""Name of the edges that were moved towards a blocked one."""

HALVINGS: Final = 30
"""Of the way to a blocked edge: the rest is 1e-9 of it."""

Edges = tuple[Rows, Rows]


def plan_path(key: str, space: ArmSpace, start: Any, goals: Any) -> Plan:
    """The plan of a planner, or the one to the pose of the first goal."""
    if key == "pose":
        return cs.plan(space.robot, start, space.robot.fk(np.atleast_2d(goals)[0]), space.scene)
    return PLANNERS[key].plan(space, start, goals)


def judge_paths(name: str, judge: Judge, planners: list[str]) -> dict[str, Any]:
    """Per planner the paths found, the paths that touch something, and the least clearance [m]."""
    robot, _ = published_robot(name)
    found = {key: {"paths": 0, "touch": 0, "least": float("inf")} for key in planners}
    for problem, (_, _, scene, start, goals) in enumerate(problems(name)):
        judge.set_problem(problem)
        space = ArmSpace(robot, scene)
        if robot.collides(np.array([start, np.atleast_2d(goals)[0]]), scene).any():
            continue
        for key in planners:
            plan = plan_path(key, space, start, goals)
            if plan:
                least = judge.judge_path(plan.path)
                found[key]["paths"] += 1
                found[key]["touch"] += least < 0.0
                found[key]["least"] = min(found[key]["least"], least)
    return found


def draw_edges(rng: np.random.Generator, bounds: Edges, length: float, count: int) -> Edges:
    """Random edges of a length within bounds; those that leave the bounds are shorter."""
    low, high = bounds
    a = rng.uniform(low, high, (count, len(low)))
    v = rng.normal(size=a.shape)
    return a, np.clip(a + length * v / np.linalg.norm(v, axis=1, keepdims=True), low, high)


def count_verdicts(name: str, judge: Judge, count: int) -> dict[str, Any]:
    """Random edges of one radian: how many are proved free, blocked and undecided."""
    robot, data = published_robot(name)
    bounds = read_bounds(data)
    rng = np.random.default_rng(20)
    verdicts: Counter[str] = Counter()
    each = -(-count // len(judge.problems))
    for _, _, scene, _, _ in problems(name):
        a, b = draw_edges(rng, bounds, LENGTHS["one radian"], each)
        verdicts.update(robot.edge(p, q, scene).verdict for p, q in zip(a, b, strict=True))
    return {**verdicts, "edges": each * len(judge.problems)}


def read_bounds(data: dict[str, Any]) -> Edges:
    low, high = (np.array(data["bounds_used_by_vamp"][side]) for side in ("lower", "upper"))
    return low, high


def prove_edges(
    robot: cs.Robot, scene: cs.Scene, rng: np.random.Generator, bounds: Edges, length: float, count: int
) -> tuple[Edges, Edges]:
    """Random edges that are proved free, `count` if so many are met, and at most as many that are not."""
    kept: dict[bool, list[Edges]] = {True: [], False: []}
    for _ in range(100):
        for p, q in zip(*draw_edges(rng, bounds, length, count), strict=True):
            kept[bool(robot.edge(p, q, scene))].append((p, q))
        if len(kept[True]) >= count:
            break
    free, blocked = (np.array(kept[k][:count]).reshape(-1, 2, len(bounds[0])) for k in (True, False))
    return (free[:, 0], free[:, 1]), (blocked[:, 0], blocked[:, 1])


def press_edges(robot: cs.Robot, scene: cs.Scene, free: Edges, blocked: Edges) -> Edges:
    """Free edges moved towards blocked ones, in halvings, as far as they are proved free."""
    found = []
    for k in range(len(free[0]) if len(blocked[0]) else 0):
        edge = np.array([free[0][k], free[1][k]])
        other = np.array([side[k % len(side)] for side in blocked])
        low, high = 0.0, 1.0
        for _ in range(HALVINGS):
            part = 0.5 * (low + high)
            if robot.edge(*(edge + part * (other - edge)), scene):
                low = part
            else:
                high = part
        found.append(edge + low * (other - edge))
    rows = np.array(found).reshape(-1, 2, robot.dof)
    return rows[:, 0], rows[:, 1]


def judge_edges(name: str, judge: Judge, count: int) -> dict[str, Any]:
    """Edges that are proved free: per kind how many were judged and touch, and the least clearance [m]."""
    robot, data = published_robot(name)
    bounds = read_bounds(data)
    rng = np.random.default_rng(21)
    each = -(-count // (len(judge.problems) * (len(LENGTHS) + 1)))
    found = {kind: {"judged": 0, "touch": 0, "least": float("inf")} for kind in (*LENGTHS, PRESSED)}
    places = 0
    for problem, (_, _, scene, _, _) in enumerate(problems(name)):
        judge.set_problem(problem)
        groups: dict[str, Edges] = {}
        for kind, length in LENGTHS.items():
            groups[kind], blocked = prove_edges(robot, scene, rng, bounds, length, each)
        groups[PRESSED] = press_edges(robot, scene, groups["one radian"], blocked)
        for kind, edges in groups.items():
            least, _, looked = judge.motions.look(*edges)
            places += looked
            found[kind]["judged"] += len(least)
            found[kind]["touch"] += int((least < 0.0).sum())
            found[kind]["least"] = min(found[kind]["least"], float(least.min(initial=np.inf)))
    totals = {key: sum(int(one[key]) for one in found.values()) for key in ("judged", "touch")}
    return {**found, **totals, "places": places}


def compare_verdicts(name: str, judge: Judge, vamp: Path) -> dict[str, Any]:
    """Configurations whose verdict differs from VAMP's, and the largest |clearance| among them [m]."""
    robot, _ = published_robot(name)
    given = vamp / "rows" / f"{name}_rows.bin"
    rows = np.fromfile(given, np.float32).reshape(len(judge.problems), -1, robot.dof).astype(np.float64)
    with tempfile.TemporaryDirectory() as folder:
        answer = Path(folder) / "verdicts.bin"
        command = [vamp / f"vamp_{name}", "verdicts", vamp / "problems" / f"{name}.txt", given, answer]
        subprocess.run(command, check=True, capture_output=True)
        theirs = np.fromfile(answer, np.uint8).astype(bool).reshape(rows.shape[:2])
    differ, worst = 0, 0.0
    for problem, (_, _, scene, _, _) in enumerate(problems(name)):
        ours = ~robot.collides(rows[problem], scene)
        other = np.flatnonzero(ours != theirs[problem])
        differ += len(other)
        if len(other):
            worst = max(worst, float(np.abs(judge.clearance(problem, rows[problem][other])).max()))
    return {
        "rows": int(theirs.size),
        "free": int(theirs.sum()),
        "differ": differ,
        "largest_clearance": worst,
        "outside_band": bool(worst > BAND),
    }


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--edges", type=int, default=100_000)
    parser.add_argument("--vamp", type=Path)
    parser.add_argument("--stages", nargs="+", default=["edges", "judged", "verdicts", "paths"])
    parser.add_argument("--planners", nargs="+", default=["plan", "aorrtc", "pose", "sampled"])
    parser.add_argument("--robots", nargs="+", default=list(ROBOTS))
    given = parser.parse_args()
    data = Path(os.environ.setdefault("CSPACE_DATA", str(HERE.parents[1] / "shared" / "data")))
    file = HERE / "results/planning_proofs.json"
    results: dict[str, Any] = json.loads(file.read_text()) if file.is_file() else {}
    results |= {"version": cs.__version__, "band": BAND}
    for name in given.robots:
        judge = Judge(name, data / "planning")
        stages = {
            "edges": lambda: count_verdicts(name, judge, given.edges),  # noqa: B023
            "judged": lambda: judge_edges(name, judge, given.edges),  # noqa: B023
            "verdicts": lambda: compare_verdicts(name, judge, given.vamp),  # noqa: B023
            "paths": lambda: judge_paths(name, judge, given.planners),  # noqa: B023
        }
        for stage in given.stages:
            found = stages[stage]()
            print(name, stage, json.dumps(found), flush=True)
            results.setdefault(name, {}).setdefault(stage, {}).update(found)
            file.write_text(json.dumps(results, indent=1) + "\n")


if __name__ == "__main__":
    main()
