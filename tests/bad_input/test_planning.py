"""Bad options, files, goals and robots of planners: a right answer, or an error that names the cause."""

from __future__ import annotations

import json
import time

import numpy as np
import pytest

import cspace as cs
from cspace.collision import MeshJudge
from cspace.errors import CspaceError, InputError, InputTypeError, RoadmapError
from cspace.planning import PLANNERS, ArmSpace, JointSpace, Roadmap
from cspace.planning.roadmap_files import TITLE, digest_of
from cspace.search.options import options_of

LINK = (
    '<link name="l{k}"><collision><origin xyz="0.15 0 0"/><geometry>{shape}</geometry></collision></link>'
    '<joint name="j{k}" type="revolute"><parent link="{parent}"/><child link="l{k}"/><origin xyz="0.3 0 0"/>'
    '<axis xyz="0 {y} {z}"/><limit lower="-3" upper="3" effort="1" velocity="1"/></joint>'
)
ROBOT = cs.Robot.from_urdf(
    '<robot name="two"><link name="base"/>'
    + LINK.format(k=0, parent="base", y=0, z=1, shape='<cylinder radius="0.03" length="0.1"/>')
    + LINK.format(k=1, parent="l0", y=1, z=0, shape='<box size="0.25 0.05 0.05"/>')
    + "</robot>"
)
SCENE = cs.Scene([cs.Box([0.1, 0.1, 0.3], [0.45, 0.25, 0.1])])
START, GOAL = [-0.5, 0.3], [0.3, -0.3]
ODD = (np.nan, np.inf, -np.inf, -1, 0, True, "x", [1, 2], 5e-324, 1e-300, 1e300, 2**70, 1j, b"x")
TIME = 0.05
STATUSES = {"found", "undetermined", "local_minimum", "unreachable"}


def values_at_bounds(option):
    """Odd values of an option, its bounds and their neighbours, without bounds that ask for much work."""
    bounds = [x for x in (option.minimum, option.maximum, option.above) if np.isfinite(x)]
    near = [np.nextafter(x, side) for x in bounds for side in (-np.inf, np.inf)]
    values = [*ODD, *bounds, *near, *map(int, bounds)]
    slow = {"samples": 1000, "time_limit": TIME}
    most = slow.get(option.name, np.inf)
    return [x for x in values if not (isinstance(x, (int, float)) and x > most)]


def plan_or_error(name, options):
    """The status of a plan, or the text of an error of cspace."""
    try:
        return cs.plan(ROBOT, START, GOAL, SCENE, planner=name, **options).status
    except CspaceError as error:
        return str(error)


@pytest.mark.parametrize("name", PLANNERS)
def test_options_at_their_bounds_plan_or_are_refused_by_name(name):
    few = {"samples": 100} if "samples" in options_of(type(PLANNERS[name])) else {}
    for option in options_of(type(PLANNERS[name])).values():
        for value in values_at_bounds(option):
            options = {"time_limit": TIME, **few, option.name: value}
            outcome = plan_or_error(name, options)
            words = (option.name, option.subject or option.name, "no such file")
            assert outcome in STATUSES or any(word in outcome for word in words), (words, value, outcome)


ODD_ENDS = (
    None,
    [],
    np.empty((0, 2)),
    [np.nan, 0.0],
    [0.0] * 3,
    [9.0, 0.0],
    "x",
    {"nonsense": 1},
    [[[0.0, 0.0]]],
)


@pytest.mark.parametrize("name", PLANNERS)
@pytest.mark.parametrize("end", ODD_ENDS, ids=repr)
def test_odd_starts_and_goals_are_refused(name, end):
    options = {"planner": name, "time_limit": TIME} | ({"samples": 100} if "pr" in name else {})
    for ends in ((end, GOAL), (START, end)):
        with pytest.raises(CspaceError):
            cs.plan(ROBOT, *ends, SCENE, **options)


@pytest.mark.parametrize("name", PLANNERS)
def test_no_problems_have_no_plans(name):
    options = {"planner": name} | ({"samples": 100} if "pr" in name else {})
    assert len(cs.plan_many(ROBOT, START, [], SCENE, **options)) == 0


@pytest.mark.parametrize("robot", [None, "ur5e", 5])
@pytest.mark.parametrize("use", [Roadmap, ArmSpace, JointSpace, MeshJudge, lambda r: Roadmap.load("x", r)])
def test_what_is_no_robot_is_refused(robot, use):
    if use is MeshJudge:
        pytest.importorskip("coal")
    with pytest.raises(InputTypeError, match="it must be a Robot"):
        use(robot)


def forge(path, header=None, nodes=None, edges=None):
    """A roadmap file whose numbers are replaced and whose checksum is right."""
    line, _, payload = path.read_bytes()[len(TITLE) :].partition(b"\n")
    whole = json.loads(line)
    split = 8 * whole["nodes"]
    nodes = payload[:split] if nodes is None else np.asarray(nodes, "<f4").tobytes()
    edges = payload[split:] if edges is None else np.asarray(edges, "<i4").tobytes()
    whole |= {"nodes": len(nodes) // 8, "edges": len(edges) // 8} | (header or {})
    whole["sha256"] = digest_of(whole, nodes + edges)
    path.write_bytes(TITLE + json.dumps(whole).encode() + b"\n" + nodes + edges)


MAP = Roadmap(ROBOT, samples=60)
FORGED = {
    "edge to no node": {"edges": [[len(MAP), 0]]},
    "negative node": {"edges": [[1, -1]]},
    "loop": {"edges": [[1, 1]]},
    "order": {"edges": [[0, 1]]},
    "twice": {"edges": [[1, 0], [1, 0]]},
    "NaN": {"nodes": np.full((len(MAP), 2), np.nan)},
    "far": {"nodes": np.full((len(MAP), 2), 1e30)},
    "few samples": {"header": {"samples": 0}},
    **{f"samples {n}": {"header": {"samples": n}} for n in (2**62, 2**70)},
    **{f"neighbours {n}": {"header": {"neighbours": n}} for n in (1001, 2**31, 2**70)},
    **{f"seed {n}": {"header": {"seed": n}} for n in (2**64, 2**70)},
    **{f"margin {x}": {"header": {"margin": x}} for x in (1e300, float("nan"), float("inf"))},
}


@pytest.mark.parametrize("kind", FORGED)
def test_roadmaps_with_wrong_numbers_are_refused(kind, tmp_path):
    path = tmp_path / "map"
    MAP.save(path)
    forge(path)
    assert len(Roadmap.load(path, ROBOT)) == len(MAP)
    forge(path, **FORGED[kind])
    with pytest.raises(RoadmapError, match=r"map: .*save the roadmap again"):
        Roadmap.load(path, ROBOT)


def test_steps_of_a_judge_that_need_too_many_samples_are_refused():
    pytest.importorskip("coal")
    judge = MeshJudge(ROBOT, SCENE)
    began = time.perf_counter()
    for step in (5e-324, 1e-300, 1e-12, 1e-8):
        with pytest.raises(InputError, match="samples"):
            judge.judge_path([START, GOAL], step=step)
    with pytest.raises(InputError, match="samples"):
        judge.judge_path([START, [1e12, 0.0]])
    with pytest.raises(InputError, match="at least one corner"):
        judge.judge_path(np.empty((0, 2)))
    assert time.perf_counter() - began < 5.0
    with pytest.raises(InputTypeError, match="scene is an int"):
        MeshJudge(ROBOT, 5)


@pytest.mark.parametrize("check", ["collides", "contact", "clearance", "escape"])
def test_checks_refuse_what_is_no_robot(check):
    with pytest.raises(InputTypeError, match="robot is a NoneType"):
        getattr(cs.collision, check)(None, [0.0])
    with pytest.raises(InputTypeError, match="robot is a str"):
        cs.collision.edge("ur5e", [0.0], [1.0])
