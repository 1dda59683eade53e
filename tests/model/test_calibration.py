"""Calibrated UR arms: the joint frames of ur_calibration, on arms of the catalogue and on URDF files."""

import math

import numpy as np
import pytest

from cspace.errors import DescriptionError, InputError
from cspace.model import Joint, calibrated, chain, from_screws, from_urdf, to_urdf, with_frame
from cspace.robot import Robot
from cspace.robots import load_description, load_robot
from cspace.spatial import pose
from model.mutation import damaged, exercise_file
from oracles.forward import motion

PARTS = ("shoulder", "upper_arm", "forearm", "wrist_1", "wrist_2", "wrist_3")
HALF = 1.570796327  # as the maker prints it; the catalogue keeps this for the e-series
E_SERIES = {  # d1, a2, a3, d4, d5, d6 of the data sheets [m]
    "ur3e": (0.15185, -0.24355, -0.2132, 0.13105, 0.08535, 0.0921),
    "ur5e": (0.1625, -0.425, -0.3922, 0.1333, 0.0997, 0.0996),
    "ur10e": (0.1807, -0.6127, -0.57155, 0.17415, 0.11985, 0.11655),
    "ur16e": (0.1807, -0.4784, -0.36, 0.17415, 0.11985, 0.11655),
    "ur20": (0.2363, -0.862, -0.7287, 0.201, 0.1593, 0.1543),
}
CB_SERIES = {
    "ur3": (0.1519, -0.24365, -0.21325, 0.11235, 0.08535, 0.0819),
    "ur5": (0.089159, -0.425, -0.39225, 0.10915, 0.09465, 0.0823),
    "ur10": (0.1273, -0.612, -0.5723, 0.163941, 0.1157, 0.0922),
}


def frames(d1, a2, a3, d4, d5, d6, half=math.pi / 2):
    """The six joint frames of a UR arm, as (x, y, z, roll, pitch, yaw), π/2 rounded as the makers have it."""
    other = math.pi - half
    return {
        "shoulder": (0, 0, d1, 0, 0, 0),
        "upper_arm": (0, 0, 0, half, 0, 0),
        "forearm": (a2, 0, 0, 0, 0, 0),
        "wrist_1": (a3, 0, d4, 0, 0, 0),
        "wrist_2": (0, -d5, d5 * math.cos(half), half, 0, 0),
        "wrist_3": (0, d6, -d6 * math.cos(other), other, math.pi, math.pi),
    }


def text_of(parts, digest="calib_123"):
    keys = ("x", "y", "z", "roll", "pitch", "yaw")
    lines = ["kinematics:"]
    for part, numbers in parts.items():
        lines.append(f"  {part}:")
        lines += [f"    {key}: {float(value)!r}" for key, value in zip(keys, numbers, strict=True)]
    return "\n".join([*lines, f"  hash: {digest}", ""])


def product(parts, q):
    """tool0 in base_link: base_link_inertia looks backward, then frame by frame."""
    T = pose((0, 0, 0), rpy=(0, 0, math.pi))
    for numbers, value in zip(parts.values(), q, strict=True):
        T = T @ pose(numbers[:3], rpy=numbers[3:]) @ motion("R", (0, 0, 1), value)
    return T


def perturbed(parts, rng, size=1e-3):
    return {part: np.array(numbers) + size * rng.uniform(-1, 1, 6) for part, numbers in parts.items()}


@pytest.fixture
def write(tmp_path):
    def to_file(text, name="arm.yaml"):
        path = tmp_path / name
        path.write_text(text if isinstance(text, str) else text_of(text))
        return path

    return to_file


@pytest.mark.parametrize("name", [*E_SERIES, *CB_SERIES])
def test_the_published_frames_give_the_arm_of_the_catalogue(name, write):
    nominal = load_robot(name)
    half = HALF if name in E_SERIES else math.pi / 2
    robot = load_robot(name, calibration=write(frames(*(CB_SERIES | E_SERIES)[name], half=half)))
    assert (robot.base, robot.tip, robot.joint_names) == (nominal.base, nominal.tip, nominal.joint_names)
    q = np.random.default_rng(0).uniform(-6, 6, (200, 6))
    np.testing.assert_allclose(robot.fk(q), nominal.fk(q), rtol=0, atol=1e-12)
    for field in ("lower", "upper", "velocity", "effort"):
        np.testing.assert_array_equal(getattr(robot.limits, field), getattr(nominal.limits, field))


@pytest.mark.parametrize("name", ["ur5e", "ur10e"])
def test_frames_of_a_measured_arm_are_multiplied_in_order(name, write):
    rng = np.random.default_rng(1)
    parts = perturbed(frames(*E_SERIES[name]), rng)
    robot = load_robot(name, calibration=write(parts))
    for q in rng.uniform(-6, 6, (50, 6)):
        np.testing.assert_allclose(robot.fk(q), product(parts, q), rtol=0, atol=1e-14)


def test_a_measured_arm_is_solved_and_comes_back(write):
    rng = np.random.default_rng(2)
    nominal = load_robot("ur5e")
    robot = load_robot("ur5e", calibration=write(perturbed(frames(*E_SERIES["ur5e"]), rng)))
    for q in rng.uniform(-3, 3, (40, 6)):
        T = robot.fk(q)
        s = robot.ik(T)
        assert np.abs(robot.fk(s.q) - T).max() < 1e-9
        assert np.abs(np.sin((s.q - q) / 2)).max(axis=1).min() < 1e-6, "the configuration itself"
        assert np.abs(nominal.fk(q) - T).max() > 1e-5, "another arm than the nominal one"


def test_the_source_of_the_joints_is_the_file(write):
    nominal = load_description("ur5e")
    description = load_description("ur5e", calibration=write(frames(*E_SERIES["ur5e"])))
    assert description.provenance.sources["joints"].source == "calibration calib_123 (arm.yaml)"
    assert [link.name for link in description.links] == [link.name for link in nominal.links]
    assert {"base_link_inertia", *(f"{part}_link" for part in PARTS), "tool0"} <= set(nominal.link_by_name)
    assert description.poses == nominal.poses


def test_a_file_with_the_frames_of_ur_description_keeps_all_else(write, tmp_path):
    nominal = frames(*E_SERIES["ur5e"])
    ros = calibrated(load_description("ur5e"), write(nominal))
    tooled = with_frame(ros, "tool0", pose((0, 0, 0.1)), "gripper")
    path = tmp_path / "arm.urdf"
    path.write_text(to_urdf(tooled).replace('"shoulder_pan_joint"', '"left_shoulder_pan_joint"'))
    parts = perturbed(nominal, np.random.default_rng(3))
    robot = load_robot(path, calibration=write(parts))
    assert robot.tip == "gripper"
    q = np.array([0.1, -1.2, 1.3, 0.4, -0.5, 0.6])
    expected = product(parts, q) @ pose((0, 0, 0.1))
    np.testing.assert_allclose(robot.fk(q), expected, rtol=0, atol=1e-14)
    limits = [(joint.lower, joint.upper) for joint in from_urdf(path).moving_joints]
    assert [(joint.lower, joint.upper) for joint in robot.description.moving_joints] == limits


@pytest.mark.parametrize(
    ("name", "other"), [("ur5e", "ur10e"), ("ur10e", "ur5e"), ("ur3", "ur5"), ("ur3e", "ur3")]
)
def test_the_calibration_of_another_model_is_refused(name, other, write):
    numbers = (CB_SERIES | E_SERIES)[other]
    with pytest.raises(
        DescriptionError,
        match=rf"^.*\.yaml: this calibration is not that of '{name}': the axis of '.*_joint'",
    ):
        load_robot(name, calibration=write(frames(*numbers)))


def test_robots_that_no_calibration_fits_are_refused(write):
    path = write(frames(*E_SERIES["ur5e"]))
    with pytest.raises(InputError, match=r"'panda' has no joint named …shoulder_pan_joint"):
        load_robot("panda", calibration=path)
    c = chain(load_description("ur5e"))
    screws = from_screws(c.axes, c.points, c.T_zero, joint_names=c.joint_names, name="ur5e")
    with pytest.raises(InputError, match="link frames of robot 'ur5e' do not fit a calibration"):
        calibrated(screws, path)
    ros = calibrated(load_description("ur5e"), path)
    joints = [Joint(f"b_{j.name}", j.type, *ends(j, "b_"), j.origin, j.axis) for j in ros.joints]
    links = [type(link)(f"b_{link.name}") for link in ros.links]
    mount = Joint("mount", "fixed", "base_link", "b_base_link", pose((0, 1, 0)))
    two = type(ros)("two", (*ros.links, *links), (*ros.joints, mount, *joints))
    with pytest.raises(InputError, match="several joints named …shoulder_pan_joint"):
        calibrated(two, path)


def ends(joint, prefix):
    return prefix + joint.parent, prefix + joint.child


GOOD = text_of(frames(*E_SERIES["ur5e"]))


def test_remarks_blank_lines_and_other_indents_are_read(write):
    lines = ["---", "# measured", ""]
    lines += [
        line.replace("    ", "          ").replace("  ", " ", 1) + "  # so" for line in GOOD.splitlines()
    ]
    text = "\r\n".join(lines).replace("0.1625", "'0.1625'")
    plain, odd = (load_robot("ur5e", calibration=write(t, n)) for t, n in ((GOOD, "a"), (text, "b")))
    np.testing.assert_array_equal(plain.chain.points, odd.chain.points)


FAULTS = {
    "empty": ("", 1, "begins with the key kinematics"),
    "other": ("robot:\n  x: 1\n", 1, "begins with the key kinematics"),
    "no key": (GOOD.replace("    x: 0.0", "    x 0.0", 1), 3, "expected a key and a value"),
    "flow style": (GOOD.replace("  shoulder:", "  shoulder: {x: 0, y: 0}", 1), 2, "expected x, y, z"),
    "tab": (GOOD.replace("    x: 0.0", "\tx: 0.0", 1), 3, "expected a key and a value"),
    "word": (GOOD.replace("x: 0.0", "x: zero", 1), 3, "'x' of shoulder is 'zero'; expected a finite number"),
    "nan": (GOOD.replace("x: 0.0", "x: nan", 1), 3, "expected a finite number"),
    "inf": (GOOD.replace("x: 0.0", "x: 1e999", 1), 3, "expected a finite number"),
    "underscore": (GOOD.replace("x: 0.0", "x: 1_0", 1), 3, "expected a finite number"),
    "nothing": (GOOD.replace("x: 0.0", "x:", 1), 3, "expected a finite number"),
    "other link": (GOOD.replace("forearm", "foream"), 16, "no link 'foream'.*did you mean 'forearm'"),
    "other number": (GOOD.replace("roll", "rol", 1), 6, "no number 'rol' in shoulder; did you mean 'roll'"),
    "missing number": (GOOD.replace("    yaw: 0.0\n", "", 1), 2, "'shoulder' has no yaw"),
    "missing link": ("\n".join(GOOD.split("\n")[:36]), 1, "no 'wrist_3'"),
    "twice": (GOOD + "  shoulder:\n", 45, "'shoulder' is there twice"),
    "number twice": (
        GOOD.replace("    y: 0.0", "    x: 0.0\n    y: 0.0", 1),
        4,
        "'x' of shoulder is there twice",
    ),
    "indent": (GOOD.replace("    y: 0.0", "      y: 0.0", 1), 4, "indented by 6"),
    "beside": (GOOD + "more: 1\n", 45, "'more' stands beside kinematics"),
    "orphan": (GOOD + "    x: 1\n", 45, "'x' stands below no link"),
}


@pytest.mark.parametrize(("text", "line", "says"), FAULTS.values(), ids=FAULTS.keys())
def test_a_fault_is_told_with_file_and_line(text, line, says, write):
    path = write(text)
    with pytest.raises(DescriptionError, match=says) as caught:
        load_robot("ur5e", calibration=path)
    assert (caught.value.path, caught.value.line) == (str(path), line)


def test_files_that_are_none_are_refused(tmp_path):
    with pytest.raises(DescriptionError, match="no such file"):
        load_robot("ur5e", calibration=tmp_path / "none.yaml")
    (tmp_path / "x.yaml").write_bytes(b"kinematics:\n\xff\xfe")
    with pytest.raises(DescriptionError, match="not UTF-8") as caught:
        load_robot("ur5e", calibration=tmp_path / "x.yaml")
    assert caught.value.line == 2
    (tmp_path / "x.yaml").write_bytes(b"#" * (2**20 + 1))
    with pytest.raises(DescriptionError, match="the maximum is"):
        load_robot("ur5e", calibration=tmp_path / "x.yaml")


def test_damaged_files_end_in_an_error_of_ours_or_in_a_robot(tmp_path):
    rng = np.random.default_rng(0)
    nominal = load_description("ur5e")
    path = tmp_path / "x.yaml"
    read = 0
    for _ in range(400):
        path.write_bytes(damaged(rng, GOOD.encode(), [GOOD.encode()]))
        read += exercise_file(lambda file: calibrated(nominal, file), path)
    assert read > 0, "the damage is too coarse to reach the deeper checks"


def test_a_chain_through_the_calibrated_links_is_the_arm(write):
    robot = load_robot("ur5e", calibration=write(GOOD))
    T = Robot(robot.description, tip="wrist_3_link").fk(np.zeros(6))
    np.testing.assert_allclose(T, robot.fk(np.zeros(6)), rtol=0, atol=1e-15)
    assert chain(robot.description).joint_types == "RRRRRR"
