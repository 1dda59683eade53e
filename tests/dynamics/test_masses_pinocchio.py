"""Total mass, centre of mass and composite inertia of every robot of example-robot-data against Pinocchio."""

from __future__ import annotations

import numpy as np
import pytest

from cspace.model import from_urdf
from cspace.robot import Robot
from oracles.example_robots import FAULTY, place_joints, urdf_files
from oracles.forward import joint_values
from oracles.rigid_bodies import assembled_body, same_body

pytestmark = pytest.mark.oracle
pin = pytest.importorskip("pinocchio")

FILES = urdf_files()
if not FILES:
    pytest.skip("the robots of example-robot-data are not installed", allow_module_level=True)

NAMES = sorted(set(FILES) - set(FAULTY))
MOST_TIPS = 4
"""Ends of a robot that branches, each of which leaves the others locked."""


class Composite:
    """The whole robot of a file, its base included, as Pinocchio folds it into one body."""

    def __init__(self, path):
        self.model = pin.buildModelFromUrdf(str(path), pin.JointModelFreeFlyer())
        self.data = self.model.createData()

    def body(self, values):
        """Mass, centre (3,) and inertia about it (3, 3) in the root; values: joint name → rad or m."""
        q = place_joints(pin, self.model, values)
        pin.ccrba(self.model, self.data, q, np.zeros(self.model.nv))
        return self.data.Ig.mass, self.data.com[0], self.data.Ig.inertia


@pytest.mark.parametrize("name", NAMES)
def test_the_whole_robot_is_the_composite_of_pinocchio(name):
    robot, oracle = Robot(from_urdf(FILES[name]), floating=True), Composite(FILES[name])
    rng = np.random.default_rng(len(name))
    for _ in range(3):
        q = rng.uniform(-2, 2, len(robot.joint_names))
        given = dict(zip(robot.joint_names, q, strict=True))
        expected = oracle.body(joint_values(robot.description, given))
        if robot.mass == 0.0:
            assert expected[0] == 0.0
            continue
        same_body(assembled_body(robot, q), expected)
        np.testing.assert_allclose(robot.center_of_mass(q), expected[1], rtol=0, atol=1e-12)


@pytest.mark.parametrize("name", NAMES)
def test_what_is_off_a_chain_is_where_pinocchio_has_it(name):
    """Each of a few ends as tip, all joints elsewhere locked at random values."""
    description, oracle = from_urdf(FILES[name]), Composite(FILES[name])
    rng = np.random.default_rng(len(name))
    for tip in description.leaves[:: max(1, len(description.leaves) // MOST_TIPS)]:
        on_path = set(Robot(description, tip=tip)._assembly.chain.joint_names)
        independent = [j for j in description.moving_joints if j.mimic is None and j.name not in on_path]
        locked = {joint.name: rng.uniform(-1, 1) for joint in independent}
        robot = Robot(description, tip=tip, locked=locked)
        if robot.mass == 0.0:
            continue
        q = rng.uniform(-2, 2, len(robot.joint_names))
        law, chain = robot.chain.coordinates, robot.chain
        moved = law.multiplier * q[law.index] + law.offset
        values = joint_values(description, locked) | dict(zip(chain.joint_names, moved, strict=True))
        same_body(assembled_body(robot, q), oracle.body(values))
