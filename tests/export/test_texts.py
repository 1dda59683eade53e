"""Every arm that robot.ik solves can be written down, whole, free of the library and of allocation."""

from __future__ import annotations

import copy
import pickle
import re
import warnings

import numpy as np
import pytest

import cspace as cs
from cspace.errors import InputError, InputTypeError, UnknownNameError
from cspace.export import LANGUAGES
from cspace.ik import NoClosedFormError

STANDARD = {
    *("array", "cfloat", "climits", "cmath", "cstddef", "cstdint", "cstdlib", "cstring", "initializer_list"),
    *("limits", "type_traits", "utility", "algorithm"),
}
REGISTERS = {"immintrin.h", "arm_neon.h"}
ALLOCATION = re.compile(r"\b(new|malloc|std::vector|std::string|unique_ptr|shared_ptr|throw|std::function)\b")


def code_of(text):
    """C or C++ without comments and literals."""
    return re.sub(r'//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\])*"', "", text, flags=re.S)


@pytest.mark.slow
@pytest.mark.parametrize("name", cs.robots.names())
def test_every_arm_of_the_catalogue(name):
    robot = cs.load_robot(name)
    for lang in ("cpp", "c"):
        made = robot.export(lang)
        for text in made.files.values():
            assert text.isascii()
            assert "0BSD" in text.split("#ifndef")[0] or text.startswith("#include")
            code = code_of(text)
            assert not ALLOCATION.search(code)
            assert "cspace" not in code.lower()
            assert code.count("{") == code.count("}")
            assert "$" not in text
            included = set(re.findall(r"#include <([^>]+)>", text))
            assert included <= STANDARD | REGISTERS
        assert made.name in made.text


def test_a_file_holds_the_headers_of_its_solver_alone():
    """A closed form comes without the general solver, an arm of three joints without either."""
    words = {
        "irb120": ({"place_wrist"}, {"eliminate_angles", "solve_few_joint_pose"}),
        "gen3_lite": ({"eliminate_angles"}, {"solve_few_joint_pose", "solve_fast_path"}),
        "planar_2r": ({"solve_few_joint_pose"}, {"eliminate_angles", "place_wrist", "solve_carefully"}),
    }
    for name, (there, missing) in words.items():
        code = code_of(cs.load_robot(name).export("cpp").text)
        found = set(re.findall(r"[A-Za-z_]\w*", code))
        assert there <= found
        assert not missing & found, name


def test_macros_do_not_outlive_the_header():
    text = cs.load_robot("crx10ia").export("cpp").text
    defined = set(re.findall(r"^ *# *define (\w+)", text, re.M))
    removed = set(re.findall(r"^ *# *undef (\w+)", text, re.M))
    assert defined - removed == {"CRX10IA_IK_HPP"}


@pytest.mark.parametrize(
    ("name", "expected"),
    [
        ("ur5e", "ur5e"),
        ("My Arm 2", "my_arm_2"),
        ("7-dof", "arm_7_dof"),
        ("double", "double_arm"),
        ("ünö", "n"),
    ],
)
def test_names_become_identifiers(name, expected):
    robot = cs.Robot.from_screws([[0, 0, 1]], [[0, 0, 0]], np.eye(4), name=name)
    assert robot.export().name == expected


WORDS = (
    "co_await co_yield concept requires char8_t and_eq not thread_local static_assert true false constinit"
)
MACROS = "NULL EOF NAN INFINITY errno assert offsetof stdin INT_MAX DBL_EPSILON UINT64_C M_PI SIGINT PRId64 I"
BAD = ["", "1a", "a-b", "a b", "int", "a__b", "std", "ä", "a;b"]


@pytest.mark.parametrize("name", [*BAD, *WORDS.split(), *MACROS.split()])
def test_names_that_are_none_are_refused(name):
    with pytest.raises(InputError, match="name is"):
        cs.load_robot("ur5e").export(name=name)


def test_names_with_quotes_and_accents_stay_literals():
    robot = cs.Robot.from_screws(
        [[0, 0, 1]], [[0, 0, 0]], np.eye(4), name='evil "; */ \n // é', joint_names=['j"\\ é?']
    )
    for lang in LANGUAGES:
        text = robot.export(lang).text
        assert "\n // é" not in text


NAMES = [
    '"""',
    "\0",
    "a\0b",
    "\\",
    'a"',
    '"a',
    'x"""+"',
    "a\nb",
    "a\rb",
    "*/",
    "**//",
    '*"/',
    "/*",
    "'''",
    "\x1b[2J",
]
NAMES += ["$name", "${name}", "\\N{x}", "\\x", "\\u12", "a\u2028b", "??/", "{q}", "%s", "é", "\x7f"]


@pytest.mark.parametrize("name", NAMES)
def test_no_name_of_a_robot_ends_its_comment(name):
    robot = cs.Robot.from_screws([[0, 0, 1]], [[0, 0, 0]], np.eye(4), name=name)
    plain = cs.Robot.from_screws([[0, 0, 1]], [[0, 0, 0]], np.eye(4), name="plain")
    for lang in LANGUAGES:
        made, twin = robot.export(lang, name="arm"), plain.export(lang, name="arm")
        for text, other in zip(
            [*made.files.values(), made.example], [*twin.files.values(), twin.example], strict=True
        ):
            assert re.fullmatch(r"[ -~\n]*", text)
            assert text.count("\n") == other.count("\n")
            assert text.count("*/") == other.count("*/")
            if lang == "python":
                with warnings.catch_warnings():
                    warnings.simplefilter("error")
                    compile(text, "arm.py", "exec")


@pytest.mark.parametrize("name", NAMES)
def test_names_of_joints_stay_literals(name):
    robot = cs.Robot.from_screws([[0, 0, 1]], [[0, 0, 0]], np.eye(4), name="arm", joint_names=[name])
    plain = cs.Robot.from_screws([[0, 0, 1]], [[0, 0, 0]], np.eye(4), name="arm", joint_names=["j"])
    for lang in LANGUAGES:
        made, twin = robot.export(lang), plain.export(lang)
        assert made.text.count("\n") == twin.text.count("\n")
        assert "\0" not in made.text
    assert compile(robot.export("python").text, "arm.py", "exec")


def test_half_characters_are_no_names():
    for options in ({"name": "\ud800"}, {"joint_names": ["\udfff"]}):
        with pytest.raises(InputError, match="half of a character"):
            cs.Robot.from_screws([[0, 0, 1]], [[0, 0, 0]], np.eye(4), **options)


def test_the_language_follows_the_ending(tmp_path):
    robot = cs.load_robot("planar_2r")
    assert robot.export(path=tmp_path / "a.hpp").language == "cpp"
    assert robot.export(path=tmp_path / "a.h").language == "c"
    assert robot.export("cpp", tmp_path / "b.h").language == "cpp"
    assert sorted(p.name for p in tmp_path.iterdir()) == ["a.cpp", "a.h", "a.hpp", "b.h"]


def test_unknown_languages_are_named():
    with pytest.raises(UnknownNameError, match=r"no language 'c\+\+'.*cpp"):
        cs.load_robot("ur5e").export("c++")
    with pytest.raises(InputTypeError, match="lang is an int"):
        cs.load_robot("ur5e").export(3)


def test_what_cannot_be_written_leaves_nothing_behind(tmp_path):
    robot = cs.load_robot("ur5e")
    with pytest.raises(InputError, match="cannot be written"):
        robot.export("cpp", tmp_path / "missing" / "a.hpp")
    with pytest.raises(InputError, match="cannot be written"):
        robot.export("cpp", tmp_path)
    (tmp_path / "a.hpp").write_text("old")
    with pytest.raises(UnknownNameError):
        robot.export("cpp", tmp_path / "a.hpp", locked="elbow")
    assert [(p.name, p.read_text()) for p in tmp_path.iterdir()] == [("a.hpp", "old")]


def test_tools_and_mountings_count(tmp_path):
    T = np.eye(4)
    T[:3, 3] = 0.1, 0.2, 0.3
    robot = cs.load_robot("ur5e")
    assert robot.with_tool(T).export().text != robot.export().text
    assert robot.with_base(T).export().text != robot.export().text


def test_the_same_arm_gives_the_same_text():
    assert cs.load_robot("irb120").export().text == cs.load_robot("irb120").export().text


@pytest.mark.parametrize(
    ("lang", "file", "words"),
    [
        ("c", "arm.cpp", "reserved for the second file"),
        ("python", "my arm.py", "not that of a module"),
        ("python", "arm.txt", "not that of a module"),
        ("python", "class.py", "not that of a module"),
        ("cpp", 'a"b.hpp', "not allowed in an #include"),
        ("cpp", "a\nb.hpp", "not allowed in an #include"),
    ],
)
def test_files_that_could_not_be_used_are_refused(lang, file, words, tmp_path):
    with pytest.raises(InputError, match=words):
        cs.load_robot("planar_2r").export(lang, tmp_path / file)
    assert list(tmp_path.iterdir()) == []


def test_where_one_of_two_files_cannot_be_written_neither_is(tmp_path):
    (tmp_path / "arm.cpp").mkdir()
    with pytest.raises(InputError, match=r"arm\.cpp cannot be written"):
        cs.load_robot("planar_2r").export("c", tmp_path / "arm.h")
    assert [path.name for path in tmp_path.iterdir()] == ["arm.cpp"]


def test_an_arm_without_joints_is_refused(tmp_path):
    link = '<link name="a"/><link name="b"/>'
    joint = '<joint name="j" type="fixed"><parent link="a"/><child link="b"/></joint>'
    (tmp_path / "still.urdf").write_text(f'<robot name="still">{link}{joint}</robot>')
    robot = cs.load_robot(tmp_path / "still.urdf")
    with pytest.raises(NoClosedFormError, match="no joint moves"):
        robot.export()


def test_an_ending_that_names_no_language_is_refused():
    with pytest.raises(InputError, match=r"'arm.foo' is not that of a language"):
        cs.load_robot("ur5e").export(path="arm.foo")
    with pytest.raises(InputTypeError, match="a file is given by its path"):
        cs.load_robot("ur5e").export("cpp", 5)


@pytest.mark.parametrize("again", [copy.deepcopy, lambda made: pickle.loads(pickle.dumps(made))])
def test_an_export_survives_pickling_and_copying(again):
    made = cs.load_robot("panda").export("c")
    other = again(made)
    assert other == made
    with pytest.raises(TypeError):
        other.files["more"] = ""
