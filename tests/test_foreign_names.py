"""The names of other libraries that the page for their users translates are answered with ours."""

from __future__ import annotations

import builtins
import re

import numpy as np
import pytest

import cspace as cs
from cspace import errors
from house.tree import ROOT

PAGE = (ROOT / "docs/coming-from.md").read_text(encoding="utf-8")
# Names of frames, of files, of groups of a file, of what Python has and of the value of an option.
NO_NAMES = {"base_link", "tool0", "group_state", "q", "T", "T1", "T2", "LOCAL", "Phase", "No", "Time", "Q"}
# Members of their answers and of their data, which have no owner here.
THEIR_OWNERS = {"data", "plan", "trajectory", "Synchronization", "DurationDiscretization", "models", "T"}
OWN = {"plan", "manipulability"}
MEMBERS = {
    "points",
    "UR5",
    "update",
    "calculate",
    "data",
    "RPY",
    "homogeneous",
}  # of what has another name here


def foreign_words():
    """Every name in the first column of the tables: of a function, a class, a member of a robot."""
    words = []
    for first in re.findall(r"^\| (.*?) \| ", PAGE, re.M):
        for span in re.findall(r"`([^`]+)`", first):
            code = re.sub(r"\.(yaml|py)$|^model = |^data = | = .*", "", span)
            if re.fullmatch(r"evo_\w+ .*", code):
                code = code.partition(" ")[0]
            for owner, name in re.findall(r"(?:\b(\w+)\.)?\b([A-Za-z_]\w*)(?=\(|$|\s\*|\.)", code):
                if name not in NO_NAMES and owner not in THEIR_OWNERS:
                    words.append((owner, name))
    return sorted(set(words))


ROBOTS = {"robot", "model", "bot", "state"}


@pytest.mark.parametrize(("owner", "name"), foreign_words())
def test_each_foreign_name_of_the_page_is_answered(owner, name):
    if name in OWN | MEMBERS or name in {
        "robot",
        "model",
        "bot",
        "state",
        "rtb",
        "pin",
        "gtsam",
        "kinematics",
    }:
        return
    if owner == "solution":
        asked = cs.load_robot("ur5e").ik(np.eye(4))
    else:
        asked = cs.load_robot("ur5e") if owner in ROBOTS else cs
    if hasattr(asked, name) or name == "tool":  # ours has the name too, or it is assigned there
        return
    with pytest.raises(AttributeError, match=rf"has no attribute {name!r}: use "):
        getattr(asked, name)


def test_the_page_has_many_foreign_names():
    assert len(foreign_words()) > 60


@pytest.mark.parametrize(("name", "ours"), errors.FOREIGN_NAMES.items())
def test_what_stands_for_a_foreign_name_exists(name, ours):
    robot = cs.load_robot("ur5e")
    for owner, member in re.findall(r"\b(robot|cs)\.(\w+)", ours):
        assert hasattr({"robot": robot, "cs": cs}[owner], member), ours
    for room, member in re.findall(r"cs\.([a-z_]+)\.(\w+)", ours):
        assert hasattr(getattr(cs, room), member), ours
    assert not hasattr(builtins, name)
    if not hasattr(robot, name):
        with pytest.raises(AttributeError, match=re.escape(f"no attribute {name!r}: use ")):
            getattr(robot, name)
    if not hasattr(cs, name):
        with pytest.raises(AttributeError, match=re.escape(f"no attribute {name!r}: use {ours}")):
            getattr(cs, name)


@pytest.mark.parametrize("name", ["q0", *errors.FOREIGN_KEYWORDS["ik"]])
def test_foreign_keywords_of_ik_are_answered(name):
    robot = cs.load_robot("ur5e")
    for robot_or_solver in (robot.ik, robot.solver.solve):
        with pytest.raises(errors.InputTypeError, match=rf"^unknown keyword {name!r}: use "):
            robot_or_solver(np.eye(4), **{name: 1.0})


PLANNERS = {
    **{"RRT*": "rrt_star", "RRT": "rrt", "jps": "jump_point_search", "JPS": "jump_point_search"},
    **{
        "bfs": "wavefront",
        "ucs": "dijkstra",
        "PRM*": "prm",
        "Dijkstra": "dijkstra",
        "ThetaStar": "theta_star",
    },
}
ARM_PLANNERS = {
    **{"RRT*": "rrt_star", "PRM*": "prm_star", "LazyPRM": "lazy_prm", "RRTConnect": "rrt_connect"},
    **{"InformedRRT*": "informed_rrt_star", "RRT": "rrt", "PRM": "prm", "PRMstar": "prm_star"},
}


@pytest.mark.parametrize(("theirs", "ours"), PLANNERS.items())
def test_foreign_planners_of_the_plane_are_answered(theirs, ours):
    with pytest.raises(errors.UnknownNameError, match=re.escape(f"{theirs!r}; did you mean {ours!r}")):
        cs.navigate(cs.PolygonWorld([], (0, 0, 4, 4)), (1, 1), (3, 3), planner=theirs)


@pytest.mark.parametrize(("theirs", "ours"), ARM_PLANNERS.items())
def test_foreign_planners_of_arms_are_answered(theirs, ours):
    with pytest.raises(errors.UnknownNameError, match=re.escape(f"{theirs!r}; did you mean {ours!r}")):
        cs.plan(cs.load_robot("ur5e"), np.zeros(6), np.ones(6), planner=theirs)
