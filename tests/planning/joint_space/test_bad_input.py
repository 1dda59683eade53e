"""Every invalid argument of a joint space gets an error that names it."""

from __future__ import annotations

import numpy as np
import pytest

import cspace as cs
from cspace.errors import CspaceError

BOX = cs.Scene([cs.Box([0.2, 0.2, 0.2], [0.5, 0, 0.5], "box")])


@pytest.fixture(scope="module")
def space():
    return cs.configuration_space(cs.load_robot("panda"), BOX)


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"joints": ("panda_joint1", "panda_joint9")}, "no joint 'panda_joint9' in panda; did you mean"),
        ({"joints": (0, 7)}, "joint 7, but panda has joints 0 to 6"),
        ({"joints": (0, -8)}, "joint -8"),
        ({"joints": (2, 2)}, "twice"),
        ({"joints": (2, -5)}, "twice"),
        ({"joints": ("panda_joint1", 0)}, "twice"),
        ({"joints": (1,)}, "give two joints"),
        ({"joints": (1, 2, 3)}, "give two joints"),
        ({"joints": "12"}, "give two joints"),
        ({"joints": 3}, "give two joints"),
        ({"joints": (True, 2)}, "contains a bool"),
        ({"joints": (0.0, 2)}, "contains a float"),
        ({"at": np.zeros(6)}, "at has shape"),
        ({"at": np.zeros((2, 7))}, "at has shape"),
        ({"at": np.full(7, np.nan)}, "at"),
        ({"at": np.zeros(7)}, "'panda_joint4' is at 0, outside its limits"),
        ({"size": 0}, "size is 0"),
        ({"size": -3}, "size is -3"),
        ({"size": 2.5}, "size is a float"),
        ({"size": (3, 4, 5)}, "size has 3 entries"),
        ({"size": 10**7}, "size is 10000000"),
        ({"time_limit": 0}, "time_limit"),
        ({"time_limit": -1.0}, "time_limit"),
        ({"threads": -1}, "threads"),
    ],
)
def test_slices(space, options, words):
    with pytest.raises(CspaceError, match=words):
        space.slice(**{"joints": (0, 1)} | options)


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"joints": (0, 0)}, "twice"),
        ({"size": 0}, "size is 0"),
        ({"samples": 0}, "samples is 0"),
        ({"samples": 1.5}, "samples is a float"),
        ({"including": np.zeros(7)}, "including: joint 'panda_joint4'"),
        ({"including": np.zeros((2, 3))}, "including has shape"),
        ({"rng": "seven"}, "rng is a str"),
        ({"time_limit": np.nan}, "time_limit"),
    ],
)
def test_projections(space, options, words):
    with pytest.raises(CspaceError, match=words):
        space.project(**{"joints": (0, 1)} | options)


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"samples": 0}, "samples is 0"),
        ({"samples": 10**11}, "samples is"),
        ({"rng": -1}, "rng is -1"),
        ({"time_limit": "soon"}, "time_limit"),
        ({"threads": 1.5}, "threads"),
    ],
)
def test_volumes(space, options, words):
    with pytest.raises(CspaceError, match=words):
        space.volume(**options)


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda s: s.free([1, 2]), "q has shape"),
        (lambda s: s.blocked_by([np.inf] * 7), "q"),
        (lambda s: s.blocked_by(np.zeros((1, 7))), "q has shape"),
        (lambda s: s.bitmap, "bitmap"),
    ],
)
def test_questions_that_make_no_sense(space, call, words):
    with pytest.raises((CspaceError, AttributeError), match=words):
        call(space)


@pytest.mark.parametrize(
    ("robot", "options", "words"),
    [
        ("panda", {}, "robot is a str"),
        (cs.load_robot("panda"), {"exact": True}, "has 7 joints"),
        (cs.load_robot("panda"), {"exact": 1}, "exact is an int"),
        (cs.load_robot("panda"), {"limits": "no"}, "limits is a str"),
        (cs.load_robot("panda"), {"link_radius": 0.1}, "link_radius is an option of planar arms"),
        (cs.load_robot("panda"), {"height": 0.1}, "height is an option of planar arms"),
        (cs.load_robot("panda"), {"margin": -0.1}, "margin"),
        (cs.load_robot("planar_2r"), {"margin": 0.1}, "margin is an option of a JointSpace"),
        (cs.load_robot("puma560_urdf"), {}, "no collision geometry|cannot be checked"),
    ],
)
def test_robots_and_options(robot, options, words):
    with pytest.raises(CspaceError, match=words):
        cs.configuration_space(robot, BOX, **options)


def test_scenes_that_do_not_fit():
    panda = cs.load_robot("panda")
    with pytest.raises(CspaceError, match="scene is a list"):
        cs.planning.JointSpace(panda, [cs.Sphere(1.0)])
    with pytest.raises(CspaceError, match="has 7 joints"):
        cs.configuration_space(panda, [[(0, 0), (1, 0), (0, 1)]])
    with pytest.raises(CspaceError, match=r"no link|no frame|no name|nothing"):
        cs.configuration_space(panda, BOX.allow("box", "no_such_link"))
    T = np.eye(4)
    T[0, 3] = 1.0
    open_slide = cs.Robot.from_screws(np.eye(3), np.zeros((3, 3)), T, joint_types="RRP")
    with pytest.raises(CspaceError, match="has no limits"):
        cs.configuration_space(open_slide.with_spheres({"tip": [[0, 0, 0, 0.1]]}))
    with pytest.raises(CspaceError, match="robot is an int"):
        cs.planning.JointSpace(3)
