"""Compiled roll-outs: they are the steps of the functions of dynamics, in lanes, on any number of threads."""

from __future__ import annotations

import signal
import sys
import time
import tracemalloc

import numpy as np
import pytest

import cspace as cs
from cspace.dynamics import PD, ComputedTorque
from cspace.dynamics.mechanics import State
from cspace.errors import InputError
from cspace.model import Description, Joint, Link
from dynamics.bodies import hand_arm, random_body
from dynamics.stepping import STEPS, World
from kinematics.robots import random_q
from model.random_robots import random_pose, with_resistances

METHODS = ["rk4", "variational", "adaptive"]
FIXED = ["rk4", "variational"]


@pytest.fixture
def rng():
    return np.random.default_rng(21)


def hand(rng, floating=False, resists=True):
    """An arm with fingers that mimic, with damping, friction and armature."""
    description = hand_arm(rng)
    return cs.Robot(with_resistances(rng, description) if resists else description, floating=floating)


def branches(rng, floating=False, n=7):
    """A tree of revolute and prismatic joints with armature, damping and friction."""
    links = tuple(Link(f"link_{i}", random_body(rng)) for i in range(n + 1))
    joints = tuple(
        Joint(
            f"joint_{i}",
            "prismatic" if i % 3 == 2 else "continuous",
            f"link_{rng.integers(max(0, i - 2), i + 1)}",
            f"link_{i + 1}",
            random_pose(rng),
            rng.normal(size=3),
            armature=0.02,
            damping=0.1 * (i % 2),
            friction=0.3 * (i % 2),
        )
        for i in range(n)
    )
    return cs.Robot(Description("branches", links, joints), floating=floating)


ROBOTS = {
    "mimic": hand,
    "tree": branches,
    "mimic, floating": lambda rng: hand(rng, floating=True),
    "tree, floating": lambda rng: branches(rng, floating=True),
}


def start_of(robot, rng, *lead):
    """A state and constant torques; a base that floats is turned."""
    q, qd = random_q(robot, rng, *lead), 0.3 * rng.normal(size=(*lead, robot.dof))
    tau = rng.normal(size=(*lead, robot.dof))
    T = random_pose(rng) if not lead else np.array([random_pose(rng) for _ in range(lead[0])])
    return q, qd, tau, T


def differ(run, other):
    """The largest difference of two simulations, relative to their sizes."""
    names = ["q", "qd", "tau", "energy", "momentum"] + (
        ["T_world_base"] if run.T_world_base is not None else []
    )
    pairs = [(getattr(run, name), getattr(other, name)) for name in names]
    return max(np.abs(a - b).max() / (1 + np.abs(a).max()) for a, b in pairs)


@pytest.mark.parametrize("name", ROBOTS)
@pytest.mark.parametrize("method", FIXED)
def test_compiled_steps_are_those_of_the_functions_of_dynamics(method, name, rng):
    robot = ROBOTS[name](rng)
    for expressed_in in ("base", "tip"):
        q, qd, tau, T = start_of(robot, rng)
        gravity = rng.normal(size=3)
        wrenches = {frame: rng.normal(size=6) for frame in (robot.frames[-1], robot.frames[2])}
        world = World(robot, gravity, wrenches, expressed_in)
        run = robot.simulate(
            q,
            qd,
            control=tau,
            duration=0.02,
            dt=0.004,
            method=method,
            gravity=gravity,
            wrenches=wrenches,
            expressed_in=expressed_in,
            T_world_base=T,
        )
        assert run
        state = State(q, qd, T)
        for k in range(5):
            state = STEPS[method](world, state, tau, run.times[k + 1] - run.times[k])
            np.testing.assert_allclose(run.q[k + 1], state.q, rtol=1e-11, atol=1e-12)
            np.testing.assert_allclose(run.qd[k + 1], state.qd, rtol=1e-9, atol=1e-10)
            if robot.floating:
                np.testing.assert_allclose(run.T_world_base[k + 1], state.T_world_base, atol=1e-12)
        place = {"T_world_base": run.T_world_base if robot.floating else T}
        energy = robot.kinetic_energy(run.q, run.qd, **place)
        energy = energy + robot.potential_energy(run.q, gravity=gravity, **place)
        np.testing.assert_allclose(run.energy, energy, rtol=1e-12)
        momentum = robot.centroidal_momentum(run.q, run.qd, **place)
        np.testing.assert_allclose(run.momentum, momentum, rtol=1e-11, atol=1e-11 * np.abs(momentum).max())


@pytest.mark.parametrize("name", ROBOTS)
@pytest.mark.parametrize("method", FIXED)
def test_lanes_are_one_lane(method, name, rng):
    robot = ROBOTS[name](rng)
    q, qd, tau, T = start_of(robot, rng, 11)
    given = {"duration": 0.02, "dt": 0.004, "method": method}
    many = robot.simulate(q, qd, control=tau, T_world_base=T, **given)
    for i in range(11):
        one = robot.simulate(q[i], qd[i], control=tau[i], T_world_base=T[i], **given)
        for part in ("q", "qd", "tau", "energy", "momentum"):
            alone, among = getattr(one, part), getattr(many, part)[i]
            np.testing.assert_allclose(among, alone, rtol=1e-12, atol=1e-12 * (1 + np.abs(alone).max()))


@pytest.mark.parametrize("method", METHODS)
def test_any_number_of_threads_gives_the_same_bits(method, rng):
    robot = branches(rng, floating=True)
    q, qd, _, T = start_of(robot, rng, 300)
    given = {"duration": 0.05, "dt": 0.005, "method": method, "T_world_base": T, "tolerance": 1e-6}
    control = PD(random_q(robot, rng), 2.0, 0.5)
    runs = [robot.simulate(q, qd, control=control, threads=threads, **given) for threads in (1, 2, 3, 0)]
    for other in runs[1:]:
        for part in ("q", "qd", "tau", "energy", "momentum", "T_world_base"):
            np.testing.assert_array_equal(getattr(other, part), getattr(runs[0], part))


def test_rows_step_adaptively_on_their_own(rng):
    robot = branches(rng)
    q, qd, tau, _ = start_of(robot, rng, 9)
    qd[3] *= 30.0  # a row that needs far shorter steps
    given = {"duration": 0.1, "dt": 0.05, "method": "adaptive", "tolerance": 1e-10, "friction": False}
    many = robot.simulate(q, qd, control=tau, **given)
    calm = np.delete(np.arange(9), 3)
    without = robot.simulate(q[calm], qd[calm], control=tau[calm], **given)
    taken, before = (np.diff(run._dense.first) for run in (many, without))
    np.testing.assert_array_equal(taken[calm], before)
    assert taken[3] > 2 * taken[calm].max()
    for t in (0.0, 0.0123, 0.05, 0.1):
        np.testing.assert_allclose(many(t)[0][calm], without(t)[0], atol=1e-9)
        alone = robot.simulate(q[3], qd[3], control=tau[3], **given)
        np.testing.assert_allclose(many(t)[1][3], alone(t)[1], rtol=1e-7, atol=1e-7)


@pytest.mark.parametrize("method", METHODS)
def test_without_dense_steps_the_records_are_the_same(method, rng):
    robot = branches(rng, floating=True)
    q, qd, tau, T = start_of(robot, rng, 11)
    given = {"duration": 0.2, "dt": 0.02, "every": 3, "method": method, "T_world_base": T, "friction": False}
    run, lean = (robot.simulate(q, qd, control=tau, dense=dense, **given) for dense in (True, False))
    assert differ(run, lean) == 0.0
    assert lean._dense is None
    t = run.times[1]
    np.testing.assert_allclose(lean(t)[0], run(t)[0], atol=1e-12)


def test_adaptive_records_are_most_of_the_memory_without_dense_steps(rng):
    robot = branches(rng)
    q, qd, _, _ = start_of(robot, rng, 400)
    given = {"duration": 0.2, "dt": 1e-3, "method": "adaptive", "dense": False, "friction": False}
    robot.simulate(q[:8], qd[:8], **given)
    tracemalloc.start()
    run = robot.simulate(q, qd, **given)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    parts = (run.q, run.qd, run.tau, run.energy, run.momentum)
    assert peak < 2.0 * sum(part.nbytes for part in parts)


def call_of(control, robot, **world):
    """A controller as a function of Python."""
    return lambda t, q, qd: control(robot, t, q, qd, **world)


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("weight", [True, False])
def test_a_compiled_pd_controller_is_the_same_as_a_function(method, weight, rng):
    robot = branches(rng)
    q, qd, _, T = start_of(robot, rng, 5)
    n = len(robot.joint_names)
    gravity, goal = rng.normal(size=3), random_q(robot, rng, 5)
    control = PD(goal, rng.uniform(1, 5, n), 0.5, gravity_compensation=weight)
    given = {"duration": 0.05, "dt": 0.005, "method": method, "gravity": gravity, "T_world_base": T}
    compiled = robot.simulate(q, qd, control=control, **given)
    called = robot.simulate(q, qd, control=call_of(control, robot, gravity=gravity, T_world_base=T), **given)
    assert differ(compiled, called) < 1e-11


@pytest.mark.parametrize("method", METHODS)
def test_compiled_computed_torque_is_the_same_as_a_function(method, rng):
    robot = hand(rng)
    q, qd, _, _ = start_of(robot, rng, 3)
    phase = np.arange(len(robot.joint_names)) + np.arange(3)[:, None]

    def wave(t):
        return np.sin(2 * t + phase), 2 * np.cos(2 * t + phase), -4 * np.sin(2 * t + phase)

    control = ComputedTorque(wave, 50.0, 10.0)
    given = {"duration": 0.05, "dt": 0.005, "method": method}
    compiled = robot.simulate(q, qd, control=control, **given)
    called = robot.simulate(q, qd, control=call_of(control, robot), **given)
    assert differ(compiled, called) < 1e-10


def test_a_long_motion_is_sampled_in_parts(monkeypatch, rng):
    from cspace.dynamics import roll_out

    robot = hand(rng)
    q, qd, _, _ = start_of(robot, rng)
    phase = np.arange(len(robot.joint_names))
    control = ComputedTorque(lambda t: (np.sin(t + phase), np.cos(t + phase), -np.sin(t + phase)), 50.0, 10.0)
    whole = robot.simulate(q, qd, control=control, duration=0.05, dt=0.005)
    monkeypatch.setattr(roll_out, "MOTION_SAMPLES", 40)
    parts = robot.simulate(q, qd, control=control, duration=0.05, dt=0.005)
    np.testing.assert_array_equal(parts.q, whole.q)


@pytest.mark.parametrize("method", METHODS)
def test_constant_torques_are_those_of_a_function(method, rng):
    robot = branches(rng)
    q, qd, tau, _ = start_of(robot, rng, 4)
    given = {"duration": 0.009, "dt": 0.003, "method": method, "tolerance": 1e-11}
    fixed = robot.simulate(q, qd, control=tau[0], **given)
    called = robot.simulate(q, qd, control=lambda t, q, qd: tau[0], **given)
    assert differ(fixed, called) < 1e-9
    with pytest.raises(InputError, match=r"control has shape \(3,\), expected \(4, 7\)"):
        robot.simulate(q, qd, control=[1, 2, 3], **given)


@pytest.mark.parametrize("method", METHODS)
def test_rows_that_end_at_limits_are_the_same_alone(method, rng):
    links = tuple(Link(f"link_{i}", random_body(rng)) for i in range(3))
    joints = tuple(
        Joint(f"joint_{i}", "revolute", f"link_{i}", f"link_{i + 1}", lower=-1.0, upper=1.0, axis=(0, 1, 0))
        for i in range(2)
    )
    robot = cs.Robot(Description("limited", links, joints))
    q = rng.uniform(-0.9, 0.9, (13, 2))
    given = {"duration": 0.5, "dt": 0.01, "method": method, "every": 7, "stop_at_limits": True}
    many = robot.simulate(q, [2.0, -1.0], **given)
    assert len(set(many.stopped)) > 5
    for i in range(13):
        one = robot.simulate(q[i], [2.0, -1.0], **given)
        assert one.stopped == many.stopped[i]
        shown = many.times <= one.stopped
        for part in ("q", "qd", "energy", "momentum"):
            row, alone = getattr(many, part)[i], getattr(one, part)
            assert np.isnan(row[~shown]).all()
            np.testing.assert_allclose(row[shown], alone[: shown.sum()], atol=1e-9)


@pytest.mark.parametrize("method", METHODS)
def test_a_time_limit_is_kept_within_hundredths(method, rng):
    robot = branches(rng)
    q, qd, _, _ = start_of(robot, rng, 40)
    begin = time.perf_counter()
    run = robot.simulate(q, qd, duration=1e4, dt=1e-3, method=method, every=10**5, time_limit=0.1)
    assert time.perf_counter() - begin < 0.6
    assert not run
    assert run.reason.startswith("time limit, at t = ")
    assert (run.stopped < 1e4).all()


@pytest.mark.skipif(sys.platform == "win32", reason="no timer signals there")
@pytest.mark.parametrize("threads", [1, 2])
@pytest.mark.parametrize("method", METHODS)
def test_an_interrupt_ends_a_compiled_loop(method, threads, rng):
    robot = branches(rng)
    q, qd, _, _ = start_of(robot, rng, 40)
    before = signal.signal(signal.SIGALRM, signal.default_int_handler)
    signal.setitimer(signal.ITIMER_REAL, 0.1)
    begin = time.perf_counter()
    try:
        with pytest.raises(KeyboardInterrupt):
            robot.simulate(q, qd, duration=1e5, dt=1e-3, method=method, every=10**6, threads=threads)
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)
    assert time.perf_counter() - begin < 0.6


@pytest.mark.slow
def test_many_long_roll_outs_take_less_than_twice_their_answer(rng):
    robot = hand(rng)
    q, qd, _, _ = start_of(robot, rng, 10**4)
    tracemalloc.start()
    run = robot.simulate(q, qd, control=PD(q[0], 1.0, 0.1), duration=1.0, dt=1e-3, every=10)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    answer = sum(each.nbytes for each in (run.q, run.qd, run.tau, run.energy, run.momentum))
    assert run.q.shape[:2] == (10**4, 101)
    assert peak < 1.2 * answer
