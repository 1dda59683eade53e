"""Xacro files: what they make, where each fault is told to be, and that none of them hangs."""

import os
import subprocess
import sys
import time
from importlib.util import find_spec

import numpy as np
import pytest

import cspace.model.xacro
from cspace.errors import DescriptionError, InputError, InputTypeError, MissingExtraError
from cspace.model import from_urdf, from_xacro, to_toml
from cspace.model.xml import parse_document
from cspace.robots import load_description, load_robot
from model.mutation import exercise_file, mutant

HEAD = '<robot name="arm" xmlns:xacro="http://ros.org/wiki/xacro">\n'

ARM = (
    HEAD
    + """  <xacro:arg name="length" default="0.5"/>
  <xacro:arg name="gripper" default="false"/>
  <xacro:property name="length" value="$(arg length)"/>
  <xacro:include filename="$(find arm_parts)/urdf/joint.xacro"/>
  <link name="link_0"/>
  <xacro:turn i="1" z="${2 * length}" axis="0 0 1"/>
  <xacro:turn i="2" z="${length}" axis="0 1 0"/>
  <xacro:if value="$(arg gripper)">
    <link name="gripper"/>
    <joint name="mount" type="fixed"><parent link="link_2"/><child link="gripper"/></joint>
  </xacro:if>
</robot>
"""
)

PART = (
    HEAD
    + """<xacro:macro name="turn" params="i z axis">
  <link name="link_${i}">
    <visual><geometry><mesh filename="package://arm_parts/meshes/link.stl"/></geometry></visual>
  </link>
  <joint name="joint_${i}" type="revolute">
    <origin xyz="0 0 ${z}" rpy="0 0 ${pi / 4}"/>
    <parent link="link_${i - 1}"/>
    <child link="link_${i}"/>
    <axis xyz="${axis}"/>
    <limit lower="-1" upper="1" velocity="1" effort="1"/>
  </joint>
</xacro:macro></robot>
"""
)


@pytest.fixture
def arm(tmp_path):
    """A xacro file and a package beside it."""
    package = tmp_path / "src" / "parts-clone"
    (package / "urdf").mkdir(parents=True)
    (package / "meshes").mkdir()
    (package / "package.xml").write_text("<package>\n <name> arm_parts </name></package>")
    (package / "meshes" / "link.stl").write_text("solid")
    (package / "urdf" / "joint.xacro").write_text(PART)
    path = tmp_path / "arm.urdf.xacro"
    path.write_text(ARM)
    return path


def needs_xacro(test):
    """Marks a test that expands a file."""
    return pytest.mark.skipif(find_spec("xacro") is None, reason="the package xacro is not installed")(test)


def by_xacro_itself(path, **arguments):
    """The URDF text that the package's own command line writes."""
    script = "import sys, xacro; xacro.main()"
    words = [f"{name}:={value}" for name, value in arguments.items()]
    done = subprocess.run(
        [sys.executable, "-c", script, str(path), *words], capture_output=True, text=True, check=True
    )
    return done.stdout


@needs_xacro
def test_macros_arguments_and_packages_make_the_robot(arm):
    folders = [arm.parent / "src"]
    robot = load_robot(arm, package_paths=folders)
    assert robot.joint_names == ("joint_1", "joint_2")
    assert robot.fk([0, 0])[2, 3] == 1.5
    longer = load_robot(str(arm), xacro_args={"length": 2, "gripper": True}, package_paths=folders)
    assert longer.tip == "gripper"
    assert longer.fk([0, 0])[2, 3] == 6.0
    mesh = robot.description.link("link_1").visual[0].mesh
    assert mesh.file() == str(arm.parent / "src/parts-clone/meshes/link.stl")


@needs_xacro
def test_a_package_is_found_above_the_file_and_in_the_environment(arm, monkeypatch):
    inside = arm.parent / "src" / "parts-clone" / "urdf" / "arm.xacro"
    inside.write_text(ARM)
    assert load_robot(inside).dof == 2
    with pytest.raises(
        DescriptionError, match=r"package 'arm_parts' not found; searched:(?s:.*)package_paths"
    ):
        load_robot(arm)
    monkeypatch.setenv("ROS_PACKAGE_PATH", str(arm.parent / "src"))
    assert load_robot(arm).dof == 2


@needs_xacro
def test_what_comes_out_is_what_xacro_itself_writes(tmp_path):
    path = tmp_path / "loop.xacro"
    rows = "".join(f'<xacro:link_of n="{n}"/>' for n in range(12))
    path.write_text(
        HEAD
        + '<xacro:property name="a" value="${[0.1 * k for k in range(12)]}"/><link name="l-1"/>'
        + '<xacro:macro name="link_of" params="n"><link name="l${n}"/><joint name="j${n}" type="continuous">'
        + '<parent link="l${n - 1}"/><child link="l${n}"/><origin xyz="${a[n]} ${sin(n)} 0" rpy="${n} 0 1"/>'
        + f'<axis xyz="0 ${{n % 2}} 1"/></joint></xacro:macro>{rows}</robot>'
    )
    assert to_toml(from_xacro(path)) == to_toml(from_urdf(by_xacro_itself(path)))


@needs_xacro
def test_xacro_elements_are_found_whatever_the_suffix(arm):
    path = arm.with_name("arm.urdf")
    path.write_text(ARM)
    assert load_robot(path, package_paths=[arm.parent / "src"]).dof == 2
    plain = '<!-- <xacro:macro/> --><robot name="r"><link name="a"/></robot>'
    assert not cspace.model.xacro.is_xacro(parse_document(plain.encode()))
    path.write_text(ARM[:-20])
    with pytest.raises(DescriptionError, match="malformed XML"):
        load_robot(path)


@needs_xacro
def test_mjcf_can_be_written_by_macros_too(tmp_path):
    path = tmp_path / "leg.xml.xacro"
    path.write_text(
        '<mujoco xmlns:xacro="http://ros.org/wiki/xacro"><worldbody><xacro:property name="h" value="0.5"/>'
        '<body name="b" pos="0 0 ${h}"><joint name="j"/></body></worldbody></mujoco>'
    )
    robot = load_description(path)
    assert robot.name == "leg"
    assert robot.joint("j").origin[2, 3] == 0.5


@needs_xacro
def test_an_argument_that_the_file_does_not_have_is_refused(arm):
    with pytest.raises(InputError, match=r"no argument 'lenght' .*did you mean 'length'"):
        load_robot(arm, xacro_args={"lenght": 2}, package_paths=[arm.parent / "src"])


def test_arguments_without_a_xacro_file_are_refused(tmp_path):
    for name in ("ur5e", tmp_path / "arm.urdf"):
        (tmp_path / "arm.urdf").write_text('<robot name="r"><link name="a"/></robot>')
        with pytest.raises(InputTypeError, match="xacro_args can only be used with a xacro file"):
            load_robot(name, xacro_args={"length": 1})


@pytest.mark.parametrize(
    ("arguments", "says"), [(["a"], "mapping"), ({1: "a"}, "1: str"), ({"a": []}, "list")]
)
def test_arguments_of_other_types_are_refused(arguments, says, arm):
    with pytest.raises(InputTypeError, match=says):
        from_xacro(arm, xacro_args=arguments)


def test_without_the_package_the_extra_is_named(arm, monkeypatch):
    monkeypatch.setattr("importlib.util.find_spec", lambda name: None)
    with pytest.raises(MissingExtraError, match=r"pip install 'cspace\[xacro\]'"):
        load_robot(arm)
    with pytest.raises(DescriptionError, match="no such file"):
        load_robot(arm.with_name("other.xacro"))


ENTITIES = '<!DOCTYPE x [<!ENTITY a "aaaa"><!ENTITY b "&a;&a;&a;&a;">]>'
TWICE = "".join(
    f'<xacro:macro name="m{k}"><xacro:m{k + 1}/><xacro:m{k + 1}/></xacro:macro>\n' for k in range(40)
)

FAULTS = {
    "malformed": (HEAD + "<link>", 2, "malformed XML"),
    "entities": (ENTITIES + HEAD + "</robot>", 1, "entity declarations are refused"),
    "unknown property": (
        HEAD + '<link name="a"/>\n<xacro:property name="p" value="1"/>\n<link name="${q}"/>',
        4,
        "q",
    ),
    "unknown macro": (HEAD + "\n<xacro:leg/></robot>", 3, "unknown macro name: xacro:leg"),
    "missing parameter": (
        HEAD + '<xacro:macro name="m" params="a"/>\n<xacro:m/></robot>',
        3,
        r"Undefined parameters \[a\]",
    ),
    "missing argument": (HEAD + '<link name="$(arg nothing)"/></robot>', 2, "nothing"),
    "missing include": (HEAD + '\n<xacro:include filename="no.xacro"/></robot>', 3, "no.xacro: no such file"),
    "missing package": (
        HEAD + '<xacro:include filename="$(find no)/a.xacro"/></robot>',
        2,
        "package 'no' not",
    ),
    "no condition": (HEAD + '<xacro:if value="perhaps"/></robot>', 2, "perhaps"),
    "circle": (HEAD + '<xacro:macro name="m"><xacro:m/></xacro:macro><xacro:m/></robot>', 2, "without end"),
    "itself": (HEAD + '<xacro:include filename="bad.xacro"/></robot>', 2, "without end"),
    "no end": (
        HEAD + TWICE + '<xacro:macro name="m40"/><xacro:m0/></robot>',
        None,
        "has more than .* elements",
    ),
    "only macros": (HEAD + '<xacro:macro name="m"/></robot>', 1, "makes no links"),
    "in a macro": (
        HEAD
        + '<xacro:macro name="m" params="t">\n<link name="a"/>\n<joint name="j" type="${t}"/></xacro:macro>'
        '\n<xacro:m t="hinge"/></robot>',
        4,
        "no joint type 'hinge'",
    ),
    "URDF": (
        HEAD + '<link name="a"/>\n<xacro:if value="1"><link name="a"/></xacro:if></robot>',
        3,
        "two links",
    ),
}


@pytest.mark.slow
@needs_xacro
@pytest.mark.parametrize(("text", "line", "says"), FAULTS.values(), ids=FAULTS.keys())
def test_a_fault_is_told_with_file_and_line(text, line, says, tmp_path):
    path = tmp_path / "bad.xacro"
    path.write_text(text if text.endswith(("</robot>", "<link>")) else text + "</robot>")
    with pytest.raises(DescriptionError, match=says) as caught:
        load_description(path)
    assert caught.value.path == str(path)
    assert line is None or caught.value.line == line


@needs_xacro
def test_a_fault_in_an_included_file_is_told_there(arm):
    part = arm.parent / "src/parts-clone/urdf/joint.xacro"
    part.write_text(PART.replace('upper="1"', 'upper="-2"'))
    with pytest.raises(DescriptionError, match="reversed") as caught:
        load_description(arm, package_paths=[arm.parent / "src"])
    assert os.path.samefile(caught.value.path, part)
    assert "<joint" in PART.splitlines()[caught.value.line - 1]


@needs_xacro
def test_a_file_that_computes_for_ever_is_stopped(tmp_path, monkeypatch):
    monkeypatch.setattr(cspace.model.xacro, "XACRO_SECONDS", 0.05)
    path = tmp_path / "slow.xacro"
    path.write_text(HEAD + 1000 * '<link name="${max([k for k in range(9*10**5)])}"/>' + "</robot>")
    with pytest.raises(DescriptionError, match=r"longer than 0\.05 s"):
        load_description(path)


@needs_xacro
def test_modules_of_the_working_folder_are_not_run(tmp_path, monkeypatch):
    for name in ("json.py", "xacro.py", "cspace.py"):
        (tmp_path / name).write_text("raise SystemExit('taken from the working folder')")
    monkeypatch.chdir(tmp_path)
    monkeypatch.syspath_prepend("")  # as in a session typed at the prompt
    (tmp_path / "a.xacro").write_text(HEAD + '<link name="a"/></robot>')
    assert load_description("a.xacro").root == "a"


@pytest.mark.slow
@needs_xacro
def test_damaged_files_end_in_an_error_of_ours_or_in_a_robot(arm):
    rng = np.random.default_rng(0)
    package_paths = [arm.parent / "src"]
    for _ in range(12):
        arm.write_bytes(mutant(rng, [ARM.encode()]))
        exercise_file(lambda path: from_xacro(path, package_paths=package_paths), arm)
    arm.write_text(ARM)
    assert exercise_file(lambda path: from_xacro(path, package_paths=package_paths), arm)


SIZES = {
    "9**9**9": "bits",
    "(9**9)**(9**9)": "bits",
    "-(2**(2**40))": "bits",
    "1 &lt;&lt; 10**9": "bits",
    "max([9**9**9])": "bits",
    "'a' * 10**10": "items",
    "10**10 * [0]": "items",
    "(('a'*1000)*1000)*1000": "items",
    "[k for k in range(10**12)]": "items",
    "max(k for k in range(10**12))": "items",
    "max(range(10**12))": "items",
    "list(range(10**12, 0, -1))": "items",
    "python.sum(python.range(10**12))": "items",
    "len([1 for i in range(10**6) for k in range(10**6)])": "items",
    "len([[0]*10**5 for k in range(10**5)])": "items",
    "len(list(map(str, range(10**9))))": "items",
    "'a'.ljust(10**10)": "items",
    "factorial(10**6)": "bits",
    "math.comb(10**7, 5*10**6)": "bits",
    "math.perm(10**6, 10**6)": "bits",
    "math.prod(python.range(1, 10**5))": "bits",
    "'%1000000000d' % 1": "items",
    "'%*d' % (10**9, 1)": "items",
    "('a'*600000) + ('a'*600000)": "items",
}


@pytest.mark.slow
@needs_xacro
@pytest.mark.parametrize("expression", SIZES)
def test_a_value_that_is_too_large_is_refused_at_once(expression, tmp_path):
    path = tmp_path / "robot.xacro"
    path.write_text(
        f'{HEAD}<xacro:property name="x" value="${{{expression}}}"/><link name="${{x}}"/></robot>'
    )
    with pytest.raises(DescriptionError, match=f"more than .* {SIZES[expression]}"):
        load_description(path)


@needs_xacro
@pytest.mark.parametrize(
    ("expression", "value"),
    [
        ("3**-2 + 2**3", 3**-2 + 8),
        ("1 &lt;&lt; 3", 8),
        ("2*3.5", 7),
        ("2*'1'", 11),
        ("max([k*k for k in range(4) if k != 3])", 4),
        ("int('7'.rjust(2, '1'))", 17),
        ("max(dict(a=3, b=len(range(5))).values())", 5),
    ],
)
def test_operators_keep_their_meaning(expression, value, tmp_path):
    path = tmp_path / "robot.xacro"
    origin = f'<origin xyz="${{{expression}}} 0 0"/>'
    ends = f'<parent link="b"/><child link="t"/>{origin}'
    path.write_text(
        f'{HEAD}<link name="b"/><link name="t"/><joint name="j" type="fixed">{ends}</joint></robot>'
    )
    (joint,) = load_description(path).joints
    np.testing.assert_allclose(joint.origin[0, 3], value, rtol=1e-12)


def nested(*lines):
    """A xacro file of these lines."""
    return HEAD + "".join(lines) + '<link name="a"/></robot>'


# A first one, the opening of the k-th, what is in it ten times, its closing, a use of the last, and what is
# counted.
GROWING = {
    "macros": (
        '<xacro:macro name="m0"><link name="a"/></xacro:macro>',
        *('<xacro:macro name="m{k}">', "<xacro:m{j}/>", "</xacro:macro>", "<xacro:m29/>", "elements"),
    ),
    "blocks": (
        '<xacro:property name="b0"><link name="a"/></xacro:property>',
        *('<xacro:property name="b{k}">', '<xacro:insert_block name="b{j}"/>', "</xacro:property>"),
        *('<xacro:insert_block name="b29"/>', "elements"),
    ),
    "texts": (
        '<xacro:property name="x0" value="aaaa"/>',
        *('<xacro:property name="x{k}" value="', "${{x{j}}}", '"/>', '<link name="${{x29}}"/>', "characters"),
    ),
    "sums": (
        '<xacro:property name="x0" value="aaaa"/>',
        *('<xacro:property name="x{k}" value="${{x0', "+x{j}", '}}"/>', '<link name="${{x29}}"/>', "items"),
    ),
}


@pytest.mark.slow
@needs_xacro
@pytest.mark.parametrize("kind", GROWING)
def test_a_short_file_that_grows_without_measure_is_refused(kind, tmp_path):
    """Ten of each in the one behind it: 10^29 of them, of which a budget stops the expansion."""
    first, opening, inside, closing, last, says = GROWING[kind]
    levels = [(opening + 10 * inside + closing).format(k=k, j=k - 1) for k in range(1, 30)]
    path = tmp_path / "growing.xacro"
    path.write_text(nested(first, *levels, last.format()), encoding="utf-8")
    started = time.perf_counter()
    with pytest.raises(DescriptionError, match=f"more than [0-9]+ {says}, which is the maximum"):
        from_xacro(path)
    assert time.perf_counter() - started < 30.0
