"""Laws of simulations: order, conserved quantities, known motions, controllers and broken runs."""

from __future__ import annotations

import pickle
import signal
import tracemalloc

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.special import ellipk

import cspace as cs
from cspace.dynamics import PD, ComputedTorque
from cspace.errors import InputError, InputTypeError, UnknownNameError
from cspace.mechanisms import FourBar
from cspace.model import Description, Inertial, Joint, Link, Mimic
from dynamics.bodies import random_body
from kinematics.robots import arm, random_q, tree
from model.random_robots import random_pose

G = 9.81
METHODS = ["rk4", "variational", "adaptive"]


@pytest.fixture
def rng():
    return np.random.default_rng(11)


def pendulum(n=1, **properties):
    """Points of 1 kg at the ends of rods of 1 m, level at zero."""
    links = [Link("base"), *(Link(f"rod_{i}", Inertial(1.0, [1, 0, 0], np.zeros((3, 3)))) for i in range(n))]
    joints = []
    for i in range(n):
        origin = cs.pose((1.0 if i else 0.0, 0, 0))
        kind = "revolute" if "upper" in properties else "continuous"
        joint = Joint(f"pivot_{i}", kind, links[i].name, links[i + 1].name, origin, (0, 1, 0), **properties)
        joints.append(joint)
    return cs.Robot(Description("pendulum", tuple(links), tuple(joints)))


def rigid_body(moments=(1.0, 2.0, 3.0), com=(0, 0, 0)):
    link = Link("body", Inertial(1.5, com, np.diag(moments)))
    return cs.Robot(Description("body", (link,), ()), floating=True)


def free_chain(rng, n=3):
    links = tuple(Link(f"link_{i}", random_body(rng)) for i in range(n + 1))
    joints = tuple(
        Joint(f"joint_{i}", "continuous", f"link_{i}", f"link_{i + 1}", random_pose(rng), rng.normal(size=3))
        for i in range(n)
    )
    return cs.Robot(Description("chain", links, joints), floating=True)


def energy_error(method, h, duration=2.0):
    run = pendulum(2).simulate([0, 0], [0, 0], duration=duration, dt=h, method=method)
    assert run
    assert run.reason == "ended"
    return np.abs(run.energy - run.energy[0]).max()


@pytest.mark.parametrize(("method", "ratio"), [("rk4", 14.0), ("variational", 3.8)])
def test_the_energy_error_falls_with_the_order_of_the_method(method, ratio):
    errors = [energy_error(method, h) for h in (0.01, 0.005, 0.0025)]
    assert errors[0] >= ratio * errors[1]
    assert errors[1] >= ratio * errors[2]


@pytest.mark.parametrize(("method", "order"), [("rk4", 4), ("variational", 2)])
def test_the_state_converges_to_that_of_scipy(method, order, rng):
    robot = arm(2, "RPR")
    q, qd = random_q(robot, rng), rng.normal(size=3)

    def rate(_, y):
        return np.concatenate([y[3:], robot.forward_dynamics(y[:3], y[3:], [0.3, -0.2, 0.1])])

    end = solve_ivp(rate, (0, 0.1), [*q, *qd], "DOP853", rtol=1e-13, atol=1e-13).y[:, -1]
    errors = []
    for h in (0.01, 0.005):
        run = robot.simulate(q, qd, control=lambda *_: [0.3, -0.2, 0.1], duration=0.1, dt=h, method=method)
        errors.append(np.abs(np.concatenate([run.q[-1], run.qd[-1]]) - end).max())
    assert errors[0] > 0.75 * 2**order * errors[1]
    run = robot.simulate(
        q, qd, control=lambda *_: [0.3, -0.2, 0.1], duration=0.1, dt=0.05, method="adaptive", tolerance=1e-12
    )
    np.testing.assert_allclose([*run.q[-1], *run.qd[-1]], end, rtol=1e-9)


def drift(method, duration):
    """The energy error of the last tenth of a run over that of its first tenth [J]."""
    run = pendulum(2).simulate([0, 0], [0, 0], duration=duration, dt=0.02, method=method, every=2)
    error = np.abs(run.energy - run.energy[0])
    tenth = len(error) // 10
    return error[-tenth:].mean() / error[:tenth].mean()


def test_the_energy_of_the_variational_method_does_not_drift():
    assert drift("variational", 40.0) < 3.0


@pytest.mark.slow
def test_the_energy_drifts_with_rk4_and_not_with_the_variational_method():
    assert drift("variational", 400.0) < 3.0
    assert drift("rk4", 400.0) > 10.0


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("amplitude", [0.1, 2.0, 3.0])
def test_a_pendulum_swings_with_the_period_of_the_elliptic_integral(method, amplitude):
    period = 4.0 * np.sqrt(1.0 / G) * ellipk(np.sin(amplitude / 2) ** 2)
    down = np.pi / 2  # a positive angle about y lowers the rod
    steps = 1000
    run = pendulum().simulate([down + amplitude], [0], duration=period, dt=period / steps, method=method)
    tolerance = {"rk4": 1e-7, "variational": 1e-3, "adaptive": 1e-6}[method]
    assert run.q[-1, 0] == pytest.approx(down + amplitude, abs=tolerance)
    assert run.q[steps // 2, 0] == pytest.approx(down - amplitude, abs=tolerance)
    assert len(run) == steps + 1
    assert run.times[-1] == period


@pytest.mark.parametrize("method", METHODS)
def test_the_work_of_torques_wrenches_and_damping_is_the_change_of_energy(method, rng):
    robot = arm(3)
    q, qd = random_q(robot, rng), rng.normal(size=6)
    tau, force = rng.normal(size=6), np.array([1.0, -2.0, 0.5, 0, 0, 0])
    run = robot.simulate(
        q,
        qd,
        control=lambda *_: tau,
        wrenches={robot.tip: force},
        duration=0.05,
        dt=2e-4,
        method=method,
    )
    tip = robot.fk(run.q)[:, :3, 3]
    work = (run.q - q) @ tau + (tip - tip[0]) @ force[:3]
    tolerance = 1e-3 if method == "variational" else 1e-7
    np.testing.assert_allclose(run.energy - run.energy[0], work, atol=tolerance * np.abs(run.energy).max())
    by_call = robot.simulate(
        q,
        qd,
        control=lambda *_: tau,
        wrenches=lambda t, q, qd: {robot.tip: force},
        duration=0.05,
        dt=2e-4,
        method=method,
    )
    np.testing.assert_allclose(by_call.q, run.q, atol=1e-8)


@pytest.mark.parametrize("method", METHODS)
def test_a_free_chain_keeps_its_momentum_whatever_its_joints_do(method, rng):
    robot = free_chain(rng)
    q, T = random_q(robot, rng), random_pose(rng)
    qd = rng.normal(size=robot.dof)
    inner = np.concatenate([np.zeros(6), rng.normal(size=3)])
    run = robot.simulate(
        q,
        qd,
        control=lambda t, q, qd: inner * np.cos(3 * t),
        duration=0.5,
        dt=0.005,
        method=method,
        gravity=np.zeros(3),
        T_world_base=T,
    )
    assert run
    h = robot.centroidal_momentum(run.q, run.qd, T_world_base=run.T_world_base)
    center = robot.center_of_mass(run.q, T_world_base=run.T_world_base)
    about_origin = h[:, 3:] + np.cross(center, h[:, :3])
    both = np.hstack([h[:, :3], about_origin])
    exact = {"variational": 1e-12, "rk4": 1e-6, "adaptive": 1e-7}[method]
    np.testing.assert_allclose(both, np.broadcast_to(both[0], both.shape), atol=exact * np.abs(both).max())
    R = run.T_world_base[:, :3, :3]
    np.testing.assert_allclose(R @ np.swapaxes(R, 1, 2), np.broadcast_to(np.eye(3), R.shape), atol=1e-13)


@pytest.mark.parametrize(("method", "order"), [("rk4", 4), ("variational", 2)])
def test_a_floating_robot_converges_with_the_order_of_the_method(method, order, rng):
    robot = free_chain(rng, 2)
    q, T, qd = random_q(robot, rng), random_pose(rng), rng.normal(size=robot.dof)
    given = {"duration": 0.2, "T_world_base": T}
    exact = robot.simulate(q, qd, dt=0.2, method="adaptive", tolerance=1e-12, **given)
    errors = []
    for h in (0.02, 0.01):
        run = robot.simulate(q, qd, dt=h, method=method, **given)
        gaps = [
            run.q[-1] - exact.q[-1],
            run.qd[-1] - exact.qd[-1],
            run.T_world_base[-1] - exact.T_world_base[-1],
        ]
        errors.append(max(np.abs(gap).max() for gap in gaps))
    assert errors[0] > 0.75 * 2**order * errors[1]


@pytest.mark.parametrize("method", METHODS)
def test_a_body_that_spins_about_its_middle_axis_turns_over_and_keeps_its_momentum(method):
    robot = rigid_body()
    spin = np.array([0, 0, 0, 1e-3, 5.0, 0])
    run = robot.simulate([], spin, duration=5.0, dt=0.01, method=method, gravity=np.zeros(3))
    L = robot.centroidal_momentum(run.q, run.qd, T_world_base=run.T_world_base)[:, 3:]
    exact = {"variational": 1e-12, "rk4": 1e-5, "adaptive": 1e-7}[method]
    np.testing.assert_allclose(L, np.broadcast_to(L[0], L.shape), atol=exact * 10.0)
    about = np.einsum("kij,ki->kj", run.T_world_base[:, :3, :3], run.qd[:, 3:])[:, 1]  # ω in the body
    assert about.min() < -4.9
    assert about.max() > 4.9
    turned = np.abs(about).min()
    assert turned < 1.0
    if method != "variational":
        assert np.ptp(run.energy) < 1e-4 * run.energy[0]


@pytest.mark.parametrize("method", METHODS)
def test_a_thrown_body_falls_along_a_parabola(method, rng):
    robot = rigid_body(com=(0.1, -0.2, 0.3))
    T, qd = random_pose(rng), rng.normal(size=6)
    run = robot.simulate([], qd, duration=0.5, dt=0.002, method=method, T_world_base=T)
    center = robot.center_of_mass(run.q, T_world_base=run.T_world_base)
    v = robot.centroidal_momentum([], qd, T_world_base=T)[:3] / robot.mass
    t = run.times[:, None]
    path = center[0] + v * t + 0.5 * t**2 * [0, 0, -G]
    tolerance = {"variational": 1e-4, "rk4": 1e-9, "adaptive": 1e-8}[method]
    np.testing.assert_allclose(center, path, atol=tolerance)


@pytest.mark.parametrize("method", METHODS)
def test_rows_of_a_batch_are_those_alone(method, rng):
    robot = tree(4)
    q, qd = random_q(robot, rng, 2, 3), 0.1 * rng.normal(size=(2, 3, robot.dof))
    given = {"duration": 0.02, "dt": 0.002, "method": method, "tolerance": 1e-12, "every": 3}
    many = robot.simulate(q, qd, control=lambda t, q, qd: -0.1 * qd, **given)
    assert many.q.shape == (2, 3, 5, len(robot.joint_names))
    assert many.energy.shape == (2, 3, 5)
    np.testing.assert_allclose(many.times, [0, 0.006, 0.012, 0.018, 0.02])
    for i in np.ndindex(2, 3):
        alone = robot.simulate(q[i], qd[i], control=lambda t, q, qd: -0.1 * qd, **given)
        for name in ("q", "qd", "tau", "energy"):
            one, row = getattr(alone, name), getattr(many, name)[i]
            np.testing.assert_allclose(row, one, atol=1e-8 * (1 + np.abs(one).max()), err_msg=name)


def test_recorded_states_do_not_depend_on_how_many_are_recorded():
    given = {"duration": 1.005, "dt": 0.01}
    for method in METHODS:
        full = pendulum(2).simulate([0.3, 0.1], [0, 1], method=method, **given)
        some = pendulum(2).simulate([0.3, 0.1], [0, 1], method=method, every=7, **given)
        np.testing.assert_array_equal(some.times, [*full.times[:-1:7], 1.005])
        np.testing.assert_array_equal(some.q, [*full.q[:-1:7], full.q[-1]])


@pytest.mark.parametrize("method", METHODS)
def test_states_between_records_are_interpolated(method, rng):
    robot = free_chain(rng, 2)
    q, T, qd = random_q(robot, rng), random_pose(rng), rng.normal(size=robot.dof)
    fine, coarse = (
        robot.simulate(q, qd, duration=0.2, dt=0.002, method=method, T_world_base=T, every=every)
        for every in (1, 5)
    )
    for k in (0, 3, 5, 11, 58, 100):
        q_t, qd_t, T_t = coarse(fine.times[k])
        np.testing.assert_allclose(q_t, fine.q[k], atol=1e-5)
        np.testing.assert_allclose(qd_t, fine.qd[k], atol=2e-3)
        np.testing.assert_allclose(T_t, fine.T_world_base[k], atol=1e-5)
    with pytest.raises(InputError, match=r"from 0 to 0\.2 s"):
        fine(0.3)


def damped_rotor(damping, friction=0.0):
    joint = Joint("axis", "continuous", "base", "disk", axis=(0, 0, 1), damping=damping, friction=friction)
    links = (Link("base"), Link("disk", Inertial(1.0, [0, 0, 0], np.diag([0.1, 0.1, 0.2]))))
    return cs.Robot(Description("rotor", links, (joint,)))


@pytest.mark.parametrize("method", METHODS)
def test_damping_decays_exponentially(method):
    run = damped_rotor(0.6).simulate([0], [2.0], duration=1.0, dt=0.01, method=method)
    np.testing.assert_allclose(run.qd[:, 0], 2.0 * np.exp(-3.0 * run.times), atol=1e-6)
    np.testing.assert_allclose(run.q[:, 0], 2.0 / 3.0 * (1 - np.exp(-3.0 * run.times)), atol=1e-4)
    free = damped_rotor(0.6).simulate([0], [2.0], duration=1.0, dt=0.01, method=method, friction=False)
    np.testing.assert_allclose(free.q[:, 0], 2.0 * free.times, rtol=1e-12)


@pytest.mark.parametrize("damping", [1e-3, 1.0, 30.0, 1e3, 1e6])
def test_stiff_damping_decays_exactly_with_the_variational_method(damping):
    run = damped_rotor(damping).simulate([0], [2.0], duration=0.2, dt=0.01, method="variational")
    expected = 2.0 * np.exp(-damping / 0.2 * run.times)
    np.testing.assert_allclose(run.qd[:, 0], expected, atol=1e-12)


@pytest.mark.parametrize("damping", [1e-3, 1.0, 30.0, 1e3, 1e6])
def test_a_torque_turns_a_stiffly_damped_rotor_as_exactly(damping):
    run = damped_rotor(damping).simulate(
        [0], [0], control=lambda *_: [3.0], duration=0.2, dt=0.01, method="variational"
    )
    expected = 3.0 / damping * -np.expm1(-damping / 0.2 * run.times)
    np.testing.assert_allclose(run.qd[:, 0], expected, rtol=1e-11)


def test_stiff_damping_breaks_rk4_with_a_reason_and_not_the_adaptive_method():
    run = damped_rotor(100.0).simulate([0], [2.0], duration=5.0, dt=0.02, method="rk4")
    assert not run
    assert run.reason.startswith("not finite: after t = ")
    assert "'axis'" in run.reason
    assert np.isfinite(run.q).all()
    assert run.stopped < 5.0
    assert not run.ended
    run = damped_rotor(100.0).simulate([0], [2.0], duration=0.1, dt=0.02, method="adaptive")
    assert run
    assert abs(run.qd[-1, 0]) < 1e-6


@pytest.mark.parametrize("method", ["variational", "adaptive"])
def test_dry_friction_stops_a_rotor_when_its_energy_is_used_up(method):
    speed = {"variational": 1e-6, "adaptive": 1e-3}[method]
    run = damped_rotor(0.0, 0.5).simulate(
        [0], [2.0], duration=1.2, dt=0.01, method=method, friction_speed=speed
    )
    stop = 2.0 * 0.2 / 0.5
    np.testing.assert_allclose(run.q[-1, 0], 0.5 * 0.2 * 2.0**2 / 0.5, rtol=0.01)
    slides = run.times < stop - 0.05
    np.testing.assert_allclose(run.qd[slides, 0], 2.0 - 2.5 * run.times[slides], atol=3e-3)
    assert np.abs(run.qd[run.times > stop + 0.05]).max() < 1e-3


def test_dry_friction_holds_a_pendulum_that_gravity_cannot_move():
    robot = pendulum(friction=12.0)
    run = robot.simulate([0.3], [0], duration=1.0, dt=0.01, method="variational", friction_speed=1e-6)
    assert run
    assert abs(run.q[-1, 0] - 0.3) < 1e-5


def test_joints_that_mimic_rub_too():
    links = (Link("base"), *(Link(name, Inertial(1.0, [0, 0, 0], 0.1 * np.eye(3))) for name in ("a", "b")))
    joints = (
        Joint("lead", "continuous", "base", "a", axis=(0, 0, 1), damping=0.2),
        Joint("follow", "continuous", "base", "b", axis=(0, 0, 1), damping=0.3, mimic=Mimic("lead", -2.0)),
    )
    robot = cs.Robot(Description("gears", links, joints))
    run = robot.simulate([0], [1.0], duration=0.3, dt=0.001)
    rate = (0.2 + 4 * 0.3) / (0.1 + 4 * 0.1)
    np.testing.assert_allclose(run.qd[:, 0], np.exp(-rate * run.times), rtol=1e-9)


@pytest.mark.parametrize("method", METHODS)
def test_pd_with_gravity_brings_an_arm_to_its_goal(method, rng):
    robot = arm(1)
    goal = random_q(robot, rng)
    inertia = 1.0 / np.diagonal(np.linalg.inv(robot.mass_matrix(goal)))  # of each joint, the others free
    control = PD(goal, kp=40.0 * inertia, kd=12.0 * inertia)
    start = goal + 0.3 * rng.normal(size=(2, 6))
    run = robot.simulate(
        start, np.zeros((2, 6)), control=control, duration=5.0, dt=0.01, method=method, every=50
    )
    assert run
    np.testing.assert_allclose(run.q[:, -1], [goal, goal], atol=2e-2)
    assert np.abs(run.q[:, -1] - goal).max() < 0.1 * np.abs(start - goal).max()
    np.testing.assert_allclose(run.tau[0, 0], control(robot, 0.0, start[0], np.zeros(6)), rtol=1e-12)


def wave(t):
    phase = np.arange(6)
    return np.sin(2 * t + phase), 2 * np.cos(2 * t + phase), -4 * np.sin(2 * t + phase)


@pytest.mark.parametrize("method", METHODS)
def test_computed_torque_follows_a_motion(method):
    robot = arm(1)
    q, qd, _ = wave(0.0)
    errors = []
    for dt in (0.004, 0.002):
        control = ComputedTorque(wave, kp=100.0, kd=20.0)
        run = robot.simulate(q, qd, control=control, duration=0.4, dt=dt, method=method, every=10)
        errors.append(np.abs(run.q - [wave(t)[0] for t in run.times]).max())
    assert errors[1] < 5e-3
    assert errors[1] < 0.7 * errors[0]


def test_a_floating_base_falls_under_a_controller_that_holds_its_joints(rng):
    robot = free_chain(rng)
    q = random_q(robot, rng)
    run = robot.simulate(q, np.zeros(9), control=PD(q, 5.0, 1.0), duration=0.1, dt=0.005)
    assert run
    assert (run.tau[:, :6] == 0).all()
    assert run.T_world_base[-1, 2, 3] < -0.04
    with pytest.raises(InputError, match="floats"):
        robot.simulate(q, np.zeros(9), control=ComputedTorque(wave, 1, 1), duration=0.1, dt=0.01)


@pytest.mark.parametrize("method", METHODS)
def test_a_limit_ends_a_simulation_and_names_the_joint(method):
    robot = pendulum(2, lower=-1.0, upper=1.0)
    run = robot.simulate([0, 0], [0, 0], duration=3.0, dt=0.01, method=method, stop_at_limits=True)
    assert run
    assert not run.ended
    assert run.reason.startswith("limit reached: joint 'pivot_")
    assert run.stopped == run.times[-1] < 3.0
    assert (np.abs(run.q[:-1]) <= 1.0).all()
    assert np.abs(run.q[-1]).max() > 1.0
    through = robot.simulate([0, 0], [0, 0], duration=3.0, dt=0.01, method=method)
    assert through.reason == "ended"
    rows = robot.simulate(
        [[0, 0], [0.5, 0]], [0, 0], duration=0.4, dt=0.01, method=method, stop_at_limits=True
    )
    assert rows
    assert rows.ended.tolist() == [True, False]
    assert rows.reason.endswith(" in row 1")
    valid = rows.times <= rows.stopped[1]
    assert np.isfinite(rows.q[0]).all()
    assert np.isnan(rows.q[1, ~valid]).all()
    assert valid.sum() > 10
    assert np.isfinite(rows.energy[1, valid]).all()
    with pytest.raises(InputError, match="'pivot_1' outside of its limits, -1 to 1"):
        robot.simulate([0, 1.5], [0, 0], duration=1.0, dt=0.01, stop_at_limits=True)


def test_a_row_that_breaks_down_does_not_disturb_the_others():
    robot = damped_rotor(0.0)
    run = robot.simulate(
        [[0.0], [0.0]], [1.0], control=lambda t, q, qd: [[0.0], [1e60]], duration=0.1, dt=0.01
    )
    assert not run
    assert run.reason.startswith("not finite: after t = 0 s in row 1")
    np.testing.assert_allclose(run.q[0, :, 0], run.times, rtol=1e-12)
    assert np.isnan(run.q[1, 1:]).all()
    assert np.isnan(run.energy[1, 1:]).all()
    assert run.stopped.tolist() == [0.1, 0.0]
    assert run.ended.tolist() == [True, False]


def test_the_variational_method_says_where_it_has_no_step():
    run = pendulum(2).simulate([0, 0], [300.0, -500.0], duration=1.0, dt=0.1, method="variational")
    assert not run
    assert run.reason.startswith("not solved: no step from t = ")


@pytest.mark.parametrize("method", METHODS)
def test_a_time_limit_ends_a_simulation(method):
    run = pendulum(2).simulate([0, 0], [0, 0], duration=1e4, dt=0.01, method=method, time_limit=0.05)
    assert not run
    assert run.reason.startswith("time limit, at t = ")
    assert 0 < len(run) < 1e5
    assert np.isfinite(run.energy).all()


def test_an_answer_is_one_line_a_table_and_can_be_pickled():
    run = pendulum(2).simulate([0, 0], [0, 0], duration=0.1, dt=0.01, method="adaptive")
    assert repr(run) == "<Simulation pendulum by adaptive: 11 states to 0.1 s, ended>"
    assert "<table>" in run._repr_html_()
    again = pickle.loads(pickle.dumps(run))
    np.testing.assert_array_equal(again(0.055)[0], run(0.055)[0])
    rows = pendulum(2).simulate(np.zeros((3, 2)), [0, 0], duration=0.1, dt=0.01)
    assert "3 rows" in repr(rows)
    assert rows._repr_html_().count("<tr>") == 4


@pytest.mark.parametrize(
    ("change", "error", "message"),
    [
        ({"dt": 0.0}, InputError, r"dt is 0.0; it must be one positive number \[s\]"),
        ({"dt": -1.0}, InputError, "dt"),
        ({"dt": 1e-15}, InputError, "dt is 1e-15"),
        ({"duration": np.inf}, InputError, "duration"),
        ({"duration": np.nan}, InputError, "duration"),
        ({"method": "euler"}, UnknownNameError, "euler"),
        ({"every": 0}, InputError, "every"),
        ({"q": [0, np.nan]}, InputError, "q holds nan"),
        ({"qd": [0]}, InputError, "qd has shape"),
        ({"friction_speed": 0}, InputError, "friction_speed"),
        ({"tolerance": -1}, InputError, "tolerance"),
        ({"time_limit": 0}, InputError, "time_limit"),
        ({"expressed_in": "tool"}, UnknownNameError, "tool"),
        ({"control": 3}, InputTypeError, "control is an int"),
        ({"control": lambda t, q, qd: [1.0]}, InputError, r"control at step 0 \(t = 0 s\) has shape \(1,\)"),
        ({"control": lambda t, q, qd: np.zeros((3, 2))}, InputError, r"shape \(3, 2\), expected \(2,\)"),
        ({"control": lambda t, q, qd: None}, InputTypeError, "control at step 0.* is None"),
        (
            {"control": lambda t, q, qd: [0, np.nan if t > 0.015 else 0]},
            InputError,
            r"control at step 2 \(t = 0.02 s\) holds nan at index",
        ),
        ({"control": PD([0, 0, 0], 1, 1)}, InputError, r"q_goal has shape \(3,\)"),
        ({"control": lambda t, q, qd: [1e300, 0]}, InputError, r"at step 0 .* the largest allowed value"),
        ({"wrenches": {"rod_1": np.zeros((3, 5))}}, InputError, r"'rod_1' .*\(3, 5\)"),
        (
            {"wrenches": lambda t, q, qd: {"rod_1": np.zeros((3, 6))}},
            InputError,
            r"'rod_1' has shape \(3, 6\), expected \(6,\)",
        ),
        ({"wrenches": lambda t, q, qd: [1, 2]}, InputTypeError, "dict of frame"),
        ({"wrenches": {"nowhere": np.zeros(6)}}, UnknownNameError, "nowhere"),
    ],
)
def test_bad_arguments_are_named(change, error, message):
    given = {"q": [0, 0], "qd": [0, 0], "duration": 0.1, "dt": 0.01} | change
    with pytest.raises(error, match=message):
        pendulum(2).simulate(**given)


def test_recorded_states_are_most_of_the_memory():
    robot, q = pendulum(2), np.random.default_rng(0).normal(size=(500, 2))
    given = {"duration": 0.1, "dt": 0.002}
    robot.simulate(q, [0, 0], **given)
    tracemalloc.start()
    run = robot.simulate(q, [0, 0], **given)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert peak < 2.0 * sum(each.nbytes for each in (run.q, run.qd, run.tau, run.energy, run.momentum))


def test_an_interrupt_ends_a_simulation():
    def interrupt(t, q, qd):
        if t > 0.05:
            signal.raise_signal(signal.SIGINT)
        return [0, 0]

    with pytest.raises(KeyboardInterrupt):
        pendulum(2).simulate([0, 0], [0, 0], control=interrupt, duration=1e3, dt=0.01)


@pytest.mark.parametrize("method", METHODS)
def test_a_robot_without_joints_stands(method):
    body = Link("stone", Inertial(1.0, [0, 0, 0.5], np.eye(3)))
    run = cs.Robot(Description("stone", (body,), ())).simulate([], [], duration=0.1, dt=0.01, method=method)
    assert run
    assert run.q.shape == (11, 0)
    np.testing.assert_allclose(run.energy, 0.5 * G)


@pytest.mark.parametrize("method", ["rk4", "variational"])
def test_a_base_that_rotates_too_fast_is_named(method):
    run = rigid_body().simulate([], [0, 0, 0, 100, 200, 300], duration=1.0, dt=0.1, method=method)
    assert not run
    assert "half a turn in one step" in run.reason


def test_bad_controllers_are_named():
    with pytest.raises(InputError, match="kp holds -1"):
        PD([0], -1, 1)
    with pytest.raises(InputError, match="q_goal"):
        PD([np.nan], 1, 1)
    with pytest.raises(InputTypeError, match="motion"):
        ComputedTorque([0], 1, 1)


def test_a_control_cannot_change_the_state():
    def spoil(t, q, qd):
        q[...] = 9.0
        return np.zeros(2)

    run = pendulum(2).simulate([0.1, 0.2], [0, 0], control=spoil, duration=0.01, dt=0.01)
    np.testing.assert_array_equal(run.q[0], [0.1, 0.2])


def test_a_robot_where_a_joint_moves_nothing_is_refused():
    light = Link("rod_1", None)
    whole = pendulum(2).description
    robot = cs.Robot(Description("light", (*whole.links[:2], light), whole.joints))
    for method in METHODS:
        with pytest.raises(InputError, match="'pivot_1' moves no inertia"):
            robot.simulate([0, 0], [0, 0], duration=0.1, dt=0.01, method=method)


def test_a_placed_robot_moves_as_in_a_turned_world(rng):
    robot, T = pendulum(2), random_pose(rng)
    for method in METHODS:
        given = {"duration": 0.2, "dt": 0.01, "method": method}
        placed = robot.simulate([0.2, 0.5], [0, 1], T_world_base=T, **given)
        turned = robot.simulate([0.2, 0.5], [0, 1], gravity=T[:3, :3].T @ [0, 0, -G], **given)
        np.testing.assert_allclose(placed.q, turned.q, atol=1e-10)
        assert placed.T_world_base is None


def test_a_controller_follows_a_trajectory_and_holds_its_end():
    robot = cs.load_robot("panda")
    q = np.array([0, 0, 0, -1.5, 0, 1.5, 0])
    way = robot.move_to(q + 0.3, start=q)
    control = ComputedTorque(way, kp=100.0, kd=20.0)
    run = robot.simulate(q, np.zeros(7), control=control, duration=way.duration + 2.0, dt=1e-3)
    assert run
    np.testing.assert_allclose(run.q[-1], q + 0.3, atol=1e-5)
    told = ComputedTorque(lambda t: (way(t), way(t, 1), way(t, 2)), kp=100.0, kd=20.0)
    part = robot.simulate(q, np.zeros(7), control=told, duration=0.5 * way.duration, dt=1e-3)
    np.testing.assert_array_equal(run.q[: len(part) - 1], part.q[:-1])


@pytest.mark.parametrize("friction", [0.5, 10.0, 200.0])
@pytest.mark.parametrize("dt", [1e-3, 1e-2])
def test_stiff_dry_friction_chooses_the_method_that_takes_it(friction, dt):
    """Without a method the answer is that of shorter steps; RK4 by name is refused where it would creep."""
    robot = pendulum(2, friction=friction)
    given = {"q": [0.0, 0.0], "qd": [0.0, 0.0], "duration": 0.5}
    run = robot.simulate(**given, dt=dt)
    exact = robot.simulate(**given, dt=dt, method="adaptive", tolerance=1e-8)
    np.testing.assert_allclose(run.q, exact.q, atol=0.05 * dt / 1e-3 * 0.02)
    if run.method == "variational":
        with pytest.raises(InputError, match=r"creeps: the friction of joint .* use a dt below"):
            robot.simulate(**given, dt=dt, method="rk4")
    else:
        assert robot.simulate(**given, dt=dt, method="rk4")


def test_rows_of_torques_wrenches_and_goals_are_rows_of_states(rng):
    robot = pendulum(2)
    taus = rng.normal(size=(4, 2))
    given = {"duration": 0.1, "dt": 0.01}
    many = robot.simulate([0.1, 0.2], [0, 0], control=taus, **given)
    pushed = robot.simulate([0.1, 0.2], [0, 0], wrenches={robot.frames[-1]: rng.normal(size=(3, 6))}, **given)
    goals = robot.simulate([0.1, 0.2], [0, 0], control=PD(rng.normal(size=(5, 2)), 10.0, 1.0), **given)
    assert (many.q.shape[0], pushed.q.shape[0], goals.q.shape[0]) == (4, 3, 5)
    for i in range(4):
        one = robot.simulate([0.1, 0.2], [0, 0], control=taus[i], **given)
        np.testing.assert_allclose(many.q[i], one.q, atol=1e-12)
    with pytest.raises(InputError, match="leading axes"):
        robot.simulate(np.zeros((3, 2)), [0, 0], control=taus, **given)


def test_a_robot_with_closed_loops_is_not_simulated_as_a_tree():
    linkage = FourBar(1.0, 0.3, 0.9, 0.7)
    q = linkage.assembly_modes({"crank": 0.5}).q[0]
    with pytest.raises(InputError, match=r"has closed loops \(pin\).*Mechanism"):
        linkage.robot.simulate(q, np.zeros(3), duration=0.1, dt=0.01)


@pytest.mark.parametrize(
    ("kp", "kd", "word"), [(0.0, 1e6, "kd of joint"), (1e9, 0.0, "kp of joint"), (1e9, 1e6, "kd of joint")]
)
@pytest.mark.parametrize("method", ["rk4", "variational"])
def test_gains_that_are_too_high_for_the_step_are_named(method, kp, kd, word):
    robot = pendulum(2)
    run = robot.simulate([0, 0], [1, 0], control=PD([1, 1], kp, kd), duration=5.0, dt=0.01, method=method)
    assert not run
    assert word in run.reason
    assert "use at most" in run.reason


@pytest.mark.parametrize("part", ["damping", "friction", "armature"])
def test_negative_resistances_are_refused(part):
    with pytest.raises(InputError, match=f"{part} of joint 'j' is -1; it must not be negative"):
        Joint("j", "continuous", "a", "b", **{part: -1.0})


def test_a_negative_inertia_is_named_as_such():
    robot = cs.Robot(
        Description(
            "wrong",
            (Link("base"), Link("arm", Inertial(1.0, (0, 0, 0), np.diag([-1.0, -1.0, 0.1])))),
            (Joint("j", "continuous", "base", "arm", axis=(0, 1, 0)),),
        )
    )
    with pytest.raises(InputError, match="not positive: joint 'j' moves a negative inertia"):
        robot.forward_dynamics([0], [0], [1])
