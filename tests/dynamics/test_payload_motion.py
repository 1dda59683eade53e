"""Payloads, locked joints and massless motions as dynamics sees them."""

from dataclasses import replace

import numpy as np
import pytest

from cspace.dynamics import forward_dynamics, inverse_dynamics, mass_matrix
from cspace.dynamics.massless_motions import energy_factor
from cspace.model import Joint, Link
from cspace.robot import Robot
from dynamics.bodies import hand_arm, random_body
from kinematics import robots
from model.random_robots import random_pose, with_resistances


def with_link(description, parent, body, T_parent_link):
    """The robot with a link of its own in place of a payload."""
    seam = Joint("seam", "fixed", parent, "load", T_parent_link)
    links, joints = (*description.links, Link("load", body)), (*description.joints, seam)
    return replace(description, links=links, joints=joints)


@pytest.mark.parametrize("seed", range(5))
def test_a_payload_moves_as_a_link_does(seed):
    rng = np.random.default_rng(seed)
    body, T_tool, T_mount = random_body(rng), random_pose(rng), random_pose(rng)
    description = with_resistances(rng, hand_arm(rng))
    plain = Robot(description, tip="tcp", locked={"open": 0.02})
    loaded = plain.with_tool(T_tool).with_base(T_mount).with_payload(body.mass, body.com, body.inertia)
    linked = Robot(with_link(description, "tcp", body, T_tool), tip="tcp", locked={"open": 0.02})
    linked = linked.with_base(T_mount)
    q, qd, qdd = rng.normal(size=(3, 20, plain.dof))
    tau = inverse_dynamics(linked, q, qd, qdd)
    np.testing.assert_allclose(
        inverse_dynamics(loaded, q, qd, qdd), tau, rtol=0, atol=1e-12 * np.abs(tau).max()
    )
    M = mass_matrix(linked, q)
    np.testing.assert_allclose(mass_matrix(loaded, q), M, rtol=0, atol=1e-12 * np.abs(M).max())
    np.testing.assert_allclose(forward_dynamics(loaded, q, qd, tau), qdd, rtol=0, atol=1e-7)
    assert np.abs(inverse_dynamics(plain.with_base(T_mount), q, qd, qdd) - tau).max() > 1e-2


@pytest.mark.parametrize("seed", range(5))
def test_locked_joints_weigh_as_in_the_whole_tree(seed):
    """The rows of the joints of the chain, with the others at rest at their locked values."""
    rng = np.random.default_rng(seed)
    description = hand_arm(rng)
    whole, arm = Robot(description), Robot(description, tip="tcp", locked={"open": 0.03})
    q, qd, qdd = rng.normal(size=(3, arm.dof))
    order = [whole.joint_names.index(name) for name in arm.joint_names]
    rows = np.zeros((3, whole.dof))
    rows[0, whole.joint_names.index("open")] = 0.03
    rows[:, order] = q, qd, qdd
    tau = inverse_dynamics(whole, *rows)[order]
    np.testing.assert_allclose(inverse_dynamics(arm, q, qd, qdd), tau, rtol=0, atol=1e-12 * np.abs(tau).max())


@pytest.mark.parametrize("floating", [False, True])
@pytest.mark.parametrize("seed", range(10))
def test_the_energy_factor_is_a_root_of_the_compiled_mass_matrix(seed, floating):
    rng = np.random.default_rng(seed)
    robot = Robot(with_resistances(rng, robots.tree(seed).description), floating=floating)
    q = robots.random_q(robot, rng)
    A, M = energy_factor(robot._assembly, q), mass_matrix(robot, q)
    np.testing.assert_allclose(A.T @ A, M, rtol=0, atol=1e-12 * np.abs(M).max())
