"""What plans and proofs are worth, judged from outside: benchmarks/results/planning_proofs.json.

Usage: python benchmarks/planning_proofs.py [--edges 100000] [--judged 20] [--vamp FOLDER]
[--robots panda ur5 fetch] [--stages edges verdicts paths] [--planners plan aorrtc sampled]. Results are added
to those of earlier runs. Needs the shared data folder ($CSPACE_DATA, default ../shared/data); FOLDER as of
planning.py, with rows/NAME_rows.bin: float32 configurations, as many for each problem.

Paths: every path of the planners on the valid problems, judged at a hundred times the resolution. Edges:
random ones of one radian, proved free, blocked or undecided; of those that are proved the first ones of each
problem (--judged) are judged in the same way. Verdicts: of configurations, beside those of VAMP on the same
spheres.
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
from typing import Any

import numpy as np

HERE = Path(__file__).resolve().parent
sys.path.append(str(HERE.parent / "tests"))

import cspace as cs  # noqa: E402
from collision.motion_bench import ROBOTS, problems, published_robot  # noqa: E402
from cspace.planning import AORRTC, ArmSpace, RRTConnect  # noqa: E402
from planning_judge import BAND, Judge  # noqa: E402

PLANNERS = {
    "plan": RRTConnect(),
    "aorrtc": AORRTC(improve=2000),
    "sampled": RRTConnect(search="sampled", certify=False),
}
"""Those whose paths are judged; the last one checks its motions at samples alone."""

LENGTH = 1.0
"""Of the random edges [rad or m, L2 norm of the joints]."""


def judge_paths(name: str, judge: Judge, planners: list[str]) -> dict[str, Any]:
    """Per planner the paths found, the paths that touch something, and the deepest contact [m]."""
    robot, _ = published_robot(name)
    found: Counter[str] = Counter()
    bad: Counter[str] = Counter()
    depth = dict.fromkeys(planners, 0.0)
    for problem, (_, _, scene, start, goals) in enumerate(problems(name)):
        space = ArmSpace(robot, scene)
        for key in planners:
            plan = PLANNERS[key].plan(space, start, goals)
            if plan:
                contacts = judge.judge_path(problem, plan.path)
                found[key] += 1
                bad[key] += bool(contacts)
                depth[key] = max([depth[key], *(-gap for _, _, gap in contacts)])
    return {key: {"paths": found[key], "touch": bad[key], "deepest": depth[key]} for key in planners}


def judge_edges(name: str, judge: Judge, count: int, most: int) -> dict[str, Any]:
    """Random edges: how many are proved free, blocked and undecided, and how many proved ones touch.

    count: of the edges; most: proved ones that are judged per problem.
    """
    robot, data = published_robot(name)
    low, high = (np.array(data["bounds_used_by_vamp"][side]) for side in ("lower", "upper"))
    rng = np.random.default_rng(20)
    verdicts: Counter[str] = Counter()
    touching, judged = [], 0
    each = -(-count // len(judge.problems))
    for problem, (_, _, scene, _, _) in enumerate(problems(name)):
        a = rng.uniform(low, high, (each, len(low)))
        v = rng.normal(size=a.shape)
        b = np.clip(a + LENGTH * v / np.linalg.norm(v, axis=1, keepdims=True), low, high)
        found = [robot.edge(p, q, scene).verdict for p, q in zip(a, b, strict=True)]
        verdicts.update(found)
        proved = np.flatnonzero([verdict == "free" for verdict in found])[:most]
        contacts = judge.find_contacts(problem, a[proved], b[proved])
        judged += len(proved)
        touching += [(problem, edge, gap) for edge, _, gap in contacts]
    return {**verdicts, "edges": each * len(judge.problems), "judged": judged, "touch": len(touching)}


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
    parser.add_argument("--judged", type=int, default=20)
    parser.add_argument("--vamp", type=Path)
    parser.add_argument("--stages", nargs="+", default=["edges", "verdicts", "paths"])
    parser.add_argument("--planners", nargs="+", default=list(PLANNERS))
    parser.add_argument("--robots", nargs="+", default=list(ROBOTS))
    given = parser.parse_args()
    data = Path(os.environ.setdefault("CSPACE_DATA", str(HERE.parents[1] / "shared" / "data")))
    file = HERE / "results/planning_proofs.json"
    results: dict[str, Any] = json.loads(file.read_text()) if file.is_file() else {}
    results |= {"version": cs.__version__, "band": BAND}
    for name in given.robots:
        judge = Judge(name, data / "planning")
        stages = {
            "edges": lambda: judge_edges(name, judge, given.edges, given.judged),  # noqa: B023
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
