"""Dynamics of closed loops: laws, and minimal coordinates as the oracle."""

from dataclasses import replace

import numpy as np
import pytest

from cspace import dynamics
from cspace.errors import InputError, InputTypeError, UnknownNameError
from cspace.kinematics import LoopConstraints, find_assembly_modes
from cspace.mechanisms import Delta, FourBar, SliderCrank, Stewart
from cspace.model import Loop
from cspace.robot import Robot
from kinematics.loops import bennett, closing_loop, random_tree


def four_bar(rng):
    mechanism = FourBar(1.0, 0.3, 0.9, 0.7)
    return mechanism.constraints, mechanism.assembly_modes({"crank": rng.uniform(-3, 3)}).q[0], ["crank"]


def slider_crank(rng):
    mechanism = SliderCrank(0.3, 1.0, offset=0.1)
    return mechanism.constraints, mechanism.assembly_modes({"crank": rng.uniform(-3, 3)}).q[0], ["crank"]


def delta(rng):
    mechanism = Delta(0.2, 0.05, 0.25, 0.6)
    place = {"x": rng.uniform(-0.1, 0.1), "y": rng.uniform(-0.1, 0.1), "z": -0.55}
    return mechanism.constraints, mechanism.assembly_modes(place).q[0], ["arm_1", "arm_2", "arm_3"]


def stewart(rng):
    mechanism = Stewart.of_radii(0.5, 0.3, 0.6)
    pose = dict(
        zip(
            ["x", "y", "z", "rx", "ry", "rz"],
            rng.uniform(-0.1, 0.1, 6) + np.array([0, 0, 0.65, 0, 0, 0]),
            strict=True,
        )
    )
    return mechanism.constraints, mechanism.assembly_modes(pose).q[0], [f"length_{i + 1}" for i in range(6)]


def overconstrained(rng):
    robot = bennett()
    constraints = LoopConstraints(robot, robot.description.loops)
    return (
        constraints,
        find_assembly_modes(constraints, {"pin_0": rng.uniform(0.5, 1.2)}, starts=60).q[0],
        ["pin_0"],
    )


CASES = [four_bar, slider_crank, delta, stewart, overconstrained]
case = pytest.mark.parametrize("make", CASES, ids=lambda make: make.__name__)


def motion(constraints, q, driven, rng):
    qd = dynamics.loop_velocities(
        constraints, q, dict(zip(driven, rng.normal(size=len(driven)), strict=True))
    )
    rates = dict(zip(driven, rng.normal(size=len(driven)), strict=True))
    return qd, dynamics.loop_accelerations(constraints, q, qd, rates)


@case
def test_inverse_and_forward_dynamics_are_inverse(make):
    rng = np.random.default_rng(0)
    for _ in range(5):
        constraints, q, driven = make(rng)
        qd, qdd = motion(constraints, q, driven, rng)
        K, k = constraints.jacobian(q), constraints.bias(q, qd)
        np.testing.assert_allclose(K @ qd, 0, atol=1e-11)
        np.testing.assert_allclose(K @ qdd + k, 0, atol=1e-9 * max(1, np.abs(k).max()))
        tau = dynamics.constrained_inverse_dynamics(constraints, q, qd, qdd, driven)
        names = constraints.robot.joint_names
        assert not tau[[i for i, name in enumerate(names) if name not in driven]].any()
        back = dynamics.constrained_forward_dynamics(constraints, q, qd, tau)
        np.testing.assert_allclose(back, qdd, atol=1e-8 * max(1, np.abs(qdd).max()))


@case
def test_the_driven_torques_do_the_work(make):
    """Power balance: what the driven joints do is what the energy gains."""
    rng = np.random.default_rng(1)
    constraints, q, driven = make(rng)
    robot = constraints.robot
    qd, qdd = motion(constraints, q, driven, rng)
    tau = dynamics.constrained_inverse_dynamics(constraints, q, qd, qdd, driven, friction=False)
    h = 1e-5

    def energy(t):
        place, speed = q + t * qd + t * t / 2 * qdd, qd + t * qdd
        return robot.kinetic_energy(place, speed) + robot.potential_energy(place)

    power = (energy(h) - energy(-h)) / (2 * h)
    assert tau @ qd == pytest.approx(power, abs=1e-5 * max(1, np.abs(tau * qd).max()))


@case
def test_forward_dynamics_obeys_the_principle_of_least_constraint(make):
    """Gauss: no other acceleration that the loops allow is nearer to the free one in the metric of M."""
    rng = np.random.default_rng(2)
    constraints, q, driven = make(rng)
    robot = constraints.robot
    qd, _ = motion(constraints, q, driven, rng)
    tau = rng.normal(size=robot.dof)
    qdd = dynamics.constrained_forward_dynamics(constraints, q, qd, tau)
    torques = robot.inverse_dynamics(q, qd, qdd) - tau  # those of the loops: no work in allowed motions
    for _ in range(5):
        other, _ = motion(constraints, q, driven, rng)
        assert torques @ other == pytest.approx(
            0, abs=1e-9 * np.abs(torques).max() * np.abs(other).max() * 30
        )


def test_a_slider_crank_against_its_single_equation_of_motion():
    """Minimal coordinates: with the influence G(θ) = dq/dθ, m(θ) θ̈ + ½ m′ θ̇² + V′ = τ."""
    mechanism = SliderCrank(0.3, 1.0, offset=0.1, density=0.7, slider_mass=1.3)
    robot, h = mechanism.robot, 1e-4

    def place(turn):
        return mechanism.assembly_modes({"crank": turn}).q[0]

    def influence(turn):
        return (place(turn + h) - place(turn - h)) / (2 * h)

    def inertia(turn):
        G = influence(turn)
        return G @ robot.mass_matrix(place(turn)) @ G

    for turn, speed, torque in ((0.4, 1.3, 0.2), (1.9, -0.7, -1.0), (-1.1, 2.0, 0.0)):
        q = place(turn)
        qd = mechanism.velocities(q, {"crank": speed})
        np.testing.assert_allclose(qd, influence(turn) * speed, atol=1e-7)
        qdd = mechanism.forward_dynamics(q, qd, [torque, 0, 0])
        slope = (inertia(turn + h) - inertia(turn - h)) / (2 * h)
        weight = (robot.potential_energy(place(turn + h)) - robot.potential_energy(place(turn - h))) / (2 * h)
        expected = (torque - 0.5 * slope * speed**2 - weight) / inertia(turn)
        assert qdd[0] == pytest.approx(expected, rel=1e-5, abs=1e-5)


def test_redundant_rows_change_no_acceleration():
    """A planar loop by a spherical joint (rank 2 of 3), by a revolute one (2 of 5), and by both at once."""
    linkage = FourBar(1.0, 0.3, 0.9, 0.7)
    robot, pin = linkage.robot, linkage.loops[0]
    ball = Loop("ball", "spherical", pin.parent, pin.child, pin.origin, pin.child_origin)
    rng = np.random.default_rng(3)
    q = linkage.assembly_modes({"crank": 0.9}).q[1]
    qd = linkage.velocities(q, {"crank": 1.7})
    tau = rng.normal(size=3)
    answers = [
        dynamics.constrained_forward_dynamics(LoopConstraints(robot, loops), q, qd, tau)
        for loops in ([pin], [ball], [pin, ball])
    ]
    np.testing.assert_allclose(answers[1], answers[0], atol=1e-11)
    np.testing.assert_allclose(answers[2], answers[0], atol=1e-11)


@case
def test_batches_are_single_calls(make):
    rng = np.random.default_rng(4)
    rows = [make(rng) for _ in range(3)]
    constraints, driven = rows[0][0], rows[0][2]
    q = np.array([each[1] for each in rows])
    rates = {name: rng.normal(size=3) for name in driven}
    qd = dynamics.loop_velocities(constraints, q, rates)
    qdd = dynamics.loop_accelerations(constraints, q, qd, rates)
    tau = dynamics.constrained_inverse_dynamics(constraints, q, qd, qdd, driven)
    back = dynamics.constrained_forward_dynamics(constraints, q, qd, tau)
    forces = dynamics.loop_wrenches(constraints, q, qd, qdd, tau)
    for i in range(3):
        one = {name: values[i] for name, values in rates.items()}
        np.testing.assert_allclose(dynamics.loop_velocities(constraints, q[i], one), qd[i], atol=1e-9)
        single = dynamics.constrained_inverse_dynamics(constraints, q[i], qd[i], qdd[i], driven)
        np.testing.assert_allclose(single, tau[i], atol=1e-8 * max(1, np.abs(tau).max()))
        single = dynamics.loop_wrenches(constraints, q[i], qd[i], qdd[i], tau[i])
        np.testing.assert_allclose(single, forces[i], atol=1e-8 * max(1, np.abs(forces).max()))
    np.testing.assert_allclose(back, qdd, atol=1e-7 * max(1, np.abs(qdd).max()))
    assert forces.shape == (3, len(constraints.loops), 6)


def test_forces_in_a_loop_hold_the_parts():
    """The rocker alone, under the force of the pin, moves as it does in the linkage."""
    linkage = FourBar(1.0, 0.3, 0.9, 0.7)
    rng = np.random.default_rng(5)
    q = linkage.assembly_modes({"crank": 0.5}).q[0]
    qd = linkage.velocities(q, {"crank": 2.0})
    tau = rng.normal(size=3)
    qdd = linkage.forward_dynamics(q, qd, tau)
    force, *_ = linkage.loop_wrenches(q, qd, qdd, tau)
    J = linkage.robot.jacobian(q, "rocker", point=(0.7, 0, 0))
    alone = linkage.robot.inverse_dynamics(q, qd, qdd)
    np.testing.assert_allclose(alone[2], tau[2] + (J.T @ force)[2], atol=1e-10)


def test_more_drives_than_freedoms_share_the_work():
    linkage = FourBar(1.0, 0.3, 0.9, 0.7)
    q = linkage.assembly_modes({"crank": 0.5}).q[0]
    qd = linkage.velocities(q, {"crank": 2.0})
    qdd = linkage.accelerations(q, qd, {"crank": -1.0})
    one, two = (linkage.inverse_dynamics(q, qd, qdd, names) for names in (["crank"], ["crank", "rocker"]))
    assert two @ qd == pytest.approx(one @ qd)
    assert np.linalg.norm(two) < np.linalg.norm(one)
    np.testing.assert_allclose(linkage.forward_dynamics(q, qd, two), qdd, atol=1e-10)


def test_at_a_dead_point_nothing_can_be_driven_there():
    linkage = FourBar(1.0, 0.3, 0.9, 0.7)
    for q in linkage.dead_points("rocker"):
        with pytest.raises(
            InputError, match="driven joint 'rocker' does not determine the motion of four_bar"
        ):
            linkage.velocities(q, {"rocker": 1.0})
        qd = linkage.velocities(q, {"crank": 1.0})
        assert abs(qd[2]) < 1e-9
        with pytest.raises(InputError, match="a dead point, or too few driven joints"):
            linkage.inverse_dynamics(q, qd, linkage.accelerations(q, qd, {"crank": 0.0}), ["rocker"])


def test_a_floating_base():
    """A free mechanism keeps its momentum: internal torques change none of it."""
    linkage = FourBar(1.0, 0.3, 0.9, 0.7)
    description = linkage.robot.description

    from cspace.model import Inertial, Link

    heavy = Link("ground", Inertial(2.0, np.zeros(3), 0.1 * np.eye(3)))
    links = tuple(heavy if each.name == "ground" else each for each in description.links)
    robot = Robot(replace(description, links=links), floating=True)
    constraints = LoopConstraints(robot, description.loops)
    rng = np.random.default_rng(6)
    q = linkage.assembly_modes({"crank": 0.5}).q[0]
    qd = np.concatenate([rng.normal(size=6), linkage.velocities(q, {"crank": 2.0})])
    tau = np.concatenate([np.zeros(6), rng.normal(size=3)])
    T = np.eye(4)
    qdd = dynamics.constrained_forward_dynamics(constraints, q, qd, tau, gravity=(0, 0, 0), T_world_base=T)
    needs = robot.inverse_dynamics(q, qd, qdd, gravity=(0, 0, 0), T_world_base=T)
    np.testing.assert_allclose(needs[:6], 0, atol=1e-10)
    run = dynamics.simulate_loops(constraints, q, qd, gravity=(0, 0, 0), duration=0.2, dt=1e-3)
    assert np.abs(constraints.residual(run.q)).max() < 1e-12
    momentum = robot.centroidal_momentum(run.q, run.qd, T_world_base=run.T_world_base)
    np.testing.assert_allclose(momentum, momentum[:1].repeat(len(momentum), axis=0), atol=1e-7)
    assert np.ptp(run.energy) < 1e-7 * np.abs(run.energy).max()


@case
def test_a_simulation_keeps_loops_closed_and_energy(make):
    rng = np.random.default_rng(7)
    constraints, q, driven = make(rng)
    if make is stewart:  # its legs would collapse within a second; they are held by springs

        def control(t, q, qd):
            tau = np.zeros_like(q)
            legs = slice(2, 18, 3)
            tau[..., legs] = -2000 * (q[..., legs] - 0.7)
            return tau
    else:
        control = None
    qd, _ = motion(constraints, q, driven, rng)
    run = dynamics.simulate_loops(constraints, q, qd, control=control, duration=0.3, dt=1e-3)
    assert run
    assert np.linalg.norm(constraints.residual(run.q), axis=-1).max() < 1e-12
    speeds = np.einsum("kij,kj->ki", constraints.jacobian(run.q), run.qd)
    assert np.abs(speeds).max() < 1e-10 * np.abs(run.qd).max()
    if control is None:
        assert np.ptp(run.energy) < 1e-5 * np.ptp(constraints.robot.potential_energy(run.q))


def test_energy_falls_with_the_order_of_the_method():
    """Halving the step divides the error by 14 or more."""
    linkage = FourBar(1.0, 0.3, 0.9, 0.7)
    q = linkage.assembly_modes({"crank": 0.5}).q[0]
    qd = linkage.velocities(q, {"crank": 1.0})
    errors = []
    for dt in (0.02, 0.01):
        run = linkage.simulate(q, qd, duration=1.0, dt=dt)
        errors.append(np.abs(run.energy - run.energy[0]).max())
    assert errors[0] / errors[1] > 14


@pytest.mark.slow
@case
def test_loops_stay_closed_over_ten_thousand_steps(make):
    rng = np.random.default_rng(8)
    constraints, q, driven = make(rng)
    numbers = [constraints.robot.joint_names.index(name) for name in driven]
    rest = q[numbers]
    slides = np.array([constraints.robot.joint_types[i] == "P" for i in numbers])
    kp, kd = np.where(slides, 2000.0, 50.0), np.where(slides, 100.0, 1.0)

    def control(t, q, qd):
        tau = np.zeros_like(q)
        wish = rest + 0.05 * np.sin(2 * t + np.arange(len(rest)))
        tau[..., numbers] = -kp * (q[..., numbers] - wish) - kd * qd[..., numbers]
        return tau

    run = dynamics.simulate_loops(constraints, q, 0 * q, control=control, duration=10, dt=1e-3)
    assert run
    assert len(run) == 10_001
    assert np.linalg.norm(constraints.residual(run.q), axis=-1).max() <= 1e-12


@case
def test_one_step_is_that_of_runge_and_kutta(make):
    """Four times the accelerations of constrained forward dynamics, where the loops stay nearly closed."""
    rng = np.random.default_rng(11)
    constraints, q, driven = make(rng)
    qd, _ = motion(constraints, q, driven, rng)
    tau, h = rng.normal(size=constraints.robot.dof), 1e-4

    def rate(state):
        at, speed = state
        closed = dynamics.simulate_loops(constraints, at, speed, duration=1e-12, dt=1e-12)  # projects only
        qdd = dynamics.constrained_forward_dynamics(constraints, closed.q[0], closed.qd[0], tau)
        return np.array([speed, qdd])

    start = np.array([q, qd])
    a = rate(start)
    b = rate(start + h / 2 * a)
    c = rate(start + h / 2 * b)
    d = rate(start + h * c)
    after = start + h / 6 * (a + 2 * b + 2 * c + d)
    run = dynamics.simulate_loops(constraints, q, qd, control=tau, duration=h, dt=h)
    size = np.abs(a[1]).max()
    np.testing.assert_allclose(run.q[-1], after[0], atol=1e-9 * h * size)
    np.testing.assert_allclose(run.qd[-1], after[1], atol=1e-6 * h * size)


def test_a_mechanism_stops_at_a_limit_of_a_joint():
    linkage = FourBar(1.0, 0.3, 0.9, 0.7)
    description = linkage.robot.description
    joints = tuple(
        replace(joint, lower=-3.0, upper=0.8) if joint.name == "crank" else joint
        for joint in description.joints
    )
    robot = Robot(replace(description, joints=joints))
    constraints = LoopConstraints(robot, linkage.loops)
    q = linkage.assembly_modes({"crank": 0.5}).q[0]
    qd = linkage.velocities(q, {"crank": 3.0})
    still = {"gravity": (0, 0, 0), "duration": 1.0, "dt": 1e-3}
    run = dynamics.simulate_loops(constraints, q, qd, stop_at_limits=True, **still)
    assert run.reason.startswith("limit reached: joint 'crank'")
    assert 0.8 < run.q[-1, 0] < 0.81
    assert dynamics.simulate_loops(constraints, q, qd, **still).reason == "ended"


def test_compiled_controllers_are_their_functions():
    linkage = FourBar(1.0, 0.3, 0.9, 0.7)
    q = linkage.assembly_modes({"crank": 0.5}).q[0]
    law = dynamics.PD(q + 0.1, kp=20.0, kd=2.0)
    compiled = linkage.simulate(q, np.zeros(3), control=law, duration=0.2, dt=1e-3)

    def called(t, q, qd):
        return law(linkage.robot, t, q, qd)

    slow = linkage.simulate(q, np.zeros(3), control=called, duration=0.2, dt=1e-3)
    np.testing.assert_allclose(compiled.q, slow.q, atol=1e-11)
    np.testing.assert_allclose(compiled.tau, slow.tau, atol=1e-9)


def test_a_batch_of_simulations_is_one_by_one():
    linkage = FourBar(1.0, 0.3, 0.9, 0.7)
    q = np.array([linkage.assembly_modes({"crank": turn}).q[0] for turn in (0.5, 1.5)])
    both = linkage.simulate(q, np.zeros(3), duration=0.1, dt=0.01, every=3)
    assert both.q.shape == (2, 5, 3)
    for row in range(2):
        one = linkage.simulate(q[row], np.zeros(3), duration=0.1, dt=0.01, every=3)
        np.testing.assert_allclose(both.q[row], one.q, atol=1e-12)
        np.testing.assert_allclose(both.energy[row], one.energy, atol=1e-12)
    np.testing.assert_allclose(both.times, [0, 0.03, 0.06, 0.09, 0.1])


def test_a_simulation_that_breaks_down_says_so():
    linkage = FourBar(1.0, 0.3, 0.9, 0.7)
    q = linkage.assembly_modes({"crank": 0.5}).q[0]
    run = linkage.simulate(q, np.zeros(3), control=lambda t, q, qd: 1e60 * np.ones(3), duration=1.0, dt=0.1)
    assert not run
    assert run.reason.startswith("not finite: after t = 0 s")
    slow = linkage.simulate(q, np.zeros(3), duration=1e6, dt=1e-3, every=10**6, time_limit=0.05)
    assert not slow
    assert slow.reason.startswith("time limit")


def test_controllers_and_wrenches():
    linkage = FourBar(1.0, 0.3, 0.9, 0.7)
    q = linkage.assembly_modes({"crank": 0.5}).q[0]
    push = {"rocker": (1.0, 0, 0, 0, 0, 0)}
    always = linkage.simulate(q, np.zeros(3), wrenches=push, duration=0.05, dt=0.01)
    called = linkage.simulate(q, np.zeros(3), wrenches=lambda t, q, qd: push, duration=0.05, dt=0.01)
    np.testing.assert_array_equal(always.q, called.q)
    held = linkage.simulate(q, np.zeros(3), control=dynamics.PD(q, kp=300, kd=30), duration=3.0, dt=0.01)
    np.testing.assert_allclose(held.q[-1], q, atol=1e-3)


@pytest.mark.parametrize("seed", range(5))
def test_random_trees_with_loops(seed):
    """KKT equations of independent rows, solved as they stand."""
    rng = np.random.default_rng(seed)
    robot = Robot(random_tree(rng, 9))
    q = rng.uniform(-1, 1, robot.dof)
    loops = [
        closing_loop(robot, q, "distance", "link_0", "link_7", "rod", rng),
        closing_loop(robot, q, "spherical", "link_1", "link_8", "ball", rng),
    ]
    constraints = LoopConstraints(robot, loops)
    K = constraints.jacobian(q)
    if np.linalg.matrix_rank(K) < len(K):
        K = K[np.abs(K).any(axis=1)]
        if np.linalg.matrix_rank(K) < len(K):
            pytest.skip("dependent rows")
    qd, tau = rng.normal(size=(2, robot.dof))
    qd -= np.linalg.pinv(K) @ (K @ qd)  # velocities that keep the loops closed
    k = constraints.bias(q, qd)[np.abs(constraints.jacobian(q)).any(axis=1)]
    n, r = robot.dof, len(K)
    kkt = np.block([[robot.mass_matrix(q), -K.T], [K, np.zeros((r, r))]])
    h = robot.inverse_dynamics(q, qd, np.zeros(n))
    expected = np.linalg.solve(kkt, np.concatenate([tau - h, -k]))[:n]
    ours = dynamics.constrained_forward_dynamics(constraints, q, qd, tau)
    np.testing.assert_allclose(ours, expected, atol=1e-8 * np.abs(expected).max())


@case
def test_answers_go_into_given_arrays(make):
    rng = np.random.default_rng(4)
    constraints, q, driven = make(rng)
    qd, qdd = motion(constraints, q, driven, rng)
    rates = dict(zip(driven, rng.normal(size=len(driven)), strict=True))
    tau = dynamics.constrained_inverse_dynamics(constraints, q, qd, qdd, driven)
    calls = [
        lambda **out: dynamics.constrained_forward_dynamics(constraints, q, qd, tau, **out),
        lambda **out: dynamics.constrained_inverse_dynamics(constraints, q, qd, qdd, driven, **out),
        lambda **out: dynamics.loop_wrenches(constraints, q, qd, qdd, tau, **out),
        lambda **out: dynamics.loop_velocities(constraints, q, rates, **out),
        lambda **out: dynamics.loop_accelerations(constraints, q, qd, rates, **out),
    ]
    for call in calls:
        expected = call()
        out = np.full_like(expected, np.nan)
        assert call(out=out) is out
        np.testing.assert_array_equal(out, expected)
        with pytest.raises(InputError, match="out has shape"):
            call(out=np.zeros(1 + expected.size))


@case
def test_velocities_that_tear_loops_apart_are_refused(make):
    rng = np.random.default_rng(5)
    constraints, q, driven = make(rng)
    qd, _ = motion(constraints, q, driven, rng)
    rest = np.zeros(constraints.robot.dof)
    dynamics.constrained_forward_dynamics(constraints, q, qd, rest)
    for size in (1e-3, 1.0, 1e3):
        with pytest.raises(InputError, match="qd tears a loop apart"):
            dynamics.constrained_forward_dynamics(constraints, q, qd + size * rng.normal(size=len(qd)), rest)


def test_bad_input():
    linkage = FourBar(1.0, 0.3, 0.9, 0.7)
    loops, q = linkage.constraints, linkage.assembly_modes({"crank": 0.5}).q[0]
    rest = np.zeros(3)
    with pytest.raises(InputError, match=r"loop 'pin' is open by 0\.\d+ m at q"):
        dynamics.constrained_forward_dynamics(loops, q + 0.1, rest, rest)
    with pytest.raises(InputError, match="qd tears a loop apart"):
        dynamics.constrained_inverse_dynamics(loops, q, [1, 0, 0], rest, ["crank"])
    with pytest.raises(InputError, match="qdd tears a loop apart"):
        dynamics.constrained_inverse_dynamics(loops, q, rest, [1, 0, 0], ["crank"])
    with pytest.raises(UnknownNameError, match="no joint 'arm' in four_bar"):
        dynamics.constrained_inverse_dynamics(loops, q, rest, rest, ["arm"])
    with pytest.raises(InputTypeError, match="expected a list of joint names"):
        dynamics.constrained_inverse_dynamics(loops, q, rest, rest, "crank")
    with pytest.raises(InputError, match="no driven joints"):
        dynamics.constrained_inverse_dynamics(loops, q, rest, rest, [])
    with pytest.raises(InputError, match="do not allow these rates"):
        linkage.velocities(q, {"crank": 1.0, "rocker": 1.0})
    with pytest.raises(InputTypeError, match="must be LoopConstraints"):
        dynamics.constrained_forward_dynamics(linkage, q, rest, rest)
    with pytest.raises(InputError, match="dt is 0"):
        linkage.simulate(q, rest, duration=1, dt=0)
    with pytest.raises(InputTypeError, match="control is an int"):
        linkage.simulate(q, rest, control=3, duration=1, dt=0.1)
    with pytest.raises(InputError, match="expected"):
        linkage.simulate(q, rest, control=lambda t, q, qd: np.zeros(2), duration=1, dt=0.1)
    with pytest.raises(UnknownNameError, match="rk4"):
        linkage.simulate(q, rest, duration=1, dt=0.1, method="variational")


def test_a_base_that_moves_without_inertia_is_refused():
    """A massless base that one joint carries turns about it, or slides along it, for nothing."""
    found = 0
    for seed in range(60):
        rng = np.random.default_rng(seed)
        description = random_tree(rng, 9, mimic=False)
        if sum(joint.parent == "base" for joint in description.joints) != 1:
            continue
        found += 1
        robot, plain = Robot(description, floating=True), Robot(description)
        q = rng.uniform(-1, 1, 9)
        constraints = LoopConstraints(
            robot, [closing_loop(plain, q, "spherical", "link_1", "link_8", "ball", rng)]
        )
        rest = np.zeros(robot.dof)
        with pytest.raises(InputError, match="moves no inertia"):
            dynamics.constrained_forward_dynamics(constraints, q, rest, rest)
        with pytest.raises(InputError, match="moves no inertia"):
            dynamics.simulate_loops(constraints, q, rest, duration=1e-3, dt=1e-3)
    assert found > 5
