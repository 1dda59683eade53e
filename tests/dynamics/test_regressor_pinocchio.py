"""The regressor and the parameters of arms of the catalogue against Pinocchio."""

from __future__ import annotations

import numpy as np
import pytest

import cspace as cs
from cspace.dynamics import parameters
from cspace.model import to_urdf

pytestmark = pytest.mark.oracle
pin = pytest.importorskip("pinocchio")

BY_ROW = [0, 1, 2, 3, 4, 5, 7, 6, 8, 9]
"""Pinocchio has the inertia as xx, xy, yy, xz, yz, zz: its numbers at our places."""


@pytest.mark.parametrize("name", ["panda", "ur5e", "kuka_iiwa_14", "puma560"])
def test_regressor_and_parameters_are_those_of_pinocchio(name):
    robot = cs.load_robot(name)
    model = pin.buildModelFromXML(to_urdf(robot.description))
    data, n = model.createData(), robot.dof
    assert model.nq == model.nv == n
    assert list(model.names)[1:] == list(robot.joint_names)
    rng = np.random.default_rng(n)
    order = np.concatenate([10 * k + np.array(BY_ROW) for k in range(n)])
    pi = np.concatenate([model.inertias[k + 1].toDynamicParameters() for k in range(n)])
    np.testing.assert_allclose(parameters(robot)[: 10 * n], pi[order], rtol=0, atol=1e-9)
    for _ in range(10):
        q, qd, qdd = rng.normal(size=(3, n))
        expected = pin.computeJointTorqueRegressor(model, data, q, qd, qdd)[:, order]
        Y = robot.regressor(q, qd, qdd)[:, : 10 * n]
        np.testing.assert_allclose(Y, expected, rtol=0, atol=1e-8 * np.abs(expected).max())
