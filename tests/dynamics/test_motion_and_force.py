"""Laws of the mass matrix, inverse and forward dynamics, on random trees with mimicking joints."""

from __future__ import annotations

import numpy as np
import pytest

import cspace as cs
from cspace.errors import InputError
from cspace.model import Description, Inertial, Joint, Link
from kinematics.robots import arm, random_q, tree
from model.random_robots import random_pose


def massive_tree(seed):
    """A random tree whose every joint moves some inertia."""
    while True:
        robot = tree(seed)
        if not robot.inertia_report().singular:
            return robot
        seed += 100


TREES = [massive_tree(seed) for seed in range(6)]
ARMS = [arm(1), arm(2, "RPRPRR"), arm(3, "PPP"), arm(4, "R"), arm(5, "RRRRRRRRR")]
ROBOTS = [*TREES, *ARMS]
ids = [robot.name for robot in ROBOTS]
STEP = 1e-5


@pytest.fixture
def rng():
    return np.random.default_rng(7)


def bodies(robot):
    """Per link with a mass: its name, mass, centre of mass and inertia about it."""
    frames = set(robot.frames)
    for link in robot.description.links:
        if link.inertial is not None and link.name in frames:
            yield link.name, link.inertial.mass, link.inertial.com, link.inertial.inertia


def mass_from_jacobians(robot, q):
    """Σ m Jᵥᵀ Jᵥ + Jωᵀ R I Rᵀ Jω over the links."""
    M = np.zeros((robot.dof, robot.dof))
    for name, mass, com, inertia in bodies(robot):
        J = robot.jacobian(q, name, point=com)
        R = robot.fk(q, name)[:3, :3]
        M += mass * J[:3].T @ J[:3] + J[3:].T @ R @ inertia @ R.T @ J[3:]
    return M


def potential(robot, q, gravity):
    return -sum(m * gravity @ (robot.fk(q, name) @ [*com, 1])[:3] for name, m, com, _ in bodies(robot))


def scale(a):
    return 1.0 + np.abs(a).max()


@pytest.mark.parametrize("robot", ROBOTS, ids=ids)
def test_the_mass_matrix_is_that_of_the_kinetic_energy_of_all_links(robot, rng):
    for q in random_q(robot, rng, 5):
        expected = mass_from_jacobians(robot, q)
        np.testing.assert_allclose(robot.mass_matrix(q), expected, atol=1e-12 * scale(expected))


@pytest.mark.parametrize("robot", ROBOTS, ids=ids)
def test_the_mass_matrix_is_symmetric_and_positive(robot, rng):
    M = robot.mass_matrix(random_q(robot, rng, 20))
    np.testing.assert_array_equal(M, np.swapaxes(M, -1, -2))
    assert (np.linalg.eigvalsh(M) > 0.0).all()


@pytest.mark.parametrize("robot", ROBOTS, ids=ids)
def test_columns_of_the_mass_matrix_are_torques_of_unit_accelerations(robot, rng):
    q = random_q(robot, rng)
    rest, unit = np.zeros(robot.dof), np.eye(robot.dof)
    torques = cs.dynamics.inverse_dynamics(robot, q, rest, unit, gravity=np.zeros(3))
    M = robot.mass_matrix(q)
    np.testing.assert_allclose(torques.T, M, atol=1e-13 * scale(M))


@pytest.mark.parametrize("robot", ROBOTS, ids=ids)
def test_torques_of_velocities_follow_from_lagrange(robot, rng):
    q, qd = random_q(robot, rng), rng.normal(size=robot.dof)
    none = np.zeros(3)
    rate = (robot.mass_matrix(q + STEP * qd) - robot.mass_matrix(q - STEP * qd)) @ qd / (2 * STEP)
    slope = [
        qd @ (robot.mass_matrix(q + d) - robot.mass_matrix(q - d)) @ qd / (4 * STEP)
        for d in STEP * np.eye(robot.dof)
    ]
    tau = robot.inverse_dynamics(q, qd, np.zeros(robot.dof), gravity=none, friction=False)
    np.testing.assert_allclose(tau, rate - slope, atol=1e-7 * scale(tau))


@pytest.mark.parametrize("robot", ROBOTS, ids=ids)
def test_gravity_torques_are_the_slope_of_the_potential(robot, rng):
    q, gravity = random_q(robot, rng), rng.normal(size=3)
    g = robot.gravity_torques(q, gravity=gravity)
    slope = [
        (potential(robot, q + d, gravity) - potential(robot, q - d, gravity)) / (2 * STEP)
        for d in STEP * np.eye(robot.dof)
    ]
    np.testing.assert_allclose(g, slope, atol=1e-8 * scale(g))
    rest = np.zeros(robot.dof)
    np.testing.assert_allclose(
        robot.inverse_dynamics(q, rest, rest, gravity=gravity), g, atol=1e-13 * scale(g)
    )


@pytest.mark.parametrize("robot", ROBOTS, ids=ids)
def test_forward_dynamics_undoes_inverse_dynamics(robot, rng):
    q = random_q(robot, rng, 30)
    qd, qdd = rng.normal(size=(2, 30, robot.dof))
    tau = robot.inverse_dynamics(q, qd, qdd)
    np.testing.assert_allclose(robot.forward_dynamics(q, qd, tau), qdd, atol=1e-9 * scale(qdd))


@pytest.mark.parametrize("robot", ROBOTS, ids=ids)
def test_one_row_alone_and_among_others_agree(robot, rng):
    q = random_q(robot, rng, 13)
    qd, force = rng.normal(size=(2, 13, robot.dof))
    for function in (robot.inverse_dynamics, robot.forward_dynamics):
        many = function(q, qd, force)
        alone = np.array([function(*row) for row in zip(q, qd, force, strict=True)])
        np.testing.assert_allclose(many, alone, atol=1e-11 * scale(many))
        np.testing.assert_array_equal(function(q, qd, force, threads=1), function(q, qd, force, threads=2))
    np.testing.assert_allclose(
        robot.mass_matrix(q), [robot.mass_matrix(row) for row in q], atol=1e-13 * scale(robot.mass_matrix(q))
    )


@pytest.mark.parametrize("count", [1, 2, 9])
@pytest.mark.parametrize("robot", [ARMS[1], TREES[0]], ids=lambda robot: robot.name)
def test_a_result_may_be_written_over_an_argument(robot, rng, count):
    q = random_q(robot, rng, count)
    qd, force = rng.normal(size=(2, count, robot.dof))
    for function in (robot.inverse_dynamics, robot.forward_dynamics):
        expected = function(q, qd, force)
        for k in range(3):
            given = [q.copy(), qd.copy(), force.copy()]
            np.testing.assert_array_equal(function(*given, out=given[k]), expected)


@pytest.mark.parametrize("robot", [*TREES[:3], ARMS[1]], ids=lambda robot: robot.name)
def test_a_floating_base_obeys_the_law_of_the_whole_body(robot, rng):
    free = cs.Robot(robot.description, floating=True)
    T = random_pose(rng)
    q = random_q(free, rng)
    qd, qdd = rng.normal(size=(2, free.dof))
    none = np.zeros(3)
    tau = free.inverse_dynamics(q, qd, qdd, T_world_base=T, gravity=none)
    M = free.mass_matrix(q, T_world_base=T)
    np.testing.assert_allclose(M[:3, :3], free.mass * np.eye(3), atol=1e-12 * free.mass)
    # The force on the base is mass times acceleration of the centre of mass.
    J = free.center_of_mass_jacobian(q, T_world_base=T)
    ahead, behind = (
        free.center_of_mass_jacobian(q + h * qd[6:], T_world_base=moved(T, h * qd[:6])) @ qd
        for h in (STEP, -STEP)
    )
    expected = free.mass * (J @ qdd + (ahead - behind) / (2 * STEP))
    np.testing.assert_allclose(tau[:3], expected, atol=1e-7 * scale(tau))
    weight = free.gravity_torques(q, T_world_base=T, gravity=[0, 0, -1])
    np.testing.assert_allclose(weight[:3], [0, 0, free.mass], atol=1e-12 * free.mass)
    again = free.forward_dynamics(q, qd, tau, T_world_base=T, gravity=none)
    np.testing.assert_allclose(again, qdd, atol=1e-9 * scale(qdd))
    columns = free.inverse_dynamics(q, np.zeros(free.dof), np.eye(free.dof), T_world_base=T, gravity=none)
    np.testing.assert_allclose(M, columns.T, atol=1e-12 * scale(M))


def moved(T, step):
    """T after a small motion [v; ω] of its origin in world axes."""
    result = cs.spatial.exp_se3(np.concatenate([np.zeros(3), step[3:]])) @ T
    result[:3, 3] = T[:3, 3] + step[:3]
    return result


@pytest.mark.parametrize("robot", ROBOTS, ids=ids)
def test_torques_are_those_of_the_robot_in_a_turned_world(robot, rng):
    T, gravity = random_pose(rng), rng.normal(size=3)
    turned = robot.with_base(T)
    q = random_q(robot, rng)
    qd, qdd = rng.normal(size=(2, robot.dof))
    tau = robot.inverse_dynamics(q, qd, qdd, gravity=gravity)
    atol = 1e-11 * scale(tau)
    mounted = turned.inverse_dynamics(q, qd, qdd, gravity=T[:3, :3] @ gravity)
    np.testing.assert_allclose(mounted, tau, atol=atol)
    placed = robot.inverse_dynamics(q, qd, qdd, gravity=T[:3, :3] @ gravity, T_world_base=T)
    np.testing.assert_allclose(placed, tau, atol=atol)


@pytest.mark.parametrize("robot", ARMS, ids=lambda robot: robot.name)
def test_a_weight_on_the_tip_is_a_wrench(robot, rng):
    q = random_q(robot, rng, 4)
    qd, qdd = rng.normal(size=(2, 4, robot.dof))
    w = rng.normal(size=6)
    free = robot.inverse_dynamics(q, qd, qdd)
    J = robot.jacobian(q)
    loaded = robot.inverse_dynamics(q, qd, qdd, wrenches={robot.tip: w})
    np.testing.assert_allclose(loaded, free - np.swapaxes(J, -1, -2) @ w, atol=1e-12 * scale(free))
    np.testing.assert_allclose(
        robot.forward_dynamics(q, qd, loaded, wrenches={robot.tip: w}), qdd, atol=1e-9 * scale(qdd)
    )
    R = robot.fk(q)[..., :3, :3]
    local = np.concatenate([np.swapaxes(R, -1, -2) @ w[:3], np.swapaxes(R, -1, -2) @ w[3:]], axis=-1)
    again = robot.inverse_dynamics(q, qd, qdd, wrenches={robot.tip: local}, expressed_in="tip")
    np.testing.assert_allclose(again, loaded, atol=1e-12 * scale(free))


def two_links(m1=1.3, m2=0.7, l1=0.9, r1=0.4, r2=0.35, I1=0.05, I2=0.03):
    """A planar arm of two links whose centres of mass are r1 and r2 behind their joints."""

    def link(name, mass, r, inertia):
        return Link(name, Inertial(mass, [r, 0, 0], np.diag([0, inertia, inertia])))

    elbow = np.eye(4)
    elbow[0, 3] = l1
    joints = (
        Joint("shoulder", "continuous", "base", "upper", axis=[0, 0, 1]),
        Joint("elbow", "continuous", "upper", "lower", elbow, [0, 0, 1]),
    )
    links = (Link("base"), link("upper", m1, r1, I1), link("lower", m2, r2, I2))
    return cs.Robot(Description("two links", links, joints))


def test_two_links_in_closed_form(rng):
    m1, m2, l1, r1, r2, I1, I2 = rng.uniform(0.2, 2.0, 7)
    robot = two_links(m1, m2, l1, r1, r2, I1, I2)
    q, qd, qdd = rng.uniform(-3, 3, (3, 2))
    c2, s2 = np.cos(q[1]), np.sin(q[1])
    M12 = I2 + m2 * (r2**2 + l1 * r2 * c2)
    M = [[I1 + I2 + m1 * r1**2 + m2 * (l1**2 + r2**2 + 2 * l1 * r2 * c2), M12], [M12, I2 + m2 * r2**2]]
    h = -m2 * l1 * r2 * s2
    C = h * np.array([[qd[1], qd[0] + qd[1]], [-qd[0], 0]])
    g = 9.81
    lower = m2 * g * r2 * np.cos(q.sum())
    G = np.array([(m1 * r1 + m2 * l1) * g * np.cos(q[0]) + lower, lower])
    np.testing.assert_allclose(robot.mass_matrix(q), M, rtol=1e-13)
    down = [0, -g, 0]
    np.testing.assert_allclose(robot.gravity_torques(q, gravity=down), G, atol=1e-13 * scale(G))
    tau = robot.inverse_dynamics(q, qd, qdd, gravity=down)
    np.testing.assert_allclose(tau, np.array(M) @ qdd + C @ qd + G, atol=1e-12 * scale(tau))


def joint_robot(**properties):
    joint = Joint("pivot", "continuous", "base", "arm", axis=[0, 1, 0], **properties)
    links = (Link("base"), Link("arm", Inertial(2.0, [0.5, 0, 0], np.zeros((3, 3)))))
    return cs.Robot(Description("pendulum", links, (joint,)))


def test_armature_damping_and_friction_count_in_every_function():
    robot = joint_robot(armature=0.3, damping=0.2, friction=0.1)
    inertia = 2.0 * 0.25 + 0.3
    assert robot.mass_matrix([0.4])[0, 0] == pytest.approx(inertia, rel=1e-14)
    for rate in (-1.5, 0.0, 2.0):
        rubbing = 0.2 * rate + 0.1 * np.sign(rate)
        free = robot.inverse_dynamics([0.4], [rate], [3.0], friction=False, gravity=np.zeros(3))
        assert free[0] == pytest.approx(3.0 * inertia, rel=1e-14)
        tau = robot.inverse_dynamics([0.4], [rate], [3.0], gravity=np.zeros(3))
        assert tau[0] == pytest.approx(3.0 * inertia + rubbing, rel=1e-14)
        qdd = robot.forward_dynamics([0.4], [rate], tau, gravity=np.zeros(3))
        assert qdd[0] == pytest.approx(3.0, rel=1e-13)


def massless_tip():
    joints = (
        Joint("first", "continuous", "base", "upper", axis=[0, 0, 1]),
        Joint("second", "continuous", "upper", "lower", axis=[0, 1, 0]),
    )
    links = (Link("base"), Link("upper", Inertial(1.0, [0.2, 0, 0], np.eye(3) * 0.01)), Link("lower"))
    return cs.Robot(Description("light", links, joints))


def test_a_joint_that_moves_no_inertia_is_named():
    robot = massless_tip()
    np.testing.assert_array_equal(robot.mass_matrix([0.3, 0.2])[1], 0.0)
    assert np.isfinite(robot.inverse_dynamics([0.3, 0.2], [1, 1], [1, 1])).all()
    for q in ([0.3, 0.2], np.full((5, 2), 0.3)):
        with pytest.raises(InputError, match="'second' moves no inertia"):
            robot.forward_dynamics(q, [0, 0], [0, 0])


def test_two_joints_about_one_axis_cannot_be_told_apart_by_torques():
    joints = (
        Joint("outer", "continuous", "base", "ring", axis=[0, 0, 1]),
        Joint("inner", "continuous", "ring", "arm", axis=[0, 0, 1]),
    )
    links = (Link("base"), Link("ring"), Link("arm", Inertial(1.7, [0.3, 0.1, 0.2], np.eye(3) * 0.013)))
    robot = cs.Robot(Description("gimbal", links, joints))
    rng = np.random.default_rng(3)
    for q in rng.uniform(-3, 3, (20, 2)):
        with pytest.raises(InputError, match="singular"):
            robot.forward_dynamics(q, [0, 0], [1, 0])


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"q": [np.nan] * 6}, "q"),
        ({"qd": [np.inf] * 6}, "qd"),
        ({"qdd": np.zeros(5)}, r"qdd has shape \(5,\), expected \(..., 6\)"),
        ({"gravity": [0, 0]}, "gravity"),
        ({"gravity": [0, 0, np.nan]}, "gravity"),
        ({"wrenches": [1, 2, 3, 4, 5, 6]}, "dict of frame"),
        ({"wrenches": {"nowhere": np.zeros(6)}}, "nowhere"),
        ({"wrenches": {"link_6": np.zeros(5)}}, "wrench at 'link_6'"),
        ({"out": np.zeros(5)}, "out has shape"),
        ({"T_world_base": np.zeros((4, 4))}, "T_world_base"),
    ],
)
def test_bad_arguments_are_named(change, message):
    robot = ARMS[0]
    given = {"q": np.zeros(6), "qd": np.zeros(6), "qdd": np.zeros(6)} | change
    with pytest.raises((InputError, TypeError, ValueError, KeyError), match=message):
        robot.inverse_dynamics(**given)


def test_a_robot_without_masses_is_refused():
    robot = cs.Robot(Description("empty", (Link("a"), Link("b")), (Joint("j", "continuous", "a", "b"),)))
    for call in (
        lambda: robot.mass_matrix([0.0]),
        lambda: robot.gravity_torques([0.0]),
        lambda: robot.inverse_dynamics([0.0], [0.0], [0.0]),
        lambda: robot.forward_dynamics([0.0], [0.0], [0.0]),
    ):
        with pytest.raises(InputError, match="no link of empty has a mass"):
            call()
