"""A name of other libraries, or of yesterday, gets an error that says ours."""

from __future__ import annotations

import re

import numpy as np
import pytest

import cspace as cs
from cspace import errors
from house.tree import ROOT


def test_an_old_keyword_names_the_new_one():
    robot = cs.load_robot("panda")
    with pytest.raises(errors.InputTypeError, match=r"^unknown keyword 'fixed': use locked=$"):
        robot.ik(np.eye(4), fixed={"panda_joint7": 0.3})
    with pytest.raises(TypeError, match=r"^ik\(\) got an unexpected keyword argument 'fixd'"):
        robot.ik(np.eye(4), fixd=0)


@pytest.mark.parametrize(
    ("method", "old", "new"),
    [
        ("ik_plan", "asked", "goal_parts"),
        ("ik_plan", "fixed", "locked"),
        ("export", "fixed", "locked"),
        ("redundancy", "fixed", "locked"),
    ],
)
def test_methods_in_python_name_the_new_keyword_too(method, old, new):
    robot = cs.load_robot("panda")
    function = getattr(cs.export if method == "export" else cs.ik, method)
    for call in (getattr(robot, method), lambda **given: function(robot, **given)):
        with pytest.raises(errors.InputTypeError, match=f"^unknown keyword '{old}': use {new}=$"):
            call(**{old: {"panda_joint7": 0.3}})
    if method != "redundancy":
        with pytest.raises(TypeError, match="unexpected keyword argument 'fixd'"):
            getattr(robot, method)(fixd=0)


@pytest.mark.parametrize("old", ["held", "hold"])
def test_locked_joints_had_other_keywords(old):
    robot = cs.load_robot("panda")
    for call in (lambda **given: robot.ik(np.eye(4), **given), robot.redundancy, robot.ik_plan):
        with pytest.raises(errors.InputTypeError, match=f"^unknown keyword '{old}': use locked=$"):
            call(**{old: {"panda_joint7": 0.3}})


@pytest.mark.parametrize(
    ("room", "old", "new"),
    [
        (cs.ik, "StillPoint", "InvariantPoint"),
        (cs.ik, "StillDirection", "InvariantDirection"),
        (cs.ik, "Family", "SelfMotion"),
        (cs.navigation, "Price", "Stats"),
    ],
)
def test_an_old_name_of_a_room_names_the_new_one(room, old, new):
    getattr(room, new)
    with pytest.raises(
        AttributeError, match=f"^module '{room.__name__}' has no attribute '{old}': use {new}$"
    ):
        getattr(room, old)
    with pytest.raises(AttributeError, match=r" has no attribute 'colour'$"):
        _ = room.colour


def answers():
    robot = cs.load_robot("ur5e")
    q = np.full(6, 0.3)
    found, batch = robot.ik(robot.fk(q)), robot.ik(robot.fk(np.stack([q, q])))
    route = cs.navigate(cs.PolygonWorld([], (0, 0, 4, 4)), (1, 1), (3, 3))
    track = robot.track(robot.fk(np.linspace(q, q + 0.1, 4)), start=q)
    planner = cs.navigation.PLANNERS["a_star"]
    panda, grid = cs.load_robot("panda"), cs.OccupancyGrid(np.zeros((40, 40), dtype=bool), 1.0)
    redundancy = panda.redundancy(panda.fk(np.full(7, 0.3)))
    car = cs.navigation.Car()
    car_route = cs.navigation.hybrid_a_star(grid, (5, 20, 0), (30, 20, 0), vehicle=car)
    return [
        *((found, old, new) for old, new in (("families", "self_motions"), ("missing", "out_of_reach"))),
        (found, "asked", "goal_parts"),
        (batch, "missing", "out_of_reach"),
        (route, "price", "stats"),
        (track, "why", "cause"),
        (track[0], "why", "cause"),
        (planner, "line", "summary"),
        (planner, "sees", "sensing"),
        (redundancy, "robot", "solver"),
        (car_route, "price", "stats"),
        *((panda.export("cpp"), old, "locked") for old in ("held", "fixed")),
        (panda.ik_plan(), "held", "locked"),
        (panda.ik_plan(), "still_points", "invariant_points"),
        (panda.ik_plan(), "still_directions", "invariant_directions"),
    ]


def test_an_old_attribute_names_the_new_one():
    for owner, old, new in answers():
        getattr(owner, new)
        with pytest.raises(AttributeError, match=f"no attribute '{old}': use {new}$"):
            getattr(owner, old)
        with pytest.raises(AttributeError, match=r"no attribute 'colour'$"):
            _ = owner.colour
        assert not hasattr(owner, "colour")


@pytest.mark.parametrize(
    ("theirs", "ours"),
    [
        *(("fkine", "fk"), ("ikine_LM", "ik"), ("jacob0", "jacobian"), ("qlim", "limits"), ("n", "dof")),
        *(("names", "joint_names"), ("qr", "named_poses"), ("setFromIK", "ik"), ("getJacobian", "jacobian")),
        *(
            ("getGlobalLinkTransform", "fk"),
            ("computeCartesianPath", "track"),
            ("fwdKin", "fk"),
            ("IK", "ik"),
        ),
    ],
)
def test_an_attribute_of_another_library_names_ours(theirs, ours):
    robot = cs.load_robot("ur5e")
    getattr(robot, ours)
    with pytest.raises(AttributeError, match=f"'Robot' object has no attribute '{theirs}': use {ours}$"):
        getattr(robot, theirs)


OTHER_WAYS = {"tool", "createData"}  # one is assigned there, the other has no counterpart


def test_members_that_the_page_for_users_of_other_libraries_translates_name_ours():
    page = (ROOT / "docs/coming-from.md").read_text(encoding="utf-8")
    robot, rows = cs.load_robot("ur5e"), re.findall(r"^\| (`.*?) \| (.*) \|$", page, re.M)
    solutions, found = robot.ik(robot.fk(np.zeros(6))), 0
    for theirs, ours in rows:
        for owner, name in re.findall(r"\b(robot|state|bot|model|solution)\.([A-Za-z_]\w*)", theirs):
            ours_owner = solutions if owner == "solution" else robot
            if name in OTHER_WAYS or hasattr(ours_owner, name):
                continue
            with pytest.raises(AttributeError, match=": use ") as caught:
                getattr(ours_owner, name)
            assert str(caught.value).rpartition(": use ")[2] in ours
            found += 1
    assert found >= 15


def test_a_keyword_of_another_library_names_ours():
    robot = cs.load_robot("ur5e")
    with pytest.raises(errors.InputTypeError, match=r"^unknown keyword 'q0': use near=$"):
        robot.ik(np.eye(4), q0=np.zeros(6))
    for call in (robot.random_configuration, cs.random_pose, cs.random_rotation):
        with pytest.raises(errors.InputTypeError, match=r"^unknown keyword 'seed': use near= or rng=$"):
            call(seed=7)
        assert np.array_equal(call(rng=7), call(rng=7))


def test_a_choice_of_another_library_names_ours():
    world, robot = cs.PolygonWorld([], (0, 0, 4, 4)), cs.load_robot("ur5e")
    for theirs, ours in (
        ("astar", "a_star"),
        ("A*", "a_star"),
        ("D*", "d_star_lite"),
        ("Theta*", "theta_star"),
    ):
        with pytest.raises(errors.UnknownNameError, match=re.escape(f"{theirs!r}; did you mean {ours!r}?")):
            cs.navigate(world, (1, 1), (3, 3), planner=theirs)
    for theirs, ours in (("local", "tip"), ("world", "base")):
        with pytest.raises(errors.UnknownNameError, match=f"{theirs!r}; did you mean {ours!r}"):
            robot.jacobian(np.zeros(6), expressed_in=theirs)


def test_names_say_each_what_is_meant():
    assert not set(errors.RENAMED) & set(errors.RENAMED.values())


def test_a_function_of_a_room_that_became_a_method_is_named():
    with pytest.raises(AttributeError, match=r"'inverse_kinematics': use robot\.ik\(T\)$"):
        _ = cs.ik.inverse_kinematics
