"""Robots from files: chains, trees with a chosen tip, names and paths alike."""

from __future__ import annotations

import numpy as np
import pytest

from cli import schema
from cli.run import cspace

TREE = """<robot name="two_hands">
<link name="base"/><link name="torso"/><link name="left"/><link name="right"/>
<joint name="lift" type="prismatic"><parent link="base"/><child link="torso"/>
<axis xyz="0 0 1"/><limit lower="0" upper="0.5" velocity="1" effort="10"/></joint>
<joint name="l" type="continuous"><parent link="torso"/><child link="left"/>
<origin xyz="0 0.2 0"/><axis xyz="0 0 1"/></joint>
<joint name="r" type="continuous"><parent link="torso"/><child link="right"/>
<origin xyz="0 -0.2 0"/><axis xyz="0 0 1"/></joint>
</robot>"""


@pytest.fixture
def tree(tmp_path):
    path = tmp_path / "two_hands.urdf"
    path.write_text(TREE)
    return str(path)


@pytest.mark.parametrize("line", ["fk {} 0 0 0", "ik {} --xyz 0 0 0", "dh {}", "jacobian {} 0 0 0"])
def test_a_tree_asks_for_a_tip_and_names_the_choices(tree, line):
    result = cspace(line.format(tree))
    assert result.code == 2
    assert "--tip" in result.err
    assert "left" in result.err
    assert "right" in result.err


def test_with_a_tip_it_is_a_chain(tree):
    found = cspace(f"fk {tree} --tip left --json 0.3 0.5").json
    np.testing.assert_allclose(found["xyz"], [0, 0.2, 0.3], atol=1e-15)
    np.testing.assert_allclose(found["rpy"], [0, 0, 0.5], atol=1e-15)
    found = cspace(f"fk {tree} --base torso --tip right --json 0.5").json
    np.testing.assert_allclose(found["xyz"], [0, -0.2, 0], atol=1e-15)


def test_frames_of_a_tree_need_no_tip(tree):
    found = cspace(f"fk {tree} --frame right --json 0.3 0 90 --deg").json
    np.testing.assert_allclose(found["rpy"], [0, 0, np.pi / 2], atol=1e-12)
    assert cspace(f"jacobian {tree} --frame right --json 0.3 0 0.1").code == 0


def test_the_sheet_of_a_tree(tree):
    facts = cspace(f"info {tree} --json").json
    schema.check(facts)
    assert facts["tip"] is None
    assert sorted(facts["leaves"]) == ["left", "right"]
    assert [joint["type"] for joint in facts["joints"]] == ["prismatic", "revolute", "revolute"]
    assert facts["joints"][1]["upper"] is None
    assert facts["freedoms"]["dof"] == facts["freedoms"]["description"] == 3
    assert "left, right" in cspace(f"info {tree}").out


def test_degrees_leave_slides_alone(tree):
    found = cspace(f"fk {tree} --tip left --deg --json 0.3 90").json
    np.testing.assert_allclose(found["q"], [0.3, np.pi / 2])


def test_units_of_a_sheet_follow_the_joint(tree):
    rows = cspace(f"info {tree} --deg").out.splitlines()[-3:]
    assert rows[0].endswith("m, m/s, N")
    assert rows[1].endswith("deg, deg/s, N m")
