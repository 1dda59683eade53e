"""Masses, centres of mass and inertia tensors of the catalogue, against the makers' files and data sheets."""

import json
from pathlib import Path

import numpy as np
import pytest

from cspace.robots import load_description, load_robot, names

RECORDED = json.loads((Path(__file__).parent / "published_masses.json").read_text())
"""By Pinocchio 4.1, from the makers' URDF files (puma560, puma560_dh and stanford: from the tables of the
books, joint by joint): of each arm its mass, and at three configurations the centre of mass in the base, the
diagonal of the mass matrix and the gravity torques."""

WRITTEN = 1e-9
"""Relative, of what was recorded with twelve digits from files that write π/2 with ten."""

GRAVITY = 9.81

REQUIRED = [
    "ur3e",
    "ur5e",
    "ur10e",
    "ur16e",
    "panda",
    "fr3",
    "iiwa7",
    "iiwa14",
    "gen3",
    "xarm6",
    "xarm7",
    "puma560",
    "puma560_dh",
    "stanford",
    "so101",
    "planar_1r",
    "planar_2r",
    "planar_3r",
]

UNUSUAL = {
    ("lite6", "link_base"): "its tensor is not published; it does not move",
    (
        "puma560",
        "link_1",
    ): "only the moment about the axis of joint 1 is published, and no other has an effect",
    ("puma560", "link_3"): "measured: 0.086 > 0.066 + 0.0125 kg m²",
    ("puma560_dh", "q1_link"): "only the moment about the axis of joint 1 is published",
    ("puma560_dh", "q3_link"): "measured: 0.086 > 0.066 + 0.0125 kg m²",
}
"""Bodies whose published numbers no rigid body has, with the reason."""

WEIGHTS = {
    "crx10ia": 40,
    "crx10ial": 40,
    "crx30ia": 135,
    "crx3ia": 11,
    "fr3": 17.8,
    "gen3": 8.2,
    "gen3_lite": 5.4,
    "iiwa14": 29.9,
    "iiwa7": 23.9,
    "lbr_iiwa14_r820_tool0": 29.9,
    "lite6": 7.2,
    "m1013": 33,
    "panda": 18,
    "ur10": 28.9,
    "ur10e": 33.5,
    "ur16e": 33.1,
    "ur20": 64,
    "ur3": 11,
    "ur30": 63.5,
    "ur3e": 11.2,
    "ur5": 18.4,
    "ur5e": 20.6,
    "ur7e": 20.6,
    "xarm6": 12.2,
    "xarm7": 13.7,
}
"""Rounded weights [kg] as the makers advertise them, to find a wrong unit or a lost link. Those of the
iiwa were looked up in its data sheet, the others were not. They count cables that a file leaves out."""

SQUARED = 2e-5
"""What of a recording is due to right angles that the file of the maker rounds [rad, m, unitless]."""

NEAR_THE_WEIGHT = 0.2


def with_masses():
    return [name for name in names() if any(link.inertial for link in load_description(name).links)]


def is_of_a_body(inertial):
    """Positive mass and moments, none larger than the sum of the other two."""
    low, middle, high = np.linalg.eigvalsh(inertial.inertia)
    return inertial.mass > 0 and low > 0 and high <= (low + middle) * (1 + 1e-9)


def moved_inertia(robot, q):
    """What each joint moves when it alone moves, (n,), without its own rotor."""
    armature = [joint.armature or 0.0 for joint in map(robot.description.joint, robot.joint_names)]
    return np.diag(robot.mass_matrix(q)) - armature


def test_the_known_arms_have_masses():
    assert set(REQUIRED) <= set(with_masses())
    assert len(with_masses()) >= 45


@pytest.mark.parametrize("name", with_masses())
def test_every_link_has_the_mass_properties_of_a_body(name):
    about = load_description(name).provenance
    assert about.sources["inertia"].source
    assert about.sources["inertia"].licence
    for link in load_description(name).links:
        if link.inertial is not None:
            assert is_of_a_body(link.inertial) != ((name, link.name) in UNUSUAL), link.name


@pytest.mark.parametrize("name", with_masses())
def test_every_joint_moves_a_mass(name):
    robot = load_robot(name)
    loads = moved_inertia(robot, robot.random_configuration(rng=0))
    idle = name == "gen3_lite"  # its last joint carries the gripper alone, which is not part of the arm
    assert (loads[: robot.dof - idle] > 1e-6).all()
    assert not idle or loads[-1] == 0


@pytest.mark.parametrize("name", WEIGHTS)
def test_an_arm_weighs_about_what_its_maker_says(name):
    assert load_robot(name).mass == pytest.approx(WEIGHTS[name], rel=NEAR_THE_WEIGHT)


@pytest.mark.parametrize("name", RECORDED)
def test_masses_are_those_of_the_maker(name):
    """Moved to the frames of the catalogue, where these are others."""
    robot = load_robot(name)
    assert robot.mass == pytest.approx(RECORDED[name]["mass"], rel=WRITTEN)
    squared = "exact here" in load_description(name).provenance.sources["joints"].source
    atol = SQUARED if squared else WRITTEN
    for state in RECORDED[name]["states"]:
        q = np.array(state["q"])
        np.testing.assert_allclose(robot.center_of_mass(q), state["center_of_mass"], atol=atol, rtol=0)
        loads = np.array(state["mass_matrix_diagonal"])
        np.testing.assert_allclose(moved_inertia(robot, q), loads, atol=atol * loads.max(), rtol=0)
        weight = GRAVITY * robot.mass
        np.testing.assert_allclose(
            robot.gravity_torques(q), state["gravity_torques"], atol=atol * weight, rtol=0
        )


def test_all_arms_with_frames_of_a_maker_were_recorded():
    """But textbook arms, and two whose file has other lengths or stands nowhere whole."""
    textbook = {"planar_1r", "planar_2r", "planar_3r"}
    assert set(with_masses()) - set(RECORDED) == textbook | {"lbr_iiwa14_r820_tool0", "ur15"}


def test_the_two_files_of_the_iiwa_14_have_one_centre_of_mass():
    """Up to the height of the shoulder, which differs by 0.44 mm."""
    one, other = load_robot("iiwa14"), load_robot("lbr_iiwa14_r820_tool0")
    for q in np.random.default_rng(0).uniform(-1.5, 1.5, (5, 7)):
        np.testing.assert_allclose(one.center_of_mass(q), other.center_of_mass(q), atol=5e-4, rtol=0)


def test_both_files_of_the_puma_have_one_mass_matrix():
    one, other = load_robot("puma560"), load_robot("puma560_dh")
    for q in np.random.default_rng(0).uniform(-3, 3, (5, 6)):
        np.testing.assert_allclose(one.mass_matrix(q), other.mass_matrix(q), atol=1e-10)


def test_the_planar_arm_has_the_mass_matrix_of_the_textbooks():
    """Spong, Hutchinson, Vidyasagar 2006, section 7.4."""
    robot = load_robot("planar_2r")
    one, two = (link.inertial for link in robot.description.links if link.inertial)
    l1, r1, r2 = 1.0, one.com[0], two.com[0]
    i1, i2 = one.inertia[2, 2], two.inertia[2, 2]
    for q in np.random.default_rng(0).uniform(-3, 3, (5, 2)):
        coupling = i2 + two.mass * (r2**2 + l1 * r2 * np.cos(q[1]))
        corner = i2 + two.mass * r2**2
        first = i1 + one.mass * r1**2 + corner + two.mass * (l1**2 + 2 * l1 * r2 * np.cos(q[1]))
        np.testing.assert_allclose(robot.mass_matrix(q), [[first, coupling], [coupling, corner]], atol=1e-14)


def test_friction_and_rotors_of_the_puma_are_those_of_its_motors_behind_the_gears():
    gears = np.array([62.6111, 107.815, 53.7063, 76.0364, 71.923, 76.686])
    viscous = np.array([1.48e-3, 0.817e-3, 1.38e-3, 71.2e-6, 82.6e-6, 36.7e-6])
    for name in ("puma560", "puma560_dh"):
        damping = [joint.damping for joint in load_description(name).moving_joints]
        np.testing.assert_allclose(damping, gears**2 * viscous, rtol=1e-5)
        armature = [joint.armature for joint in load_description(name).moving_joints]
        np.testing.assert_allclose(armature, gears**2 * np.repeat([200e-6, 33e-6], 3), rtol=1e-5)
