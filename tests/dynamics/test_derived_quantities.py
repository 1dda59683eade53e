"""Laws of the Coriolis matrix, momentum, energies and derivatives, on random trees and floating bases."""

from __future__ import annotations

import numpy as np
import pytest

import cspace as cs
from cspace.errors import InputError
from dynamics.test_motion_and_force import ARMS, ROBOTS, STEP, TREES, ids, moved, scale
from kinematics.robots import random_q
from model.random_robots import random_pose

FREE = [cs.Robot(robot.description, floating=True) for robot in [*TREES[:4], ARMS[1], ARMS[4]]]
free_ids = [robot.name for robot in FREE]


@pytest.fixture
def rng():
    return np.random.default_rng(11)


@pytest.mark.parametrize("robot", ROBOTS, ids=ids)
def test_the_coriolis_matrix_gives_the_forces_of_velocities_and_the_rate_of_the_mass_matrix(robot, rng):
    q, qd = random_q(robot, rng), rng.normal(size=robot.dof)
    C = robot.coriolis_matrix(q, qd)
    forces = robot.inverse_dynamics(q, qd, np.zeros(robot.dof), gravity=np.zeros(3), friction=False)
    np.testing.assert_allclose(C @ qd, forces, atol=1e-12 * scale(forces))
    rate = (robot.mass_matrix(q + STEP * qd) - robot.mass_matrix(q - STEP * qd)) / (2 * STEP)
    np.testing.assert_allclose(C + C.T, rate, atol=1e-7 * scale(rate))


@pytest.mark.parametrize("robot", FREE, ids=free_ids)
def test_the_coriolis_matrix_of_a_floating_base(robot, rng):
    q, qd, T = random_q(robot, rng), rng.normal(size=robot.dof), random_pose(rng)
    C = robot.coriolis_matrix(q, qd, T_world_base=T)
    rest = np.zeros(robot.dof)
    forces = robot.inverse_dynamics(q, qd, rest, T_world_base=T, gravity=np.zeros(3), friction=False)
    np.testing.assert_allclose(C @ qd, forces, atol=1e-12 * scale(forces))
    ahead, behind = (
        robot.mass_matrix(q + h * qd[6:], T_world_base=moved(T, h * qd[:6])) for h in (STEP, -STEP)
    )
    rate = (ahead - behind) / (2 * STEP)
    np.testing.assert_allclose(C + C.T, rate, atol=1e-7 * scale(rate))


@pytest.mark.parametrize("robot", [*ROBOTS[:3], ARMS[1], *FREE], ids=lambda robot: f"{robot.name}")
def test_momentum_is_mass_times_velocity_and_energy_is_half_its_square(robot, rng):
    q, qd = random_q(robot, rng), rng.normal(size=robot.dof)
    placed = {"T_world_base": random_pose(rng)} if robot.floating else {}
    h = robot.centroidal_momentum(q, qd, **placed)
    A = robot.centroidal_momentum_matrix(q, **placed)
    np.testing.assert_allclose(A @ qd, h, atol=1e-12 * scale(h))
    velocity = robot.center_of_mass_jacobian(q, **placed) @ qd
    np.testing.assert_allclose(h[:3], robot.mass * velocity, atol=1e-12 * scale(h))
    M = robot.mass_matrix(q, **placed)
    energy = robot.kinetic_energy(q, qd, **placed)
    assert energy == pytest.approx(0.5 * qd @ M @ qd, rel=1e-12)
    c = robot.center_of_mass(q, **placed)
    gravity = rng.normal(size=3)
    potential = robot.potential_energy(q, gravity=gravity, **placed)
    assert potential == pytest.approx(-robot.mass * gravity @ c, rel=1e-10)


@pytest.mark.parametrize("robot", FREE, ids=free_ids)
def test_momentum_changes_by_the_wrench_on_the_base_alone(robot, rng):
    q, T = random_q(robot, rng), random_pose(rng)
    qd, tau = rng.normal(size=(2, robot.dof))
    none = np.zeros(3)
    qdd = robot.forward_dynamics(q, qd, tau, T_world_base=T, gravity=none, friction=False)

    def momentum(h):
        base = moved(T, h * qd[:6] + h * h / 2 * qdd[:6])
        return robot.centroidal_momentum(
            q + h * qd[6:] + h * h / 2 * qdd[6:], qd + h * qdd, T_world_base=base
        )

    rate = (momentum(STEP) - momentum(-STEP)) / (2 * STEP)
    lever = T[:3, 3] - robot.center_of_mass(q, T_world_base=T)
    expected = np.concatenate([tau[:3], tau[3:6] + np.cross(lever, tau[:3])])
    np.testing.assert_allclose(rate, expected, atol=1e-6 * scale(qdd))


def differences(function, n):
    return np.array([(function(d) - function(-d)) / (2 * STEP) for d in STEP * np.eye(n)]).T


@pytest.mark.parametrize("robot", ROBOTS, ids=ids)
def test_derivatives_of_inverse_dynamics_are_its_slopes(robot, rng):
    q = random_q(robot, rng)
    qd, qdd = rng.normal(size=(2, robot.dof))
    gravity = rng.normal(size=3) * 5
    dq, dqd, M = robot.inverse_dynamics_derivatives(q, qd, qdd, gravity=gravity)
    n = robot.dof
    slope = differences(lambda d: robot.inverse_dynamics(q + d, qd, qdd, gravity=gravity), n)
    np.testing.assert_allclose(dq, slope, atol=1e-7 * scale(slope))
    slope = differences(lambda d: robot.inverse_dynamics(q, qd + d, qdd, gravity=gravity), n)
    np.testing.assert_allclose(dqd, slope, atol=1e-7 * scale(slope))
    own = robot.mass_matrix(q)
    np.testing.assert_allclose(M, own, atol=1e-13 * scale(own))
    np.testing.assert_array_equal(M, M.T)


@pytest.mark.parametrize("robot", FREE, ids=free_ids)
def test_derivatives_of_a_floating_base(robot, rng):
    q, T = random_q(robot, rng), random_pose(rng)
    qd, qdd = rng.normal(size=(2, robot.dof))
    gravity = rng.normal(size=3) * 5

    def torques(d, e):
        return robot.inverse_dynamics(
            q + d[6:], qd + e, qdd, gravity=gravity, T_world_base=moved(T, d[:6]), friction=False
        )

    none = np.zeros(robot.dof)
    dq, dqd, M = robot.inverse_dynamics_derivatives(
        q, qd, qdd, gravity=gravity, T_world_base=T, friction=False
    )
    own = robot.mass_matrix(q, T_world_base=T)
    np.testing.assert_allclose(M, own, atol=1e-13 * scale(own))
    slope = differences(lambda d: torques(d, none), robot.dof)
    np.testing.assert_allclose(dq, slope, atol=1e-7 * scale(slope))
    slope = differences(lambda e: torques(none, e), robot.dof)
    np.testing.assert_allclose(dqd, slope, atol=1e-7 * scale(slope))


@pytest.mark.parametrize("robot", ROBOTS, ids=ids)
def test_derivatives_of_forward_dynamics_are_its_slopes(robot, rng):
    q = random_q(robot, rng)
    qd, tau = rng.normal(size=(2, robot.dof))
    dq, dqd, dtau = robot.forward_dynamics_derivatives(q, qd, tau)
    n = robot.dof
    slope = differences(lambda d: robot.forward_dynamics(q + d, qd, tau), n)
    np.testing.assert_allclose(dq, slope, atol=1e-5 * scale(slope))
    slope = differences(lambda d: robot.forward_dynamics(q, qd + d, tau), n)
    np.testing.assert_allclose(dqd, slope, atol=1e-5 * scale(slope))
    slope = differences(lambda d: robot.forward_dynamics(q, qd, tau + d), n)
    np.testing.assert_allclose(dtau, slope, atol=1e-5 * scale(slope))


@pytest.mark.parametrize("axes", ["base", "tip"])
@pytest.mark.parametrize("robot", [*ROBOTS, *FREE], ids=lambda robot: robot.name)
def test_derivatives_with_wrenches_are_slopes(robot, axes, rng):
    q, n, still = random_q(robot, rng), robot.dof, {"friction": False}
    T, b = (random_pose(rng), 6) if robot.floating else (None, 0)
    qd, qdd = rng.normal(size=(2, n))
    frames = dict.fromkeys([robot.base, *rng.choice(robot.frames, size=2)])
    pushed = {"wrenches": {frame: rng.normal(size=6) * 10 for frame in frames}, "expressed_in": axes, **still}

    def placed(d):
        return {"T_world_base": moved(T, d[:6])} if robot.floating else {}

    def torques(d):
        return robot.inverse_dynamics(q + d[b:], qd, qdd, **placed(d), **pushed)

    def responses(d):
        return robot.forward_dynamics(q + d[b:], qd, tau, **placed(d), **pushed)

    tau = torques(np.zeros(n))
    slope = differences(torques, n)
    dq = robot.inverse_dynamics_derivatives(q, qd, qdd, **placed(np.zeros(6)), **pushed)[0]
    np.testing.assert_allclose(dq, slope, atol=1e-7 * scale(slope))
    slope = differences(responses, n)
    dq = robot.forward_dynamics_derivatives(q, qd, tau, **placed(np.zeros(6)), **pushed)[0]
    np.testing.assert_allclose(dq, slope, atol=1e-5 * scale(slope))


def test_derivatives_with_a_wrench_for_each_row_are_those_of_single_rows(rng):
    robot = ARMS[0]
    q, (qd, qdd) = random_q(robot, rng, 5), rng.normal(size=(2, 5, robot.dof))
    w = rng.normal(size=(3, 5, 6))
    tip = robot.frames[-1]
    for compute in (robot.inverse_dynamics_derivatives, robot.forward_dynamics_derivatives):
        all_rows = compute(q, qd, qdd, wrenches={tip: w})[0]
        for i, j in np.ndindex(3, 5):
            one = compute(q[j], qd[j], qdd[j], wrenches={tip: w[i, j]})[0]
            np.testing.assert_allclose(all_rows[i, j], one, atol=1e-11 * scale(one))


@pytest.mark.parametrize("robot", [*ROBOTS, *FREE], ids=lambda robot: robot.name)
def test_derivatives_of_forward_dynamics_are_those_of_inverse_dynamics_through_the_mass_matrix(robot, rng):
    q, placed = random_q(robot, rng), {"T_world_base": random_pose(rng)} if robot.floating else {}
    qd, tau = rng.normal(size=(2, robot.dof))
    qdd = robot.forward_dynamics(q, qd, tau, **placed)
    dq, dqd, M = robot.inverse_dynamics_derivatives(q, qd, qdd, **placed)
    forward = robot.forward_dynamics_derivatives(q, qd, tau, **placed)
    weight = np.abs(forward[2]).max()
    for found, expected in zip(forward, (-dq, -dqd, np.eye(robot.dof)), strict=True):
        np.testing.assert_allclose(
            M @ found, expected, atol=1e-12 * scale(expected) * max(1.0, weight * scale(M))
        )


@pytest.mark.parametrize("robot", [*ROBOTS[:2], TREES[1], FREE[0]], ids=lambda robot: robot.name)
def test_rows_alone_and_among_others_agree(robot, rng):
    q, qd, qdd = random_q(robot, rng, 11), *rng.normal(size=(2, 11, robot.dof))
    for many, alone in (
        (robot.coriolis_matrix(q, qd), [robot.coriolis_matrix(a, b) for a, b in zip(q, qd, strict=True)]),
        (robot.centroidal_momentum_matrix(q), [robot.centroidal_momentum_matrix(a) for a in q]),
        (robot.kinetic_energy(q, qd), [robot.kinetic_energy(a, b) for a, b in zip(q, qd, strict=True)]),
        (
            robot.inverse_dynamics_derivatives(q, qd, qdd)[0],
            [robot.inverse_dynamics_derivatives(*row)[0] for row in zip(q, qd, qdd, strict=True)],
        ),
        (
            robot.forward_dynamics_derivatives(q, qd, qdd)[0],
            [robot.forward_dynamics_derivatives(*row)[0] for row in zip(q, qd, qdd, strict=True)],
        ),
        (robot.regressor(q, qd, qdd), [robot.regressor(*row) for row in zip(q, qd, qdd, strict=True)]),
    ):
        np.testing.assert_allclose(many, alone, atol=1e-11 * scale(many))


@pytest.mark.parametrize("robot", [TREES[0], FREE[1]], ids=lambda robot: robot.name)
def test_matrices_are_written_into_an_array(robot, rng):
    q, qd, qdd = random_q(robot, rng, 5), *rng.normal(size=(2, 5, robot.dof))
    n, p = robot.dof, robot.regressor(q[0], qd[0], qdd[0]).shape[1]
    for function, shape in (
        (robot.inverse_dynamics_derivatives, (5, 3, n, n)),
        (robot.forward_dynamics_derivatives, (5, 3, n, n)),
        (robot.regressor, (5, n, p)),
    ):
        out = np.full(shape, np.nan)
        for threads in (1, 2):
            found = function(q, qd, qdd, out=out, threads=threads)
            again = function(q, qd, qdd)
            if isinstance(found, tuple):
                np.testing.assert_array_equal(np.stack(again, axis=1), out)
                assert all(np.shares_memory(part, out) for part in found)
            else:
                assert found is out
                np.testing.assert_array_equal(again, out)


@pytest.mark.parametrize("lead", [(), (4,), (2, 3), (0,)])
def test_energies_are_written_to_out(lead):
    robot, rng = cs.load_robot("panda"), np.random.default_rng(5)
    q, qd = rng.normal(size=(2, *lead, robot.dof))
    for ours, wanted in (
        (lambda out: robot.kinetic_energy(q, qd, out=out), robot.kinetic_energy(q, qd)),
        (lambda out: robot.potential_energy(q, out=out), robot.potential_energy(q)),
    ):
        out = np.full(lead, np.nan)
        assert ours(out) is out
        assert np.array_equal(out, wanted)
        with pytest.raises(InputError, match="out has shape"):
            ours(np.zeros((*lead, 2)))
