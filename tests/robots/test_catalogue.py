import importlib.util
import json
import math
import pickle
import re
from dataclasses import replace
from importlib import metadata

import numpy as np
import pytest

from cspace.errors import UnknownNameError
from cspace.model import chain, dh_matrix, from_dh, from_urdf, to_dh, to_urdf, with_right_angles
from cspace.model.values import from_rpy
from cspace.robot import Robot
from cspace.robots import find, load_description, load_robot, names, rows, search
from cspace.robots.lookup import FOLDER, plain_text
from data import ROOT, shared_data
from oracles.forward import product_of_exponentials


def maker():
    spec = importlib.util.spec_from_file_location("catalogue_tool", ROOT / "tools" / "catalogue.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def chain_fk(c, q):
    return product_of_exponentials(c.axes, c.points, c.joint_types, c.T_zero, q)


def test_the_index_and_the_page_are_made_from_the_files():
    for path, text in maker().outputs().items():
        assert path.read_text(encoding="utf-8") == text, f"run tools/catalogue.py: {path.name} has drifted"


def test_every_file_is_named_as_its_robot_and_every_name_is_found_once():
    assert sorted(path.stem for path in FOLDER.glob("*.toml")) == list(names())
    owner = {}
    for row in rows():
        assert load_description(row.name).name == row.name
        for name in {plain_text(n) for n in (row.name, *row.aliases)}:
            assert name not in owner, f"{name} is both {owner[name]} and {row.name}"
            owner[name] = row.name


@pytest.mark.parametrize("name", names())
def test_a_robot_says_what_it_is_and_what_it_lacks(name):
    robot = load_description(name)
    about = robot.provenance
    assert about.title
    assert about.vendor
    assert about.sources["joints"].source
    assert about.sources["joints"].licence
    limited = [j.type == "continuous" or np.isfinite([j.lower, j.upper]).any() for j in robot.moving_joints]
    assert ("limits" in about.sources) == any(limited)
    assert ("limits" in about.missing) != any(limited)
    for field in ("velocity", "acceleration", "jerk", "effort"):
        known = [j for j in robot.moving_joints if np.isfinite(getattr(j, field))]
        assert (field in about.missing) != bool(known)
        assert (field in about.sources) == bool(known)
        assert len(known) in (0, len(robot.moving_joints))
        assert all(getattr(j, field) > 0 for j in known)
    for field in ("damping", "friction", "armature"):
        known = [j for j in robot.moving_joints if getattr(j, field) is not None]
        assert (field in about.sources) == bool(known)
        assert len(known) in (0, len(robot.moving_joints))
    massive = any(link.inertial for link in robot.links)
    assert ("inertia" in about.missing) != massive
    assert ("inertia" in about.sources) == massive
    assert ("collision" in about.missing) != any(link.collision for link in robot.links)
    assert ("visual" in about.missing) != any(link.visual for link in robot.links)
    assert ("poses" in about.missing) != bool(robot.poses)


@pytest.mark.parametrize("name", names())
def test_urdf_and_both_tables_of_a_robot_move_alike(name):
    robot = load_description(name)
    c = chain(robot)
    rng = np.random.default_rng(0)
    q = rng.uniform(-3, 3, (3, len(c.joint_types)))
    tables = [to_dh(c, convention=convention) for convention in ("standard", "modified")]
    others = [chain(from_urdf(to_urdf(robot))), *(chain(from_dh(table)) for table in tables)]
    allowed = [1e-12, *(max(1e-12, table.deviation) for table in tables)]
    for values in q:
        expected = chain_fk(c, values)
        for other, atol in zip(others, allowed, strict=True):
            np.testing.assert_allclose(chain_fk(other, values), expected, atol=atol)
        for table in tables:
            np.testing.assert_allclose(table.fk(values), expected, atol=max(1e-12, table.deviation))


def test_no_arm_pays_for_nearly_parallel_axes_in_its_tables():
    """Right angles that makers print with five digits are exact."""
    beyond = [
        n for n in names() if to_dh(chain(load_description(n)), convention="standard").deviation > 1e-12
    ]
    assert not beyond


def squared_here(description):
    """Whether the catalogue has exact right angles where the source rounds them."""
    return "exact here" in description.provenance.sources["joints"].source


@pytest.mark.parametrize("name", names())
def test_right_angles_are_exact_or_the_source_is_further_off(name):
    """No axis of the catalogue is almost, but not quite, at a right angle to the one before."""
    robot = load_description(name)
    squared = with_right_angles(robot)
    tolerance = 1e-15 if squared_here(robot) else 1e-8  # of nine digits and more, as of UR arms
    for joint, exact in zip(robot.joints, squared.joints, strict=True):
        np.testing.assert_allclose(joint.origin, exact.origin, atol=tolerance, rtol=0)
        np.testing.assert_allclose(joint.axis, exact.axis, atol=tolerance, rtol=0)


ENDS = {
    "fanuc_crx10ia": ("base_link", "flange"),
    "fanuc_crx10ial": ("base_link", "fanuc_flange"),
    "fanuc_crx30ia": ("base_link", "flange"),
    "fanuc_crx3ia": ("base_link", "flange"),
    "iiwa14": ("iiwa_link_0", "iiwa_link_ee"),
    "m1013": ("base_0", "link6"),
    "viperx300s": ("vx300s/base_link", "vx300s/gripper_link"),
}
"""Arms whose maker names the base and the tip of the shared data otherwise."""

JOINT_NAMES = {
    "fanuc_crx10ial": ("J1", "J2", "J3", "J4", "J5", "J6"),
    "m1013": ("joint1", "joint2", "joint3", "joint4", "joint5", "joint6"),
}
"""Arms whose maker names the joints of the shared data otherwise."""

OLDER_UR = ("ur3", "ur5", "ur10")
"""Arms of which the shared data has a file that prints π/2 with twelve digits. Here it is π/2."""

TWELVE_DIGITS = 2e-11
"""How far an axis [rad] or a point [m] is moved by that."""

FIVE_DIGITS = 3e-5
"""How far an axis [rad] or a point [m] is moved where right angles of five digits are exact here."""

TURNED_TIPS = {
    **{name: [[0, 0, 1], [-1, 0, 0], [0, -1, 0]] for name in OLDER_UR},
    "rtbdata_kr210l150": [[0, 0, 1], [0, 1, 0], [-1, 0, 0]],
}
"""tool0 in the tip of the shared data, which is turned and is no frame of the maker."""


@pytest.mark.data
def test_the_arms_of_the_shared_data_are_here_to_rounding():
    arms = json.loads((shared_data() / "arms" / "chains.json").read_text())
    assert len(arms) == 81
    for arm in arms:
        name, n = arm["name"], len(arm["joints"])
        older = name in OLDER_UR
        robot = load_description(name)
        ends = ENDS.get(name, (arm["base_link"], arm["ee_link"]))
        assert older or ends == ("None", "None") or set(ends) <= set(robot.link_by_name)
        c = chain(robot, *(end if end in robot.link_by_name else None for end in ends))
        names_there = tuple(joint["name"] for joint in arm["joints"])
        assert c.joint_names == JOINT_NAMES.get(name, names_there)
        kinds = {"prismatic": "P", "revolute": "R"}
        assert c.joint_types == "".join(kinds[joint["type"]] for joint in arm["joints"])
        axes = np.array([joint["axis"] for joint in arm["joints"]])
        axes /= np.linalg.norm(axes, axis=1)[:, None]
        T_zero = np.array(arm["tool_zero"])
        T_zero[:3, :3] = T_zero[:3, :3] @ TURNED_TIPS.get(name, np.eye(3))
        atol = TWELVE_DIGITS if older else FIVE_DIGITS if squared_here(load_description(name)) else 1e-15
        np.testing.assert_allclose(c.axes, axes, atol=atol, rtol=0)
        np.testing.assert_allclose(c.T_zero, T_zero, atol=atol, rtol=0)
        gap = np.cross(c.points - [joint["point"] for joint in arm["joints"]], c.axes)
        turning = np.array([kind == "R" for kind in c.joint_types])
        np.testing.assert_allclose(gap[turning], 0, atol=atol)
        for i in range(n):
            if name == "puma560":
                continue  # ±180° in the data; the published ranges have a test of their own
            lower, upper = (arm["joints"][i][key] for key in ("lower", "upper"))
            assert c.limits.lower[i] == (-np.inf if lower is None else unrounded(lower))
            assert c.limits.upper[i] == (np.inf if upper is None else unrounded(upper))


PRINTED = 1e-8
"""How much of a limit [rad] is lost by files that print nine digits or more."""


def unrounded(value):
    """A limit as printed, or the multiple of half a degree that was printed with nine digits or more."""
    round_angle = math.radians(round(2 * math.degrees(value)) / 2)
    return round_angle if round_angle and abs(value - round_angle) < PRINTED else value


@pytest.mark.parametrize("name", names())
def test_a_limit_that_is_a_round_angle_is_it_to_the_last_digit(name):
    """π printed with 15 digits is 3e-15 short of the angle that a solution stands at."""
    for joint in load_description(name).moving_joints:
        if joint.type == "revolute":
            for limit in filter(math.isfinite, (joint.lower, joint.upper)):
                assert limit == unrounded(limit), f"{joint.name}: {limit!r} is {math.degrees(limit)}°"


def test_the_published_ranges_of_the_puma():
    """Of Lee's table, where the zero of joints 2 and 3 is half a turn away from Paul's and Corke's."""
    published = [(-160, 160), (-225, 45), (-45, 225), (-110, 170), (-100, 100), (-266, 266)]
    table = [(-90, 0, 0), (0, 0.4318, 0.15005), (90, -0.0203, 0), (-90, 0, 0.4318), (90, 0, 0), (0, 0, 0)]
    half = np.array([0, 180, 180, 0, 0, 0])
    turned = np.diag([-1.0, -1.0, 1.0, 1.0])  # base and flange, half a turn about z
    robot = load_robot("puma560")
    for theta in np.random.default_rng(0).uniform(-180, 180, (20, 6)):
        T = np.eye(4)
        for (alpha, a, d), angle in zip(table, theta, strict=True):
            T = T @ dh_matrix(np.radians(alpha), a, d, np.radians(angle), convention="standard")
        np.testing.assert_allclose(turned @ robot.fk(np.radians(theta + half)) @ turned, T, atol=1e-14)
    for name in ("puma560", "puma560_dh"):
        limits = load_robot(name).limits
        gaps = [
            np.degrees(side) - (np.array(ends) + half)
            for side, ends in zip((limits.lower, limits.upper), zip(*published, strict=True), strict=True)
        ]
        np.testing.assert_allclose(gaps[0], gaps[1], atol=1e-12)  # by the same multiple of a turn
        np.testing.assert_allclose(gaps[0], 360 * np.round(gaps[0] / 360), atol=1e-12)


def cos_sin(*angles):
    return [f(a) for a in angles for f in (np.cos, np.sin)]


def test_the_planar_arms_of_the_lectures():
    t1, t2, t3 = 0.3, -1.1, 0.7
    a, b, c = t1, t1 + t2, t1 + t2 + t3
    expected = {
        "planar_1r": (np.cos(a), np.sin(a), a),
        "planar_2r": (np.cos(a) + np.cos(b), np.sin(a) + np.sin(b), b),
        "planar_3r": (np.cos(a) + np.cos(b) + np.cos(c) / 2, np.sin(a) + np.sin(b) + np.sin(c) / 2, c),
    }
    for name, (x, y, heading) in expected.items():
        robot = load_robot(name)
        T = robot.fk(np.array([t1, t2, t3])[: robot.dof])
        np.testing.assert_allclose(T[:3, 3], [x, y, 0], atol=1e-15)
        np.testing.assert_allclose(T[:2, 0], [np.cos(heading), np.sin(heading)], atol=1e-15)


def test_the_simplified_puma_of_the_lectures():
    l1, l2 = 1.0, 0.8
    q = np.array([0.4, -0.7, 1.3])
    c1, s1, c2, s2, c23, s23 = cos_sin(q[0], q[1], q[1] + q[2])
    gamma = c2 * l1 + c23 * l2
    p = [c1 * gamma, s1 * gamma, -(s2 * l1 + s23 * l2)]
    np.testing.assert_allclose(load_robot("simplified_puma").fk(q)[:3, 3], p, atol=1e-15)


def test_the_rpr_arm_of_the_lectures():
    l4 = 0.5
    t1, d2, t3 = 0.4, 0.9, 1.3
    c1, s1, c3, s3 = cos_sin(t1, t3)
    gamma = d2 - l4 * s3
    p = [-s1 * gamma, c1 * gamma, l4 * c3]
    np.testing.assert_allclose(load_robot("rpr").fk(np.array([t1, d2, t3]))[:3, 3], p, atol=1e-15)


def test_the_puma_style_arm_of_the_lectures():
    a2, a3, d6 = 0.45, 0.4, 0.1
    q = np.array([0.3, 0.5, -0.8, 0.6, 0.9, -1.2])
    T = load_robot("puma_style").fk(q)
    wrist = T[:3, 3] - d6 * T[:3, 2]
    assert wrist @ wrist == pytest.approx(a2**2 + a3**2 + 2 * a2 * a3 * np.cos(q[2]), abs=1e-15)
    assert np.arctan2(wrist[1], wrist[0]) == pytest.approx(q[0], abs=1e-15)
    c = chain(load_description("puma_style"))
    R_3 = chain_fk(c, [*q[:3], 0, 0, 0])[:3, :3]
    c4, s4, c5, s5, c6, s6 = cos_sin(*q[3:])
    Rz4 = np.array([[c4, -s4, 0], [s4, c4, 0], [0, 0, 1]])
    Ry5 = np.array([[c5, 0, s5], [0, 1, 0], [-s5, 0, c5]])
    Rz6 = np.array([[c6, -s6, 0], [s6, c6, 0], [0, 0, 1]])
    np.testing.assert_allclose(R_3.T @ T[:3, :3], Rz4 @ Ry5 @ Rz6, atol=1e-15)


def test_the_elbow_arm_of_the_lectures_has_its_invariant_points():
    c = chain(load_description("elbow"))
    shoulder, wrist = np.array([0, 0, 0.4]), c.T_zero[:3, 3]
    for joints, point in (((0, 1), shoulder), ((3, 4, 5), wrist)):
        for i in joints:
            np.testing.assert_allclose(np.cross(point - c.points[i], c.axes[i]), 0, atol=1e-15)
    np.testing.assert_allclose(wrist - shoulder, [0, 0.9, 0], atol=1e-15)


def test_the_scara_of_the_textbook():
    t1, t2, d3, t4 = 0.3, 0.8, 0.2, -0.5
    c1, s1, c12, s12 = cos_sin(t1, t1 + t2)
    T = load_robot("scara").fk(np.array([t1, t2, d3, t4]))
    np.testing.assert_allclose(T[:3, 3], [0.4 * c1 + 0.3 * c12, 0.4 * s1 + 0.3 * s12, -d3 - 0.05], atol=1e-15)
    np.testing.assert_allclose(T[:3, 2], [0, 0, -1], atol=1e-15)


@pytest.mark.parametrize(
    ("name", "types", "table"),
    [
        (
            "puma560_dh",
            "RRRRRR",
            [
                (90, 0, 0.67183),
                (0, 0.4318, 0),
                (-90, 0.0203, 0.15005),
                (90, 0, 0.4318),
                (-90, 0, 0),
                (0, 0, 0),
            ],
        ),
        (
            "stanford",
            "RRPRRR",
            [(-90, 0, 0.412), (90, 0, 0.154), (0, 0.0203, 0, -90), (-90, 0, 0), (90, 0, 0), (0, 0, 0)],
        ),
    ],
)
def test_the_published_tables(name, types, table):
    q = np.random.default_rng(0).uniform(-1, 1, 6)
    T = np.eye(4)
    for (alpha, a, d, *offset), kind, value in zip(table, types, q, strict=True):
        theta = np.radians(offset[0]) if offset else 0.0
        turn, slide = (value, 0.0) if kind == "R" else (0.0, value)
        T = T @ dh_matrix(np.radians(alpha), a, d + slide, theta + turn, convention="standard")
    np.testing.assert_allclose(load_robot(name).fk(q), T, atol=1e-15)


@pytest.mark.parametrize("name", names())
def test_every_robot_loads_as_a_chain_within_its_limits(name):
    robot = load_robot(name)
    q = robot.random_configuration(rng=1, reach=1.0)
    c = robot.chain
    np.testing.assert_allclose(robot.fk(q), chain_fk(c, q), atol=1e-13)


@pytest.mark.parametrize(
    ("name", "degrees_per_second", "torques"),
    [
        ("ur3e", [180, 180, 180, 360, 360, 360], [54, 54, 28, 9, 9, 9]),
        ("ur5e", [180] * 6, [150, 150, 150, 28, 28, 28]),
        ("ur10e", [120, 120, 180, 180, 180, 180], [330, 330, 150, 54, 54, 54]),
        ("panda", np.degrees([2.175] * 4 + [2.61] * 3), [87] * 4 + [12] * 3),
        ("panda_urdf", np.degrees([2.175] * 4 + [2.61] * 3), [87] * 4 + [12] * 3),
        ("iiwa7", [98, 98, 100, 130, 140, 180, 180], [176, 176, 110, 110, 110, 40, 40]),
        ("iiwa14", [85, 85, 100, 75, 130, 135, 135], [320, 320, 176, 176, 110, 40, 40]),
        ("m1013", [120, 120, 180, 225, 225, 225], [346, 346, 163, 50, 50, 50]),
        ("xmatepro7", [90, 90, 120, 120, 120, 120, 120], [217, 217, 102, 102, 66, 66, 66]),
    ],
)
def test_the_published_velocities_and_torques(name, degrees_per_second, torques):
    limits = load_robot(name).limits
    np.testing.assert_allclose(np.degrees(limits.velocity), degrees_per_second, rtol=1e-12)
    np.testing.assert_array_equal(limits.effort, torques)


@pytest.mark.data
@pytest.mark.parametrize(
    ("name", "file"), [("fetch_torso", "fetch"), ("fetch", "fetch"), ("panda", "panda"), ("ur5", "ur5")]
)
def test_links_joints_and_frames_are_those_of_the_maker(name, file):
    """Those of the robots that the shared data has whole, with the parents and the frames of each joint."""
    published = json.loads((shared_data() / "planning" / f"robot_{file}.json").read_text())["joints"]
    published = {joint["name"]: joint for joint in published}
    robot = load_description(name)
    known = [joint for joint in robot.joints if joint.name in published]
    assert {joint.name for joint in robot.moving_joints} <= {joint.name for joint in known}
    for joint in known:
        row = published[joint.name]
        assert joint.child == row["child"]
        if file == "ur5":
            continue  # in frames of an earlier description, without base_link_inertia
        assert joint.parent == row["parent"]
        np.testing.assert_allclose(joint.origin, from_rpy(row["xyz"], row["rpy"]), atol=1e-5, rtol=0)
        if joint.moving:
            np.testing.assert_array_equal(joint.axis, row["axis"])


def parts_of_example_robots():
    """Robots whose frames are from example-robot-data, with the path there."""
    found = []
    for name in names():
        about = load_description(name).provenance
        package, _, path = about.sources["joints"].source.partition(" robots/")
        if package.startswith("example-robot-data") and "link frames" not in about.missing:
            found.append((name, path.split(";")[0]))
    return found


@pytest.mark.oracle
@pytest.mark.parametrize(("name", "path"), parts_of_example_robots())
def test_a_part_of_a_robot_of_example_robot_data_has_its_names_and_numbers(name, path):
    try:
        files = metadata.files("example-robot-data")
    except metadata.PackageNotFoundError:
        pytest.skip("needs example-robot-data")
    whole = from_urdf(next(file.locate() for file in files if str(file).endswith(f"robots/{path}")))
    squared = squared_here(load_description(name))
    whole, atol = (with_right_angles(whole), 1e-15) if squared else (whole, 0)
    for joint in load_description(name).joints:
        published = whole.joint(joint.name)
        assert (joint.parent, joint.child) == (published.parent, published.child)
        if not joint.name.endswith("end_effector"):  # of another source, which its file names
            np.testing.assert_allclose(joint.origin, published.origin, atol=atol, rtol=0)
        np.testing.assert_allclose(joint.axis, published.axis, atol=atol, rtol=0)
        for field in ("velocity", "effort"):
            assert getattr(joint, field) in (getattr(published, field), np.inf)
    for link in load_description(name).links:
        published = whole.link_by_name[link.name].inertial
        if link.inertial is not None:
            assert link.inertial.mass == published.mass
            np.testing.assert_allclose(link.inertial.com, published.com, atol=1e-15, rtol=0)
            scale = np.abs(published.inertia).max()
            np.testing.assert_allclose(link.inertial.inertia, published.inertia, atol=1e-12 * scale, rtol=0)


FLANGES = {
    "Universal Robots": (r"ur\d+e?", "tool0", 1),
    "ABB": (r"irb\d+(_5_90)?", "tool0", 1),
    "KUKA": (r"kr\d+_.*", "tool0", None),
    "FANUC": (r"crx\d+ial?|lrmate200id|m710ic", "tool0|fanuc_flange", -1),
    "Kinova": (r"gen3.*|j2s.*", r"(\w+_)?end_effector(_link)?", None),
    "UFactory": (r"xarm\d|lite6", "link_eef", 1),
    "Franka Robotics": (r"panda.*|fr3", r"\w+_link8", 1),
    "Yaskawa": (r"gp7", "tool0", -1),
}
"""Of each maker: the names of the arms, the names of their tips, and whether the last joint turns about their
z or against it (None: not alike, as the makers count the last joint either way)."""


FLANGE_CENTRE = 5e-4
"""How far [m] a flange is from the last axis: a file of KUKA has it a quarter of a millimetre away."""


@pytest.mark.parametrize("vendor", FLANGES)
def test_the_flanges_of_a_maker_are_alike(vendor):
    """The z of the tip is the axis of the last joint and points away from the arm."""
    arms, tips, sense = FLANGES[vendor]
    found = [row.name for row in rows() if row.vendor == vendor and re.fullmatch(arms, row.name)]
    assert found
    for name in found:
        c = chain(load_description(name))
        assert re.fullmatch(tips, c.tip)
        z = c.T_zero[:3, :3].T @ c.axes[-1]
        np.testing.assert_allclose(z, [0, 0, sense or np.sign(z[2])], atol=2e-5, rtol=0)
        gap = np.cross(c.points[-1] - c.T_zero[:3, 3], c.axes[-1])
        assert np.linalg.norm(gap) < FLANGE_CENTRE


def test_the_published_accelerations_and_jerks():
    """Of Franka's control interface."""
    panda, fr3 = load_robot("panda").limits, load_robot("fr3").limits
    np.testing.assert_array_equal(panda.acceleration, [15, 7.5, 10, 12.5, 15, 20, 20])
    np.testing.assert_array_equal(panda.jerk, 500 * panda.acceleration)
    np.testing.assert_array_equal(fr3.acceleration, np.full(7, 10))
    np.testing.assert_array_equal(fr3.jerk, 500 * fr3.acceleration)


def test_the_measured_accelerations_of_the_iiwa_and_the_published_torques_of_the_puma():
    """Larsen 2019, in degrees per second and second; Armstrong, Khatib, Burdick 1986."""
    measured = [490.77, 490.80, 500.77, 650.71, 700.73, 900.66, 900.69]
    for name in ("iiwa14", "iiwa14_r820", "lbr_iiwa14_r820_tool0"):
        np.testing.assert_allclose(np.degrees(load_robot(name).limits.acceleration), measured, atol=0.3)
    for name in ("puma560", "puma560_dh", "puma560_urdf"):
        effort = load_robot(name).limits.effort
        np.testing.assert_array_equal(effort, [97.6, 186.4, 89.4, 24.2, 20.1, 21.3])


def posed():
    return [name for name in names() if load_description(name).poses]


@pytest.mark.parametrize("name", posed())
def test_named_poses_are_configurations_within_the_limits(name):
    robot = load_robot(name)
    assert robot.named_poses
    assert robot.named_poses.keys() == robot.description.poses.keys()
    for q in robot.named_poses.values():
        assert q.shape == (robot.dof,)
        assert (q >= robot.limits.lower).all()
        assert (q <= robot.limits.upper).all()


def test_published_poses():
    """The ready pose of the Panda holds the flange above (0.307, 0, 0.59), looking down."""
    panda = load_robot("panda")
    np.testing.assert_allclose(panda.fk(panda.named_poses["ready"])[:3, 3], [0.3069, 0, 0.5903], atol=1e-4)
    np.testing.assert_allclose(panda.fk(panda.named_poses["ready"])[:3, 2], [0, 0, -1], atol=1e-12)
    up = load_robot("ur5e")
    T = up.fk(up.named_poses["up"])
    assert T[2, 3] > 1.0  # straight up: 0.1625 + 0.425 + 0.3922 + 0.0997 m
    with pytest.raises(UnknownNameError, match="no named pose 'hom' in robot 'ur5e'; did you mean 'home'"):
        up.named_poses["hom"]
    with pytest.raises(UnknownNameError, match="there are no named poses"):
        load_robot("planar_2r").named_poses["home"]


def test_named_poses_are_copies_and_need_a_value_for_every_joint():
    robot = load_robot("ur5e")
    robot.named_poses["home"][:] = 7
    assert (robot.named_poses["home"] != 7).all()
    assert load_robot("ur5e", tip="forearm_link").named_poses["home"].shape == (3,)
    tree = load_robot("fetch_torso").description
    part = dict(tree.poses["tuck"])
    del part["torso_lift_joint"]
    assert Robot(replace(tree, poses={"arm": part})).named_poses == {}
    assert Robot(replace(tree, poses={"arm": part}), base="torso_lift_link").named_poses.keys() == {"arm"}
    again = pickle.loads(pickle.dumps(robot.named_poses))
    with pytest.raises(UnknownNameError):
        again["hom"]


def test_names_are_forgiving_and_unknown_ones_get_suggestions():
    assert find("UR-5e") == find("ur 5E") == "ur5e"
    assert find("kr6") == "kr6_r900"
    assert find("franka_panda") == find("Franka") == "panda"
    with pytest.raises(UnknownNameError, match=r"did you mean .*'ur5e'.*cs.robots.names\(\)"):
        find("ur6e")


NOBODY = ["ur@5e!", "ur5e?", "ur5(e)", "urü5e", "ur5e\0", "@", "ur5e;panda", "u/r5e", "", " "]
UNUSUAL = ["ur5e\n", "u.r.5.e", "UR_5-e", "KR 6", "Franka Emika Panda", "pr2 right.torso"]


@pytest.mark.parametrize("name", NOBODY)
def test_what_is_no_separator_counts_in_a_name(name):
    with pytest.raises(UnknownNameError, match=r"^no robot '.*[?;] cs.robots.names\(\) lists all \d+, "):
        find(name)


@pytest.mark.parametrize("name", UNUSUAL)
def test_separators_and_capitals_do_not_count(name):
    assert find(name) in names()


MAKERS = {
    "KUKA KR 6 R900 sixx": "kr6_r900",
    "KUKA LBR iiwa 7": "iiwa7",
    "Universal Robots UR5e": "ur5e",
    "universal ur10e": "ur10e",
    "Unimation PUMA 560": "puma560",
    "Willow Garage PR2": "pr2_right",
    "Kinova Gen3": "gen3",
    "Unitree G1": "g1_left_arm",
    "PAL TALOS": "talos_left_leg",
}


@pytest.mark.parametrize("name", MAKERS)
def test_the_maker_may_stand_before_the_name(name):
    assert find(name) == MAKERS[name]


@pytest.mark.parametrize(
    "name", ["ABB UR5e", "Universal Robots", "KUKA", "robots ur5e", "ur5e Universal Robots"]
)
def test_another_maker_or_none_but_the_maker_is_nobody(name):
    with pytest.raises(UnknownNameError):
        find(name)


def found(text):
    return [row.name for row in search(text)]


def test_search_finds_by_words():
    assert {"iiwa7", "iiwa14"} <= set(found("kuka 7"))
    assert "kr210_r2700" not in found("kuka 7")
    assert all("KUKA" in row.vendor for row in search("kuka"))
    assert found("ur5")[0] == "ur5"
    assert set(found("ur5")) >= {"ur5", "ur5e", "ur5_dh"}
    assert {"stanford"} == set(found("RRPRRR"))
    assert "scara" in found("scara")
    assert found("universal robots") == found("Universal, ROBOTS")
    assert len(found("")) == len(names())
    assert found("no such robot at all") == []
    assert found("((") == []


def test_rows_are_printed_one_a_line():
    for text in ("", "kuka", "panda", "no such robot"):
        found = search(text)
        lines = str(found).splitlines()
        assert str(found) == repr(found)
        if not found:
            assert lines == ["no robots"]
            continue
        assert [line.split()[0] for line in lines] == [row.name for row in found]
        assert all(row.title in line and row.vendor in line for line, row in zip(lines, found, strict=True))
        assert found == tuple(found)
