"""Every invalid argument of a configuration space gets an error that names it."""

from __future__ import annotations

import numpy as np
import pytest

import cspace as cs
from cspace.errors import CspaceError

SQUARE = np.array([[0.5, 0.5], [1.0, 0.5], [1.0, 1.0], [0.5, 1.0]])


@pytest.fixture(scope="module")
def arm():
    return cs.load_robot("planar_2r")


def two_joints(axes=((0, 0, 1), (0, 0, 1)), points=((0, 0, 0), (1, 0, 0)), tip=(2, 0, 0), **options):
    T = np.eye(4)
    T[:3, 3] = tip
    return cs.Robot.from_screws(axes, points, T, **options)


@pytest.mark.parametrize(
    ("robot", "words"),
    [
        ("planar_2r", "robot is a str"),
        (cs.load_robot("planar_3r"), "has 3 joints"),
        (cs.load_robot("ur5e"), "two revolute joints.*cs.Scene"),
        (two_joints(axes=((0, 0, 1), (0, 1, 0))), "enclose 90 degrees"),
        (two_joints(joint_types="RP"), "'RP'"),
        (two_joints(lower=[-np.inf, -1], upper=[1, 1]), "one side only"),
        (two_joints(lower=[0, -1], upper=[0, 1]), "cannot move"),
        (two_joints(lower=[-1e4, -1], upper=[1e4, 1]), "turns apart"),
    ],
)
def test_robots_that_are_no_planar_arm_of_two_joints(robot, words):
    with pytest.raises(CspaceError, match=words):
        cs.configuration_space(robot, [SQUARE])


@pytest.mark.parametrize(
    ("obstacles", "words"),
    [
        (SQUARE, "must be a Scene"),
        ("walls", "must be a Scene"),
        (None, r"cs\.Scene\(\)"),
        ([SQUARE * np.nan], "must be finite"),
        ([[(0, 0), (1, 1), (1, 0), (0, 1)]], "crosses itself"),
        ([[(1, 0), (2, 0), (3, 0)]], "no area"),
        ([[(1, 0)]], "one corner only"),
        (cs.Scene([cs.Cylinder(0.1, 1, cs.pose([1, 0, 0], rotvec=[0.5, 0, 0]))]), "is tilted"),
        (cs.Scene([cs.Capsule(0.1, 1, cs.pose([1, 0, 0], rotvec=[0.5, 0, 0]))]), "is tilted"),
        (cs.Scene([cs.Box([1, 1, 1], [3, 0, 0], "b")]).attach("b", "tip", [0, 0, 0]), "is attached"),
        (cs.Scene([cs.Box([1, 1, 1], [3, 0, 0], "b")]).allow("b", "link_1"), "may touch"),
        (cs.Scene([cs.HeightField(np.zeros((3, 3)), (1, 1))]), "exact=False"),
    ],
)
def test_obstacles_that_cannot_be_used(arm, obstacles, words):
    with pytest.raises(CspaceError, match=words):
        cs.configuration_space(arm, obstacles)


def test_links_in_different_planes_need_a_height():
    arm = two_joints(points=((0, 0, 0), (1, 0, 0.3)))
    scene = cs.Scene([cs.Sphere(0.3, [1.5, 0, 0])])
    with pytest.raises(CspaceError, match="height="):
        cs.configuration_space(arm, scene)
    assert cs.configuration_space(arm, scene, height=0.1).sections["sphere_1"]
    assert cs.configuration_space(arm, [SQUARE]).obstacles == ("obstacle 0",)


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"link_radius": -0.1}, "link_radius"),
        ({"link_radius": np.nan}, "link_radius"),
        ({"link_radius": "thin"}, "link_radius"),
        ({"height": np.inf}, "height"),
        ({"limits": 1}, "limits is an int"),
    ],
)
def test_options_out_of_range(arm, options, words):
    with pytest.raises(CspaceError, match=words):
        cs.configuration_space(arm, [SQUARE], **options)


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda s: s.bitmap(0), "n is 0"),
        (lambda s: s.bitmap(10**6), "n is 1000000"),
        (lambda s: s.bitmap(2.5), "n is a float"),
        (lambda s: s.bitmap((3, 4, 5)), "n has 3 entries"),
        (lambda s: s.free([1, 2, 3]), "q has shape"),
        (lambda s: s.free([np.nan, 0]), "must be finite"),
        (lambda s: s.component([[0, 0]]), "q has shape"),
        (lambda s: s.blocked_by([0]), "q has shape"),
        (lambda s: s.connected([0.8, 0], [0, 0]), "q_a .* touches"),
        (lambda s: s.connected([0, 0], [0.8, 0]), "q_b .* touches"),
        (lambda s: s.path([0.8, 0], [0, 0]), "start .* touches"),
        (lambda s: s.path([0, 0], np.empty((0, 2))), "goals is empty"),
        (lambda s: s.path([0, 0], [1, 2, 3]), "goals has shape"),
    ],
)
def test_questions_that_make_no_sense(arm, call, words):
    with pytest.raises(CspaceError, match=words):
        call(cs.configuration_space(arm, [SQUARE]))
