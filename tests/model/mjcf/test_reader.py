"""What the reader makes of MJCF, in numbers that can be worked out by hand."""

import logging
import math

import numpy as np
import pytest

from cspace.errors import DescriptionError
from cspace.model import chain, from_mjcf, mobility, to_urdf
from cspace.robots import load_description, load_robot
from cspace.spatial import pose
from model.mjcf.models import ARM
from oracles.forward import link_poses


def world(inside, before=""):
    return f"<mujoco>{before}<worldbody>{inside}</worldbody></mujoco>"


def tip(text, link, **q):
    return link_poses(from_mjcf(text), q)[link]


def test_everything_in_the_arm_is_read():
    robot = from_mjcf(ARM)
    assert robot.name == "arm"
    assert robot.root == "world"
    assert [joint.name for joint in robot.moving_joints] == ["pan", "lift", "elbow", "grip", "mirror"]
    names = {link.name for link in robot.links}
    bodies = {"base", "upper", "fore", "hand", "other"}
    assert names == {"world", *bodies, "upper/pan", "upper/lift", "camera", "hand_site"}


def test_classes_give_what_an_element_leaves_out():
    robot = from_mjcf(ARM)
    pan, elbow, grip = (robot.joint(name) for name in ("pan", "elbow", "grip"))
    assert (pan.lower, pan.upper) == (math.radians(-170), math.radians(170))
    assert (elbow.lower, elbow.upper) == (math.radians(-120), math.radians(120))
    assert (grip.type, grip.lower, grip.upper) == ("prismatic", 0.0, 0.1)
    assert grip.axis.tolist() == [1, 0, 0]
    assert (pan.damping, pan.friction, grip.damping) == (2.0, 0.5, 2.0)


def test_actuators_add_their_damping_and_armature_behind_their_gears():
    """As MuJoCo has it, gear² times their own; defaults count, and several actuators add up."""
    body = '<body name="b"><joint name="j" damping="1"{}/><geom size="1"/></body>'
    classes = '<default><joint frictionloss="3"/><motor armature="0.01"/></default>'
    text = world(body.format(' armature="0.1"'), classes).replace(
        "</mujoco>",
        """<actuator><motor joint="j" gear="-10" damping="0.5"/><position jointinparent="j" armature="0.02"/>
        <general site="s" armature="7"/></actuator></mujoco>""",
    )
    joint = from_mjcf(text).joint("j")
    assert joint.armature == pytest.approx(0.1 + 100 * 0.01 + 0.02)
    assert (joint.damping, joint.friction) == (pytest.approx(1 + 100 * 0.5), 3.0)
    plain = from_mjcf(world(body.format(""), classes)).joint("j")
    assert (plain.armature, plain.damping, plain.friction) == (None, 1.0, 3.0)


def test_efforts_are_those_of_joints_and_actuators():
    robot = from_mjcf(ARM)
    efforts = {joint.name: joint.effort for joint in robot.moving_joints}
    # gear · ctrlrange of a motor; forcerange; the class's gear · forcerange, less than the joint's own 30
    assert efforts == {"pan": 30.0, "lift": 50.0, "elbow": 24.0, "grip": 30.0, "mirror": 30.0}


def test_a_coupling_is_a_mimic_about_the_references():
    mirror = from_mjcf(ARM).joint("mirror")
    assert mirror.mimic.joint == "grip"
    assert mirror.mimic.multiplier == -0.5
    assert mirror.mimic.offset == pytest.approx(0.01 + 0.02)  # q − 0.02 = 0.01 − 0.5 q_grip


def test_a_coupling_to_nothing_holds_the_joint():
    text = world('<body name="b"><joint name="j" ref="0.1" type="slide" axis="0 0 1"/></body>').replace(
        "</mujoco>", '<equality><joint joint1="j" polycoef="0.5"/></equality></mujoco>'
    )
    robot = from_mjcf(text)
    assert robot.joint("j").type == "fixed"
    np.testing.assert_allclose(tip(text, "b"), pose((0, 0, 0.5)), atol=1e-15)


def test_a_curved_coupling_leaves_its_joints_free_and_is_logged(caplog):
    text = ARM.replace('polycoef="0.01 -0.5 0 0 0"', 'polycoef="0 1 2"')
    with caplog.at_level(logging.WARNING, "cspace"):
        robot = from_mjcf(text)
    assert robot.joint("mirror").mimic is None
    assert "'mirror' and 'grip' are coupled by a polynomial" in caplog.text


def test_keyframes_are_poses_of_the_independent_joints():
    robot = from_mjcf(ARM)
    assert {name: dict(values) for name, values in robot.poses.items()} == {
        "home": {"pan": 0.1, "lift": 0.2, "elbow": 0.3, "grip": 0.04}
    }


def test_shapes_colours_and_meshes(tmp_path):
    path = tmp_path / "arm.xml"
    path.write_text(ARM)
    robot = load_description(path)
    (box,) = robot.link("base").visual
    assert (box.shape, box.size, box.color) == ("box", (0.2, 0.4, 0.1), (0.5, 0.6, 0.7, 1.0))
    capsule, mesh = robot.link("upper").visual
    assert (capsule.shape, capsule.size) == ("capsule", (0.05, 0.4))
    np.testing.assert_allclose(capsule.origin[:3, 3], [0, 0.2, 0], atol=1e-15)
    assert (mesh.mesh.uri, mesh.mesh.scale) == ("meshes/link.stl", (0.001, 0.001, 0.001))
    (cylinder,) = robot.link("upper").collision
    assert (cylinder.shape, cylinder.size, cylinder.color) == ("cylinder", (0.06, 0.4), (1.0, 0.0, 0.0, 1.0))
    (cover,) = robot.link("fore").collision
    expected = pose((0, 0.0, 0)) @ robot.joint("camera_fixed").origin
    x_of_frame = pose((0.3, 0, 0)) @ pose((0, 0, 0), rpy=(0, math.pi / 2, 0))
    np.testing.assert_allclose(cover.origin, x_of_frame @ pose((0, 0, -0.1)), atol=1e-15)  # refpos taken away
    np.testing.assert_allclose(expected[:3, 3], (x_of_frame @ pose((0.01, 0, 0)))[:3, 3], atol=1e-15)
    with pytest.raises(
        DescriptionError, match=r"mesh 'meshes/link.stl' not found; searched:\n.*meshes/link.stl"
    ):
        mesh.mesh.file()
    (tmp_path / "meshes").mkdir()
    (tmp_path / "meshes" / "link.stl").write_text("solid")
    assert mesh.mesh.file() == str(tmp_path / "meshes" / "link.stl")


def test_planes_and_ellipsoids_are_not_drawn():
    robot = from_mjcf(ARM)
    assert not robot.link("world").visual
    assert not robot.link("hand").visual


def test_an_ellipsoid_collides_as_the_box_around_it():
    (box,) = (
        from_mjcf(world('<body name="b"><geom type="ellipsoid" size="0.1 0.05 0.02" pos="1 0 0"/></body>'))
        .link("b")
        .collision
    )
    assert box.shape == "box"
    np.testing.assert_allclose(box.size, (0.2, 0.1, 0.04))
    np.testing.assert_allclose(box.origin[:3, 3], (1, 0, 0))


@pytest.mark.parametrize("geom", ['type="plane" size="1 1 1"', 'type="hfield"', 'type="sdf"'])
def test_a_shape_that_links_do_not_have_is_logged_where_it_can_collide(geom, caplog):
    assert not from_mjcf(world(f'<body name="b"><geom {geom} mass="0"/></body>')).link("b").collision
    assert f"geom of type {geom.split(chr(34))[1]} can collide" in caplog.text
    caplog.clear()
    from_mjcf(world(f'<body name="b"><geom {geom} mass="0" contype="0" conaffinity="0"/></body>'))
    assert not caplog.text


def test_a_mass_that_only_a_mesh_could_tell_is_unknown():
    asset = '<asset><mesh name="m" file="m.stl"/></asset>'
    assert (
        from_mjcf(world('<body name="b"><geom type="mesh" mesh="m"/></body>', asset)).link("b").inertial
        is None
    )
    both = '<body name="b"><geom type="mesh" mesh="m" mass="0"/><geom size="1" density="3"/></body>'
    assert from_mjcf(world(both, asset)).link("b").inertial.mass == pytest.approx(4 * math.pi)


def test_an_anchor_and_a_reference_turn_about_a_point():
    """A hinge through (1, 0, 0): a quarter turn beyond its reference takes the origin to (1, −1, 0)."""
    text = world('<body name="b"><joint name="j" pos="1 0 0" ref="90"/></body>')
    np.testing.assert_allclose(tip(text, "b", j=math.pi / 2), np.eye(4), atol=1e-15)
    np.testing.assert_allclose(tip(text, "b", j=math.pi)[:3, 3], [1, -1, 0], atol=1e-15)


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ('euler="10 20 30"', lambda: rotations((0, 10), (1, 20), (2, 30))),
        ('quat="2 0 0 2"', lambda: rotations((2, 90))),
        ('axisangle="0 5 0 40"', lambda: rotations((1, 40))),
        ('xyaxes="0 2 0 -1 7 0"', lambda: rotations((2, 90))),
        ('zaxis="0 -3 0"', lambda: rotations((0, 90))),
        ('zaxis="0 0 -1"', lambda: rotations((0, 180))),
    ],
)
def test_every_way_to_turn_a_body(text, expected):
    np.testing.assert_allclose(tip(world(f'<body name="b" {text}/>'), "b"), expected(), atol=1e-15)


@pytest.mark.parametrize(
    ("sequence", "order"), [("zyx", (2, 1, 0)), ("XYZ", (2, 1, 0)), ("xYz", (1, 0, 2)), ("zxz", (2, 0, 2))]
)
def test_small_letters_turn_with_the_body_and_capitals_with_the_world(sequence, order):
    angles = dict(zip("abc", (10, 20, 30), strict=True))
    text = world('<body name="b" euler="10 20 30"/>', f'<compiler eulerseq="{sequence}"/>')
    product = np.eye(4)
    for letter, angle in zip(sequence, angles.values(), strict=True):
        turn = rotations(("xyz".index(letter.lower()), angle))
        product = product @ turn if letter.islower() else turn @ product
    np.testing.assert_allclose(tip(text, "b"), product, atol=1e-15)
    if sequence == "XYZ":
        np.testing.assert_allclose(product, rotations(*zip(order, (30, 20, 10), strict=True)), atol=1e-15)


def rotations(*turns):
    T = np.eye(4)
    for axis, degrees in turns:
        T = T @ pose((0, 0, 0), rpy=np.radians(degrees) * np.eye(3)[axis])
    return T


def test_several_joints_in_a_body_act_in_order_with_links_between():
    text = world('<body name="b"><joint name="a" type="slide" axis="1 0 0"/><joint name="c"/></body>')
    robot = from_mjcf(text)
    assert [joint.child for joint in robot.joints] == ["b/a", "b"]
    assert chain(robot).joint_types == "PR"


def test_names_are_made_up_where_there_are_none_and_never_twice():
    text = world(
        '<body><joint/><joint/><body name="body_1"><site name="body_1"/><site/></body></body>'
        '<body name="body_1_site"/>'
    )
    robot = from_mjcf(text)
    assert len({link.name for link in robot.links}) == len(robot.links) == 6
    assert len({joint.name for joint in robot.joints}) == len(robot.joints) == 5


def test_ties_of_bodies_are_loops():
    bars = "".join(
        f'<body name="{name}" pos="{x} 0 0"><joint name="{name}" axis="0 1 0"/></body>'
        for name, x in (("left", 0), ("right", 1))
    )
    ties = """<equality><connect name="bar" body1="left" body2="right" anchor="0 0 1"/>
      <weld body1="right" body2="world"/><weld body1="left" active="false"/></equality>"""
    robot = from_mjcf(world(bars).replace("</mujoco>", ties + "</mujoco>"))
    bar, weld = robot.loops
    assert (bar.name, bar.type, bar.parent, bar.child) == ("bar", "spherical", "left", "right")
    np.testing.assert_allclose(bar.child_origin, pose((-1, 0, 1)), atol=1e-15)
    assert (weld.type, weld.parent, weld.child) == ("fixed", "right", "world")
    np.testing.assert_allclose(weld.origin, pose((-1, 0, 0)), atol=1e-15)
    assert mobility(robot) == 6 * (3 - 1 - 4) + 1 + 1 + 3 + 0


def test_sites_tie_bodies_too():
    inside = '<body name="a"><site name="s" pos="1 0 0"/></body><body name="b"><site name="t"/></body>'
    ties = '<equality><weld site1="s" site2="t"/></equality></mujoco>'
    (loop,) = from_mjcf(world(inside).replace("</mujoco>", ties)).loops
    assert (loop.parent, loop.child) == ("s", "t")


def test_includes_are_put_in_their_place(tmp_path):
    (tmp_path / "parts").mkdir()
    (tmp_path / "main.xml").write_text(
        '<mujoco><include file="defaults.xml"/>\n'
        '<worldbody><include file="parts/arm.xml"/></worldbody></mujoco>'
    )
    (tmp_path / "defaults.xml").write_text('<mujoco><default><joint type="slide"/></default></mujoco>')
    (tmp_path / "parts/arm.xml").write_text('<x><body name="b">\n<include file="near.xml"/></body></x>')
    (tmp_path / "parts/near.xml").write_text('<x><joint name="j"/></x>')
    assert load_description(tmp_path / "main.xml").joint("j").type == "prismatic"
    (tmp_path / "near.xml").write_text('<x><joint name="k"/></x>')  # beside the main file: found first
    assert [joint.name for joint in load_description(tmp_path / "main.xml").moving_joints] == ["k"]
    (tmp_path / "near.xml").write_text('<x>\n\n<joint axis="0 0 0"/></x>')
    with pytest.raises(DescriptionError, match="must not be zero") as caught:
        load_description(tmp_path / "main.xml")
    assert (caught.value.path, caught.value.line) == (str(tmp_path / "near.xml"), 3)


def test_deep_chains_are_read_and_deeper_ones_refused():
    def nested(n):
        return world('<body><joint axis="0 1 0"/>' * n + "</body>" * n)

    assert len(from_mjcf(nested(490)).moving_joints) == 490
    with pytest.raises(DescriptionError, match="nested more than 500 deep"):
        from_mjcf(nested(600))


def test_a_urdf_file_and_an_mjcf_file_are_told_apart(tmp_path):
    robot = from_mjcf(world('<body name="b"><joint name="j"/></body>'))
    (tmp_path / "a.xml").write_text(to_urdf(robot))
    (tmp_path / "b.xml").write_text("<!-- mujoco -->\n" + world('<body name="b"><joint name="j"/></body>'))
    for name in ("a.xml", "b.xml"):
        assert load_robot(tmp_path / name).joint_names == ("j",)


HOSTILE = '<!DOCTYPE x [<!ENTITY a "aaaaaaaaaa"><!ENTITY b "&a;&a;&a;&a;&a;&a;&a;&a;">]><mujoco>&b;</mujoco>'

FAULTS = {
    "ball": (world('<body><joint\n name="j" type="ball"/></body>'), 1, "'j' is a ball joint.*three hinges"),
    "free inside": (world('<body><body name="b"><freejoint/></body></body>'), 1, "free joint of 'b'"),
    "free and more": (world('<body name="b">\n<freejoint/><joint/></body>'), 2, "its only one"),
    "joint of the world": (world("\n<joint/>"), 2, "<joint> stands in the world"),
    "zero axis": (
        world('<body>\n<joint name="j" axis="0 0 0"/></body>'),
        2,
        "axis of joint 'j'.*not be zero",
    ),
    "range": (world('<body><joint limited="true" range="2 1"/></body>'), 1, "range 2 to 1"),
    "no range": (world('<body><joint limited="true"/></body>'), 1, "range 0 to 0"),
    "autolimits": (
        world('<body>\n<joint range="0 1"/></body>', '<compiler autolimits="false"/>'),
        2,
        "has a range, and autolimits is off",
    ),
    "class": (world('\n<body childclass="x"><joint/></body>'), 2, "no default class 'x'"),
    "second class": (
        world("", '<default><default class="a"/>\n<default class="a"/></default>'),
        2,
        "second default class 'a'",
    ),
    "nameless class": (world("", "<default><default/></default>"), 1, "a class needs a name"),
    "type": (world('<body><joint type="hing"/></body>'), 1, "did you mean 'hinge'"),
    "attribute": (
        world('<body>\n<joint rnage="0 1"/></body>'),
        2,
        "no attribute 'rnage'; did you mean 'range'",
    ),
    "element": (world("<body>\n<jiont/></body>"), 2, "<body> has no <jiont>; did you mean <joint>"),
    "section": ("<mujoco>\n<worldbdy/></mujoco>", 2, "did you mean <worldbody>"),
    "numbers": (world('<body pos="1 2"/>'), 1, r"holds 2 numbers, expected 3"),
    "word": (world('<body pos="1 2 x"/>'), 1, "expected 3 numbers"),
    "nan": (world('<body pos="1 2 nan"/>'), 1, "must be finite"),
    "huge": (world('<body pos="1 2 1e20"/>'), 1, "holds 1e.20; no robot has numbers beyond"),
    "twice turned": (world('<body quat="1 0 0 0" euler="0 0 0"/>'), 1, "turned twice, by 'quat' and 'euler'"),
    "zero quaternion": (world('<body quat="0 0 0 0"/>'), 1, "quat of <body> is zero"),
    "zero axisangle": (world('<body axisangle="0 0 0 1"/>'), 1, "axisangle of <body> is no direction"),
    "one axis twice": (world('<body xyaxes="1 0 0 2 0 0"/>'), 1, "the y axis in xyaxes"),
    "size": (world('<body><geom type="box" size="1 2"/></body>'), 1, r"size of a box is \[1.0, 2.0\]"),
    "no size": (world("<body><geom/></body>"), 1, "size of a sphere is"),
    "fromto of a sphere": (world('<body><geom fromto="0 0 0 1 1 1" size="1"/></body>'), 1, "no sphere"),
    "no length": (
        world('<body><geom type="capsule" fromto="1 1 1 1 1 1" size="1"/></body>'),
        1,
        "no direction",
    ),
    "mesh": (world('<body><geom type="mesh" mesh="m"/></body>'), 1, "no mesh 'm' in <asset>"),
    "mass": (world('<body><inertial pos="0 0 0" mass="-1"/></body>'), 1, "must not be negative"),
    "no place": (world('<body><inertial mass="1"/></body>'), 1, "needs the attribute 'pos'"),
    "two masses": (world("<body>" + '<inertial pos="0 0 0" mass="1"/>' * 2 + "</body>"), 1, "two <inertial>"),
    "two bodies": (world('<body name="b"/>\n<body name="b"/>'), 2, "a second body is named 'b'"),
    "a second world": (world('<body name="world"/>'), 1, "a second body is named 'world'"),
    "two joints": (
        world('<body><joint name="b"/>\n<joint name="b"/></body>'),
        2,
        "a second joint is named 'b'",
    ),
    "two sites": (world('<site name="b"/>\n<site name="b"/>'), 2, "a second site is named 'b'"),
    "replicate": (world('<replicate count="3"><body/></replicate>'), 1, "copies of a body.*mj_saveLastXML"),
    "coordinates": (world("", '<compiler coordinate="global"/>'), 1, "global coordinates were dropped"),
    "sequence": (world("", '<compiler eulerseq="xyw"/>'), 1, "eulerseq is 'xyw'"),
    "part": ("<mujocoinclude/>", 1, "it is a part, so give the file"),
    "other root": ("<html/>", 1, "not <mujoco>"),
    "entities": (HOSTILE, 1, "entity declarations are refused"),
    "cut": (world('<body name="b"/>')[:-20], 1, "malformed XML"),
    "include in a text": (world('<include file="x.xml"/>'), 1, "a text, which has no folder"),
}


@pytest.mark.parametrize(("text", "line", "says"), FAULTS.values(), ids=FAULTS.keys())
def test_a_fault_is_told_with_its_line(text, line, says):
    with pytest.raises(DescriptionError, match=says) as caught:
        from_mjcf(text)
    assert caught.value.line == line


EQUALITIES = {
    "unknown joint": ('<joint joint1="x" joint2="j"/>', "joint1 of an equality: no joint 'x'"),
    "free joint": ('<joint joint1="f" joint2="j"/>', "'f' is free"),
    "twice": ('<joint joint1="j" joint2="k"/><joint joint1="j" joint2="k"/>', "coupled twice"),
    "itself": ('<joint joint1="j" joint2="j"/>', "mimics itself"),
    "circle": ('<joint joint1="j" joint2="k"/><joint joint1="k" joint2="j"/>', "through a cycle"),
    "unknown body": ('<weld body1="x"/>', "no body 'x'.*bodies: a, b, c, world"),
    "unknown site": ('<connect site1="x" site2="y"/>', "no site 'x'"),
    "no anchor": ('<connect body1="a"/>', "needs the attribute 'anchor'"),
}


@pytest.mark.parametrize(("tie", "says"), EQUALITIES.values(), ids=EQUALITIES.keys())
def test_an_equality_that_ties_nothing_is_told_with_its_line(tie, says, tmp_path):
    bodies = (
        '<body name="a"><joint name="j"/></body><body name="b"><joint name="k"/></body>'
        '<body name="c"><freejoint name="f"/></body>'
    )
    path = tmp_path / "x.xml"
    path.write_text(world(bodies).replace("</mujoco>", f"\n<equality>{tie}</equality></mujoco>"))
    with pytest.raises(DescriptionError, match=says) as caught:
        from_mjcf(path)
    assert caught.value.path == str(path)
    assert caught.value.line in (1, 2)  # of the equality, or of the joint that it concerns


@pytest.mark.parametrize("target", ["main.xml", "a.xml", "b.xml"])
def test_circles_of_includes_end(target, tmp_path):
    (tmp_path / "main.xml").write_text('<mujoco><include file="a.xml"/></mujoco>')
    (tmp_path / "a.xml").write_text('<mujoco>\n<include file="b.xml"/></mujoco>')
    (tmp_path / "b.xml").write_text(f'<mujoco>\n\n<include file="{target}"/></mujoco>')
    with pytest.raises(DescriptionError, match="included a second time") as caught:
        load_description(tmp_path / "main.xml")
    assert (caught.value.path, caught.value.line) == (str(tmp_path / "b.xml"), 3)


@pytest.mark.parametrize(
    ("content", "says"),
    [(None, "no such file"), ("<x/>", "holds no elements"), ("<x>", "malformed XML"), ("", "malformed XML")],
)
def test_an_include_that_cannot_be_read_says_why(content, says, tmp_path):
    (tmp_path / "main.xml").write_text('<mujoco>\n<include file="a.xml"/></mujoco>')
    if content is not None:
        (tmp_path / "a.xml").write_text(content)
    with pytest.raises(DescriptionError, match=says):
        load_description(tmp_path / "main.xml")


GEOM = '<geom size="1" mass="1"/>'
PAIR = f'<body name="a"><joint/>{GEOM}\n<body name="b"><joint name="j"/>{GEOM}</body></body>'


def with_contact(contact):
    return f"<mujoco><worldbody>{PAIR}</worldbody>\n<contact>{contact}</contact></mujoco>"


def test_excluded_bodies_may_touch():
    named, unnamed = '<exclude name="grip" body1="b" body2="a"/>', '<exclude body1="world" body2="b"/>'
    robot = from_mjcf(with_contact(named + unnamed))
    assert robot.allowed_pairs == (("b", "a", "grip"), ("world", "b", "excluded"))
    assert from_mjcf(with_contact('<pair geom1="x" geom2="y"/>')).allowed_pairs == ()


@pytest.mark.parametrize(
    ("contact", "says"),
    [
        ('<exclude body1="a"/>', "<exclude>: no body ''"),
        ('<exclude body1="a" body2="c"/>', "<exclude>: no body 'c'"),
        ('<exclude body1="a" body2="a"/>', "names body 'a' twice"),
        ('<exlude body1="a" body2="b"/>', "did you mean <exclude>"),
    ],
)
def test_a_faulty_exclude_is_told_with_its_line(contact, says):
    with pytest.raises(DescriptionError, match=says) as caught:
        from_mjcf(with_contact(contact))
    assert caught.value.line == 3
