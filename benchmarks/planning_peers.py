"""Plans of the Panda beside OMPL's RRT-Connect with checks of three kinds: results/planning_peers.json.

Usage: python benchmarks/planning_peers.py [--prefix /usr] [--repeat 3] [--step 2] [--seconds 5] [--cases NAME
...]. Needs the shared data folder ($CSPACE_DATA, default ../shared/data), a C++ compiler, Debian's
libompl-dev and libeigen3-dev (or both below --prefix), and `pip install coal example-robot-data`, whose
wheels hold coal's headers and the Panda's meshes.

benchmarks/peers/ompl_plans.cpp is compiled with -O3, so OMPL and its checks run without Python; ours is
called from Python. "callback" is what a check costs that OMPL's wheel 2.0.1 (`pip install ompl`) calls in
Python and that reads the configuration only. Cases of CASES differ in their checks and in the resolution of
motions. Slow cases plan every --step-th problem alone. Ours plans the same problems in turn with them. All
times are those of the thread's processor clock, the median of the rounds per problem, then over the problems
that both solved.
"""

from __future__ import annotations

import argparse
import json
import os
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any, Final

import numpy as np

HERE = Path(__file__).resolve().parent
sys.path.append(str(HERE.parent / "tests"))

import cspace as cs  # noqa: E402
from collision.motion_bench import problems, published_robot  # noqa: E402
from cspace.planning import ArmSpace, RRTConnect  # noqa: E402
from motion_judge import KINDS, MOTIONS, Rows, rotation_of, size_of  # noqa: E402
from planning_covers import find_description, meshed_robot  # noqa: E402
from planning_judge import Judge, read_object  # noqa: E402

SAME: Final = 1.0 / 32.0
"""The resolution of samples in sampled searches of ours and of VAMP [rad]."""

CASES: Final = {
    "spheres": ("spheres", SAME, False),
    "spheres, OMPL's resolution": ("spheres", 0.0, False),
    "coal, same spheres": ("coal_spheres", SAME, True),
    "coal, meshes": ("coal_meshes", SAME, True),
    "coal, meshes, OMPL's resolution": ("coal_meshes", 0.0, True),
}
"""Checker and resolution of a case, and whether it is slow."""

STL: Final = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("about", "<u2")])
STL_HEADER: Final = 84
"""A triangle of a binary STL file, and the bytes before the first."""

SIDES: Final = (
    *((0, 1, 3), (0, 3, 2), (4, 6, 7), (4, 7, 5), (0, 4, 5), (0, 5, 1)),
    *((2, 3, 7), (2, 7, 6), (0, 2, 6), (0, 6, 4), (1, 5, 7), (1, 7, 3)),
)
"""Triangles of a box whose corners count in binary."""

TURNS: Final = 10
"""Parts of the problems that the peer and ours plan in turn."""

COLUMNS: Final = ("valid", "solved", "search_us", "total_us", "raw_cost", "cost", "checks")


def build_program(prefix: Path, folder: Path) -> Path:
    """The compiled program, linked with OMPL below `prefix` and coal of the wheel."""
    program = folder / "ompl_plans"
    wheel = find_description().parents[5]
    found = sorted(prefix.glob("include/ompl-*")) + sorted(prefix.glob("include/ompl"))
    libraries = [wheel / "lib", *(path.parent for path in prefix.glob("lib/**/libompl.so"))]
    headers = [found[0], wheel / "include", Path("/usr/include/eigen3")]
    command = [
        os.environ.get("CXX", "c++"),
        "-std=c++17",
        "-O3",
        "-DNDEBUG",
        "-w",
        HERE / "peers/ompl_plans.cpp",
    ]
    command += [part for path in headers for part in ("-isystem", path)]
    command += [part for path in libraries for part in (f"-L{path}", f"-Wl,-rpath,{path}")]
    command += ["-Wl,--disable-new-dtags", "-lompl", "-lcoal", "-o", program]  # libraries of libraries too
    subprocess.run(command, check=True)
    return program


def join(values: Any) -> str:
    return " ".join(repr(float(x)) for x in np.ravel(values))


def write_problems(judge: Judge, robot: cs.Robot, file: Path) -> None:
    """The published spheres, the meshes of `robot` and all problems as text."""
    data = judge.robot
    bounds = robot.limits
    frames: dict[str, int] = {data["joints"][0]["parent"]: 0}
    lines = [str(robot.dof), join(bounds.lower), join(bounds.upper), str(len(data["joints"]))]
    for k, j in enumerate(data["joints"]):
        planned = data["planned_joints"]
        variable = planned.index(j["name"]) if j["name"] in planned else -1
        numbers = join([*j["xyz"], *rotation_of(j).ravel(), *(j.get("axis") or (0, 0, 1))])
        lines.append(f"{frames[j['parent']]} {MOTIONS[j['type']]} {variable} {numbers}")
        frames[j["child"]] = k + 1
    links = sorted(set(judge.links), key=judge.links.index)
    meshes = {link.name: link.collision for link in robot.description.links}
    lines.append(str(len(links)))
    for link in links:
        spheres = [s for s in data["spheres"] if s["link"] == link]
        vertices, faces = read_mesh(meshes[link])
        lines += [f"{frames[link]} {len(spheres)}", *(join([*s["center"], s["radius"]]) for s in spheres)]
        lines += [f"{len(vertices)} {join(vertices)}", f"{len(faces)} " + " ".join(map(str, faces.ravel()))]
    pairs = [
        (links.index(a), links.index(b))
        for a, b in data["self_pairs_checked_by_vamp"]
        if a in links and b in links
    ]
    lines += [str(len(pairs)), *(f"{a} {b}" for a, b in pairs), str(len(judge.problems))]
    for group, row in judge.problems:
        goal = np.atleast_2d(row["goals"])[0]
        lines += [join(row["start"]), join(goal), str(len(row["objects"]))]
        for given in row["objects"]:
            shape = read_object(given, group == "box")
            numbers = join([*shape["position"], *rotation_of(shape).ravel(), *size_of(shape)])
            lines.append(f"{KINDS.index(shape['type'])} {numbers}")
    file.write_text("\n".join(lines) + "\n")


def read_mesh(shapes: Any) -> tuple[Rows, np.ndarray[Any, Any]]:
    """Vertices (n, 3) in the frame of the link and faces (m, 3) of its meshes and boxes."""
    vertices: list[Rows] = [np.empty((0, 3))]
    faces = [np.empty((0, 3), int)]
    for shape in shapes:
        if shape.shape == "mesh":
            rows = np.fromfile(shape.mesh.file(), STL, offset=STL_HEADER)["corners"].reshape(-1, 3)
            corners, turns = np.unique(rows, axis=0, return_inverse=True)
            corners, turns = corners.astype(float) * shape.mesh.scale, turns.reshape(-1, 3)
        else:
            corners = (np.array(list(np.ndindex(2, 2, 2))) - 0.5) * shape.size
            turns = np.array(SIDES)
        T = np.asarray(shape.origin)
        faces.append(turns + sum(map(len, vertices)))
        vertices.append(corners @ T[:3, :3].T + T[:3, 3])
    return np.concatenate(vertices), np.concatenate(faces)


def run_case(
    program: Path, file: Path, case: str, chosen: list[int], given: argparse.Namespace
) -> dict[str, Rows]:
    """The columns of the peer on some problems, which are equally far apart."""
    checker, resolution, slow = CASES[case]
    rounds = 1 if slow else given.repeat
    step = chosen[1] - chosen[0]
    command = [program, file, checker, rounds, resolution, given.seconds, chosen[0], step]
    out = subprocess.run(list(map(str, command)), check=True, capture_output=True, text=True).stdout
    rows = np.array([line.split() for line in out.splitlines()], float)
    return dict(zip(COLUMNS, rows.T, strict=True))


def run_in_turn(
    program: Path, file: Path, case: str, spaces: list[Any], given: argparse.Namespace
) -> tuple[dict[str, Rows], dict[str, Rows]]:
    """Columns of the peer and of ours, a part of the problems each in turn."""
    step = given.step if CASES[case][2] else 1
    theirs, ours = [], []
    for turn in range(TURNS):
        chosen = list(range(turn * step, len(spaces), step * TURNS))
        theirs.append(run_case(program, file, case, chosen, given))
        ours.append(plan_ours(spaces, chosen, given.repeat))
    return tuple(
        {key: np.concatenate([one[key] for one in part]) for key in part[0]} for part in (theirs, ours)
    )


def plan_ours(spaces: list[Any], chosen: list[int], repeat: int) -> dict[str, Rows]:
    """Times [µs] of the search at samples and of whole plans, lengths, and whether there is a path."""
    planners = {"search": RRTConnect(simplify=False, certify=False, search="sampled"), "total": RRTConnect()}
    found: dict[str, list[float]] = {
        key: [] for key in ("search_us", "total_us", "raw_cost", "cost", "solved")
    }
    for k in chosen:
        for key, planner in planners.items():
            spent = []
            for _ in range(repeat):
                begin = time.thread_time_ns()
                plan = planner.plan(*spaces[k])
                spent.append((time.thread_time_ns() - begin) / 1000.0)
            found[f"{key}_us"].append(float(np.median(spent)))
            found["raw_cost" if key == "search" else "cost"].append(plan.cost)
        found["solved"].append(float(bool(plan)))
    return {key: np.array(values) for key, values in found.items()}


def measure_callback() -> float | None:
    """Microseconds of a check in Python that reads the configuration, called by OMPL."""
    try:
        from ompl import base
    except ImportError:
        return None
    space, bounds, count = base.RealVectorStateSpace(7), base.RealVectorBounds(7), 0
    bounds.setLow(-3.0)
    bounds.setHigh(3.0)
    space.setBounds(bounds)
    information = base.SpaceInformation(space)

    def check(state: Any) -> bool:
        nonlocal count
        count += len([state[i] for i in range(7)])
        return True

    information.setStateValidityChecker(check)
    information.setStateValidityCheckingResolution(SAME / space.getMaximumExtent())
    information.setup()
    a, b = space.allocState(), space.allocState()
    for i in range(7):
        a[i], b[i] = -1.0, 1.0
    begin = time.thread_time_ns()
    for _ in range(1000):
        information.checkMotion(a, b)
    return (time.thread_time_ns() - begin) / 1000.0 / (count / 7)


def compare(theirs: dict[str, Rows], ours: dict[str, Rows]) -> dict[str, Any]:
    """Medians over the problems that both solved."""
    both = (theirs["solved"] > 0) & (ours["solved"] > 0)
    result: dict[str, Any] = {
        "problems": len(both),
        "valid": int(theirs["valid"].sum()),
        "solved": int(theirs["solved"].sum()),
        "both": int(both.sum()),
        "checks": float(np.median(theirs["checks"][both])),
    }
    for key in ("search_us", "total_us", "raw_cost", "cost"):
        a, b = float(np.median(theirs[key][both])), float(np.median(ours[key][both]))
        result[key] = {"peer": a, "ours": b, "ratio": a / b}
        result[key] |= {
            "peer_mean": float(theirs[key][both].mean()),
            "ours_mean": float(ours[key][both].mean()),
        }
    return result


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--prefix", type=Path, default=Path("/usr"))
    parser.add_argument("--repeat", type=int, default=3)
    parser.add_argument("--step", type=int, default=2)
    parser.add_argument("--seconds", type=float, default=5.0)
    parser.add_argument("--cases", nargs="+", default=list(CASES))
    given = parser.parse_args()
    data = Path(os.environ.setdefault("CSPACE_DATA", str(HERE.parents[1] / "shared" / "data")))
    file = HERE / "results/planning_peers.json"
    results: dict[str, Any] = json.loads(file.read_text()) if file.is_file() else {}
    results |= {"version": cs.__version__, "isa": cs._core.isa, "seconds": given.seconds}
    results["callback_us"] = measure_callback()
    judge = Judge("panda", data / "planning")
    robot, _ = published_robot("panda")
    spaces = [(ArmSpace(robot, scene), start, goals) for _, _, scene, start, goals in problems("panda")]
    folder = Path(tempfile.mkdtemp())
    try:
        program = build_program(given.prefix, folder)
        write_problems(judge, meshed_robot(robot, 0.02), folder / "panda.txt")
        for case in given.cases:
            found = compare(*run_in_turn(program, folder / "panda.txt", case, spaces, given))
            print(case, json.dumps(found), flush=True)
            results.setdefault("cases", {})[case] = found
            file.write_text(json.dumps(results, indent=1) + "\n")
    finally:
        shutil.rmtree(folder)


if __name__ == "__main__":
    main()
