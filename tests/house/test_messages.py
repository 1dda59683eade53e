"""What bad input gets: the right class and a message that names the subject, the value, the rule and the
remedy."""

from __future__ import annotations

import numpy as np
import pytest

import cspace as cs
from cspace import errors

URDF = """<robot name="r">
  <link name="a"/>
  <link name="b"/>
  <joint name="j" type="{type}">
    <parent link="{parent}"/>
    <child link="b"/>
    <axis xyz="{axis}"/>
    <limit lower="{lower}" upper="1" velocity="1" effort="1"/>
  </joint>
</robot>
"""
GOOD = {"type": "revolute", "parent": "a", "axis": "0 0 1", "lower": "-1"}


def load_text(text, tmp_path):
    path = tmp_path / "robot.urdf"
    path.write_text(text)
    return cs.load_robot(path)


def load_branching():
    fingers = [cs.model.Joint(side, "prismatic", "hand", side, axis=(0, 1, 0)) for side in ("left", "right")]
    links = [cs.model.Link(name) for name in ("hand", "left", "right")]
    return cs.Robot(cs.model.Description("gripper", links=links, joints=fingers))


def nan_pose():
    T = np.eye(4)
    T[0, 3] = np.nan
    return T


def slanted():
    T = np.eye(4)
    T[0, 1] = 0.5
    return T


@pytest.mark.parametrize(
    ("name", "known", "text"),
    [
        ("x", [], "no frame 'x' in r; there are no frames"),
        ("x", ["abc"], "no frame 'x' in r; frames: abc"),
        ("abd", ["abc"], "no frame 'abd' in r; did you mean 'abc'? frames: abc"),
        ("ab", ["abc", "abd"], "no frame 'ab' in r; did you mean 'abd' or 'abc'? frames: abc, abd"),
        ("x", map(str, range(31)), "no frame 'x' in r; 31 frames are known"),
        ("tol", ["tool", *map(str, range(30))], "; did you mean 'tool'? 31 frames are known"),
    ],
)
def test_a_suggestion_is_a_sentence(name, known, text):
    assert text in str(errors.suggest("frame", name, known, owner="r"))


@pytest.mark.parametrize(
    ("noun", "plural"),
    [
        ("link", "links"),
        ("branch", "branches"),
        ("axis", "axes"),
        ("body", "bodies"),
        ("link or body", "links and bodies"),
    ],
)
def test_the_plural_of_a_subject_is_right(noun, plural):
    assert str(errors.suggest(noun, "x", ["a"])).endswith(f"; {plural}: a")


# What is done, the class of the error, and what its message must hold.
CALLS = {
    "unknown robot": (lambda: cs.load_robot("ur5w"), errors.UnknownNameError, ["'ur5w'", "'ur5e'"]),
    "unknown frame": (
        lambda: cs.load_robot("ur5e").fk(np.zeros(6), frame="wrist4"),
        errors.UnknownNameError,
        ["'wrist4'", "ur5e"],
    ),
    "NaN in a goal": (
        lambda: cs.load_robot("ur5e").ik(nan_pose()),
        errors.InputError,
        ["goal", "nan", "finite"],
    ),
    "a goal that is no rotation": (
        lambda: cs.load_robot("ur5e").ik(slanted()),
        errors.InputError,
        ["goal", "rotation", "0.5"],
    ),
    "a goal of the wrong shape": (
        lambda: cs.load_robot("ur5e").ik(np.eye(3)),
        errors.InputError,
        ["goal", "(3, 3)", "(..., 4, 4)"],
    ),
    "no goal": (lambda: cs.load_robot("ur5e").ik(), errors.InputTypeError, ["goal", "robot.ik("]),
    "too few joints": (
        lambda: cs.load_robot("ur5e").fk(np.zeros(5)),
        errors.InputError,
        ["q", "(5,)", "6"],
    ),
    "too many joints for a Jacobian": (
        lambda: cs.load_robot("ur5e").jacobian(np.zeros(7)),
        errors.InputError,
        ["q", "(7,)", "6"],
    ),
    "infinite joint": (
        lambda: cs.load_robot("ur5e").fk([0, 0, np.inf, 0, 0, 0]),
        errors.InputError,
        ["q", "inf", "2"],
    ),
    "words for numbers": (
        lambda: cs.load_robot("ur5e").fk(["a"] * 6),
        errors.InputTypeError,
        ["q", "numbers"],
    ),
    "zero axis": (
        lambda: cs.model.from_screws([[0, 0, 0]], [[0, 0, 0]], np.eye(4)),
        errors.InputError,
        ["axis", "zero"],
    ),
    "limits upside down": (
        lambda: cs.model.from_screws([[0, 0, 1]], [[0, 0, 0]], np.eye(4), lower=[1], upper=[-1]),
        errors.InputError,
        ["lower", "upper", "1", "-1"],
    ),
    "unknown convention": (
        lambda: cs.model.to_dh(cs.load_robot("ur5e").chain, convention="standart"),
        errors.UnknownNameError,
        ["'standart'", "'standard'"],
    ),
    "unknown metric": (
        lambda: (
            cs.load_robot("ur5e").ik(cs.load_robot("ur5e").fk(np.ones(6))).nearest(np.ones(6), metric="max2")
        ),
        errors.UnknownNameError,
        ["'max2'", "'max'"],
    ),
    "a quaternion of length two": (
        lambda: cs.rotation(wxyz=[0, 0, 0, 0]),
        errors.InputError,
        ["wxyz"],
    ),
    "two rotations at once": (
        lambda: cs.rotation(rpy=[0, 0, 0], rotvec=[0, 0, 0]),
        errors.InputTypeError,
        ["rpy", "rotvec"],
    ),
    "unknown sequence": (
        lambda: cs.rotation(euler=("XYY", [0, 0, 0])),
        errors.CspaceError,
        ["XYY"],
    ),
    "missing tip": (
        lambda: cs.Robot(cs.load_robot("ur5e").description, tip="hand"),
        errors.UnknownNameError,
        ["'hand'", "ur5e"],
    ),
    "a table of a robot instead of its chain": (
        lambda: cs.model.to_dh(cs.load_robot("ur5e"), convention="standard"),
        errors.InputTypeError,
        ["Robot", "robot.to_dh()", "robot.chain"],
    ),
    "a robot made of a name": (
        lambda: cs.Robot("ur5e"),
        errors.InputTypeError,
        ["Description", "str", "load_robot"],
    ),
    "a frame unlike all others": (
        lambda: cs.load_robot("planar_2r").fk([0, 0], frame="xyzzy"),
        errors.UnknownNameError,
        ["no frame 'xyzzy' in planar_2r; frames: "],
    ),
    "a robot unlike all others": (
        lambda: cs.load_robot("!!!"),
        errors.UnknownNameError,
        ["no robot '!!!' in the catalogue; cs.robots.names() lists all", f"{len(cs.robots.names())}, "],
    ),
    "inverse kinematics of a robot with a gripper": (
        lambda: load_branching().ik(np.eye(4)),
        errors.InputError,
        ["tip=", "left, right", "any other link"],
    ),
}


@pytest.mark.parametrize("name", CALLS)
def test_a_misuse_is_named(name):
    call, kind, fragments = CALLS[name]
    with pytest.raises(kind) as caught:
        call()
    assert isinstance(caught.value, cs.CspaceError)
    message = str(caught.value)
    for fragment in fragments:
        assert fragment in message, f"no {fragment!r} in {message!r}"


# What stands in the file, and what the message must hold besides the name of the file.
FILES = {
    "malformed XML": (URDF.format(**GOOD).replace("</robot>", ""), [":1"]),
    "not XML at all": ("solid cube\nendsolid\n", [":1"]),
    "not a robot": ("<html><body/></html>", ["html", "robot"]),
    "unknown joint type": (URDF.format(**GOOD | {"type": "revolut"}), [":4", "'revolut'", "'revolute'"]),
    "cycle": (URDF.format(**GOOD | {"parent": "b"}), ["b"]),
    "unknown link": (URDF.format(**GOOD | {"parent": "c"}), ["'c'"]),
    "zero axis": (URDF.format(**GOOD | {"axis": "0 0 0"}), ["axis", "j"]),
    "limits upside down": (URDF.format(**GOOD | {"lower": "2"}), ["lower", "upper", "2"]),
    "a number that is none": (URDF.format(**GOOD | {"axis": "0 0 up"}), ["up"]),
    "NaN": (URDF.format(**GOOD | {"axis": "0 0 nan"}), ["nan"]),
}


@pytest.mark.parametrize("name", FILES)
def test_a_bad_file_is_named_with_its_fault(name, tmp_path):
    text, fragments = FILES[name]
    with pytest.raises(cs.CspaceError) as caught:
        load_text(text, tmp_path)
    message = str(caught.value)
    for fragment in ["robot.urdf", *fragments]:
        assert fragment in message, f"no {fragment!r} in {message!r}"


def test_the_file_of_these_cases_is_good_without_their_fault(tmp_path):
    assert load_text(URDF.format(**GOOD), tmp_path).dof == 1


def test_a_file_that_is_not_there_is_named(tmp_path):
    with pytest.raises(cs.CspaceError, match=r"absent\.urdf"):
        cs.load_robot(tmp_path / "absent.urdf")
