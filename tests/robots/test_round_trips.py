"""Every way in and every way out of a robot, tools and mountings included, keeps its poses to 1e-12."""

import re

import numpy as np
import pytest

from cspace.errors import InputError, UnknownNameError
from cspace.model import mounted, with_frame
from cspace.robot import Robot
from cspace.robots import load_description, load_robot
from model.random_robots import random_pose

ARMS = ("ur5e", "puma560_dh", "stanford", "panda", "scara", "rpr", "planar_2r")
WAYS = {
    "urdf": lambda robot: Robot.from_urdf(robot.to_urdf()),
    "toml": lambda robot: Robot.from_toml(robot.to_toml()),
    "standard": lambda robot: Robot.from_dh(robot.to_dh(convention="standard")),
    "modified": lambda robot: Robot.from_dh(robot.to_dh(convention="modified")),
    "screws": lambda robot: Robot.from_screws(
        robot.to_screws().axes,
        robot.to_screws().points,
        robot.to_screws().T_zero,
        joint_types=robot.to_screws().joint_types,
    ),
}


@pytest.mark.parametrize("name", ARMS)
@pytest.mark.parametrize("way", WAYS)
@pytest.mark.parametrize("dressed", [False, True])
def test_a_round_trip_keeps_every_pose(name, way, dressed):
    rng = np.random.default_rng(1)
    robot = load_robot(name)
    if dressed:
        robot = robot.with_tool(random_pose(rng)).with_base(random_pose(rng))
    back = WAYS[way](robot)
    q = rng.uniform(-3, 3, (20, robot.dof))
    np.testing.assert_allclose(back.fk(q), robot.fk(q), rtol=0, atol=1e-12)


def test_limits_survive_where_the_format_holds_them():
    robot = load_robot("ur5e")
    for way in ("urdf", "toml"):
        back = WAYS[way](robot)
        assert back.joint_names == robot.joint_names
        np.testing.assert_array_equal(back.limits.lower, robot.limits.lower)
        np.testing.assert_array_equal(back.limits.upper, robot.limits.upper)


@pytest.mark.parametrize("name", ARMS)
def test_no_zero_is_written_with_a_sign(name):
    text = load_robot(name).with_tool(-np.diag([1.0, 1.0, -1.0, -1.0])).to_urdf()
    assert not re.search(r"-0\.0\b(?!e)", text)


def test_new_names_do_not_clash():
    robot = load_description("planar_2r")
    twice = with_frame(with_frame(robot, "tip", np.eye(4)), "tool", np.eye(4))
    assert twice.leaves == ("tool_",)
    assert mounted(mounted(robot, "base", np.eye(4)), "world", np.eye(4)).root == "world_"


def test_what_cannot_be_mounted_is_refused():
    robot = load_description("planar_2r")
    with pytest.raises(UnknownNameError, match="did you mean 'tip'"):
        with_frame(robot, "tipp", np.eye(4))
    inner = Robot(robot, base="link_1").with_base(random_pose(np.random.default_rng(0)))
    with pytest.raises(InputError, match="moves against the root"):
        inner.to_urdf()
