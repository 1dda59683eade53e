import logging
import math
import os
import warnings
from pathlib import Path

import numpy as np
import pytest

import cspace as cs
from cspace.errors import DescriptionError, InputError, InputTypeError
from cspace.model import (
    Description,
    Geometry,
    Joint,
    Link,
    Loop,
    Mesh,
    Mimic,
    from_toml,
    from_urdf,
    to_toml,
    to_urdf,
)
from cspace.model.joint import RESISTANCES
from model.random_robots import random_pose, random_tree, random_values, with_resistances
from oracles.forward import link_poses

ARM = """<?xml version="1.0"?>
<robot name="arm">
  <material name="blue"><color rgba="0 0 1 1"/></material>
  <link name="base"/>
  <link name="upper">
    <inertial>
      <origin xyz="0 0 0.1" rpy="0 0 1.5707963267948966"/>
      <mass value="2"/>
      <inertia ixx="1" ixy="0" ixz="0" iyy="2" iyz="0" izz="3"/>
    </inertial>
    <visual name="tube">
      <origin xyz="0 0 0.2"/>
      <geometry><cylinder radius="0.05" length="0.4"/></geometry>
      <material name="blue"/>
    </visual>
    <collision><geometry><box size="0.1 0.2 0.3"/></geometry></collision>
    <collision><geometry><mesh filename="package://arm/meshes/a.stl" scale="1 2 3"/></geometry></collision>
  </link>
  <link name="hand"/>
  <link name="left"/>
  <link name="right"/>
  <joint name="shoulder" type="revolute">
    <origin xyz="0 0 1" rpy="0.1 0.2 0.3"/>
    <parent link="base"/>
    <child link="upper"/>
    <axis xyz="0 0 2"/>
    <limit lower="-1" upper="2" velocity="3" effort="4"/>
    <dynamics damping="0.5" friction="0.25"/>
  </joint>
  <joint name="flange" type="fixed">
    <origin xyz="0 0 0.4"/>
    <parent link="upper"/>
    <child link="hand"/>
  </joint>
  <joint name="finger" type="prismatic">
    <parent link="hand"/>
    <child link="left"/>
    <limit upper="0.04" velocity="0.1" effort="5"/>
  </joint>
  <joint name="other" type="prismatic">
    <parent link="hand"/>
    <child link="right"/>
    <mimic joint="finger" multiplier="-1" offset="0.01"/>
  </joint>
</robot>
"""


def line_of(text, part):
    return next(i for i, line in enumerate(text.splitlines(), 1) if part in line)


def test_everything_in_a_file_is_read():
    robot = from_urdf(ARM)
    assert robot.name == "arm"
    assert robot.root == "base"
    shoulder = robot.joint("shoulder")
    assert (shoulder.type, shoulder.parent, shoulder.child) == ("revolute", "base", "upper")
    assert (shoulder.lower, shoulder.upper, shoulder.velocity, shoulder.effort) == (-1, 2, 3, 4)
    assert (shoulder.damping, shoulder.friction) == (0.5, 0.25)
    np.testing.assert_array_equal(shoulder.axis, [0, 0, 1])
    finger = robot.joint("finger")
    assert (finger.lower, finger.upper) == (0.0, 0.04)
    np.testing.assert_array_equal(finger.axis, [1, 0, 0])
    other = robot.joint("other")
    assert other.mimic == Mimic("finger", -1.0, 0.01)
    assert (other.lower, other.upper) == (-math.inf, math.inf)
    upper = robot.link("upper")
    np.testing.assert_array_equal(upper.inertial.com, [0, 0, 0.1])
    np.testing.assert_allclose(np.diag(upper.inertial.inertia), [2, 1, 3], atol=1e-15)
    (tube,) = upper.visual
    assert (tube.name, tube.shape, tube.size, tube.color) == ("tube", "cylinder", (0.05, 0.4), (0, 0, 1, 1))
    box, mesh = upper.collision
    assert (box.shape, box.size) == ("box", (0.1, 0.2, 0.3))
    assert (mesh.mesh.uri, mesh.mesh.scale) == ("package://arm/meshes/a.stl", (1, 2, 3))


DRAKE = """<robot name="r" xmlns:drake="http://drake.mit.edu"><link name="a"/><link name="b"/>
  <joint name="j" type="revolute"><parent link="a"/><child link="b"/>
    <limit effort="1" velocity="1"/><dynamics damping="0.1"/></joint>
  <transmission><type>transmission_interface/SimpleTransmission</type>
    <joint name="j"><hardwareInterface>EffortJointInterface</hardwareInterface></joint>
    <actuator name="m"><drake:rotor_inertia value="2e-4"/><drake:gear_ratio value="50"/></actuator>
  </transmission></robot>"""
ROTOR, GEAR = '<drake:rotor_inertia value="2e-4"/>', '<drake:gear_ratio value="50"/>'


def test_the_armature_is_that_of_the_rotor_behind_its_gear():
    """n² J as in Drake: without a ratio n is one, without an inertia there is none."""
    assert from_urdf(DRAKE).joint("j").armature == pytest.approx(50**2 * 2e-4)
    assert from_urdf(DRAKE.replace(GEAR, "")).joint("j").armature == 2e-4
    assert from_urdf(DRAKE.replace(ROTOR, "")).joint("j").armature is None
    given = DRAKE.replace('damping="0.1"', 'damping="0.1" armature="0.7"')
    assert from_urdf(given).joint("j").armature == 0.7  # that of the joint, its rotors included
    more = '</actuator><actuator name="n"><drake:rotor_inertia value="1"/></actuator>'
    two = DRAKE.replace("</actuator>", more)
    assert from_urdf(two).joint("j").armature == pytest.approx(1.5)


def test_a_rotor_whose_ratio_is_elsewhere_is_logged(caplog):
    text = DRAKE.replace(GEAR, "<mechanicalReduction>50</mechanicalReduction>")
    with caplog.at_level(logging.WARNING, "cspace"):
        assert from_urdf(text).joint("j").armature == 2e-4
    assert "the rotor has no <drake:gear_ratio>; its <mechanicalReduction> does not count" in caplog.text
    caplog.clear()
    text = DRAKE.replace('<joint name="j"><h', '<joint name="j"/><joint name="j"><h')
    with caplog.at_level(logging.WARNING, "cspace"):
        assert from_urdf(text).joint("j").armature is None
    assert "a transmission ties 2 joints to its rotors; their inertia is left out" in caplog.text


@pytest.mark.parametrize(
    ("old", "new", "line", "text"),
    [
        ('<joint name="j"><h', '<joint name="jj"><h', 4, "transmission: no joint 'jj'; did you mean 'j'?"),
        ('value="2e-4"', 'value="x"', 6, "value='x' of <drake:rotor_inertia>: expected 1 number"),
        ('value="2e-4"', "", 6, "<drake:rotor_inertia> needs the attribute 'value'"),
        ('value="2e-4"', 'value="-1"', 2, "armature of joint 'j' is -2500; it must not be negative"),
        ('damping="0.1"', 'armatur="0.1"', 3, "no attribute 'armatur'; did you mean 'armature'?"),
    ],
)
def test_a_faulty_rotor_is_refused_with_its_line(old, new, line, text):
    with pytest.raises(DescriptionError) as error:
        from_urdf(DRAKE.replace(old, new))
    assert text in str(error.value)
    assert error.value.line == line


@pytest.mark.parametrize("armature", [None, 0.0, 0.125])
def test_an_armature_is_written_as_drake_reads_it(armature):
    joint = Joint('j "1"', "continuous", "a", "b", armature=armature)
    text = to_urdf(Description("r", (Link("a"), Link("b")), (joint,)))
    assert ("xmlns:drake" in text) == ("transmission" in text) == (armature is not None)
    assert from_urdf(text).joint('j "1"').armature == armature


def test_an_acceleration_limit_of_drake_is_read():
    text = DRAKE.replace('velocity="1"', 'velocity="1" drake:acceleration="7"')
    assert from_urdf(text).joint("j").acceleration == 7.0
    assert (
        from_urdf(text.replace('velocity="1"', 'velocity="1" acceleration="5"')).joint("j").acceleration
        == 5.0
    )


def test_roll_pitch_yaw_turn_about_fixed_axes():
    cx, sx, cy, sy, cz, sz = (f(a) for a in (0.1, 0.2, 0.3) for f in (np.cos, np.sin))
    Rx = np.array([[1, 0, 0], [0, cx, -sx], [0, sx, cx]])
    Ry = np.array([[cy, 0, sy], [0, 1, 0], [-sy, 0, cy]])
    Rz = np.array([[cz, -sz, 0], [sz, cz, 0], [0, 0, 1]])
    np.testing.assert_allclose(from_urdf(ARM).joint("shoulder").origin[:3, :3], Rz @ Ry @ Rx, atol=1e-15)


def test_text_bytes_and_paths_give_the_same_robot(tmp_path):
    path = tmp_path / "arm.urdf"
    path.write_text(ARM)
    texts = {to_urdf(from_urdf(source)) for source in (ARM, "\n\n" + ARM, ARM.encode(), path, str(path))}
    assert len(texts) == 1


@pytest.mark.parametrize("kind", ["revolute", "continuous", "prismatic", "fixed", "floating", "planar"])
def test_every_joint_type_is_read_and_written(kind):
    joint = Joint("j", kind, "a", "b", random_pose(np.random.default_rng(0)), (0, 0, 1))
    back = from_urdf(to_urdf(Description("r", (Link("a"), Link("b")), (joint,)))).joint("j")
    assert back.type == kind
    np.testing.assert_allclose(back.origin, joint.origin, atol=1e-15)
    assert (back.lower, back.upper, back.velocity) == (-math.inf, math.inf, math.inf)


@pytest.mark.parametrize("seed", range(10))
def test_a_round_trip_keeps_every_pose(seed):
    rng = np.random.default_rng(seed)
    robot = random_tree(rng, n=15, kinds=("revolute", "continuous", "prismatic", "fixed", "floating"))
    robot = with_resistances(rng, robot)
    back = from_urdf(to_urdf(robot))
    q = random_values(rng, robot)
    mine, theirs = link_poses(back, q), link_poses(robot, q)
    for name, pose in theirs.items():
        np.testing.assert_allclose(mine[name], pose, atol=1e-12)
    for joint in robot.joints:
        other = back.joint(joint.name)
        for field in ("lower", "upper", "velocity", "effort", "acceleration", "jerk", "mimic", *RESISTANCES):
            assert getattr(other, field) == getattr(joint, field), (joint.name, field)
    for link in robot.links:
        inertial = back.link(link.name).inertial
        assert (inertial is None) == (link.inertial is None)
        if inertial is not None:
            assert inertial.mass == link.inertial.mass
            np.testing.assert_array_equal(inertial.inertia, link.inertial.inertia)


@pytest.mark.parametrize("pitch", [math.pi / 2, -math.pi / 2, math.pi / 2 - 1e-9, math.pi / 2 - 1e-7, 1.5707])
def test_gimbal_lock_keeps_the_pose(pitch):
    text = f"""<robot name="r"><link name="a"/><link name="b"/><joint name="j" type="fixed">
        <origin rpy="0.7 {pitch!r} -1.1"/><parent link="a"/><child link="b"/></joint></robot>"""
    origin = from_urdf(text).joint("j").origin
    np.testing.assert_allclose(from_urdf(to_urdf(from_urdf(text))).joint("j").origin, origin, atol=4e-16)


def test_shapes_are_written_and_read_back():
    shapes = (
        Geometry("sphere", (0.1,), random_pose(np.random.default_rng(1)), "s", None, (0.1, 0.2, 0.3, 1.0)),
        Geometry("capsule", (0.1, 0.5)),
        Geometry("mesh", (), mesh=Mesh("a&b.stl", (0.001, 0.001, 0.001))),
    )
    robot = Description('the "robot" <1>', (Link("a\nb", visual=shapes, collision=shapes[:1]),))
    back = from_urdf(to_urdf(robot))
    assert back.name == robot.name
    link = back.link("a\nb")
    for mine, theirs in zip(link.visual, shapes, strict=True):
        assert (mine.shape, mine.size, mine.name, mine.color) == (
            theirs.shape,
            theirs.size,
            theirs.name,
            theirs.color,
        )
        np.testing.assert_allclose(mine.origin, theirs.origin, atol=1e-15)
    assert link.visual[2].mesh.uri == "a&b.stl"
    assert link.visual[2].mesh.scale == (0.001, 0.001, 0.001)


def test_what_urdf_cannot_hold_is_refused():
    loop = Loop("l", "revolute", "a", "b")
    robot = Description("r", (Link("a"), Link("b")), (Joint("j", "revolute", "a", "b"),), (loop,))
    with pytest.raises(InputError, match="closed loops"):
        to_urdf(robot)
    with pytest.raises(InputError, match="XML does not allow"):
        to_urdf(Description("r\x01", (Link("a"),)))


FAULTS = {
    "malformed": ("</robot>", "</robt>", "</robt>", "malformed XML: mismatched tag"),
    "unclosed": ("</robot>\n", "", None, "malformed XML: no element found"),
    "unknown joint type": ('type="fixed"', 'type="fixt"', '"flange"', "no joint type 'fixt'.*mean 'fixed'"),
    "zero axis": ("0 0 2", "0 0 0", "<axis", "axis must not be zero"),
    "short axis": ("0 0 2", "0 2", "<axis", "holds 2 numbers, expected 3"),
    "limits upside down": ('upper="2"', 'upper="-2"', '"shoulder"', "reversed"),
    "nan": ('xyz="0 0 1"', 'xyz="0 0 nan"', 'xyz="0 0 nan"', "must be finite"),
    "inf": ('mass value="2"', 'mass value="inf"', "inf", "must be finite"),
    "no number": ('lower="-1"', 'lower="down"', '"down"', "expected 1 number"),
    "python number": ('lower="-1"', 'lower="-1_0"', "1_0", "expected 1 number"),
    "negative mass": ('mass value="2"', 'mass value="-2"', "inertial>", "must not be negative"),
    "missing parent": ('    <parent link="upper"/>\n', "", '"flange"', "needs <parent"),
    "missing child": ('    <child link="upper"/>\n', "", '"shoulder"', "needs <child"),
    "unknown parent": ('parent link="upper"', 'parent link="uper"', '"flange"', "did you mean 'upper'"),
    "unknown child": ('child link="left"', 'child link="lift"', '"finger"', "did you mean 'left'"),
    "two roots": (
        '<link name="base"/>',
        '<link name="base"/><link name="x"/>',
        '"x"',
        "2 roots: 'base', 'x'",
    ),
    "cycle": ('parent link="base"', 'parent link="hand"', None, "cycle"),
    "two parents": ('child link="right"', 'child link="left"', '"other"', "child of two joints"),
    "same link twice": ('link name="right"', 'link name="left"', 'link name="left"/>\n  <joint', "two links"),
    "same joint twice": ('name="other"', 'name="finger"', None, "two joints .* 'finger'"),
    "nameless link": ('link name="hand"', "link", "<link/>", "needs the attribute 'name'"),
    "nameless joint": ('joint name="flange" type', "joint type", "joint type", "needs the attribute 'name'"),
    "typeless joint": (' type="fixed"', "", '"flange"', "needs the attribute 'type'"),
    "unknown shape": ("<box size", "<bax size", "<bax", "no shape 'bax'.*mean 'box'"),
    "no shape": ('<cylinder radius="0.05" length="0.4"/>', "", "<visual", "needs a <geometry>"),
    "shape without size": (' length="0.4"', "", "<cylinder", "needs the attribute 'length'"),
    "negative size": ('length="0.4"', 'length="-0.4"', "<cylinder", "must not be negative"),
    "mimic of nothing": ('mimic joint="finger"', 'mimic joint="fingr"', '"other"', "did you mean 'finger'"),
    "no mass": ('<mass value="2"/>', "", "<inertial", "needs <mass"),
    "xacro": (
        "<link name=",
        "<xacro:include/><link name=",
        "xacro:include",
        "load_robot and model.from_xacro expand",
    ),
}


def in_a_row(multipliers, offset=0.0):
    """A robot whose joint k mimics joint k + 1."""
    n = len(multipliers)
    text = "".join(f"<link name='l{k}'/>" for k in range(n + 2))
    for k in range(n + 1):
        follows = (
            f"<mimic joint='j{k + 1}' multiplier='{multipliers[k]}' offset='{offset}'/>" if k < n else ""
        )
        ends = f"<parent link='l{k}'/><child link='l{k + 1}'/>{follows}"
        text += f"<joint name='j{k}' type='continuous'>{ends}</joint>"
    return f"<robot name='row'>{text}</robot>"


@pytest.mark.parametrize(
    "multipliers", [[1e12] * 39, [1e12, 1e-9, 1e10, 1e3], [1e7, 1e7], [-1e7, 1e6], [1e6, 1e6, 10.0]]
)
@pytest.mark.parametrize("turned", [False, True])
def test_multipliers_in_a_row_are_bounded_as_one_is(multipliers, turned):
    row = multipliers[::-1] if turned else multipliers
    with pytest.raises(
        DescriptionError, match=r"joint 'j\d+' mimics joints that mimic .*no robot has numbers"
    ):
        from_urdf(in_a_row(row))
    with pytest.raises(DescriptionError, match="combine to"):
        from_urdf(in_a_row([1e7, 1.0], offset=1e7))
    q = from_urdf(in_a_row([1e-12] * 300 + [1e6, 1e-6, 1e12]))
    assert np.isfinite(cs.Robot(q).fk([0.3])).all()


@pytest.mark.parametrize("fault", FAULTS)
def test_a_fault_is_told_with_file_and_line(fault, tmp_path):
    old, new, where, says = FAULTS[fault]
    assert old in ARM
    text = ARM.replace(old, new, 1)
    path = tmp_path / "bad.urdf"
    path.write_text(text)
    with pytest.raises(DescriptionError, match=says) as caught:
        from_urdf(path)
    assert caught.value.path == str(path)
    assert str(caught.value).startswith(f"{path}:{caught.value.line}: ")
    if where is not None and "\n" not in where:
        assert caught.value.line == line_of(text, where)
    if not text.startswith(" "):
        with pytest.raises(DescriptionError) as again:
            from_urdf("\n\n" + text)
        assert again.value.line == caught.value.line + 2


@pytest.mark.parametrize("name", ["malformed", "same link twice", "same joint twice", "cycle"])
def test_the_line_is_that_of_the_second_or_the_closing_one(name):
    old, new, _, _ = FAULTS[name]
    text = ARM.replace(old, new, 1)
    with pytest.raises(DescriptionError) as caught:
        from_urdf(text)
    line = text.splitlines()[caught.value.line - 1]
    expected = {
        "malformed": "</robt>",
        "same link twice": '<link name="left"/>',
        "same joint twice": '<joint name="finger"',
        "cycle": '<joint name="shoulder"',
    }
    assert expected[name] in line
    assert "same" not in name or caught.value.line > line_of(text, expected[name])


LAUGHS = (
    '<?xml version="1.0"?><!DOCTYPE robot [<!ENTITY a "ha">'
    + "".join(f'<!ENTITY a{i} "{f"&a{i - 1};" * 10}">' for i in range(1, 12)).replace("&a0;", "&a;")
    + ']><robot name="r"><link name="&a11;"/></robot>'
)


@pytest.mark.parametrize(
    ("text", "says"),
    [
        (LAUGHS, "entity declarations are refused"),
        ('<!DOCTYPE r [<!ENTITY x SYSTEM "file:///etc/hostname">]><robot name="&x;"/>', "refused"),
        ("<robot>" + "<a>" * 100_000, "nested more than"),
        ("<robot>" + "<a>" * 100_000 + "</a>" * 100_000 + "</robot>", "nested more than"),
        ("<robot name='r'/>", "no links"),
        ("<mujoco/>", "MJCF"),
        ("<sdf/>", "SDF"),
        ("<html/>", "root element is <html>"),
        ("<robot name='r'><link name='a'/>&undefined;</robot>", "undefined entity"),
        ("<?xml version='1.0' encoding='klingon'?><robot/>", "unknown encoding"),
        ("<?xml version='1.0' encoding='utf-7'?><robot/>", "XML"),
        ("<", "malformed XML"),
    ],
)
def test_hostile_and_foreign_documents_are_refused_at_once(text, says):
    with pytest.raises(DescriptionError, match=says):
        from_urdf(text)


def test_a_huge_file_is_refused_before_it_is_read(tmp_path):
    path = tmp_path / "huge.urdf"
    with open(path, "wb") as file:
        file.truncate(2**31)
    with pytest.raises(DescriptionError, match="the maximum is"):
        from_urdf(path)


@pytest.mark.parametrize(
    ("content", "says"),
    [
        (b"", "no element found"),
        (b"\x89PNG\r\n\x1a\n\x00\x00\x00\rIHDR", "malformed XML"),
        (b'{"robot": 1}', "malformed XML"),
        (None, "no such file"),
        ("folder", "this is a folder"),
    ],
)
def test_a_file_that_is_no_robot_is_refused(content, says, tmp_path):
    path = tmp_path / "thing.urdf"
    if content == "folder":
        path.mkdir()
    elif content is not None:
        path.write_bytes(content)
    with pytest.raises(DescriptionError, match=says) as caught:
        from_urdf(path)
    assert str(path) in str(caught.value)


def mesh_of(path, **more):
    return from_urdf(path, **more).link("upper").collision[1].mesh


@pytest.fixture
def package(tmp_path, monkeypatch):
    """The robot file in one folder, and a function that puts its package into another."""
    for variable in ("ROS_PACKAGE_PATH", "AMENT_PREFIX_PATH", "CMAKE_PREFIX_PATH"):
        monkeypatch.delenv(variable, raising=False)
    path = tmp_path / "robots" / "here" / "arm.urdf"
    path.parent.mkdir(parents=True)
    path.write_text(ARM)

    def put(*folders):
        mesh = tmp_path.joinpath(*folders, "arm", "meshes", "a.stl")
        mesh.parent.mkdir(parents=True)
        mesh.touch()
        return str(mesh)

    return path, put, tmp_path


def test_packages_are_found_beside_the_file_and_above_it(package):
    path, put, _ = package
    far = put()
    assert mesh_of(path).file() == far
    near = put("robots", "here")
    assert mesh_of(path).file() == near


def test_packages_are_found_by_argument_first_whether_it_holds_or_is_the_package(package):
    path, put, tmp = package
    put("robots", "here")
    mine = put("mine")
    assert mesh_of(path, package_paths=[tmp / "mine"]).file() == mine
    assert mesh_of(path, package_paths=[tmp / "mine" / "arm"]).file() == mine


@pytest.mark.parametrize("paths", ["/opt/robots", Path("/opt/robots"), b"/opt/robots", 5, [5], None])
@pytest.mark.parametrize("read", [from_urdf, from_toml])
def test_package_paths_that_are_no_list_of_folders_are_refused(read, paths):
    text = ARM if read is from_urdf else to_toml(from_urdf(ARM))
    with pytest.raises(InputTypeError, match="package_paths is a list of folders"):
        read(text, package_paths=paths)


@pytest.mark.parametrize(
    ("variable", "inner"),
    [("ROS_PACKAGE_PATH", ()), ("AMENT_PREFIX_PATH", ("share",)), ("CMAKE_PREFIX_PATH", ("share",))],
)
def test_packages_are_found_through_the_environment(package, monkeypatch, variable, inner):
    path, put, tmp = package
    mesh = put("ros", *inner)
    monkeypatch.setenv(variable, os.pathsep.join(["/nowhere", str(tmp / "ros")]))
    assert mesh_of(path).file() == mesh


def test_a_missing_mesh_is_an_error_only_when_asked_for_and_names_all_places(package, monkeypatch):
    path, _, tmp = package
    monkeypatch.setenv("ROS_PACKAGE_PATH", "/ros_here")
    monkeypatch.setenv("AMENT_PREFIX_PATH", "/ament_here")
    monkeypatch.setenv("CMAKE_PREFIX_PATH", "/cmake_here")
    mesh = mesh_of(path, package_paths=["/given"])
    with pytest.raises(DescriptionError) as caught:
        mesh.file()
    rest = os.path.join("arm", "meshes", "a.stl")
    for place in ("/given", path.parent, tmp, "/ros_here", "/ament_here/share", "/cmake_here/share"):
        assert os.path.join(str(place), rest) in str(caught.value)


def test_relative_and_file_names_need_no_package(tmp_path):
    (tmp_path / "a b.stl").touch()
    for uri in ("a b.stl", f"file://{tmp_path}/a%20b.stl", str(tmp_path / "a b.stl")):
        path = tmp_path / "arm.urdf"
        path.write_text(ARM.replace("package://arm/meshes/a.stl", uri))
        assert mesh_of(path).file() == str(tmp_path / "a b.stl")


SLIPS = {
    "orgin": ('<orgin xyz="0.25 0 0"/>', "<joint> has no <orgin>; did you mean <origin>"),
    "xzy": ('<origin xzy="0.25 0 0"/>', "<origin> has no attribute 'xzy'; did you mean 'xyz'"),
    "axes": ('<axes xyz="0 1 0"/>', "<joint> has no <axes>; did you mean <axis>"),
    "uper": ('<limit lower="-1" uper="2"/>', "<limit> has no attribute 'uper'; did you mean 'upper'"),
    "limits": ('<limits lower="-1" upper="2"/>', "<joint> has no <limits>; did you mean <limit>"),
}


@pytest.mark.parametrize("case", SLIPS)
def test_a_slip_of_the_pen_is_named_with_its_line(case):
    line, words = SLIPS[case]
    text = f"""<robot name="r"><link name="a"/><link name="b"/>
<joint name="tilt" type="revolute"><parent link="a"/><child link="b"/>
{line}
</joint></robot>"""
    with pytest.raises(DescriptionError) as caught:
        from_urdf(text)
    assert words in str(caught.value)
    assert "'tilt'" in str(caught.value)
    assert caught.value.line == 3


LIMITED = """<robot name="r"><link name="a"/><link name="b"/><link name="c"/>
<joint name="j" type="{kind}"><parent link="a"/><child link="b"/>
<limit lower="{lower}" upper="{upper}"/></joint>
<joint name="k" type="{kind}"><parent link="b"/><child link="c"/>
<limit lower="-99" upper="{upper}"/></joint></robot>"""


@pytest.mark.parametrize(("lower", "upper"), [(-180, 180), (-90, 30), (0, 57.3), (-360, 0), (-720, 720)])
def test_limits_in_degrees_are_told_once(lower, upper, tmp_path):
    (tmp_path / "arm.urdf").write_text(LIMITED.format(kind="revolute", lower=lower, upper=upper))
    said = rf"arm.urdf:2: joint 'j' has the limits {lower:g} … {upper:g} rad, .*are these degrees"
    with pytest.warns(UserWarning, match=said) as caught:
        robot = from_urdf(tmp_path / "arm.urdf")
    assert len(caught) == 1
    assert (robot.joints[0].lower, robot.joints[0].upper) == (lower, upper)


@pytest.mark.parametrize("kind", ["revolute", "prismatic", "continuous"])
def test_limits_of_some_turns_and_of_millions_are_left_alone(kind):
    for size in (1, 6.4, 12.6, 18.9, 1e4, 1e16) if kind == "revolute" else (180, 1000):
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            robot = from_urdf(LIMITED.format(kind=kind, lower=-size, upper=size).replace("-99", f"-{size}"))
        limits = {(joint.lower, joint.upper) for joint in robot.joints}
        assert limits == {(-math.inf, math.inf) if kind == "continuous" else (-size, size)}


def test_extensions_are_left_alone():
    text = """<robot name="r"><link name="a"><self_collision_checking/></link><link name="b"/>
<joint name="j" type="revolute"><parent link="a"/><child link="b"/><drake:orgin/><hardwareInterface/>
<limit lower="-1" upper="2" effort="1" velocity="1" soft_lower="-0.9"/></joint><gazebo/></robot>"""
    assert from_urdf(text).joints[0].upper == 2


def test_a_package_is_known_by_its_package_xml_too(tmp_path):
    """A clone of another name than its package: above the file, and inside a folder of packages."""
    clone = tmp_path / "ws" / "my-clone"
    for folder in ("urdf", "meshes"):
        (clone / folder).mkdir(parents=True)
    (clone / "package.xml").write_text("<package><name>arm</name></package>")
    (clone / "meshes" / "a.stl").write_text("solid")
    (clone / "urdf" / "arm.urdf").write_text(ARM)
    mesh = from_urdf(clone / "urdf" / "arm.urdf").link("upper").collision[1].mesh
    assert mesh.file() == str(clone / "meshes" / "a.stl")
    away = from_urdf(ARM, package_paths=[tmp_path / "ws"]).link("upper").collision[1].mesh
    assert away.file() == mesh.file()
    (clone / "package.xml").write_text("<package><name>other</name></package>")
    with pytest.raises(DescriptionError, match="not found; searched"):
        mesh.file()
    (clone / "package.xml").write_bytes(b"\xff\xfe<name>")
    with pytest.raises(DescriptionError, match="not found; searched"):
        mesh.file()


def test_three_slashes_after_package_are_two(tmp_path):
    (tmp_path / "arm" / "meshes").mkdir(parents=True)
    (tmp_path / "arm" / "meshes" / "a.stl").write_text("solid")
    assert Mesh("package:///arm/meshes/a.stl", package_paths=(str(tmp_path),)).file().endswith("a.stl")
