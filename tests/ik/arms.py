"""The arms that the tests of this folder share: the catalogue's closed forms, and chains from shared data."""

from __future__ import annotations

import json
from functools import cache

import numpy as np

import cspace as cs
from cspace.ik import NoClosedFormError, geometry
from cspace.model import from_screws
from cspace.robot import Robot
from data import shared_data
from model.rounding import print_right_angles

# The families of this room among the named arms, as their makers describe them; that the classification finds
# each of them is a test of its own.
SPHERICAL = [
    "puma560",
    "puma560_dh",
    "puma560_urdf",
    "puma_style",
    "elbow",
    "kr6_r900",
    "irb120",
    "irb1600",
    "irb140_dh",
    "kr120_r2500",
    "kr210_l150",
    "kr210_r2700",
    "lrmate200id",
    "m710ic",
    "rv4fr",
    "j2s6s200",
    "j2s6s300",
    "viperx300s",
    "widowx250s",
]
SHOULDER = ["icub_left_leg", "romeo_left_leg", "talos_left_leg"]
PARALLEL = [
    "ur3",
    "ur3e",
    "ur5",
    "ur5e",
    "ur10",
    "ur10e",
    "ur15",
    "ur16e",
    "ur20",
    "ur7e",
    "ur3_dh",
    "ur5_dh",
    "ur10_dh",
    "cr5",
    "standardbots_spark",
    "standardbots_thor",
    "yam",
    "z1",
    "z1_urdf",
]
SHORT = ["al5d", "so101"]
ALL = SPHERICAL + SHOULDER + PARALLEL + SHORT
ROUNDED = ["lite6_rounded", "icub_left_leg_rounded", "so101_rounded"]
"""Arms as files describe them that round right angles to 1.5708 and 3.1416."""
# Few arms that stand for the families in slow tests; the last have rounded axes or few joints.
FEW = [
    "ur5e",
    "puma560",
    "kr6_r900",
    "romeo_left_leg",
    "z1",
    "yam",
    "puma560_urdf",
    "al5d",
    "so101",
    *ROUNDED,
]


@cache
def load(name):
    base = name.removesuffix("_rounded")
    robot = cs.load_robot(base)
    return robot if base == name else Robot(print_right_angles(robot.description, 4), robot.base, robot.tip)


def is_idealised(robot):
    """Whether the form differs from the arm's true axes by more than rounding."""
    return geometry(robot).idealised > 1e-13


@cache
def shared_chains():
    return {row["name"]: row for row in json.loads((shared_data() / "arms/chains.json").read_text())}


def robot_from_chain(row):
    """A robot of the shared data, from its screws; None where it holds a joint that is not revolute."""
    joints = row["joints"]
    if any(joint["type"] not in ("revolute", "continuous") for joint in joints):
        return None
    axes, points = ([joint[key] for joint in joints] for key in ("axis", "point"))
    return Robot(from_screws(axes, points, np.array(row["tool_zero"]), name=row["name"]))


def has_closed_form(robot):
    try:
        robot.ik(np.eye(4))
    except NoClosedFormError:
        return False
    return True
