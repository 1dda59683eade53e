"""The method that makes a robot of screws names its options as the function behind it takes them."""

import inspect
import re

import numpy as np

import cspace as cs
from cspace import model

AXES, POINTS = [[0, 0, 1], [0, 1, 0]], [[0, 0, 0], [0, 0, 0.5]]


def test_the_options_that_the_docstring_lists_are_taken():
    text = re.search(r"options: (.*?), as in", inspect.getdoc(cs.Robot.from_screws), re.S).group(1)
    listed = set(re.split(r",\s+", text.replace(" and the other limits", "")))
    taken = set(inspect.signature(model.from_screws).parameters)
    assert {"lower", "upper", "joint_names"} <= listed <= taken


def test_limits_and_names_arrive():
    robot = cs.Robot.from_screws(
        AXES, POINTS, np.eye(4), lower=[-1, -2], upper=[1, 2], joint_names=["pan", "tilt"], name="neck"
    )
    assert (robot.name, robot.joint_names) == ("neck", ("pan", "tilt"))
    np.testing.assert_array_equal(robot.limits.lower, [-1, -2])
    np.testing.assert_array_equal(robot.limits.upper, [1, 2])
