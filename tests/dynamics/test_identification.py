"""Laws of the regressor, of base parameters, and of their identification from data."""

from __future__ import annotations

import itertools
import sys
from dataclasses import replace

import numpy as np
import pytest

import cspace as cs
from cspace.dynamics import (
    base_parameters,
    exciting_trajectory,
    identify,
    parameter_names,
    parameters,
    with_parameters,
)
from cspace.dynamics import possible_parameters as possible
from cspace.dynamics.regressor import TENSOR
from cspace.errors import InputError, InputTypeError
from cspace.model import Description, Inertial, Joint, Link
from cspace.tolerances import DEPENDENT_COLUMN
from dynamics.bodies import hand_arm, random_body
from dynamics.test_derived_quantities import FREE
from dynamics.test_motion_and_force import ROBOTS
from kinematics.robots import arm, random_q
from model.random_robots import random_pose, with_resistances


def rubbing(robot, **options):
    """The robot with an armature, damping and friction at half of its joints."""
    rng = np.random.default_rng(3)
    return cs.Robot(with_resistances(rng, robot.description), floating=robot.floating, **options)


def real_arm():
    """Seven joints that carry bodies which can exist."""
    rng = np.random.default_rng(3)
    description = arm(3, "RRRRRRR").description
    links = tuple(replace(link, inertial=random_body(rng)) for link in description.links)
    return cs.Robot(with_resistances(rng, replace(description, links=links)))


def gripper(**options):
    rng = np.random.default_rng(5)
    return cs.Robot(with_resistances(rng, hand_arm(rng)), **options)


TILTED = random_pose(np.random.default_rng(1))
CASES = {
    **{f"{robot.name} {i}": rubbing(robot) for i, robot in enumerate(ROBOTS)},
    **{f"floating {robot.name} {i}": rubbing(robot) for i, robot in enumerate(FREE)},
    "with mimicking finger": gripper(),
    "with locked finger": gripper(tip="tcp", locked={"open": 0.02}, T_world_base=TILTED),
    "back to front": gripper(base="tcp", tip="link_0"),
}
ARM = real_arm()
PANDA = cs.load_robot("panda")


@pytest.fixture
def rng():
    return np.random.default_rng(17)


def random_motion(robot, rng, rows):
    """q, qd, qdd and, for a floating base, where it is."""
    qd, qdd = rng.normal(size=(2, rows, robot.dof)) * 3
    placed = {"T_world_base": np.array([random_pose(rng) for _ in range(rows)])} if robot.floating else {}
    return (random_q(robot, rng, rows), qd, 3 * qdd), placed


def close(a, b, share):
    np.testing.assert_allclose(a, b, rtol=0, atol=share * (1.0 + np.abs(b).max()))


@pytest.mark.parametrize("friction", [True, False])
@pytest.mark.parametrize("name", CASES)
def test_torques_are_the_regressor_times_the_parameters(name, friction, rng):
    robot, gravity = CASES[name], 9 * rng.normal(size=3)
    motion, placed = random_motion(robot, rng, 8)
    Y = robot.regressor(*motion, gravity=gravity, friction=friction, **placed)
    pi = parameters(robot, friction=friction)
    assert Y.shape == (8, robot.dof, len(pi))
    assert len(set(parameter_names(robot, friction=friction))) == len(pi)
    close(Y @ pi, robot.inverse_dynamics(*motion, gravity=gravity, friction=friction, **placed), 1e-12)


def test_a_placed_base_turns_gravity(rng):
    motion, _ = random_motion(ARM, rng, 4)
    tau = ARM.inverse_dynamics(*motion, T_world_base=TILTED)
    close(ARM.regressor(*motion, T_world_base=TILTED) @ parameters(ARM), tau, 1e-12)


def test_leading_axes_broadcast_and_rows_do_not_depend_on_others(rng):
    (q, qd, qdd), _ = random_motion(ARM, rng, 6)
    Y = ARM.regressor(q.reshape(2, 3, 7), qd.reshape(2, 3, 7), qdd[0])
    assert Y.shape[:3] == (2, 3, 7)
    np.testing.assert_allclose(Y[1, 2], ARM.regressor(q[5], qd[5], qdd[0]), rtol=0, atol=1e-13)
    assert ARM.regressor(q[:0], qd[:0], qdd[:0]).shape == (0, *Y.shape[2:])


def test_masses_do_not_count_in_the_regressor(rng):
    bare = cs.Robot(replace(ARM.description, links=tuple(Link(link.name) for link in ARM.description.links)))
    motion, _ = random_motion(ARM, rng, 3)
    np.testing.assert_array_equal(bare.regressor(*motion), ARM.regressor(*motion))
    assert not parameters(bare)[:70].any()


def test_parameters_are_in_the_frame_of_the_link():
    body = Inertial(2.0, (0.1, 0.2, 0.3), np.diag([0.4, 0.5, 0.6]))
    joint = Joint(
        "turn", "revolute", "base", "lever", random_pose(np.random.default_rng(0)), (1, 2, 3), armature=7.0
    )
    robot = cs.Robot(Description("one", (Link("base"), Link("lever", body)), (joint,)))
    named = dict(zip(parameter_names(robot), parameters(robot), strict=True))
    m, (x, y, z) = body.mass, body.com
    assert named == pytest.approx(
        {
            "m_lever": m,
            **{f"h{axis}_lever": m * value for axis, value in zip("xyz", body.com, strict=True)},
            "Ixx_lever": 0.4 + m * (y * y + z * z),
            "Iyy_lever": 0.5 + m * (x * x + z * z),
            "Izz_lever": 0.6 + m * (x * x + y * y),
            "Ixy_lever": -m * x * y,
            "Ixz_lever": -m * x * z,
            "Iyz_lever": -m * y * z,
            "armature_turn": 7.0,
            "damping_turn": 0.0,
            "friction_turn": 0.0,
        },
        abs=1e-14,
    )


@pytest.mark.parametrize("name", CASES)
def test_a_robot_with_given_parameters_has_them(name, rng):
    robot = CASES[name]
    pi = parameters(robot)
    motion, placed = random_motion(robot, rng, 3)
    same = with_parameters(robot, pi)
    close(same.inverse_dynamics(*motion, **placed), robot.inverse_dynamics(*motion, **placed), 1e-12)
    close(parameters(with_parameters(robot, 2 * pi)), 2 * pi, 1e-12)
    bare = parameters(robot, friction=False)
    close(parameters(with_parameters(robot, 3 * bare)), np.concatenate([3 * bare, pi[len(bare) :]]), 1e-12)
    assert same.name == robot.name
    assert (same.base, same.tip, same.frames) == (robot.base, robot.tip, robot.frames)


CHAINS = [name for name in CASES if "random" not in name]


@pytest.mark.parametrize("name", CHAINS)
def test_base_parameters_are_enough_and_none_is_too_many(name, rng):
    robot = CASES[name]
    base = base_parameters(robot)
    motion, placed = random_motion(robot, rng, 60)
    Y = robot.regressor(*motion, **placed).reshape(-1, base.matrix.shape[1])
    close(Y[:, base.columns] @ base.matrix, Y, 1e-9)
    needed = Y[:, base.columns] / np.linalg.norm(Y[:, base.columns], axis=0)
    assert np.linalg.cond(needed) < 1 / DEPENDENT_COLUMN
    close(base.matrix @ parameters(robot), base.values, 1e-15)
    assert len(base) == len(base.names) == len(set(base.names))


@pytest.mark.parametrize(("name", "count"), [("puma560", 36), ("panda", 43), ("kuka_iiwa_14", 43)])
def test_the_number_of_base_parameters_is_the_known_one(name, count):
    """Gautier and Khalil 1990 for the PUMA, Gaz et al. 2019 for the Panda: without armatures."""
    base = base_parameters(cs.load_robot(name), friction=False)
    assert sum(not text.startswith("armature") for text in base.names) == count


@pytest.mark.parametrize(("name", "count"), [("gen3", 62), ("so101", 42), ("ur5e", 52)])
def test_rounded_angles_of_files_make_no_parameters(name, count, rng):
    """Axes of these files are parallel up to 4e-7 rad; a parameter for that is beyond every measurement."""
    robot = cs.load_robot(name)
    motion, _ = random_motion(robot, rng, 200)
    found = identify(robot, *motion, robot.inverse_dynamics(*motion))
    assert len(found.base) == count
    assert found.condition < 10
    close(found.base, base_parameters(robot).values, 1e-6)


def double_pendulum(gravity=(0, -9.81, 0)):
    links = [
        Link("base"),
        Link("a", random_body(np.random.default_rng(1))),
        Link("b", random_body(np.random.default_rng(2))),
    ]
    joints = [
        Joint("one", "continuous", "base", "a", axis=(0, 0, 1)),
        Joint("two", "continuous", "a", "b", cs.pose((0.5, 0, 0)), (0, 0, 1)),
    ]
    return base_parameters(
        cs.Robot(Description("pendulum", tuple(links), tuple(joints))), gravity=gravity, friction=False
    )


def test_the_base_parameters_of_a_double_pendulum_are_those_of_the_textbook():
    assert double_pendulum().names == (
        "hx_a + 0.5 m_b",
        "hy_a",
        "Izz_a + 0.25 m_b + armature_one",
        "hx_b",
        "hy_b",
        "Izz_b",
        "armature_two",
    )
    assert double_pendulum(gravity=(0, 0, -9.81)).names == (
        "Izz_a + 0.25 m_b + armature_one",
        "hx_b",
        "hy_b",
        "Izz_b",
        "armature_two",
    )
    assert "hx_a + 0.5 m_b" in str(double_pendulum())
    assert repr(double_pendulum()) == "<BaseParameters of pendulum: 7 combinations of 22 parameters>"


@pytest.mark.parametrize(
    "robot", [ARM, gripper(), rubbing(FREE[4]), rubbing(arm(2, "RPRPRR"))], ids=lambda r: r.name
)
def test_exact_data_give_the_base_parameters(robot, rng):
    motion, placed = random_motion(robot, rng, 500)
    found = identify(robot, *motion, robot.inverse_dynamics(*motion, **placed), **placed)
    assert found, found
    close(found.base, base_parameters(robot).values, 1e-9)
    assert found.samples == 500
    assert found.condition < 100
    assert (found.residuals < 1e-9).all()


def test_the_data_are_read_in_parts(rng, monkeypatch):
    motion, _ = random_motion(ARM, rng, 300)
    tau = ARM.inverse_dynamics(*motion) + rng.normal(size=(300, 7))
    whole = identify(ARM, *motion, tau)
    monkeypatch.setattr(sys.modules["cspace.dynamics.regressor"], "CHUNK", 20_000)
    parts = identify(ARM, *motion, tau)
    np.testing.assert_allclose(parts.base, whole.base, rtol=0, atol=1e-11)
    np.testing.assert_allclose(parts.covariance, whole.covariance, rtol=1e-9)
    order = rng.permutation(300)
    mixed = identify(ARM, *(x[order] for x in motion), tau[order])
    np.testing.assert_allclose(mixed.base, whole.base, rtol=0, atol=1e-11)


def test_the_answer_is_that_of_weighted_least_squares(rng):
    """Against the normal equations in one piece, with the weights that the answer implies."""
    motion, _ = random_motion(ARM, rng, 200)
    tau = ARM.inverse_dynamics(*motion) + rng.normal(size=(200, 7)) * np.geomspace(0.01, 10, 7)
    found, base = identify(ARM, *motion, tau), base_parameters(ARM)
    Y = ARM.regressor(*motion)[..., base.columns]
    spread = found.residuals * np.sqrt(200 / (200 - len(base) / 7))
    A, c = (Y / spread[:, None]).reshape(-1, len(base)), (tau / spread).ravel()
    np.testing.assert_allclose(
        np.linalg.solve(A.T @ A, A.T @ c), found.base, rtol=0, atol=1e-3 * found.errors.max()
    )
    np.testing.assert_allclose(
        np.linalg.inv(A.T @ A), found.covariance, rtol=1e-2, atol=1e-4 * found.covariance.max()
    )
    np.testing.assert_allclose(found.residuals, np.geomspace(0.01, 10, 7), rtol=0.2)


@pytest.mark.slow
def test_standard_errors_cover_the_errors(rng):
    """One per cent of noise on every torque, forty times: 99 % of the errors are within three of them."""
    base = base_parameters(ARM)
    motion, _ = random_motion(ARM, rng, 400)
    tau = ARM.inverse_dynamics(*motion)
    noise = 0.01 * np.sqrt(np.mean(tau**2, axis=0))
    within = []
    for seed in range(40):
        measured = tau + noise * np.random.default_rng(1000 + seed).normal(size=tau.shape)
        found = identify(ARM, *motion, measured)
        within.append(np.abs(found.base - base.values) <= 3 * found.errors)
    assert np.mean(within) >= 0.99


def test_joints_that_do_not_move_are_named(rng):
    (q, qd, qdd), _ = random_motion(ARM, rng, 300)
    q[:, 4], qd[:, 4], qdd[:, 4] = 0.3, 0, 0
    found = identify(ARM, q, qd, qdd, ARM.inverse_dynamics(q, qd, qdd))
    assert not found
    assert "joint_4" in found.unexcited
    assert "joint_0" not in found.unexcited
    assert "undetermined" in repr(found)
    known = ~np.isnan(found.base)
    assert 0 < known.sum() < len(known)
    close(found.base[known], base_parameters(ARM).values[known], 1e-9)
    assert np.isinf(found.condition)


def test_few_samples_determine_little(rng):
    motion, _ = random_motion(ARM, rng, 3)
    found = identify(ARM, *motion, ARM.inverse_dynamics(*motion), physical=True)
    assert not found
    assert found.parameters is None


def pseudo_inertias(pi, bodies):
    for row in pi[: 10 * bodies].reshape(bodies, 10):
        inertia = row[4:][TENSOR]
        J = np.zeros((4, 4))
        J[:3, :3] = 0.5 * np.trace(inertia) * np.eye(3) - inertia
        J[3, :3] = J[:3, 3] = row[1:4]
        J[3, 3] = row[0]
        yield J


@pytest.mark.parametrize("start", ["its own masses", "no masses"])
def test_possible_parameters_belong_to_bodies_and_give_the_torques(start, rng):
    robot = ARM
    if start == "no masses":
        links = tuple(Link(link.name) for link in ARM.description.links)
        robot = cs.Robot(replace(ARM.description, links=links))
    motion, _ = random_motion(ARM, rng, 400)
    tau = ARM.inverse_dynamics(*motion)
    noise = 0.01 * np.sqrt(np.mean(tau**2, axis=0))
    found = identify(robot, *motion, tau + noise * rng.normal(size=tau.shape), physical=True)
    for J in pseudo_inertias(found.parameters, 7):
        assert (np.linalg.eigvalsh(J) > 0).all()
    assert (found.parameters[70:] > 0).all()
    apart = base_parameters(ARM).matrix @ found.parameters - base_parameters(ARM).values
    assert (np.abs(apart) < 5 * found.errors).all()
    fresh, _ = random_motion(ARM, rng, 50)
    left = with_parameters(robot, found.parameters).inverse_dynamics(*fresh) - ARM.inverse_dynamics(*fresh)
    assert (np.abs(left) < 5 * noise).all()


def test_what_no_body_can_have_becomes_possible(rng):
    """Light links with much noise: the unconstrained answer breaks the laws of rigid bodies."""
    motion, _ = random_motion(ARM, rng, 100)
    tau = ARM.inverse_dynamics(*motion) + 3 * rng.normal(size=(100, 7))
    found = identify(ARM, *motion, tau, physical=True)
    inertia = np.array(
        [value for name, value in zip(found.names, found.base, strict=True) if name[:3] == "Izz"]
    )
    friction = np.array(
        [value for name, value in zip(found.names, found.base, strict=True) if "friction" in name]
    )
    assert (friction < 0).any() or (inertia < 0).any()
    assert all((np.linalg.eigvalsh(J) > 0).all() for J in pseudo_inertias(found.parameters, 7))


def test_logarithmic_coordinates_go_forth_and_back(rng):
    pi = np.concatenate([parameters(ARM)[:70], rng.uniform(0.1, 2, 21)])
    theta = possible.to_coordinates(pi, 7)
    close(possible.to_parameters(theta, 7), pi, 1e-12)
    slopes = possible.parameter_slopes(theta, 7)
    step = 1e-6 * np.eye(len(theta))
    differences = [
        (possible.to_parameters(theta + d, 7) - possible.to_parameters(theta - d, 7)) / 2e-6 for d in step
    ]
    close(slopes, np.transpose(differences), 1e-8)


def test_an_exciting_trajectory_keeps_the_limits():
    motion = exciting_trajectory(PANDA, trials=20, rng=0, acceleration=5.0)
    limits, (q, qd, qdd) = PANDA.limits, motion(np.linspace(0, 10, 20_001))
    assert ((limits.lower <= q) & (q <= limits.upper)).all()
    assert (np.abs(qd) <= limits.velocity).all()
    assert (np.abs(qdd) <= 5.0).all()
    attained = np.max(
        [
            2 * np.ptp(q, 0) / 2 / (limits.upper - limits.lower),
            np.abs(qd).max(0) / limits.velocity,
            np.abs(qdd).max(0) / 5,
        ],
        0,
    )
    assert (attained > 0.98).all()
    np.testing.assert_allclose(np.gradient(q, 10 / 20_000, axis=0)[1:-1], qd[1:-1], atol=1e-5)
    np.testing.assert_allclose(np.gradient(qd, 10 / 20_000, axis=0)[1:-1], qdd[1:-1], atol=1e-4)
    for value in (motion.qd[[0, -1]], motion.qdd[[0, -1]], q[0] - q[-1]):
        np.testing.assert_allclose(value, 0, atol=1e-12)
    assert motion.times.shape == (1001,)
    np.testing.assert_allclose(motion.q[137], motion(1.37)[0], atol=1e-12)


def test_more_trials_find_better_motions_and_seeds_repeat_them():
    one, many, again = (exciting_trajectory(ARM, velocity=2.0, trials=n, rng=4) for n in (1, 60, 60))
    assert many.condition < one.condition < np.inf
    np.testing.assert_array_equal(many.q, again.q)
    assert f"condition {many.condition:.3g}" in repr(many)
    found = identify(ARM, many.q, many.qd, many.qdd, ARM.inverse_dynamics(many.q, many.qd, many.qdd))
    assert found
    assert found.condition < 100
    close(found.base, base_parameters(ARM).values, 1e-9)


def test_a_joint_that_cannot_move_is_never_excited():
    stuck = replace(ARM.description.joint("joint_6"), lower=0.1, upper=0.1)
    joints = tuple(stuck if joint.name == "joint_6" else joint for joint in ARM.description.joints)
    motion = exciting_trajectory(
        cs.Robot(replace(ARM.description, joints=joints)), velocity=2.0, trials=2, rng=0
    )
    assert not motion
    assert np.isinf(motion.condition)


BAD = {
    "no velocity limits": (lambda: exciting_trajectory(ARM), "velocity="),
    "floating": (lambda: exciting_trajectory(FREE[0], velocity=1.0), "floating"),
    "endless slide": (lambda: exciting_trajectory(cs.Robot(ENDLESS), velocity=1.0), "prismatic joint slide"),
    "duration": (lambda: exciting_trajectory(ARM, velocity=1.0, duration=-1.0), "duration"),
    "harmonics": (lambda: exciting_trajectory(ARM, velocity=1.0, harmonics=1), "harmonics"),
    "trials": (lambda: exciting_trajectory(ARM, velocity=1.0, trials=0), "trials"),
    "NaN": (lambda: identify(ARM, np.full((2, 7), np.nan), *np.zeros((3, 2, 7))), "q "),
    "NaN torque": (lambda: identify(ARM, *np.zeros((3, 2, 7)), np.full((2, 7), np.nan)), "tau"),
    "shape": (lambda: identify(ARM, *np.zeros((3, 2, 7)), np.zeros((2, 6))), "tau has shape"),
    "lengths": (lambda: identify(ARM, *np.zeros((3, 2, 7)), np.zeros((3, 7))), "tau"),
    "gravity": (lambda: ARM.regressor(*np.zeros((3, 7)), gravity=[1, 2]), "gravity"),
    "number of parameters": (lambda: with_parameters(ARM, np.zeros(5)), "pi has 5 entries"),
    "negative mass": (lambda: with_parameters(ARM, -parameters(ARM)), "m_link_1 is -"),
    "no joints": (lambda: base_parameters(cs.Robot(Description("stone", (Link("stone"),), ()))), "no joints"),
    "a name": (lambda: base_parameters("ur5e"), "must be a Robot"),
    "NaN in q": (lambda: ARM.regressor(np.full(7, np.nan), *np.zeros((2, 7))), "q "),
}
ENDLESS = Description(
    "rail", (Link("a"), Link("b")), (Joint("slide", "prismatic", "a", "b", axis=(1, 0, 0)),)
)


@pytest.mark.parametrize("name", BAD)
def test_bad_arguments_are_named(name):
    call, message = BAD[name]
    with pytest.raises((InputError, InputTypeError), match=message):
        call()


def test_a_free_body_shows_all_of_its_inertia(rng):
    ball = cs.Robot(Description("ball", (Link("ball", random_body(rng)),), ()), floating=True)
    motion, placed = random_motion(ball, rng, 30)
    found = identify(ball, *motion, ball.inverse_dynamics(*motion, **placed), physical=True, **placed)
    close(found.base, parameters(ball), 1e-12)
    close(found.parameters, parameters(ball), 1e-9)


def test_the_parts_of_a_planar_joint_are_joints(rng):
    joints = (Joint("roll", "planar", "floor", "cart", random_pose(rng), (1, 2, 3)),)
    cart = cs.Robot(Description("cart", (Link("floor"), Link("cart", random_body(rng))), joints))
    motion, _ = random_motion(cart, rng, 5)
    close(cart.regressor(*motion) @ parameters(cart), cart.inverse_dynamics(*motion), 1e-12)
    assert {"m_roll/x", "m_cart", "damping_roll/turn"} <= set(parameter_names(cart))


def test_no_samples_determine_nothing():
    found = identify(ARM, *np.zeros((4, 0, 7)))
    assert not found
    assert np.isnan(found.base).all()


def test_a_still_robot_shows_its_weight_alone():
    """At rest only gravity counts: friction and inertia stay unknown."""
    q = random_q(ARM, np.random.default_rng(0), 200)
    rest = np.zeros_like(q)
    found = identify(ARM, q, rest, rest, ARM.inverse_dynamics(q, rest, rest))
    assert set(found.unexcited) == set(ARM.joint_names)
    for name, value in itertools.chain(zip(found.names, found.base, strict=True)):
        assert np.isnan(value) or name[0] in "hm"


def test_printed_tables_are_as_wide_as_a_screen():
    robot = cs.load_robot("panda")
    base = cs.dynamics.base_parameters(robot)
    q, qd, qdd = np.random.default_rng(0).normal(size=(3, 1, 7))
    found = cs.dynamics.identify(robot, q, qd, qdd, np.zeros((1, 7)))
    for printed in (base, found):
        text = str(printed)
        assert max(map(len, text.splitlines())) <= 110
        together = " ".join(text.split())
        for name in printed.names:
            assert name in together
    assert "from 1 sample:" in str(found)
