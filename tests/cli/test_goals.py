"""`cspace ik` asks what robot.ik can: parts of a pose, locked joints, the swivel, samples, the nearest."""

from __future__ import annotations

import re

import numpy as np
import pytest

import cspace as cs
from cli import schema
from cli.run import cspace
from cspace.model import to_urdf
from model.rounding import print_right_angles

POSE = "--xyz 0.4 0.1 0.4 --rpy 3 0.1 0.2"
T = cs.pose([0.4, 0.1, 0.4], rpy=[3, 0.1, 0.2])
P = [0.4, 0.1, 0.3]

PARTS = {
    "ur5e --xyz 0.4 0.1 0.3": {"position": P},
    "ur5e --position 0.4 0.1 0.3": {"position": P},
    "ur5e --xyz 0.4,0.1,0.3": {"position": P},
    "ur5e --xyz 0.4 any any": {"position": (0.4, None, None)},
    "ur5e --xyz=0.4,any,-0.1": {"position": (0.4, None, -0.1)},
    "ur5e --rpy 0.1 -0.2 0.3": {"rotation": cs.pose([0, 0, 0], rpy=[0.1, -0.2, 0.3])[:3, :3]},
    "ur5e --rotation 0 -1 0 1 0 0 0 0 1": {"rotation": [[0, -1, 0], [1, 0, 0], [0, 0, 1]]},
    "ur5e --direction 0 0.6 -0.8": {"direction": [0, 0.6, -0.8]},
    "ur5e --direction 0,0.6,-0.8 --tool-axis -x": {"direction": [0, 0.6, -0.8], "tool_axis": "-x"},
    "ur5e --xyz 0.4 0.1 0.3 --direction 0 0 -1": {"position": P, "direction": [0, 0, -1]},
    "so101 --xyz 0.2 0.05 0.1 --direction 0 0 -1 --tool-axis 1 0 0": {
        "position": [0.2, 0.05, 0.1],
        "direction": [0, 0, -1],
        "tool_axis": [1, 0, 0],
    },
    "ur5e --look-at 0.6 0.2 -0.1": {"look_at": [0.6, 0.2, -0.1]},
    "ur5e --ray 0.4 0.1 0.3 0 0.6 -0.8": {"ray": (P, [0, 0.6, -0.8])},
    "ur5e --xyz 0.4 0.1 0.3 --angle-to -z 0.5": {"position": P, "angle_to": ("-z", 0.5)},
    "planar_3r --xy 1.5 0.8 --angle -0.4": {"position": [1.5, 0.8], "angle": -0.4},
}


@pytest.mark.parametrize("line", PARTS)
def test_parts_of_a_pose_are_answered_as_the_library_does(line):
    result = cspace(f"ik {line} --limits keep --json")
    assert result.code == 0, result.err
    schema.check(result.json, "cspace.ik/1")
    answer = cs.load_robot(line.split()[0]).ik(**PARTS[line])
    np.testing.assert_allclose([row["q"] for row in result.json["solutions"]], answer.q, atol=1e-12)
    assert result.json["freedom"] == list(answer.freedom)
    assert result.json["reason"] == answer.reason
    assert result.json["complete"] == answer.complete
    assert max(row["residual"] for row in result.json["solutions"]) < 1e-9


@pytest.mark.parametrize("line", PARTS)
def test_the_goal_is_repeated_in_the_document(line):
    goal = cspace(f"ik {line} --json").json["goal"]
    asked = {name: value for name, value in goal.items() if value is not None}
    wanted = dict(PARTS[line])
    if {"direction", "look_at", "ray", "angle_to"} & set(wanted):
        wanted.setdefault("tool_axis", "z")
    assert set(asked) == set(wanted)
    for name, value in wanted.items():
        assert np.shape(asked[name]) == np.shape(value) if name != "angle_to" else asked[name][0] == value[0]


def test_a_place_and_an_orientation_by_its_matrix_are_a_pose():
    words = " ".join(map(repr, T[:3, :3].ravel().tolist()))
    found = cspace(f"ik ur5e --xyz 0.4 0.1 0.4 --rotation {words} --json").json
    np.testing.assert_allclose(found["goal"]["matrix"], T, atol=1e-15)
    assert found["solutions"] == cspace(f"ik ur5e {POSE} --json").json["solutions"]


@pytest.mark.parametrize(
    ("deg", "rad"),
    [
        ("planar_3r --xy 1.5 0.8 --angle 30", "planar_3r --xy 1.5 0.8 --angle pi/6"),
        ("ur5e --xyz 0.4 0.1 0.3 --angle-to z 150", "ur5e --xyz 0.4 0.1 0.3 --angle-to z 5pi/6"),
        ("ur5e --rpy 30 0 -45", "ur5e --rpy pi/6 0 -pi/4"),
        (
            "panda --xyz 0.4 0.1 0.4 --rpy 180 0 0 --locked panda_joint7=45",
            "panda --xyz 0.4 0.1 0.4 --rpy pi 0 0 --locked panda_joint7=pi/4",
        ),
        (
            "iiwa14 --xyz 0.5 0.1 0.4 --rpy 180 0 0 --swivel -30",
            "iiwa14 --xyz 0.5 0.1 0.4 --rpy pi 0 0 --swivel -pi/6",
        ),
    ],
)
def test_angles_of_goals_and_held_joints_are_typed_in_degrees(deg, rad):
    found, wanted = cspace(f"ik {deg} --deg --json").json, cspace(f"ik {rad} --json").json
    assert wanted["solutions"]
    np.testing.assert_allclose(
        [row["q"] for row in found["solutions"]], [row["q"] for row in wanted["solutions"]], atol=1e-9
    )


def test_a_slide_is_held_in_metres_whatever_the_angles_are_in():
    robot = cs.load_robot("stanford")
    words = " ".join(map(repr, robot.fk([0.1, 0.2, 0.3, 0.4, 0.5, 0.6]).ravel().tolist()))
    found = cspace(f"ik stanford --deg --json --locked q3=0.3 --matrix {words}").json
    assert found["solutions"]
    assert found["locked"] == {robot.joint_names[2]: 0.3}
    assert all(row["q"][2] == 0.3 for row in found["solutions"])


@pytest.mark.parametrize("word", ["panda_joint7", "q7"])
def test_a_held_joint_stands_at_its_value_and_every_solution_of_the_others_is_listed(word):
    found = cspace(f"ik panda {POSE} --locked {word}=0.7 --limits keep --json").json
    answer = cs.load_robot("panda").ik(T, locked={"panda_joint7": 0.7})
    assert len(answer)
    np.testing.assert_allclose([row["q"] for row in found["solutions"]], answer.q, atol=1e-12)
    assert found["locked"] == {"panda_joint7": 0.7}
    assert found["freedom"] == []


def test_two_joints_are_held_in_one_word_or_two():
    one = cspace(f"ik panda {POSE} --locked q7=0.7 q1=0.2 --json")
    two = cspace(f"ik panda {POSE} --locked q7=0.7 --locked q1:=0.2 --json")
    assert (one.code, one.out) == (two.code, two.out)
    assert one.json["locked"] == {"panda_joint7": 0.7, "panda_joint1": 0.2}


def test_the_swivel_is_that_of_every_solution():
    found = cspace("ik iiwa14 --xyz 0.5 0.1 0.4 --rpy pi 0 0 --swivel 0.5 --limits keep --json").json
    robot = cs.load_robot("iiwa14")
    assert len(found["solutions"]) == 8
    assert found["swivel"] == 0.5
    np.testing.assert_allclose(cs.ik.swivel(robot, [row["q"] for row in found["solutions"]]), 0.5, atol=1e-9)


def test_samples_spread_over_what_is_free():
    for count in (1, 5):
        found = cspace(f"ik panda {POSE} --samples {count} --limits keep --json").json
        values = {round(row["q"][6], 9) for row in found["solutions"]}
        assert len(values) == count
        assert found["freedom"] == ["panda_joint7"]
        assert f"at {count} value" in cspace(f"ik panda {POSE} --samples {count}").out


def test_the_nearest_of_a_self_motion_comes_alone():
    near = [0.2, 0.1, 0.1, -2.0, 0.1, 2.0, 0.5]
    found = cspace(f"ik panda {POSE} --json --near", ",".join(map(str, near))).json
    best = cs.load_robot("panda").ik(T, near=near)
    assert len(found["solutions"]) == 1
    np.testing.assert_allclose(found["solutions"][0]["q"], best.q[0], atol=1e-12)
    np.testing.assert_allclose(
        found["solutions"][0]["distance"], np.linalg.norm(best.q[0] - near), atol=1e-12
    )
    listed = cspace(f"ik panda {POSE} --samples 50 --json").json["solutions"]
    assert found["solutions"][0]["distance"] <= min(np.linalg.norm(np.array(r["q"]) - near) for r in listed)


def test_at_a_singular_pose_the_nearest_is_that_of_the_family():
    robot = cs.load_robot("puma560")
    q = np.array([0.1, 0.2, 0.3, 0.4, 0.0, 0.5])
    words = " ".join(map(repr, robot.fk(q).ravel().tolist()))
    found = cspace(f"ik puma560 --matrix {words} --near {' '.join(map(str, q))} --json").json
    assert found["solutions"][0]["distance"] < 1e-6


def test_what_comes_closest_is_told_on_request_only():
    line = "ik ur5e --xyz 0.8 0.2 0.9 --rpy 0 0 0"
    assert cspace(line).code == 1
    found = cspace(line, "--least-squares", "--json")
    assert (found.code, found.json["status"], len(found.json["solutions"])) == (0, "least_squares", 1)
    robot = cs.load_robot("ur5e")
    np.testing.assert_allclose(
        found.json["solutions"][0]["q"],
        robot.ik(cs.pose([0.8, 0.2, 0.9]), least_squares=True).q[0],
        atol=1e-9,
    )


def test_freedom_is_told_in_the_text():
    assert "leaves 4 dimensions free: goal_tool_slide_z" in cspace("ik ur5e --look-at 0.6 0.2 0").out
    assert "branch" not in cspace("ik ur5e --look-at 0.6 0.2 0").out, "a column without a word is left out"


@pytest.mark.slow
@pytest.mark.parametrize(
    "line",
    [
        "ur5e --look-at 0.6 0.2 0",
        "ur5e --direction 0 0 -1",
        f"panda {POSE} --samples 2",
        "ur5e --xyz 0.4 any 0.2",
    ],
)
def test_pictures_of_every_kind_of_goal(line, tmp_path):
    pytest.importorskip("matplotlib")
    picture = tmp_path / "all.png"
    assert cspace(f"ik {line} --plot", str(picture)).code == 0
    assert picture.read_bytes().startswith(b"\x89PNG")


def test_an_explanation_knows_the_joints_that_are_held():
    result = cspace("ik panda --explain --locked q4=-pi/2 --json")
    assert result.code == 0, result.err
    schema.check(result.json, "cspace.ik_plan/1")
    assert result.json["locked"] == ["panda_joint4"]
    assert (
        cspace("ik panda --explain --locked q4=-90 --deg").out
        == cspace("ik panda --explain --locked q4=-pi/2").out
    )
    assert (
        cspace("ik al5d --explain --goal-parts look-at").out
        == cspace("ik al5d --explain --goal-parts look_at").out
    )


@pytest.mark.parametrize("verb", ["fk", "jacobian"])
def test_numbers_may_stand_with_commas_between_them(verb):
    assert (
        cspace(f"{verb} ur5e 0.1,-1.2,pi/2,-pi/4,0,3").out
        == cspace(f"{verb} ur5e 0.1 -1.2 pi/2 -pi/4 0 3").out
    )


@pytest.mark.parametrize(
    ("with_pi", "in_degrees"),
    [
        ("fk ur5e pi/2 -30 pi/4 -pi 0 0", "fk ur5e 90 -30 45 -180 0 0"),
        ("ik ur5e --xyz 0.4 0.1 0.4 --rpy pi 3 -pi/2", "ik ur5e --xyz 0.4 0.1 0.4 --rpy 180 3 -90"),
        ("ik ur5e --xyz 0.4 0.1 0.3 --angle-to z pi/2", "ik ur5e --xyz 0.4 0.1 0.3 --angle-to z 90"),
        ("ik planar_3r --xy 1.5 0.8 --angle pi/6", "ik planar_3r --xy 1.5 0.8 --angle 30"),
        (
            "ik iiwa14 --xyz 0.5 0.1 0.4 --rpy pi 0 0 --swivel pi/6",
            "ik iiwa14 --xyz 0.5 0.1 0.4 --rpy 180 0 0 --swivel 30",
        ),
        (
            "ik panda --xyz 0.4 0.1 0.4 --rpy pi 0 0 --locked q7=pi/4",
            "ik panda --xyz 0.4 0.1 0.4 --rpy 180 0 0 --locked q7=45",
        ),
        (
            "ik puma560 --xyz 0.5 0 0.3 --rpy 0 pi 0 --near 0 0 pi/2 0 0 0",
            "ik puma560 --xyz 0.5 0 0.3 --rpy 0 180 0 --near 0 0 90 0 0 0",
        ),
    ],
)
def test_pi_is_half_a_turn_where_degrees_are_typed(with_pi, in_degrees):
    found, wanted = cspace(f"{with_pi} --deg --json"), cspace(f"{in_degrees} --deg --json")
    assert found.code == wanted.code == 0, found.err
    assert numbers_of(found.json) == pytest.approx(numbers_of(wanted.json), abs=1e-9)


def numbers_of(document):
    """Every number of a JSON document, in order."""
    if isinstance(document, dict):
        return [x for value in document.values() for x in numbers_of(value)]
    if isinstance(document, list):
        return [x for value in document for x in numbers_of(value)]
    return [document] if isinstance(document, (int, float)) else []


def test_a_reason_is_in_the_unit_that_was_asked_for():
    line = "ik kr6_r900 --xyz -0.6 0 0.3 --rpy pi -pi/2 0 --limits drop"
    in_radians, in_degrees = cspace(line), cspace(f"{line} --deg")
    beyond = float(in_radians.out.split(" out by ")[1].removesuffix(" rad\n"))
    assert in_degrees.out.endswith(f" out by {np.degrees(beyond):.4g} deg\n")
    assert cspace(f"{line} --deg --json").json["reason"].endswith(" rad")  # radians whatever --deg says


def test_a_reason_names_the_option_that_answers(tmp_path):
    path = tmp_path / "so101.urdf"
    path.write_text(to_urdf(print_right_angles(cs.load_robot("so101").description, 4)))
    line = f"ik {path} --xyz 0.2 0.05 0.1 --direction 0 0 -1"
    assert cspace(line).out.endswith("; --least-squares returns the nearest configuration\n")
    assert cspace(f"{line} --least-squares").code == 0
    assert cspace(f"{line} --right-angles 1e-5").code == 0


def test_values_of_held_joints_are_in_the_unit_that_was_asked_for():
    line = "ik planar_3r --xy 2.45 0 --locked joint_1=pi/2"
    assert cspace(line).out.endswith("nothing reaches the goal with joint_1 = 1.5708 rad\n")
    assert cspace(f"{line} --deg").out.endswith("nothing reaches the goal with joint_1 = 90 deg\n")
    line = "ik scara --xyz 0.3 0.3 9 --rpy pi 0 0 --locked joint_3=0.1 joint_4=-pi/6 --deg"
    assert cspace(line).out.endswith("with joint_3 = 0.1 m, joint_4 = -30 deg\n")


@pytest.mark.slow
@pytest.mark.parametrize("name", ["ur5e", "puma560", "panda", "simplified_puma", "planar_3r", "so101"])
@pytest.mark.parametrize("seed", range(4))
def test_a_pose_printed_by_fk_is_accepted_in_every_form(name, seed):
    robot = cs.load_robot(name)
    q = np.random.default_rng(seed).uniform(-1.5, 1.5, len(robot.joint_names))
    texts = [f"{x:.9f}" for x in q]
    lines = cspace(f"fk {name}", *texts).out.splitlines()
    rows = [line.split() for line in lines[1:5]]
    form = {line.split()[0]: re.findall(r"-?\d+\.\d+", line) for line in lines[5:]}
    rotation = [x for row in rows[:3] for x in row[:3]]
    matrix = [x for row in rows for x in row]
    goals = {"matrix": ["--matrix", *matrix], "rotation": ["--rotation", *rotation, "--xyz", *form["xyz"]]}
    goals |= {word: [f"--{word}", *form[word], "--xyz", *form["xyz"]] for word in ("rpy", "wxyz", "xyzw")}
    for words in goals.values():
        found = cspace(f"ik {name} --json", *words)
        assert found.code in (0, 1), found.err
        goal = np.array(found.json["goal"]["matrix"])
        np.testing.assert_allclose(goal, robot.fk(q), atol=2e-6)
        np.testing.assert_allclose(goal[:3, :3].T @ goal[:3, :3], np.eye(3), atol=2e-6)


def test_a_matrix_that_is_no_rotation_is_refused_and_one_typed_with_five_decimals_is_not():
    R = cs.pose([0, 0, 0], rpy=[0.3, -0.4, 1.1])[:3, :3]
    for decimals, code in ((12, 0), (8, 0), (6, 0), (5, 0), (3, 2)):
        typed = [f"{x:.{decimals}f}" for x in R.ravel()]
        assert cspace("ik ur5e --xyz 0.3 0.2 0.4 --rotation", *typed).code == code
    sheared = [f"{x:.6f}" for x in (R + 1e-3 * np.eye(3, k=1)).ravel()]
    assert cspace("ik ur5e --xyz 0.3 0.2 0.4 --rotation", *sheared).code == 2
