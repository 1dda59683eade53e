"""Torques, mass matrices and accelerations of every robot of example-robot-data against Pinocchio."""

from __future__ import annotations

import numpy as np
import pytest

from cspace.errors import InputError
from cspace.model import from_urdf
from cspace.robot import Robot
from model.random_robots import random_pose
from oracles.example_robots import FAULTY, PinocchioRobot, urdf_files

pytestmark = pytest.mark.oracle

TOLERANCE = 1e-10  # of the largest number
FILES = urdf_files()
if not FILES:
    pytest.skip("the robots of example-robot-data are not installed", allow_module_level=True)


def same(ours, theirs):
    np.testing.assert_allclose(ours, theirs, atol=TOLERANCE * np.abs(theirs).max(initial=1e-300))


@pytest.mark.parametrize("floating", [False, True], ids=["fixed", "floating"])
@pytest.mark.parametrize("name", sorted(set(FILES) - set(FAULTY)))
def test_dynamics(name, floating):
    robot = Robot(from_urdf(FILES[name]), floating=floating)
    oracle = PinocchioRobot(FILES[name], robot)
    pin, model, data = oracle.pin, oracle.model, oracle.data
    model.gravity.linear = np.array([0.3, -0.2, -9.81])
    rng = np.random.default_rng(len(name))
    T = random_pose(rng) if floating else np.eye(4)
    placed = {"T_world_base": T} if floating else {}
    laws = {**placed, "gravity": model.gravity.linear, "friction": False}
    q = rng.uniform(-2, 2, len(robot.joint_names))
    qd, qdd = rng.normal(size=(2, robot.dof))
    pin_q, S = oracle.configuration(q, T), oracle.velocity_map(T)
    change = S @ qdd + oracle.velocity_map_rate(T, qd) @ qd
    armature = S.T @ np.diag(model.armature) @ S
    own = np.zeros(robot.dof)
    own[oracle.first :] = [
        getattr(robot.description.joint(j), "armature", None) or 0.0 for j in robot.joint_names
    ]
    extra = np.diag(own) - armature if np.abs(own).max(initial=0.0) else 0 * armature
    tau = S.T @ pin.rnea(model, data, pin_q, S @ qd, change)
    same(robot.inverse_dynamics(q, qd, qdd, **laws), tau + extra @ qdd)
    if robot.dof == 0:  # one rigid body on a fixed base
        assert model.nv == 0
        return
    upper = np.triu(pin.crba(model, data, pin_q))
    M = S.T @ (upper + np.triu(upper, 1).T) @ S + extra
    same(robot.mass_matrix(q, **placed), M)
    same(
        robot.gravity_torques(q, **placed, gravity=laws["gravity"]),
        S.T @ pin.rnea(model, data, pin_q, 0 * (S @ qd), 0 * change),
    )
    energy = pin.computeKineticEnergy(model, data, pin_q, S @ qd)
    if not np.abs(own).max(initial=0.0):
        assert robot.kinetic_energy(q, qd, **placed) == pytest.approx(energy, rel=1e-9)
    try:
        again = robot.forward_dynamics(q, qd, robot.inverse_dynamics(q, qd, qdd, **laws), **laws)
    except InputError:
        assert np.linalg.cond(M) > 1e12
    else:
        size = np.sqrt(np.diag(M))
        condition = np.linalg.cond(M / np.outer(size, size))
        np.testing.assert_allclose(
            again * size, qdd * size, atol=1e-14 * condition * np.abs(qdd * size).max()
        )
