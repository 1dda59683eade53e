"""Every robot of example-robot-data against Pinocchio: poses, Jacobians, derivatives, centres of mass."""

from __future__ import annotations

import numpy as np
import pytest

from cspace.errors import DescriptionError
from cspace.model import from_urdf
from cspace.robot import Robot
from model.random_robots import random_pose
from oracles.example_robots import FAULTY, PinocchioRobot, urdf_files

pytestmark = pytest.mark.oracle

TOLERANCE = 1e-10
HUMANOIDS = (
    "talos_full_v2",
    "romeo",
    "g1_29dof_rev_1_0",
    "icub",
    "simple_humanoid",
    "human",
    "alex_nub_hands",
)


FILES = urdf_files()
if not FILES:
    pytest.skip("the robots of example-robot-data are not installed", allow_module_level=True)


@pytest.mark.parametrize("floating", [False, True], ids=["fixed", "floating"])
@pytest.mark.parametrize("name", sorted(set(FILES) - set(FAULTY)))
def test_robot(name, floating):
    robot = Robot(from_urdf(FILES[name]), floating=floating)
    oracle = PinocchioRobot(FILES[name], robot)
    rng = np.random.default_rng(len(name))
    T_world_base = random_pose(rng) if floating else np.eye(4)
    placed = {"T_world_base": T_world_base} if floating else {}
    for _ in range(2):
        q, qd = rng.uniform(-2, 2, len(robot.joint_names)), rng.normal(size=robot.dof)
        oracle.move_to(q, qd, T_world_base)
        everything = robot.fk_all(q, **placed)
        compared = 0
        for number, frame in enumerate(robot.frames):
            if not oracle.has(frame):
                continue
            compared += 1
            T = oracle.pose(frame)
            np.testing.assert_allclose(everything[number], T, atol=TOLERANCE)
            np.testing.assert_allclose(robot.fk(q, frame, **placed), T, atol=TOLERANCE)
            if oracle.model.nv == 0:
                continue  # a rigid body; Pinocchio crashes on its empty Jacobian
            J, J_in_tip, J_rate = oracle.jacobians(frame)
            np.testing.assert_allclose(robot.jacobian(q, frame, **placed), J, atol=TOLERANCE)
            ours = robot.jacobian(q, frame, expressed_in="tip", **placed)
            np.testing.assert_allclose(ours, J_in_tip, atol=TOLERANCE)
            ours = robot.jacobian_dot(q, qd, frame, **placed)
            np.testing.assert_allclose(ours, J_rate, atol=TOLERANCE * (1 + np.abs(J_rate).max()))
        assert compared >= 1
        if robot.mass > 0.0 and oracle.model.nv > 0:
            check_center_of_mass(oracle, robot, q, placed)


def check_center_of_mass(oracle, robot, q, placed):
    """Pinocchio leaves out what is fixed to a base that does not move; it is put back here."""
    moving = sum(inertia.mass for inertia in list(oracle.model.inertias)[1:])
    if moving == 0.0:
        return
    assembly = robot._assembly
    base = 0.0 if robot.floating else assembly.mass[0]
    assert moving + base == pytest.approx(robot.mass, rel=1e-12)
    J_center, center = oracle.center_of_mass()
    expected = (moving * center + base * assembly.center[0]) / robot.mass
    np.testing.assert_allclose(robot.center_of_mass(q, **placed), expected, atol=TOLERANCE)
    ours = robot.center_of_mass_jacobian(q, **placed)
    np.testing.assert_allclose(ours, J_center * moving / robot.mass, atol=TOLERANCE)


@pytest.mark.parametrize("name", FAULTY)
def test_a_file_with_a_fault_is_refused_where_it_is(name):
    with pytest.raises(DescriptionError, match=FAULTY[name]):
        from_urdf(FILES[name])


def test_there_are_enough_robots_and_humanoids_among_them():
    assert len(FILES) >= 20
    assert set(HUMANOIDS) <= set(FILES)
