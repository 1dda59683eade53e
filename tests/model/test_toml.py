from dataclasses import replace

import numpy as np
import pytest

from cspace.errors import DescriptionError
from cspace.model import (
    Description,
    Geometry,
    Joint,
    Link,
    Loop,
    Mesh,
    Provenance,
    Source,
    chain,
    from_dh,
    from_screws,
    from_toml,
    from_urdf,
    to_toml,
    to_urdf,
)
from model.random_robots import random_pose, random_tree, with_resistances

TREE = """
format = 1
name = "arm"
title = "An arm"
aliases = ["a1", "a2"]
missing = ["velocity"]

[sources.joints]
source = "a book"
licence = "facts"

[[links]]
name = "base"

[[links]]
name = "hand"
mass = 2
com = [0, 0, 0.1]
inertia = [[1, 0, 0], [0, 2, 0], [0, 0, 3]]

[[links.visual]]
shape = "mesh"
mesh = "hand.stl"
color = [1, 0, 0, 1]

[[joints]]
name = "shoulder"
type = "revolute"
parent = "base"
child = "hand"
xyz = [0, 0, 1]
rpy = [0.1, 0.2, 0.3]
axis = [0, 0, 1]
lower = -1
upper = 2

[poses.home]
shoulder = 0.5
"""

SCREWS = """
name = "slider"
[screws]
base = "base_link"
tip = "tool0"
T_zero = [[1, 0, 0, 0.5], [0, 1, 0, 0], [0, 0, 1, 0.25], [0, 0, 0, 1]]
[[screws.joints]]
name = "turn_joint"
axis = [0, 0, 1]
point = [0, 0, 0.25]
lower = -1
upper = 1
[[screws.joints]]
name = "slide_joint"
type = "prismatic"
axis = [1, 0, 0]
point = [0.1, 0, 0.25]
"""

DH = """
name = "two"
[dh]
convention = "modified"
[[dh.rows]]
[[dh.rows]]
a = 0.5
[[dh.rows]]
type = "fixed"
a = 0.3
"""


def test_a_tree_is_read():
    robot = from_toml(TREE)
    assert robot.provenance.title == "An arm"
    assert robot.provenance.aliases == ("a1", "a2")
    assert robot.provenance.missing == ("velocity",)
    assert robot.provenance.sources["joints"] == Source("a book", "facts")
    assert robot.link("hand").inertial.mass == 2.0
    assert robot.link("hand").visual[0].color == (1, 0, 0, 1)
    assert (robot.joint("shoulder").lower, robot.joint("shoulder").upper) == (-1, 2)
    assert robot.poses["home"] == {"shoulder": 0.5}
    again = from_urdf(to_urdf(robot))
    np.testing.assert_allclose(again.joint("shoulder").origin, robot.joint("shoulder").origin, atol=1e-15)
    placed = """<robot name="r"><link name="a"/><link name="b"/><joint name="j" type="fixed">
        <origin xyz="0 0 1" rpy="0.1 0.2 0.3"/><parent link="a"/><child link="b"/></joint></robot>"""
    np.testing.assert_array_equal(from_urdf(placed).joint("j").origin, robot.joint("shoulder").origin)


def test_screws_and_tables_are_read():
    c = chain(from_toml(SCREWS))
    assert (c.base, c.tip, c.joint_types) == ("base_link", "tool0", "RP")
    np.testing.assert_array_equal(c.axes, [[0, 0, 1], [1, 0, 0]])
    np.testing.assert_allclose(c.points, [[0, 0, 0.25], [0.1, 0, 0.25]])
    np.testing.assert_array_equal(c.limits.lower, [-1, -np.inf])
    expected = chain(
        from_dh([[0, 0, 0, 0], [0, 0.5, 0, 0], [0, 0.3, 0, 0]], convention="modified", joint_types="RRF")
    )
    np.testing.assert_array_equal(chain(from_toml(DH)).T_zero, expected.T_zero)


def test_a_row_of_a_table_may_say_what_its_link_weighs():
    text = DH.replace("a = 0.5\n", "a = 0.5\nmass = 2.0\ncom = [0.1, 0, 0]\ndamping = 0.3\n", 1)
    robot = from_toml(text)
    assert [link.inertial and link.inertial.mass for link in robot.links] == [None, None, 2.0, None, None]
    np.testing.assert_array_equal(robot.links[2].inertial.com, [0.1, 0, 0])
    np.testing.assert_array_equal(robot.links[2].inertial.inertia, np.zeros((3, 3)))
    assert [joint.damping for joint in robot.joints] == [None, 0.3, None, None]
    again = from_toml(to_toml(robot))
    assert again.links[2].inertial.mass == 2.0
    assert again.joints[1].damping == 0.3


def same(a, b):
    """Whether two descriptions hold the same numbers, bit for bit."""
    assert [link.name for link in a.links] == [link.name for link in b.links]
    for mine, theirs in zip((*a.joints, *a.loops), (*b.joints, *b.loops), strict=True):
        for field in type(mine).__dataclass_fields__:
            left, right = getattr(mine, field), getattr(theirs, field)
            np.testing.assert_array_equal(left, right) if isinstance(left, np.ndarray) else None
            assert isinstance(left, np.ndarray) or left == right, field
    for mine, theirs in zip(a.links, b.links, strict=True):
        assert (mine.inertial is None) == (theirs.inertial is None)
        if mine.inertial is not None:
            assert mine.inertial.mass == theirs.inertial.mass
            np.testing.assert_array_equal(mine.inertial.com, theirs.inertial.com)
            np.testing.assert_array_equal(mine.inertial.inertia, theirs.inertial.inertia)
        for left, right in zip(mine.visual + mine.collision, theirs.visual + theirs.collision, strict=True):
            np.testing.assert_array_equal(left.origin, right.origin)
            assert (left.shape, left.size, left.name, left.color) == (
                right.shape,
                right.size,
                right.name,
                right.color,
            )
            assert (left.mesh is None) == (right.mesh is None)
            assert left.mesh is None or (left.mesh.uri, left.mesh.scale) == (right.mesh.uri, right.mesh.scale)
    assert {k: dict(v) for k, v in a.poses.items()} == {k: dict(v) for k, v in b.poses.items()}
    assert a.provenance == b.provenance


@pytest.mark.parametrize("seed", range(10))
def test_a_round_trip_keeps_every_bit(seed):
    rng = np.random.default_rng(seed)
    kinds = ("revolute", "continuous", "prismatic", "fixed", "floating", "planar")
    robot = with_resistances(rng, random_tree(rng, n=15, kinds=kinds))
    same(from_toml(to_toml(robot)), robot)


def test_a_round_trip_keeps_shapes_loops_poses_sources_and_odd_names():
    rng = np.random.default_rng(0)
    shapes = (
        Geometry("box", (0.1, 0.2, 1 / 3), random_pose(rng), "b", None, (0.1, 0.2, 0.3, 1.0)),
        Geometry("mesh", mesh=Mesh("package://x/y.stl", (0.001, 0.001, 0.001))),
    )
    odd = 'a "quoted" \\ name\n\t\x7f\x01 é 🤖'
    robot = Description(
        odd,
        (Link("a", visual=shapes), Link(odd, collision=shapes[:1])),
        (Joint("j.1", "revolute", "a", odd, random_pose(rng), rng.normal(size=3), -1 / 3, 2 / 3),),
        (Loop("l", "spherical", "a", odd, random_pose(rng), random_pose(rng), (0, 1, 0)),),
        {"home pose": {"j.1": 0.1}},
        Provenance("t", "v", {"joint limits": Source("s", "l")}, ("mass",), ("x", "y")),
    )
    same(from_toml(to_toml(robot)), robot)


def test_screws_and_tables_survive_as_trees():
    for robot in (from_toml(SCREWS), from_toml(DH), from_screws(np.eye(3), np.eye(3), np.eye(4))):
        same(from_toml(to_toml(robot)), robot)


@pytest.mark.parametrize(
    ("text", "old", "new", "says", "header"),
    [
        (TREE, "format = 1", "format = 2", "reads format 1", None),
        (TREE, "format = 1", "fromat = 1", "did you mean 'format'", None),
        (TREE, 'name = "arm"\n', "", "the key 'name' is missing", None),
        (TREE, 'name = "arm"', "name = 3", "name must be a string", None),
        (TREE, "lower = -1", "lower = true", "lower must be a number, got True", "[[joints]]"),
        (TREE, "lower = -1", 'lower = "a"', "lower must be a number", "[[joints]]"),
        (TREE, "lower = -1", "lower = 3", "reversed", "[[joints]]"),
        (TREE, "lower = -1", "lower = nan", "NaN", "[[joints]]"),
        (TREE, "lower = -1", f"lower = 1{'0' * 400}", "beyond the range", "[[joints]]"),
        (TREE, "lower = -1", f"lower = 1{'0' * 5000}", "malformed TOML", None),
        (TREE, "lower = -1", "lower = 2020-01-01", "must be a number", "[[joints]]"),
        (TREE, "axis = [0, 0, 1]", "axis = [0, 0, 0]", "must not be zero", "[[joints]]"),
        (TREE, "axis = [0, 0, 1]", "axis = [0, 0]", "must hold 3 numbers, got a list of 2", "[[joints]]"),
        (TREE, "axis = [0, 0, 1]", "axis = 1", "must hold 3 numbers", "[[joints]]"),
        (TREE, "axis =", "axes =", "did you mean 'axis'", "[[joints]]"),
        (TREE, "xyz = [0, 0, 1]", "xyz = [0, 0, inf]", "finite", "[[joints]]"),
        (TREE, "rpy = [0.1, 0.2, 0.3]", "rpy = [0.1, nan, 0.3]", "finite", "[[joints]]"),
        (TREE, "xyz =", "origin = [[1]]\nxyz =", "not both", "[[joints]]"),
        (TREE, 'parent = "base"', 'parent = "bas"', "did you mean 'base'", "[[joints]]"),
        (TREE, 'type = "revolute"', 'type = "hinge"', "no joint type 'hinge'", "[[joints]]"),
        (TREE, "mass = 2", "mass = -2", "must not be negative", None),
        (TREE, "mass = 2\n", "", "need mass", None),
        (TREE, 'name = "hand"', 'name = "base"', "two links", None),
        (TREE, "shoulder = 0.5", "elbow = 0.5", "no joint 'elbow'", None),
        (TREE, "[poses.home]", "[pose.home]", "did you mean 'poses'", None),
        (TREE, "missing = [", "missing = [1,", "list of strings", None),
        (TREE, "[[links]]", "[links]", "malformed TOML", None),
        (TREE, 'shape = "mesh"', 'shape = "box"', "needs the sizes", "[[links.visual]]"),
        (SCREWS, "T_zero", "T_zer", "did you mean 'T_zero'", None),
        (SCREWS, "[1, 0, 0, 0.5]", "[2, 0, 0, 0.5]", "not a rotation", None),
        (SCREWS, 'type = "prismatic"', 'type = "fixed"', "one of revolute", "[[screws.joints]]"),
        (SCREWS, "point = [0, 0, 0.25]\n", "", "'point' is missing", "[[screws.joints]]"),
        (DH, 'convention = "modified"', 'convention = "modify"', "did you mean 'modified'", None),
        (DH, 'convention = "modified"\n', "", "'convention' is missing", None),
        (DH, "a = 0.5", "b = 0.5", "no key 'b'", None),
        (DH, "a = 0.5", "com = [0, 0, 1]", "com and inertia need mass", None),
        (DH, "a = 0.5", "mass = -1", "must not be negative", None),
        (DH, "a = 0.5", "friction = nan", "friction of joint 'joint_2'", None),
        (DH, "[dh]", "[screws]", "but has screws and dh", None),
        (DH, '"two"', '"two', "malformed TOML", None),
        ("x = 1\n", "x", "y", "must contain one of", None),
        ("x = 1\n", "1", "[" * 100_000, "malformed TOML", None),
        ("x = 1\n", "x", ".".join("a" * 20_000), "a key has more than 100 parts", None),
        ("x = 1\n", "x = 1", f"[{'a . ' * 200}b]", "a key has more than 100 parts", None),
        ("x = 1\n", "1", "{" + "'a'." * 5000 + "b = 1}", "a key has more than 100 parts", None),
    ],
)
def test_a_fault_is_told_with_file_and_place(text, old, new, says, header, tmp_path):
    assert old in text
    bad = text.replace(old, new, 1)
    path = tmp_path / "bad.toml"
    path.write_text(bad)
    with pytest.raises(DescriptionError, match=says) as caught:
        from_toml(path)
    assert caught.value.path == str(path)
    assert str(caught.value).startswith(str(path))
    if header is not None:
        assert bad.splitlines()[caught.value.line - 1] == header
    with pytest.raises(DescriptionError, match=says):
        from_toml(bad + "\n")


@pytest.mark.parametrize(
    ("content", "says"),
    [
        (b"", "none of them"),
        (b"\x89PNG\r\n\x1a\n\xff", "not UTF-8"),
        (b'{"robot": 1}', "malformed TOML"),
        (b"<robot/>", "malformed TOML"),
        (None, "no such file"),
        ("folder", "this is a folder"),
        (b" " * (5 * 2**20), "the maximum is"),
    ],
)
def test_a_file_that_is_no_robot_is_refused(content, says, tmp_path):
    path = tmp_path / "thing.toml"
    if content == "folder":
        path.mkdir()
    elif content is not None:
        path.write_bytes(content)
    with pytest.raises(DescriptionError, match=says):
        from_toml(path)


@pytest.mark.parametrize("seed", range(5))
def test_allowed_pairs_are_written_and_read_back(seed):
    rng = np.random.default_rng(seed)
    robot = random_tree(rng, n=6)
    links = list(robot.link_by_name)
    chosen = [sorted(rng.choice(links, 2, replace=False).tolist()) for _ in range(4)]
    pairs = tuple((a, b, reason) for (a, b), reason in zip(chosen, ["Never", "", 'a "b"', "é"], strict=True))
    again = from_toml(to_toml(replace(robot, allowed_pairs=pairs)))
    assert again.allowed_pairs == pairs
    assert to_toml(again) == to_toml(replace(robot, allowed_pairs=pairs))


def test_allowed_pairs_of_screws_and_tables_and_without_reasons():
    for text, base, tip in ((SCREWS, "base_link", "tool0"), (DH, "base", "tip")):
        robot = from_toml(f'allowed_pairs = [["{base}", "{tip}"]]\n{text}')
        assert from_toml(to_toml(robot)).allowed_pairs == robot.allowed_pairs == ((base, tip, ""),)


@pytest.mark.parametrize(
    ("pairs", "message"),
    [
        ("3", "allowed_pairs contains 3; a row is"),
        ('["base", "hand"]', "allowed_pairs contains 'base'; a row is"),
        ('[["base"]]', r"allowed_pairs contains \['base'\]; a row is"),
        ('[["base", 1]]', "a row is"),
        ('[["base", "hnad"]]', "no link 'hnad' in robot 'arm'; did you mean 'hand'"),
        ('[["base", "base"]]', "names link 'base' twice"),
    ],
)
def test_faulty_allowed_pairs_are_refused(pairs, message, tmp_path):
    path = tmp_path / "arm.toml"
    path.write_text(f"allowed_pairs = {pairs}\n{TREE}")
    with pytest.raises(DescriptionError, match=f"arm.toml.*{message}"):
        from_toml(path)
