"""SRDF: groups, named poses and allowed pairs, against a robot and without one."""

import itertools
import logging

import numpy as np
import pytest

import cspace as cs
from cspace.errors import DescriptionError, InputError, InputTypeError, UnknownNameError
from cspace.model import Description, Joint, Link, chain, group_ends, read_srdf, with_srdf
from kinematics import robots
from model.random_robots import random_tree

PANDA = """<?xml version="1.0"?>
<robot name="panda">
  <group name="panda_arm"><chain base_link="panda_link0" tip_link="panda_link8"/></group>
  <group name="by_joints">
    <joint name="virtual_joint"/>
    <joint name="panda_joint1"/><joint name="panda_joint2"/><joint name="panda_joint3"/>
    <joint name="panda_joint4"/><joint name="panda_joint5"/><joint name="panda_joint6"/>
    <joint name="panda_joint7"/><joint name="panda_joint8"/>
  </group>
  <group name="lower"><link name="panda_link1"/><link name="panda_link2"/><link name="panda_link3"/></group>
  <group name="upper"><chain base_link="panda_link3" tip_link="panda_link7"/></group>
  <group name="both"><group name="lower"/><group name="upper"/></group>
  <group name="gap"><joint name="panda_joint1"/><joint name="panda_joint3"/></group>
  <group name="hand"><link name="panda_hand"/><joint name="panda_finger_joint1"/></group>
  <group name="still"><joint name="panda_joint8"/></group>
  <group_state name="low" group="panda_arm">
    <joint name="panda_joint1" value="0"/><joint name="panda_joint2" value="0.5"/>
    <joint name="panda_joint3" value="0"/><joint name="panda_joint4" value="-2"/>
    <joint name="panda_joint5" value="0"/><joint name="panda_joint6" value="1"/>
    <joint name="panda_joint7" value="0.75"/>
  </group_state>
  <group_state name="open" group="hand"><joint name="panda_finger_joint1" value="0.035"/></group_state>
  <group_state name="low" group="hand"><joint name="panda_finger_joint1" value="0.0"/></group_state>
  <virtual_joint name="virtual_joint" type="fixed" parent_frame="world" child_link="panda_link0"/>
  <disable_collisions link1="panda_link5" link2="panda_link7" reason="Never"/>
  <disable_collisions link1="panda_link7" link2="panda_link5" reason="again"/>
  <disable_collisions link1="panda_link0" link2="panda_hand" reason="Never"/>
</robot>
"""


def panda():
    return cs.robots.load_description("panda")


def test_pairs_poses_and_groups_of_the_panda(caplog):
    with caplog.at_level(logging.WARNING, "cspace"):
        found = with_srdf(panda(), PANDA)
    assert "has no links 'panda_hand'" in caplog.text
    assert "has no joints 'panda_finger_joint1'" in caplog.text
    assert ("panda_link5", "panda_link7", "Never") in found.allowed_pairs
    assert len({frozenset(pair[:2]) for pair in found.allowed_pairs}) == len(found.allowed_pairs)
    assert found.poses["low"]["panda_joint6"] == 1.0
    assert found.poses.keys() == {*panda().poses, "low"}
    robot = cs.Robot(found)
    np.testing.assert_array_equal(robot.named_poses["low"], [0, 0.5, 0, -2, 0, 1, 0.75])


@pytest.mark.parametrize(
    ("group", "ends"),
    [
        ("panda_arm", ("panda_link0", "panda_link8")),
        ("by_joints", ("panda_link0", "panda_link8")),
        ("lower", ("panda_link0", "panda_link3")),
        ("upper", ("panda_link3", "panda_link7")),
        ("both", ("panda_link0", "panda_link7")),
    ],
)
def test_a_group_has_the_ends_of_its_chain(group, ends, tmp_path):
    path = tmp_path / "panda.srdf"
    path.write_text(PANDA)
    assert group_ends(panda(), read_srdf(PANDA), group) == ends
    robot = cs.load_robot("panda", srdf=path, group=group)
    assert (robot.base, robot.tip) == ends
    assert robot.named_poses["low"].shape == (robot.dof,)


@pytest.mark.parametrize(
    ("group", "error", "message"),
    [
        ("gap", InputError, "group 'gap' leaves out 'panda_joint2' of its chain; choose one of the groups"),
        ("hand", InputError, "group 'hand': no joint 'panda_finger_joint1' in robot 'panda'"),
        ("still", InputError, "group 'still' moves no joint of 'panda'"),
        ("arm", UnknownNameError, "no group 'arm' in the SRDF file of robot 'panda'; .*'panda_arm'"),
    ],
)
def test_a_group_that_is_not_a_chain_is_refused(group, error, message):
    with pytest.raises(error, match=message):
        group_ends(panda(), read_srdf(PANDA), group)


def two_arms():
    links = [Link(name) for name in ("torso", "l1", "l2", "r1", "r2")]
    ends = [("torso", "l1"), ("l1", "l2"), ("torso", "r1"), ("r1", "r2")]
    return Description("duo", links, [Joint(f"j_{b}", "continuous", a, b) for a, b in ends])


def test_a_group_of_two_arms_is_no_chain_but_a_chain_may_run_through_both():
    text = """<robot name="duo">
      <group name="left"><chain base_link="torso" tip_link="l2"/></group>
      <group name="right"><chain base_link="torso" tip_link="r2"/></group>
      <group name="all"><group name="left"/><group name="right"/></group>
      <group name="across"><chain base_link="l2" tip_link="r2"/></group>
    </robot>"""
    srdf = read_srdf(text)
    with pytest.raises(InputError, match=r"'all' branches: .* choose one of the groups 'left', 'right'"):
        group_ends(two_arms(), srdf, "all")
    assert group_ends(two_arms(), srdf, "across") == ("l2", "r2")


def test_a_group_that_includes_itself_is_refused():
    a, b = '<group name="a"><group name="b"/></group>', '<group name="b"><group name="a"/></group>'
    text = f'<robot name="duo">{a}{b}</robot>'
    with pytest.raises(InputError, match="group 'a' includes itself, by way of a → b → a"):
        group_ends(two_arms(), read_srdf(text), "a")


@pytest.mark.parametrize("seed", range(8))
def test_the_ends_of_the_joints_of_any_chain_are_those_of_the_chain(seed):
    """A group by joints in any order has the ends of the path whose joints they are."""
    rng = np.random.default_rng(seed)
    robot = random_tree(rng, n=8)
    tip = str(rng.choice(robot.leaves))
    path, here = [], tip
    while here in robot.parent_joint:
        path.append(robot.parent_joint[here])
        here = path[-1].parent
    moving = [joint for joint in path if joint.moving]
    if not moving:
        pytest.skip("a tree whose path has no moving joints")
    names = [joint.name for joint in rng.permutation(np.array(path, dtype=object))]
    text = "".join(f'<joint name="{name}"/>' for name in names)
    srdf = read_srdf(f'<robot name="x"><group name="g">{text}</group></robot>')
    assert group_ends(robot, srdf, "g") == (path[-1].parent, path[0].child)


@pytest.mark.parametrize("seed", range(5))
def test_disabled_pairs_are_allowed_in_either_order_once(seed):
    rng = np.random.default_rng(seed)
    robot = random_tree(rng, n=6)
    every = list(itertools.combinations(robot.link_by_name, 2))
    chosen = [every[k] for k in rng.choice(len(every), 6, replace=False)]
    rows = [(a, b) if rng.random() < 0.5 else (b, a) for a, b in [*chosen, *chosen]]
    text = "".join(f'<disable_collisions link1="{a}" link2="{b}" reason="r"/>' for a, b in rows)
    found = with_srdf(robot, f'<robot name="x">{text}</robot>').allowed_pairs
    assert {frozenset(pair[:2]) for pair in found} == set(map(frozenset, chosen))
    assert len(found) == len(chosen)


def test_disabled_defaults_and_enabled_pairs():
    text = """<robot name="duo">
      <disable_default_collisions link="l2"/>
      <enable_collisions link1="r2" link2="l2"/>
    </robot>"""
    found = {frozenset(pair[:2]) for pair in with_srdf(two_arms(), text).allowed_pairs}
    assert found == {frozenset(("l2", other)) for other in ("torso", "l1", "r1")}


def test_states_of_one_name_are_one_pose_unless_they_disagree():
    text = """<robot name="duo">
      <group name="left"><joint name="j_l1"/><joint name="j_l2"/></group>
      <group name="right"><joint name="j_r1"/></group>
      <group name="inner"><joint name="j_l1"/></group>
      <group_state name="home" group="left">
        <joint name="j_l1" value="1"/><joint name="j_l2" value="2"/>
      </group_state>
      <group_state name="home" group="right"><joint name="j_r1" value="3"/></group_state>
      <group_state name="up" group="left"><joint name="j_l1" value="1"/></group_state>
      <group_state name="up" group="inner"><joint name="j_l1" value="2"/></group_state>
      <group_state name="odd" group="inner"><joint name="j_l1" value="0 0 1 0 0 0 1"/></group_state>
    </robot>"""
    assert with_srdf(two_arms(), text).poses == {
        "home": {"j_l1": 1.0, "j_l2": 2.0, "j_r1": 3.0},
        "left/up": {"j_l1": 1.0},
        "inner/up": {"j_l1": 2.0},
    }


def test_the_allowed_pairs_are_not_checked():
    """Two spheres that overlap at zero collide unless the file allows the pair."""
    spheres = {"link_1": [[0, 0, 0, 0.4]], "link_2": [[0, 0, 2, 0.1]], "link_3": [[-2, 0, 0, 0.4]]}
    robot = cs.load_robot("planar_3r").with_spheres(spheres)
    assert robot.contact([0, 0, 0]) == ("link_1", "link_3")
    text = '<robot name="p"><disable_collisions link1="link_3" link2="link_1" reason="User"/></robot>'
    free = cs.Robot(with_srdf(robot.description, text))
    assert free.contact([0, 0, 0]) is None
    assert ("link_1", "link_3", "User") in free.collision.allowed


def test_rotor_parameters_are_armatures(caplog):
    """Of Pinocchio's extension; zeros stand for unknown numbers, and unknown joints are logged."""
    text = """<robot name="p"><rotor_params><joint name="joint_0" mass="1e-5" gear_ratio="100."/>
      <joint name="joint_1" mass="0" gear_ratio="100"/><joint name="wing" mass="1" gear_ratio="2"/>
      </rotor_params></robot>"""
    plain = robots.arm(0).description
    with caplog.at_level("WARNING", "cspace"):
        geared = with_srdf(plain, text)
    assert [joint.armature for joint in geared.joints[:3]] == [pytest.approx(0.1), None, None]
    assert "has no joints 'wing'" in caplog.text
    with pytest.raises(DescriptionError, match="shares no link and no joint"):
        with_srdf(plain, text.replace("joint_", "j_"))


WRONG = {
    "<robot name='x'><group name='g'></robot>": "1: malformed XML",
    "<urdf/>": "1: this is not SRDF: the root element is <urdf>",
    "<robot name='x'><link name='a'/></robot>": "this is a URDF file",
    "<robot xmlns:xacro='x'><xacro:arm/></robot>": "this SRDF is a xacro file; expand it first",
    "<robot>\n<disable_colisions link1='a' link2='b'/></robot>": "2: .*did you mean <disable_collisions>",
    "<robot><rotor_params>\n<joint name='a' mass='1'/></rotor_params></robot>": "2: .*'gear_ratio'",
    "<robot>\n\n<disable_collisions link='a' link2='b'/></robot>": "3: .*did you mean 'link1'",
    "<robot>\n<disable_collisions link1='a'/></robot>": "2: <disable_collisions> needs the attribute 'link2'",
    "<robot>\n<disable_collisions link1='a' link2='a'/></robot>": "2: .* names link 'a' twice",
    "<robot><group name='g'/>\n<group name='g'/></robot>": "2: two groups are named 'g'",
    "<robot><group name='g'>\n<chain tip_lnk='b'/></group></robot>": "2: .*did you mean 'tip_link'",
    "<robot><group name='g'>\n<group name='h'/></group></robot>": "2: no group 'h' in this file",
    "<robot>\n<group_state name='s' group='g'/></robot>": "2: no group 'g' in this file",
    "<robot><group name='g'/><group_state name='s' group='g'/>\n<group_state name='s' group='g'/></robot>": (
        "2: two states of group 'g' are named 's'"
    ),
    "<robot><group name='g'/><group_state name='s' group='g'>\n"
    "<joint name='j' value='nan'/></group_state></robot>": (
        "2: value='nan' of <joint>: every number must be finite"
    ),
    "<robot><group name='g'/><group_state name='s' group='g'>\n<joint name='j'/></group_state></robot>": (
        "2: <joint> needs the attribute 'value'"
    ),
    "<robot><group name='g'/><group_state name='s' group='g'><joint name='j' value='1'/>\n"
    "<joint name='j' value='1'/></group_state></robot>": "2: state 's' gives joint 'j' twice",
}


@pytest.mark.parametrize("text", WRONG)
def test_a_faulty_file_is_refused_with_its_line(text, tmp_path):
    path = tmp_path / "x.srdf"
    path.write_text(text)
    with pytest.raises(DescriptionError, match=f"x.srdf:.*{WRONG[text]}"):
        read_srdf(path)


def test_the_file_of_another_robot_is_refused():
    with pytest.raises(
        DescriptionError, match="shares no link and no joint with robot 'ur5e'; it names 'panda_"
    ):
        with_srdf(cs.robots.load_description("ur5e"), PANDA)


def test_arguments_of_the_loader(tmp_path):
    path = tmp_path / "panda.srdf"
    path.write_text(PANDA)
    for wrong in ({"group": "panda_arm"}, {"srdf": path, "group": "panda_arm", "tip": "panda_link8"}):
        with pytest.raises(InputTypeError, match="group= names a group of an SRDF file"):
            cs.load_robot("panda", **wrong)
    assert cs.load_robot("panda", srdf=path, tip="panda_link3").dof == 3
    with pytest.raises(DescriptionError, match="an SRDF file only adds to a robot"):
        cs.load_robot(path)
    assert chain(with_srdf(panda(), PANDA)).joint_types == "R" * 7
    assert repr(read_srdf(PANDA)) == "<Srdf of panda: 8 groups, 3 named poses, 3 pairs>"
