"""Exports of redundant arms: locked joints are arguments, and the solutions are those of the library."""

from __future__ import annotations

import json
import os
import subprocess

import numpy as np
import pytest

import cspace as cs
from cspace.errors import InputError, InputTypeError, UnknownNameError
from cspace.ik import NoClosedFormError
from export import agree, arms, compiled
from export.test_python import module_of

COMPILED = [("panda", None, "cpp"), ("p8", None, "c")]
SLOW = [
    *(
        ("coaxial", None, "cpp"),
        ("gen3", None, "cpp"),
        ("iiwa14_r820", None, "cpp"),
        ("panda", ["panda_joint4"], "cpp"),
    ),
    *(("ur5e", ["elbow_joint"], "c"), ("ur5e", [0], "cpp"), ("scara", ["joint_3"], "cpp")),
]
"""A joint between others takes the whole library along: such files compile for a minute."""
CASES = COMPILED + SLOW * bool(os.environ.get("CSPACE_EVERY_EXPORT"))


def questions(robot, locked, seed, count):
    """Goals, regular ones first, and a value of each locked joint: the one that made the goal, or any."""
    goals, regular = agree.goals(robot, count, seed)
    rng = np.random.default_rng(seed)
    q = rng.uniform(-1.5, 1.5, (count, robot.dof))
    goals[:count] = robot.fk(q)
    values = rng.uniform(-1.5, 1.5, (len(goals), len(locked)))
    values[: count // 2] = q[: count // 2, locked]
    return goals, values, regular


@pytest.mark.slow
@pytest.mark.parametrize(("name", "locked", "lang"), CASES)
def test_an_export_answers_as_the_library_with_these_joints_locked(name, locked, lang, tmp_path):
    robot = arms.arm(name)
    made = robot.export(lang, locked=locked)
    locked = [robot.joint_names.index(joint) for joint in made.locked]
    goals, values, regular = questions(robot, locked, seed=30, count=200)
    build = compiled.cpp_program if lang == "cpp" else compiled.c_program
    program = build(made, tmp_path, compiled.cxx(), *(["-O1"] if lang == "cpp" else [compiled.cc()]))
    rows = np.hstack([goals.reshape(-1, 16), values])
    certificates = []
    for k, answer in enumerate(compiled.ask(program, rows, robot.dof)):
        asked = {"locked": dict(zip(locked, values[k].tolist(), strict=True))}
        if k < regular:
            certificates.append(agree.check_regular(robot, answer, goals[k], **asked))
        else:
            agree.check_special(robot, answer, goals[k], **asked)
        assert (answer.q[:, locked] == values[k]).all()
    assert np.mean(certificates) > 0.98
    bad = np.hstack([agree.nonsense(robot).reshape(-1, 16), np.zeros((4, len(locked)))])
    bad = np.vstack([bad, rows[:2]])
    bad[4, 16], bad[5, -1] = np.nan, np.inf
    assert [answer.status for answer in compiled.ask(program, bad, robot.dof)] == ["not_a_pose"] * 6


@pytest.mark.parametrize(
    ("name", "locked"),
    [
        *(("panda", None), ("iiwa14_r820", None), ("p8", None), ("ur5e", 0), ("xarm7", None)),
        *(("rpr", 0), ("coaxial", None)),
    ],
)
def test_a_python_file_finds_what_the_library_finds(name, locked):
    robot = arms.arm(name)
    made = robot.export("python", locked=locked)
    module = module_of(made.text)
    locked = [robot.joint_names.index(joint) for joint in made.locked]
    goals, values, _ = questions(robot, locked, seed=31, count=10)
    for goal, value in zip(goals[:10], values, strict=False):
        found = robot.ik(goal, locked=dict(zip(locked, value.tolist(), strict=True)))
        answer = module.ik(goal, value)
        assert bool(answer) == bool(found)
        for q in answer.q:
            np.testing.assert_allclose(robot.fk(q), goal, atol=1e-8)
            np.testing.assert_array_equal(q[locked], value)
        for q in found.q:
            assert agree.apart(q, answer.q, robot.joint_types) < 1e-6
    with pytest.raises(ValueError, match="one for each locked joint"):
        module.ik(goals[0], np.zeros(len(locked) + 1))
    with pytest.raises(ValueError, match="finite value"):
        module.ik(goals[0], np.full(len(locked), np.nan))


@pytest.mark.parametrize(("name", "locked"), [("panda", "panda_joint4"), ("ur5e", "elbow_joint")])
def test_a_joint_between_others_has_no_python_file(name, locked):
    with pytest.raises(NoClosedFormError, match=f"with {locked} locked has no closed form"):
        cs.load_robot(name).export("python", locked=locked)


@pytest.mark.parametrize("lang", ["cpp", "c", "python"])
def test_files_and_examples_name_the_locked_joints(lang, tmp_path):
    made = cs.load_robot("panda").export(lang, name="arm")
    assert made.locked == ("panda_joint7",)
    assert "panda_joint7 locked" in made.method
    assert "panda_joint7" in made.text
    assert ("q[6]" if lang == "python" else "locked") in made.example


def test_the_python_example_runs(tmp_path):
    made = cs.load_robot("panda").export("python", tmp_path / "arm.py")
    made.write_example(tmp_path / "main.py")
    done = subprocess.run(["python", "main.py"], cwd=tmp_path, capture_output=True, text=True)
    assert "configurations reach" in done.stdout, done.stderr


def test_joints_that_cannot_be_locked_are_refused():
    robot = cs.load_robot("panda")
    with pytest.raises(UnknownNameError, match="did you mean 'panda_joint7'"):
        robot.export(locked="panda_join7")
    with pytest.raises(InputError, match="twice"):
        robot.export(locked=[6, "panda_joint7"])
    with pytest.raises(InputError, match="names 7 of 7 joints"):
        robot.export(locked=range(7))
    with pytest.raises(InputError, match="names 0 of 7"):
        robot.export(locked=[])
    with pytest.raises(InputTypeError, match="arguments of each call"):
        robot.export(locked={"panda_joint7": 0.1})


def test_names_of_locked_joints_stay_in_their_comments():
    axes = np.vstack([np.eye(3), np.eye(3), [[0, 0, 1.0]]])
    points = np.random.default_rng(3).uniform(-1, 1, (7, 3))
    points[4:6] = points[3]  # a spherical wrist: Python files hold closed forms
    names = ["a", "b", "c", "d", "e", "f", 'evil */ \\ \n // "é']
    robot = cs.Robot.from_screws(axes, points, np.eye(4), joint_names=names)
    for lang in ("cpp", "c", "python"):
        for text in robot.export(lang, locked=6).files.values():
            lines = [line for line in text.splitlines() if "evil" in line]
            assert lines
            assert not any(line.endswith("\\") for line in lines)
            assert lang == "python" or not any("evil */" in line.split('"')[0] for line in lines)
    compile(robot.export("python", locked=6).text, "arm.py", "exec")
    assert json.dumps(robot.export(locked=6).locked)
