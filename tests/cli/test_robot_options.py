"""What a robot's file may need besides: a calibration, arguments of xacro, packages; and MJCF."""

from __future__ import annotations

import numpy as np
import pytest

import cspace as cs
from cli.run import cspace
from model.mjcf.models import ARM
from model.test_calibration import E_SERIES, frames, perturbed, text_of

XACRO = """<robot name="arm" xmlns:xacro="http://ros.org/wiki/xacro"><xacro:arg name="z" default="1"/>
<xacro:include filename="$(find parts)/links.xacro"/>
<joint name="j" type="continuous">
<parent link="a"/><child link="b"/><origin xyz="0 0 $(arg z)"/></joint></robot>"""

GRIPPER = """<robot name="arm"><link name="base"/><link name="palm"/><link name="moving_jaw"/>
<joint name="turn" type="continuous"><parent link="base"/><child link="palm"/></joint>
<joint name="thumb" type="continuous"><parent link="palm"/><child link="moving_jaw"/></joint></robot>"""

CALLS = [
    "info {}",
    "fk {} 0 0 0 0 0 0",
    "ik {} --xyz 0.3 0.2 0.4 --rpy 0 3 0",
    "jacobian {} 0 0 0 0 0 0",
    "dh {}",
]


@pytest.fixture
def calibration(tmp_path):
    path = tmp_path / "arm.yaml"
    path.write_text(text_of(perturbed(frames(*E_SERIES["ur5e"]), np.random.default_rng(0))))
    return path


@pytest.mark.parametrize("line", CALLS)
def test_every_verb_takes_a_calibration(line, calibration):
    nominal, measured = cspace(line.format("ur5e")), cspace(line.format("ur5e"), "--calibration", calibration)
    assert (nominal.code, measured.code) == (0, 0), measured.err
    assert nominal.out != measured.out


def test_a_calibrated_arm_is_the_library_s(calibration):
    found = cspace("fk ur5e --json 0.1 -1 1.2 0.3 -0.4 0.5", "--calibration", calibration).json
    T = cs.load_robot("ur5e", calibration=calibration).fk([0.1, -1, 1.2, 0.3, -0.4, 0.5])
    np.testing.assert_array_equal(found["matrix"], T)


def test_a_bad_calibration_is_a_bad_file(tmp_path, calibration):
    result = cspace("info ur5e --calibration", tmp_path / "none.yaml")
    assert result.code == 3
    assert "none.yaml: no such file" in result.err
    result = cspace("info ur10e", "--calibration", calibration)
    assert result.code == 3
    assert f"{calibration}: this calibration is not that of" in result.err


def test_a_gripper_taken_for_the_last_joint_is_pointed_out(tmp_path):
    path = tmp_path / "arm.urdf"
    path.write_text(GRIPPER)
    found = cspace(f"info {path}").out
    assert (
        "tip       moving_jaw (thumb seems to belong to a gripper; --tip palm ends the arm before it)"
        in found
    )
    assert "seems" not in cspace(f"info {path} --tip moving_jaw").out
    assert "seems" not in cspace(f"info {path} --tip palm").out


def test_a_named_pose_stands_for_the_values():
    q = cs.load_robot("panda").named_poses["ready"]
    for verb in ("fk", "jacobian"):
        typed = cspace(f"{verb} panda --json", *map(repr, q.tolist()))
        assert cspace(f"{verb} panda --pose ready --json").out == typed.out
        assert cspace(f"{verb} panda --pose ready --deg --json").out == typed.out
    unknown = cspace("fk panda --pose redy")
    assert (unknown.code, "did you mean 'ready'" in unknown.err) == (2, True)
    both = cspace("fk panda 0 0 0 0 0 0 0 --pose ready")
    assert (both.code, "not both" in both.err) == (2, True)


def test_no_arm_of_the_catalogue_ends_in_a_gripper():
    for row in cs.robots.search(""):
        assert "seems" not in cspace(f"info {row.name}").out, row.name


def test_mjcf_is_a_file_like_any_other(tmp_path):
    path = tmp_path / "arm.xml"
    path.write_text(ARM)
    assert [joint["name"] for joint in cspace(f"info {path} --tip hand_site --json").json["joints"]] == [
        *("pan", "lift", "elbow", "grip")
    ]
    path.write_text(ARM.replace('name="pan" axis="0 1 0"', 'name="pan" axis="0 0 0"'))
    result = cspace(f"info {path}")
    assert result.code == 3
    assert result.err.startswith(f"cspace: {path}:25: axis of joint 'pan'")


def test_xacro_takes_arguments_and_packages(tmp_path):
    pytest.importorskip("xacro")
    (tmp_path / "src" / "parts").mkdir(parents=True)
    (tmp_path / "src" / "parts" / "links.xacro").write_text('<r><link name="a"/><link name="b"/></r>')
    path = tmp_path / "arm.urdf.xacro"
    path.write_text(XACRO)
    package = f"--package-path {tmp_path / 'src'}"
    for word, height in (("", 1), ("--xacro-arg z=2", 2), ("--xacro-arg z:=-3", -3)):
        assert cspace(f"fk {path} 0 --json {package} {word}").json["xyz"] == [0, 0, height]
    missing = cspace(f"fk {path} 0")
    assert missing.code == 3
    assert f"{path}:2: package 'parts' not found; searched:" in missing.err
    assert cspace(f"fk {path} 0 {package} --xacro-arg y=2").code == 2
    assert "not of the form NAME=VALUE" in cspace(f"fk {path} 0 --xacro-arg y").err


def test_without_the_extra_xacro_ends_with_its_name(tmp_path, monkeypatch):
    path = tmp_path / "arm.urdf.xacro"
    path.write_text(XACRO)
    monkeypatch.setattr("importlib.util.find_spec", lambda name, *rest: None)
    result = cspace(f"info {path}")
    assert result.code == 4
    assert "pip install 'cspace[xacro]'" in result.err
