"""Explanations: every arm has one, and its equations hold on the arm, for no other configuration."""

from __future__ import annotations

import itertools
import json

import numpy as np
import pytest

import cspace as cs
from cspace import _core
from cspace.ik import ik_plan
from cspace.model import from_screws
from cspace.robot import Robot
from ik import geometries
from ik.arms import load
from ik.geometries import unit

NAMES = cs.robots.names()
FORMS = ("to_text", "to_markdown", "to_latex")


def configurations(robot, rng, n=6):
    return rng.uniform(-1.5, 1.5, (n, robot.dof))


def expect_true(robot, rng):
    """The plan of an arm, after its equations were found to hold, and not to hold for other joint values."""
    plan = ik_plan(robot)
    assert plan, plan.reason
    q = configurations(robot, rng)
    T = robot.fk(q)
    seen = _core._ik_geometry(robot)
    allowed = 1e-11 + 2 * (seen["deviation"] if seen["family"] >= 0 else 0.0)
    assert plan.residuals(q, T).shape == (6, len(plan.equations))
    assert plan.residuals(q, T).max() < allowed
    for joint in range(robot.dof):
        other = q.copy()
        other[:, joint] += 0.4
        assert (plan.residuals(other, T).max(axis=1) > 1e-4).all(), (
            f"no equation depends on joint {joint + 1}"
        )
    return plan


@pytest.mark.parametrize("name", NAMES)
def test_every_arm_of_the_catalogue_is_explained(name):
    robot = load(name)
    if robot.tip is None:
        pytest.skip("a tree: it has no tip to solve for")
    plan = robot.ik_plan()
    for form in FORMS:
        assert name in getattr(plan, form)().replace("\\_", "_")
    assert json.loads(json.dumps(plan.to_dict()))["robot"] == name
    if not plan:
        assert plan.reason in plan.to_text().replace("\n", " ")
        return
    if len(robot.joint_names) > 6:  # with joints to spare: what the axes share, and no equations
        assert plan.family == "other"
        return
    expect_true(robot, np.random.default_rng(2))
    goals = robot.fk(configurations(robot, np.random.default_rng(3), 20))
    assert max(len(robot.ik(T)) for T in goals) <= plan.branches


@pytest.mark.parametrize("square", [False, True])
@pytest.mark.parametrize("word", geometries.CLASSES)
def test_every_class_of_six_joints(word, square):
    rng = np.random.default_rng([ord(letter) for letter in word])
    robot = geometries.random_arm(geometries.CLASSES[word], rng, square=square)
    plan = expect_true(robot, rng)
    form = _core._ik_plan(robot)["form"]
    order = slice(None, None, -1) if _core._ik_geometry(robot)["reversed"] else slice(None)
    assert [each.parallel for each in plan.relations][order] == form["parallel"]
    assert [each.meet and not each.parallel for each in plan.relations][order] == form["meeting"]
    assert np.prod([step.ways for step in plan.steps]) == plan.branches == 8


@pytest.mark.parametrize("kinds", ["".join(k) for n in (1, 2, 3) for k in itertools.product("RP", repeat=n)])
def test_arms_of_up_to_three_joints(kinds):
    rng = np.random.default_rng([ord(kind) for kind in kinds])
    n = len(kinds)
    axes = np.array([unit(v) for v in rng.normal(size=(n, 3))])
    tip = cs.pose(rng.normal(size=3), rpy=rng.normal(size=3))
    robot = Robot(from_screws(axes, rng.normal(size=(n, 3)), tip, joint_types=kinds))
    plan = expect_true(robot, rng)
    assert plan.family == "short arm"
    for q in configurations(robot, rng, 20):
        assert len(robot.ik(position=robot.fk(q)[:3, 3])) <= plan.branches


WORDS = ["".join(k) for n in (4, 5, 6) for k in itertools.product("RP", repeat=n) if k.count("P") <= 3]


def sliding_arm(kinds, rng, wrist=None):
    """A random arm; wrist: the first of three axes that meet in a point."""
    n = len(kinds)
    axes, points = np.array([unit(v) for v in rng.normal(size=(n, 3))]), rng.uniform(-1, 1, (n, 3))
    if wrist is not None:
        points[wrist : wrist + 3] = points[wrist]
    tip = cs.pose(rng.normal(size=3), rpy=rng.normal(size=3))
    return Robot(from_screws(axes, points, tip, joint_types=kinds, name=f"random {kinds}"))


@pytest.mark.parametrize("kinds", [*[word for word in WORDS if "P" in word][::3], "RRRR", "RRRRR"])
def test_arms_of_four_to_six_joints_that_turn_and_slide(kinds):
    rng = np.random.default_rng([ord(kind) for kind in kinds])
    robot = sliding_arm(kinds, rng)
    plan = expect_true(robot, rng)
    assert plan.branches in (2, 8, 16)
    assert ("Virtual joints" in plan.to_text()) == (len(kinds) < 6)
    for q in configurations(robot, rng, 5):
        assert len(robot.ik(robot.fk(q))) <= plan.branches


@pytest.mark.parametrize("kinds", ["RRPRRR", "PRRRRR", "PPPRRR", "RPPRRR", "RRRRPR", "RRRPRP"])
def test_a_wrist_behind_three_joints_of_any_kind(kinds):
    rng = np.random.default_rng([ord(kind) for kind in kinds])
    robot = sliding_arm(kinds, rng, wrist=3 if kinds.endswith("RRR") else 0)
    plan = expect_true(robot, rng)
    assert plan.family == "wrist behind three joints"
    assert ("read from the tip" in plan.to_text()) == (not kinds.endswith("RRR"))
    for q in configurations(robot, rng, 10):
        assert len(robot.ik(robot.fk(q))) <= plan.branches == 8


@pytest.mark.parametrize("kinds", ["RPRRPR", "PRRPRR", "RRRRPP"])
def test_the_hidden_angle_of_an_arm_with_two_slides_is_a_root_of_degree_four(kinds):
    rng = np.random.default_rng([ord(kind) for kind in kinds])
    robot = sliding_arm(kinds, rng)
    assert "degree 4" in robot.ik_plan().to_text().replace("\n", " ")
    for q in configurations(robot, rng):
        goal = robot.fk(q).ravel().tolist()
        for number, joints, backwards in _core._ik_plan(robot)["loop"]["order"]:
            f = [_core._ik_determinant(robot, goal, number, a) for a in 2 * np.pi * np.arange(32) / 32]
            harmonics = np.abs(np.fft.rfft(f))
            noise = 1e-9 * harmonics.max()
            assert harmonics[5:].max() < noise
            hidden = -q[joints[0]] if backwards else q[joints[0]]
            assert abs(_core._ik_determinant(robot, goal, number, hidden)) < 10 * noise


def test_an_arm_that_is_solved_through_its_neighbours_says_so():
    x, y, z = np.eye(3)
    points = [[0, 0.4, 0.4], [0, 0, 0.4], [0.2, 0.2, 0.4], [0, 0, 0.2], [0.4, 0, 0.2], [0.2, 0, 0.2]]
    tip = cs.pose([0.3, 0.2, 0.5])
    robot = Robot(from_screws([y, z, x, y, x, z], points, tip, joint_types="RPRRRR"))
    plan = expect_true(robot, np.random.default_rng(4))
    assert _core._ik_plan(robot)["loop"]["neighbours"]
    assert "Two neighbours of the arm" in plan.to_text()
    assert "neighbour" not in load("jaco2").ik_plan().to_text()


@pytest.mark.parametrize("name", ["jaco2", "m1013", "calibrated", "random"])
def test_the_hidden_angle_of_a_general_arm_is_a_root_of_degree_eight(name):
    rng = np.random.default_rng(5)
    if name == "random":
        axes = np.array([unit(v) for v in rng.normal(size=(6, 3))])
        robot = Robot(from_screws(axes, rng.uniform(-1, 1, (6, 3)), cs.pose(rng.normal(size=3))))
    elif name == "calibrated":
        c = load("ur5e").chain
        axes = np.array([unit(h + 1e-3 * rng.normal(size=3)) for h in c.axes])
        robot = Robot(from_screws(axes, c.points, c.T_zero))
    else:
        robot = load(name)
    plan = expect_true(robot, rng)
    assert plan.family == "general"
    assert plan.branches == 16
    loop = _core._ik_plan(robot)["loop"]
    assert f"{len(loop['order'])} of the twelve" in plan.to_text().replace("\n", " ")
    around = 2 * np.pi * np.arange(64) / 64
    for q in configurations(robot, rng):
        goal = robot.fk(q).ravel().tolist()
        for number, joints, backwards in loop["order"]:
            f = [_core._ik_determinant(robot, goal, number, a) for a in around]
            harmonics = np.abs(np.fft.rfft(f))
            noise = 1e-8 * harmonics.max()  # formulations next to vanishing ones enlarge rounding
            assert harmonics[9:].max() < noise
            hidden = -q[joints[0]] if backwards else q[joints[0]]
            assert abs(_core._ik_determinant(robot, goal, number, hidden)) < 10 * noise
    with pytest.raises(TypeError, match="general arm"):
        _core._ik_determinant(load("ur5e"), goal, 0, 0.0)


def test_what_nothing_solves_says_why_and_what_it_shares():
    axes, points = np.array([[0, 0, 1.0]] * 2 + [[0, 1.0, 0]] * 4), np.zeros((6, 3))
    points[3:, 0] = [0.3, 0.5, 0.8]
    plan = Robot(from_screws(axes, points, cs.pose([1, 0, 0]))).ik_plan()
    assert not plan
    assert "two of its joints do one's work" in plan.reason
    assert plan.relations[0].words == "on one line"
    assert plan.residuals(np.zeros(6), np.eye(4)).shape == (0,)


def test_the_text_of_a_universal_robot():
    text = load("ur5e").ik_plan().to_text()
    for line in (
        "s1 px − c1 py = 0.1333",
        "u² + v² = 0.334446 + 0.33337 c3",
        "Axes 2, 3 and 4 are parallel to (0, 1,",
        "Together up to 2 × 2 × 2 = 8 solutions.",
    ):
        assert line in text


def test_the_wrist_of_a_puma_stands_where_its_axes_meet():
    robot = load("puma560")
    (shoulder, wrist) = robot.ik_plan().still_points
    assert (shoulder.joints, wrist.joints) == ((1, 2), (4, 5, 6))
    p_tip = np.linalg.inv(robot.chain.T_zero) @ np.append(wrist.place, 1.0)
    q = np.random.default_rng(6).uniform(-3, 3, (20, 6))
    q[:, :3] = 0.0
    np.testing.assert_allclose((robot.fk(q) @ p_tip)[:, :3], np.tile(wrist.place, (20, 1)), atol=1e-12)


@pytest.mark.parametrize("name", ["ur5e", "jaco2", "al5d", "romeo_left_leg", "planar_3r", "panda", "scara"])
def test_latex_and_markdown_are_well_formed(name):
    plan = load(name).ik_plan()
    latex, markdown = plan.to_latex(), plan.to_markdown()
    assert latex.isascii()
    for text in (latex, markdown):
        assert text.count("{") == text.count("}")
    for word in ("align*", "tabular", "bmatrix"):
        assert latex.count(rf"\begin{{{word}}}") == latex.count(rf"\end{{{word}}}")
    assert markdown.count("$$") % 2 == 0
    outside = "".join(latex.split("$")[::2])
    assert "_" not in outside.replace(r"\_", "") or "align*" in outside


def test_what_is_no_robot_is_refused():
    with pytest.raises(TypeError, match="robot"):
        ik_plan("ur5e")
