"""Explanations: every arm has one, and its equations hold on the arm, for no other configuration."""

from __future__ import annotations

import itertools
import json

import numpy as np
import pytest

import cspace as cs
from cspace import _core
from cspace.errors import InputError, UnknownNameError
from cspace.ik import ik_plan
from cspace.ik.explain.general import Loop
from cspace.ik.explain.locked_joints import Split
from cspace.ik.explain.make_plan import goal_of_parts
from cspace.model import from_screws
from cspace.robot import Robot
from ik import geometries
from ik.arms import load
from ik.geometries import unit

NAMES = cs.robots.names()
FORMS = ("to_text", "to_markdown", "to_latex")


def loop_of(robot):
    kind, plan = _core._ik_numbers(robot.solver)
    assert kind == "general"
    return Loop.of(plan)


def configurations(robot, rng, n=6):
    return rng.uniform(-1.5, 1.5, (n, robot.dof))


def expect_true(robot, rng, locked_at=None, **question):
    """The plan of an arm, after its equations were found to hold, and not to hold for other joint values.

    held: values of locked joints, by number. question: what ik_plan is asked.
    """
    plan = ik_plan(robot, **question)
    assert plan, plan.reason
    q = configurations(robot, rng)
    for joint, value in (locked_at or {}).items():
        q[:, joint] = value
    T = robot.fk(q)
    seen = _core._ik_geometry(solved_by_steps(robot, plan, locked_at, question))
    reach = max(1.0, np.abs(T[:, :3, 3]).max() / seen["length"])  # a square of it is off by 2 reach deviation
    allowed = 1e-11 + 2 * reach * (seen["deviation"] if seen["family"] >= 0 else 0.0)
    assert plan.residuals(q, T).shape == (6, len(plan.equations))
    assert plan.residuals(q, T).max() < allowed
    for joint in range(robot.dof):
        other = q.copy()
        other[:, joint] += 0.4
        assert (plan.residuals(other, T).max(axis=1) > 1e-4).all(), (
            f"no equation depends on joint {joint + 1}"
        )
    return plan


def solved_by_steps(robot, plan, locked_at, question):
    """The arm that the steps of a plan belong to: without locked joints, with those of the goal."""
    solver = robot.solver
    if "goal_parts" in question:
        solver = solver.extend(goal_of_parts(question["goal_parts"], question.get("tool_axis", "z")))
    if not plan.locked:
        return solver
    joints = tuple(solver.joint_names.index(name) for name in plan.locked)
    return Split(solver, joints, {k: (locked_at or {}).get(k, 0.0) for k in joints}).others()


@pytest.mark.slow
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
    expect_true(robot, np.random.default_rng(2))
    q = configurations(robot, np.random.default_rng(3), 20)
    goals = robot.fk(q)
    if len(robot.joint_names) > 6:
        at = [{name: row[robot.joint_names.index(name)] for name in plan.locked} for row in q]
        found = [robot.ik(T, locked=values) for T, values in zip(goals, at, strict=True)]
        assert plan.locked == robot.ik(goals[0]).freedom
    else:
        found = [robot.ik(T) for T in goals]
    assert max(map(len, found)) <= plan.branches


@pytest.mark.parametrize("square", [False, True])
@pytest.mark.parametrize("word", geometries.CLASSES)
def test_every_class_of_six_joints(word, square):
    rng = np.random.default_rng([ord(letter) for letter in word])
    robot = geometries.random_arm(geometries.CLASSES[word], rng, square=square)
    plan = expect_true(robot, rng)
    form = _core._ik_numbers(robot.solver)[1]["form"]
    order = slice(None, None, -1) if _core._ik_geometry(robot.solver)["reversed"] else slice(None)
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
    assert plan.family == "fewer than six joints"
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
        for number, joints, backwards in loop_of(robot).order:
            f = [_core._ik_determinant(robot.solver, goal, number, a) for a in 2 * np.pi * np.arange(32) / 32]
            harmonics = np.abs(np.fft.rfft(f))
            noise = 1e-9 * harmonics.max()
            assert harmonics[5:].max() < noise
            hidden = -q[joints[0]] if backwards else q[joints[0]]
            assert abs(_core._ik_determinant(robot.solver, goal, number, hidden)) < 10 * noise


def test_an_arm_that_is_solved_through_its_neighbours_says_so():
    x, y, z = np.eye(3)
    points = [[0, 0.4, 0.4], [0, 0, 0.4], [0.2, 0.2, 0.4], [0, 0, 0.2], [0.4, 0, 0.2], [0.2, 0, 0.2]]
    tip = cs.pose([0.3, 0.2, 0.5])
    robot = Robot(from_screws([y, z, x, y, x, z], points, tip, joint_types="RPRRRR"))
    plan = expect_true(robot, np.random.default_rng(4))
    assert loop_of(robot).perturbed_arms
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
    loop = loop_of(robot)
    assert f"{len(loop.order)} of the twelve" in plan.to_text().replace("\n", " ")
    around = 2 * np.pi * np.arange(64) / 64
    for q in configurations(robot, rng):
        goal = robot.fk(q).ravel().tolist()
        for number, joints, backwards in loop.order:
            f = [_core._ik_determinant(robot.solver, goal, number, a) for a in around]
            harmonics = np.abs(np.fft.rfft(f))
            noise = 1e-8 * harmonics.max()  # formulations next to vanishing ones enlarge rounding
            assert harmonics[9:].max() < noise
            hidden = -q[joints[0]] if backwards else q[joints[0]]
            assert abs(_core._ik_determinant(robot.solver, goal, number, hidden)) < 10 * noise
    with pytest.raises(TypeError, match="general arm"):
        _core._ik_determinant(load("ur5e").solver, goal, 0, 0.0)


def test_an_arm_with_joints_to_spare_says_which_are_held_and_what_its_axes_share():
    axes, points = np.array([[0, 0, 1.0]] * 2 + [[0, 1.0, 0]] * 4), np.zeros((6, 3))
    points[3:, 0] = [0.3, 0.5, 0.8]
    robot = Robot(from_screws(axes, points, cs.pose([1, 0, 0])))
    plan = robot.ik_plan()
    assert plan
    assert plan.locked == ("joint_1", "joint_6")
    assert "2 more than the tip has ways to move" in plan.to_text()
    assert plan.relations[0].words == "on one line"
    q = np.linspace(0.2, 0.8, 6)
    assert np.abs(plan.residuals(q, robot.fk(q))).max() < 1e-12


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
    (shoulder, wrist) = robot.ik_plan().invariant_points
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


@pytest.mark.parametrize("name", ["iiwa14", "lwr4", "openarm_left", "xmatepro7"])
def test_two_spherical_joints_are_explained_by_the_swivel_too(name):
    robot = load(name)
    plan = expect_true(robot, np.random.default_rng(11))
    (steps,) = plan.other_ways.values()
    assert np.prod([step.ways for step in steps]) == 8
    assert {f"$t_{i}$" for i in range(1, 8)} < {step.finds for step in steps}
    own = len(plan.equations) - sum(len(step.equations) for step in steps)
    q = configurations(robot, np.random.default_rng(12), 3)
    for row in q:  # one swivel, eight configurations: they share K up to the elbow, and all of them fit
        found = robot.ik(robot.fk(row), swivel=cs.ik.swivel(robot, row))
        assert plan.residuals(found.q, np.broadcast_to(found.goal, (len(found), 4, 4)))[:, own:].max() < 1e-9
    assert not load("panda").ik_plan().other_ways


@pytest.mark.parametrize("joint", range(7))
def test_any_joint_may_be_held_and_the_others_are_explained_at_its_value(joint):
    robot = load("panda")
    plan = expect_true(robot, np.random.default_rng(joint), locked_at={joint: 0.4}, locked={joint: 0.4})
    assert plan.locked == (f"panda_joint{joint + 1}",)
    assert ("numbers below are for" in plan.to_text()) == (0 < joint < 6)
    q = configurations(robot, np.random.default_rng(20 + joint))
    q[:, joint] = 0.4
    assert max(len(robot.ik(T, locked={joint: 0.4})) for T in robot.fk(q)) <= plan.branches


def test_six_joints_with_one_held_are_an_arm_of_five():
    plan = expect_true(
        load("ur5e"), np.random.default_rng(8), locked_at={2: 1.1}, locked={"elbow_joint": 1.1}
    )
    assert plan.family == "locked"
    assert "Joints 1 to 5 of the steps are those that move" in plan.to_text()


@pytest.mark.parametrize(
    ("name", "goal_parts"),
    [
        ("ur5e", "position"),
        ("ur5e", ("position", "direction")),
        ("ur5e", "rotation"),
        ("planar_3r", "rotation"),
        ("scara", {"position": (0.1, None, None)}),
        ("al5d", ("position", "direction")),
        ("al5d", {"position": (0.2, 0.1, 0.3), "angle_to": ("z", 0.7)}),
        ("simplified_puma", "look_at"),
        ("panda", "ray"),
        ("puma560", "direction"),
    ],
)
def test_goals_that_ask_for_less_are_explained_by_the_arm_that_they_make(name, goal_parts):
    robot = load(name)
    plan = ik_plan(robot, goal_parts=goal_parts)
    if not plan:
        assert "two of its joints do one's work" in plan.reason
        return
    if "numbers below are for" not in plan.to_text():  # a joint of the goal stands at a value
        expect_true(robot, np.random.default_rng(9), goal_parts=goal_parts)
    for form in FORMS:
        assert "goal_" in getattr(plan, form)().replace("\\_", "_")


def test_a_pose_or_a_plain_point_of_a_short_arm_needs_no_joints_of_the_goal():
    assert ik_plan(load("ur5e"), goal_parts="position+rotation").to_dict() == load("ur5e").ik_plan().to_dict()
    assert "goal_" not in ik_plan(load("planar_3r"), goal_parts="position").to_text()


def test_questions_that_make_no_sense_are_refused():
    robot = load("ur5e")
    with pytest.raises(KeyError, match="did you mean 'position'"):
        robot.ik_plan(goal_parts="postion")
    with pytest.raises(TypeError, match="cannot be combined"):
        robot.ik_plan(goal_parts=("rotation", "direction"))
    with pytest.raises(TypeError, match="leave goal_parts= out"):
        robot.ik_plan(goal_parts="position", locked={0: 0.1})
    with pytest.raises(TypeError, match="goal_parts is a float"):
        robot.ik_plan(goal_parts=1.0)
    with pytest.raises(TypeError, match="one value per joint"):
        robot.ik_plan(locked={0: [0.1, 0.2]})
    with pytest.raises(KeyError, match="wrist"):
        robot.ik_plan(locked={"wrist": 0.1})


def test_what_is_no_robot_is_refused():
    with pytest.raises(TypeError, match="robot"):
        ik_plan("ur5e")


def test_residuals_take_configurations_and_poses():
    robot = cs.load_robot("ur5e")
    plan, q = robot.ik_plan(), np.full(6, 0.3)
    T = robot.fk(q)
    for bad_q, bad_T in ((q[:5], T), (q * np.nan, T), (q, np.eye(3)), (np.stack([q] * 2), np.stack([T] * 3))):
        with pytest.raises(InputError):
            plan.residuals(bad_q, bad_T)
    drill = robot.ik_plan(goal_parts=("position", "direction"))
    with pytest.raises(InputError, match=r"expected \(..., 6\)"):
        drill.residuals(np.zeros(7), T)
    with pytest.raises(UnknownNameError, match="no part"):
        robot.ik_plan(goal_parts=(np.zeros(3),))
