import os
import threading
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

import cspace as cs
from cspace.errors import CspaceError, DescriptionError, InputError, InputTypeError, UnknownNameError
from cspace.export.languages import SUFFIXES
from cspace.files import write_text
from cspace.model import to_toml, to_urdf
from cspace.robot import Robot
from cspace.robots import load_description, load_robot
from cspace.spatial import pose


def test_a_name_and_its_files_give_the_same_robot(tmp_path):
    robot = load_robot("ur5e")
    q = np.array([0.1, -0.7, 1.1, 0.4, -0.2, 0.9])
    written = {"a.urdf": to_urdf, "b.xml": to_urdf, "c.toml": to_toml, "d": to_urdf, "E.URDF": to_urdf}
    for name, write in written.items():
        path = tmp_path / name
        path.write_text(write(robot.description))
        for source in (path, str(path)):
            np.testing.assert_allclose(load_robot(source).fk(q), robot.fk(q), atol=1e-12)


def test_base_and_tip_choose_the_chain():
    robot = load_robot("ur5e", base="shoulder_link", tip="wrist_1_link")
    assert robot.dof == 3
    assert (robot.base, robot.tip) == ("shoulder_link", "wrist_1_link")
    with pytest.raises(UnknownNameError, match="did you mean 'wrist_1_link'"):
        load_robot("ur5e", tip="wrist1_link")


def test_a_base_that_floats_is_asked_for(tmp_path):
    path = tmp_path / "arm.urdf"
    locked = load_robot("ur5e")
    locked.to_urdf(path)
    q, T_world_base = np.linspace(-1, 1, 6), pose((1, 2, 3), rpy=(0.1, 0.2, 0.3))
    for robot in (
        load_robot("ur5e", floating=True),
        load_robot(path, floating=True),
        Robot.from_urdf(path, floating=True),
        Robot.from_toml(locked.to_toml(), floating=True),
    ):
        assert (robot.floating, robot.dof, len(robot.joint_names)) == (True, 12, 6)
        expected = T_world_base @ locked.fk(q)
        np.testing.assert_allclose(robot.fk(q, T_world_base=T_world_base), expected, atol=1e-14)
    assert load_robot("ur5e", floating=False).dof == load_robot("ur5e").dof == 6


@pytest.mark.parametrize("name", ["arm.urdf", "arm.toml"])
def test_a_robot_is_written_to_a_path_whole_or_not_at_all(name, tmp_path):
    path, robot = tmp_path / name, load_robot("ur5e")
    write = robot.to_urdf if name.endswith("urdf") else robot.to_toml
    for target in (path, str(path)):
        assert write(target) == write() == path.read_text(encoding="utf-8")
    q = np.linspace(-1, 1, 6)
    np.testing.assert_allclose(load_robot(path).fk(q), robot.fk(q), atol=1e-14)
    with pytest.raises(InputError, match=r"nowhere.*cannot be written: No such file"):
        write(tmp_path / "nowhere" / name)
    with pytest.raises(InputError, match="cannot be written"):
        write(tmp_path)
    with pytest.raises(InputTypeError, match="given by its path"):
        write(3.5)
    assert [entry.name for entry in tmp_path.iterdir()] == [name]


@pytest.mark.parametrize("ending", ["x" * 300, "x" * 300 + "/a", "a\0b", "y/" * 3000 + "a"])
def test_a_path_that_no_folder_allows_is_named(ending, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    robot, grid = load_robot("planar_2r"), cs.OccupancyGrid([[0, 1]])
    world, made = cs.PolygonWorld([], (0, 0, 1, 1)), robot.export("c")
    for write, suffix in [
        *((lambda p, lang=lang: robot.export(lang, p), ending) for lang, ending in SUFFIXES.items()),
        (robot.to_urdf, ".urdf"),
        (robot.to_toml, ".toml"),
        (grid.save_ros, ".yaml"),
        (world.save_geojson, ".json"),
        (world.save_text, ".txt"),
        (made.write_example, ".c"),
        (made.write, ""),
    ]:
        with pytest.raises(InputError) as caught:
            write(ending + suffix)
        assert len(str(caught.value)) < 500
    assert list(tmp_path.iterdir()) == []


def test_of_two_files_with_one_name_too_long_none_is_written(tmp_path):
    longest = os.pathconf(tmp_path, "PC_NAME_MAX")
    with pytest.raises(InputError, match=r"cpp cannot be written: .*; choose another path"):
        load_robot("planar_2r").export("c", tmp_path / ("x" * (longest - 2) + ".h"))
    assert list(tmp_path.iterdir()) == []


def test_a_name_may_be_as_long_as_the_folder_allows(tmp_path):
    path = tmp_path / ("x" * 250 + ".urdf")
    load_robot("planar_2r").to_urdf(path)
    assert load_robot(path).dof == 2


def test_two_threads_that_write_one_file_leave_one_of_both_whole(tmp_path):
    texts = [to_toml(load_description(name)) for name in ("panda", "planar_1r")]
    path, start = tmp_path / "arm.toml", threading.Barrier(4)

    def write(k):
        start.wait()
        for _ in range(25):
            write_text(path, texts[k % 2])

    with ThreadPoolExecutor(4) as pool:
        list(pool.map(write, range(4)))  # raises what a thread raised
    assert path.read_text(encoding="utf-8") in texts
    assert list(tmp_path.iterdir()) == [path]


def test_a_file_beside_is_found_without_a_separator(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "mine.urdf").write_text(to_urdf(load_description("planar_2r")))
    (tmp_path / "plain").write_text(to_urdf(load_description("planar_2r")))
    assert load_robot("mine.urdf").dof == load_robot("plain").dof == 2
    os.mkdir(tmp_path / "ur5e")  # a folder of the same name does not hide the robot
    assert load_robot("ur5e").dof == 6


@pytest.mark.parametrize(
    ("name", "says"),
    [
        ("nothing.urdf", "no such file"),
        ("nothing.toml", "no such file"),
        ("arm.xacro", "no such file"),
        ("arm.urdf.xacro", "no such file"),
        ("arm.mjcf", "no such file"),
        ("arm.srdf", "give the URDF"),
        ("a/b/c", "no such file"),
    ],
)
def test_a_path_that_cannot_be_read_says_why(name, says, tmp_path):
    with pytest.raises(DescriptionError, match=says) as caught:
        load_robot(str(tmp_path / name))
    assert caught.value.path == str(tmp_path / name)


@pytest.mark.parametrize(
    ("name", "content", "says"),
    [
        ("a.png", b"\x89PNG\r\n\x1a\n\x00", r"starts with b'\\x89PNG.*URDF .*or TOML"),
        ("a.json", b'{"a": 1}', "starts with b'{"),
        ("a.txt", b"", "starts with b''"),
        ("a.xml", b"<mujoco><body/></mujoco>", "<mujoco> has no <body>; it stands elsewhere"),
        ("a.xml", b"<html/>", "root element is <html>"),
        ("a.urdf", b'<robot name="x"><link name="a"/></robo>', "a.urdf:1: malformed XML"),
        ("a.toml", b"a = 1", "must contain one of"),
    ],
)
def test_a_file_that_is_no_robot_says_so(name, content, says, tmp_path):
    path = tmp_path / name
    path.write_bytes(content)
    with pytest.raises(DescriptionError, match=says):
        load_robot(path)


def test_a_folder_and_a_branching_robot_and_other_types_are_refused(tmp_path):
    with pytest.raises(DescriptionError, match="this is a folder"):
        load_robot(tmp_path)
    with pytest.raises(InputTypeError, match="name or the path of a robot, got int"):
        load_robot(7)
    with pytest.raises(InputTypeError, match="got NoneType"):
        load_robot(None)
    with pytest.raises(CspaceError):
        load_robot("a\0b")
    with pytest.raises(CspaceError):
        load_robot("a\0b.urdf")
    with pytest.raises(UnknownNameError):
        load_robot("")


def test_where_the_tip_is_a_choice_ik_would_need_it_and_the_leaves_are_named(tmp_path):
    text = """<robot name="two"><link name="a"/><link name="b"/><link name="c"/>
      <joint name="l" type="continuous"><parent link="a"/><child link="b"/><axis xyz="0 0 1"/></joint>
      <joint name="r" type="continuous"><parent link="a"/><child link="c"/><axis xyz="0 0 1"/></joint>
      </robot>"""
    path = tmp_path / "two.urdf"
    path.write_text(text)
    tree = load_robot(path)
    assert tree.tip is None
    assert load_robot(path, tip="c").dof == 1
    with pytest.raises(InputError, match="'b', 'c'"):
        load_robot(path, base="a")
