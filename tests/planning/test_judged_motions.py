"""Proved edges and paths of arms among thin obstacles, judged by a program of its own.

The judge is benchmarks/motion_judge.py, which shares no code with the package: its own kinematics from the
files of the catalogue, exact distances of capsules from boxes, cylinders and capsules, and samples at a
hundred times the resolution of planners.
"""

import shutil
from pathlib import Path

import numpy as np
import pytest

import cspace as cs

BENCHMARKS = Path(__file__).resolve().parents[2] / "benchmarks"
ARMS = ("ur5e", "iiwa14", "fr3", "gen3", "xarm7")
ROUNDING = 1e-5
"""Clearances [m] within which single and double precision may disagree on a configuration."""

pytestmark = pytest.mark.skipif(shutil.which("c++") is None, reason="the judge needs a C++ compiler")


@pytest.fixture
def unseen(monkeypatch):
    monkeypatch.syspath_prepend(str(BENCHMARKS))
    import planning_unseen

    return planning_unseen


@pytest.mark.parametrize("name", ARMS)
def test_proved_edges_touch_nothing(unseen, name):
    found = unseen.judge_edges(name, 3, 8)
    assert all(each["touch"] == 0 for each in found.values())
    assert found["pressed"]["judged"] >= 8
    assert found["pressed"]["least"] < 1e-3


@pytest.mark.parametrize("name", ARMS)
def test_paths_touch_nothing_and_verdicts_are_those_of_the_judge(unseen, name):
    robot = cs.load_robot(name)
    judge = unseen.read_arm(robot, name)
    for objects, scene, start, goal in unseen.random_problems(robot, unseen.ARMS[name], 4, thin=True):
        judge.set_scene(objects)
        q = robot.random_configuration(40, rng=3)
        gap = judge.clearance(q)
        assert not ((robot.collides(q, scene) != (gap < 0.0)) & (np.abs(gap) > ROUNDING)).any()
        for planner in ("rrt_connect", "aorrtc"):
            options = {"improve": 200} if planner == "aorrtc" else {}
            plan = cs.plan(robot, start, goal, scene, planner=planner, edges=5000, **options)
            if plan:
                assert judge.look(plan.path[:-1], plan.path[1:])[0].min(initial=np.inf) >= 0.0


def test_the_judge_sees_a_contact_between_coarse_samples(unseen):
    joints = [
        {"name": "turn", "type": "revolute", "parent": "base", "child": "arm", "axis": [0, 0, 1]},
        {"name": "slide", "type": "prismatic", "parent": "arm", "child": "tip", "axis": [1, 0, 0]}
        | {"lower": 0.0, "upper": 1.0},
    ]
    body = ("tip", np.array([0.9, 0.0, 0.0]), np.array([1.0, 0.0, 0.0]), 0.01)
    judge = unseen.MotionJudge(joints, ["turn", "slide"], [body], [])
    wall = {"type": "box", "position": [1.0, 0.0, 0.0], "size": [0.1, 1e-4, 0.1]}
    judge.set_scene([wall])
    a, b = np.array([[-0.5, 0.0]]), np.array([[0.5, 0.0]])
    least, at, _ = judge.look(a, b)
    assert least[0] == pytest.approx(-0.01, abs=1e-4)
    assert at[0] == pytest.approx(0.5, abs=1e-3)
    far = judge.look(a, np.array([[-0.1, 0.3]]))[0][0]
    samples = np.linspace(0.0, 1.0, 2001)[:, None] * np.array([0.4, 0.3]) + a
    assert 0.0 < judge.clearance(samples).min() <= far
