import math

import numpy as np
import pytest

from cspace.errors import CspaceError, DescriptionError, InputError, UnknownNameError
from cspace.model import Description, Geometry, Inertial, Joint, Limits, Link, Loop, Mesh, Mimic
from cspace.model.values import translation_by


def links(*names):
    return tuple(Link(name) for name in names)


def hinge(name, parent, child, **more):
    return Joint(name, "revolute", parent, child, axis=(0, 0, 1), **more)


def test_a_tree_is_ordered_from_the_root_whatever_the_file_order():
    robot = Description(
        "tree",
        links("b", "a", "c", "d"),
        (hinge("j3", "b", "d"), hinge("j1", "a", "b"), Joint("j2", "fixed", "a", "c")),
    )
    assert robot.root == "a"
    assert robot.ordered_links == ("a", "b", "d", "c")
    assert robot.leaves == ("d", "c")
    assert [j.name for j in robot.moving_joints] == ["j1", "j3"]
    assert robot.parent_joint["d"].name == "j3"
    assert [j.name for j in robot.child_joints["a"]] == ["j1", "j2"]


def test_axes_become_unit_vectors_and_arrays_are_read_only():
    joint = hinge("j", "a", "b")
    long = Joint("k", "prismatic", "a", "b", axis=(0, 3, 4))
    np.testing.assert_array_equal(long.axis, [0, 0.6, 0.8])
    huge = Joint("h", "prismatic", "a", "b", axis=(0, 3e300, 4e300))
    np.testing.assert_allclose(huge.axis, [0, 0.6, 0.8], rtol=1e-15)
    with pytest.raises(ValueError, match="read-only"):
        joint.origin[0, 3] = 1.0
    origin = np.eye(4)
    kept = hinge("c", "a", "b", origin=origin)
    origin[0, 3] = 9.0
    assert kept.origin[0, 3] == 0.0


@pytest.mark.parametrize(
    ("make", "error", "says"),
    [
        (lambda: Joint("j", "hinge", "a", "b"), UnknownNameError, "no joint type 'hinge'"),
        (lambda: Joint("j", "revolut", "a", "b"), UnknownNameError, "did you mean 'revolute'"),
        (lambda: Joint("j", "revolute", "a", "b", axis=(0, 0, 0)), InputError, "axis must not be zero"),
        (lambda: Joint("j", "revolute", "a", "b", axis=(0, 1e-7, 0)), InputError, "no direction"),
        (lambda: Joint("j", "revolute", "a", "b", axis=(0, math.nan, 1)), InputError, "nan"),
        (lambda: Joint("j", "revolute", "a", "b", axis=(0, 1)), InputError, "expected"),
        (lambda: hinge("j", "a", "b", lower=1.0, upper=-1.0), InputError, "reversed"),
        (lambda: hinge("j", "a", "b", lower=math.inf), InputError, "allow no finite value"),
        (lambda: hinge("j", "a", "b", lower=math.nan), InputError, "lower limit of joint 'j' is NaN"),
        (lambda: hinge("j", "a", "b", velocity=-1.0), InputError, "must not be negative"),
        (lambda: hinge("j", "a", "b", origin=np.diag([1, 1, -1, 1])), InputError, "reflection"),
        (lambda: hinge("j", "a", "b", origin=np.full((4, 4), np.inf)), InputError, "finite"),
        (lambda: hinge("j", "a", "b", origin=np.ones((4, 4))), InputError, "last row"),
        (lambda: hinge("j", "a", "b", origin=translation_by([0, 0, 1e13])), InputError, "beyond 1e\\+12"),
        (lambda: Inertial(1e13, (0, 0, 0), np.eye(3)), InputError, "beyond"),
        (lambda: Inertial(1.0, (0, 1e13, 0), np.eye(3)), InputError, "beyond"),
        (lambda: Geometry("sphere", (1e13,)), InputError, "beyond"),
        (lambda: hinge("", "a", "b"), InputError, "empty"),
        (lambda: Mimic("j", multiplier=math.inf), InputError, "finite"),
        (lambda: Inertial(-1.0, (0, 0, 0), np.eye(3)), InputError, "negative"),
        (lambda: Inertial(1.0, (0, 0, math.nan), np.eye(3)), InputError, "finite"),
        (lambda: Inertial(1.0, (0, 0, 0), [[1, 2, 0], [0, 1, 0], [0, 0, 1]]), InputError, "not symmetric"),
        (lambda: Geometry("cone", (1.0,)), UnknownNameError, "no shape 'cone'"),
        (lambda: Geometry("box", (1.0,)), InputError, "needs the sizes"),
        (lambda: Geometry("sphere", (-1.0,)), InputError, "negative"),
        (lambda: Geometry("mesh"), InputError, "without a mesh"),
        (lambda: Limits([0, 1], [1, 0]), InputError, "coordinate 1 are reversed"),
        (lambda: Limits([0, 1], [1]), InputError, "expected"),
        (lambda: Limits([math.nan], [1]), InputError, "NaN"),
        (lambda: Loop("l", "ball", "a", "b"), UnknownNameError, "no joint type 'ball'"),
    ],
)
def test_a_bad_part_is_refused_by_name(make, error, says):
    with pytest.raises(error, match=says):
        make()


@pytest.mark.parametrize(
    ("parts", "joints", "says"),
    [
        ("", [], "no links"),
        ("ab", [], "2 roots: 'a', 'b'"),
        ("abc", [("j", "a", "b")], "2 roots: 'a', 'c'"),
        ("aab", [("j", "a", "b")], "two links .* named 'a'"),
        ("abc", [("j", "a", "b"), ("j", "b", "c")], "two joints .* named 'j'"),
        ("ab", [("j", "a", "x")], "child of joint 'j': no link 'x'"),
        ("ab", [("j", "x", "b")], "parent of joint 'j': no link 'x'"),
        ("ab", [("j", "a", "a")], "with itself"),
        ("abc", [("j", "a", "c"), ("k", "b", "c")], "child of two joints, 'j' and 'k'"),
        ("ab", [("j", "a", "b"), ("k", "b", "a")], "cycle: "),
        ("abc", [("j", "b", "c"), ("k", "c", "b")], "cycle: "),
    ],
)
def test_what_is_no_tree_is_refused(parts, joints, says):
    with pytest.raises(DescriptionError, match=says):
        Description("bad", links(*parts), tuple(hinge(*joint) for joint in joints))


@pytest.mark.parametrize(
    ("followers", "says"),
    [
        ({"j": "k", "k": "j"}, "through a cycle"),
        ({"j": "j"}, "through a cycle"),
        ({"j": "x"}, "no joint 'x'"),
        ({"j": "f"}, "mimics 'f', which is fixed"),
    ],
)
def test_mimics_must_lead_to_a_moving_joint(followers, says):
    joints = [
        hinge(name, parent, child, mimic=Mimic(followers[name]) if name in followers else None)
        for name, parent, child in (("j", "a", "b"), ("k", "b", "c"))
    ]
    with pytest.raises(DescriptionError, match=says):
        Description("bad", links(*"abcd"), (*joints, Joint("f", "fixed", "c", "d")))


def test_a_long_chain_of_mimics_and_links_is_checked_in_linear_time():
    n = 20_000
    names = [f"l{i}" for i in range(n + 1)]
    joints = [
        hinge(f"j{i}", names[i], names[i + 1], mimic=Mimic(f"j{i - 1}") if i else None)
        for i in reversed(range(n))
    ]
    robot = Description("long", links(*names), tuple(joints))
    assert len(robot.ordered_links) == n + 1


def test_unknown_names_get_suggestions():
    robot = Description("r", links("base", "wrist_3_link"), (hinge("wrist_3_joint", "base", "wrist_3_link"),))
    with pytest.raises(CspaceError, match="did you mean 'wrist_3_link'"):
        robot.link("wrist3_link")
    with pytest.raises(CspaceError, match="did you mean 'wrist_3_joint'"):
        robot.joint("wrist_joint")
    with pytest.raises(CspaceError, match="pose 'home'"):
        Description("r", links("base"), poses={"home": {"x": 1.0}})


def test_a_missing_mesh_names_every_place_searched_when_asked_for():
    mesh = Mesh("package://ur/meshes/a.stl", beside="/a", package_paths=("/b",))
    with pytest.raises(DescriptionError, match=r"(?s)/b/ur/meshes/a.stl.*/a/ur/meshes/a.stl.*package_paths"):
        mesh.file()
