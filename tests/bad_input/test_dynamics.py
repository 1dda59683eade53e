"""States, wrenches, flags and controls that cannot be: an error of cspace names what is wrong.

No function of dynamics answers with numbers that nobody computed: what its compiled loops refuse is an error.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import cspace as cs
from cspace.dynamics import PD, ComputedTorque, exciting_trajectory, identify, simulate_loops, with_parameters
from cspace.errors import CspaceError, InputError, InputTypeError, UnknownNameError
from cspace.mechanisms import Delta, FourBar, SliderCrank, Stewart
from cspace.model import Description, Inertial, Joint, Link

ARM = cs.load_robot("panda")
N = ARM.dof
REST = np.zeros(N)

STATES: dict[str, tuple[str, ...]] = {
    "inverse_dynamics": ("q", "qd", "qdd"),
    "forward_dynamics": ("q", "qd", "tau"),
    "mass_matrix": ("q",),
    "gravity_torques": ("q",),
    "coriolis_matrix": ("q", "qd"),
    "kinetic_energy": ("q", "qd"),
    "potential_energy": ("q",),
    "centroidal_momentum": ("q", "qd"),
    "centroidal_momentum_matrix": ("q",),
    "inverse_dynamics_derivatives": ("q", "qd", "qdd"),
    "forward_dynamics_derivatives": ("q", "qd", "tau"),
    "regressor": ("q", "qd", "qdd"),
}
"""The functions of a robot, and what they are given."""

GIVEN = [(name, word) for name, words in STATES.items() for word in words]

LINKAGE = FourBar(1.0, 0.3, 0.9, 0.7)
CLOSED = LINKAGE.assembly_modes({"crank": 0.9}).q[0]
STILL = np.zeros(3)


def call(name: str, word: str, value: Any, lead: tuple[int, ...] = (), **options: Any) -> Any:
    """A function of the arm at rest, with one argument replaced."""
    words = STATES[name]
    given = [value if each == word else np.zeros((*lead, N)) for each in words]
    return getattr(ARM, name)(*given, **options)


def told(each: Callable[[], Any]) -> Any:
    """What a call returns, or the text of its InputError."""
    try:
        return each()
    except InputError as error:
        return str(error)


@pytest.mark.parametrize("value", [np.nan, np.inf, 1e101, 1e160, 1e300, -1e300])
@pytest.mark.parametrize(("name", "word"), GIVEN)
@pytest.mark.parametrize("lead", [(), (3,)])
def test_numbers_that_are_too_large_are_refused_by_name(name, word, value, lead):
    one = np.zeros((*lead, N))
    one[..., 2] = value
    for given in (one, np.full((*lead, N), value)):
        with pytest.raises(InputError, match=f"^{word} holds {re.escape(f'{value:g}')} at"):
            call(name, word, given, lead)


@pytest.mark.parametrize(("name", "word"), GIVEN)
def test_values_whose_sum_is_too_large_are_refused(name, word):
    with pytest.raises(InputError, match=f"^{word} holds 9e"):
        call(name, word, np.full(N, 9e99))


@pytest.mark.parametrize(("name", "word"), [(name, word) for name, word in GIVEN if word != "q"])
def test_a_state_cannot_be_none(name, word):
    with pytest.raises(InputTypeError, match=f"^{word} is None"):
        call(name, word, None)
    if name in ("inverse_dynamics", "forward_dynamics"):
        with pytest.raises(InputTypeError, match=f"^{word} is None"):
            call(name, word, None, dtype=np.float32)


@pytest.mark.parametrize("name", ["inverse_dynamics", "forward_dynamics"])
@pytest.mark.parametrize("wrench", [np.full(6, 1e101), np.full(6, np.nan), np.zeros(5)])
def test_wrenches(name, wrench):
    with pytest.raises(InputError, match=r"^wrench at 'panda_link8'"):
        getattr(ARM, name)(REST, REST, REST, wrenches={"panda_link8": wrench})
    with pytest.raises(InputError, match=r"^wrench at 'panda_link8'"):
        ARM.simulate(REST, REST, duration=0.01, dt=0.01, wrenches={"panda_link8": wrench})


@pytest.mark.parametrize("axes", ["world", None, 3])
def test_axes_of_wrenches_are_known_words_also_without_wrenches(axes):
    for name in ("inverse_dynamics", "forward_dynamics"):
        with pytest.raises(UnknownNameError, match="expressed_in"):
            getattr(ARM, name)(REST, REST, REST, expressed_in=axes)


GRAVITY = [name for name in STATES if name.startswith(("inv", "forw", "grav", "pot", "regr"))]


@pytest.mark.parametrize("name", GRAVITY)
@pytest.mark.parametrize("gravity", [(0, 0, 1e308), (0, 0, 1e101), (0, 0), (0, 0, np.nan)])
def test_gravity(name, gravity):
    with pytest.raises(InputError, match=r"^gravity"):
        call(name, "", None, gravity=gravity)


def test_base_parameters_end_whatever_gravity_is():
    for gravity in ((0, 0, 1e308), (0, 0, 1e101)):
        with pytest.raises(InputError, match=r"^gravity"):
            cs.dynamics.base_parameters(ARM, gravity=gravity)
    assert len(cs.dynamics.base_parameters(ARM, gravity=(0, 0, 1e90))) > 0


@pytest.mark.parametrize("value", ["no", 1, None, 0.0, np.array([True, False])])
def test_flags_are_true_or_false(value):
    state = {"duration": 0.01, "dt": 0.01}
    calls: dict[str, Callable[[], Any]] = {
        "friction": lambda: ARM.inverse_dynamics(REST, REST, REST, friction=value),
        "stop_at_limits": lambda: ARM.simulate(ARM.named_poses["ready"], REST, stop_at_limits=value, **state),
        "gravity_compensation": lambda: PD(REST, 1, 1, value),
    }
    for name, each in calls.items():
        with pytest.raises(InputTypeError, match=f"^{name} must be True or False"):
            each()
    for each in (
        lambda: ARM.forward_dynamics(REST, REST, REST, friction=value),
        lambda: ARM.regressor(REST, REST, REST, friction=value),
        lambda: cs.dynamics.parameters(ARM, friction=value),
        lambda: cs.dynamics.parameter_names(ARM, friction=value),
        lambda: cs.dynamics.base_parameters(ARM, friction=value),
        lambda: identify(ARM, REST, REST, REST, REST, friction=value),
        lambda: ARM.simulate(REST, REST, friction=value, **state),
        lambda: LINKAGE.simulate(CLOSED, STILL, friction=value, **state),
        lambda: LINKAGE.forward_dynamics(CLOSED, STILL, STILL, friction=value),
    ):
        with pytest.raises(InputTypeError, match=r"^friction must be True or False"):
            each()


@pytest.mark.parametrize("name", ["inverse_dynamics", "forward_dynamics", "mass_matrix"])
def test_what_floats_cannot_hold_is_refused(name):
    words = STATES[name]
    for value in (1e4, 1e5, 1e30, 1e39):
        for dtype in (np.float64, np.float32):
            with np.errstate(over="ignore"):
                q = np.full((4, N), value).astype(dtype)
            with pytest.raises(InputError, match=r"^q holds"):
                call(name, "q", q, (4,), dtype=np.float32)
    below = np.full((4, N), np.nextafter(np.float32(1e4), np.float32(0)))
    assert np.isfinite(call(name, "q", below, (4,), dtype=np.float32)).all()
    for word in words[1:]:
        for value in (1e38, 3e38, 1e39, 1e60):
            answer = told(lambda v=value, w=word: call(name, w, np.full((4, N), v), (4,), dtype=np.float32))
            if isinstance(answer, str):
                assert "too large for float32" in answer or answer.startswith(f"{word} holds")
            else:
                assert np.isfinite(answer).all()


@pytest.mark.parametrize(
    ("motion", "kind", "text"),
    [
        (lambda t: None, InputTypeError, r"is a NoneType, expected q, qd and qdd"),
        (lambda t: 1.0, InputTypeError, r"is a float, expected q, qd and qdd"),
        (lambda t: (REST, REST), InputError, "has 2 parts"),
        (lambda t: (REST,) * 4, InputError, "has 4 parts"),
        (lambda t: (REST[1:], REST, REST), InputError, "^q of the motion at t = 0 s has shape"),
        (lambda t: (REST, REST, REST + np.nan), InputError, "^qdd of the motion at t = 0 s holds nan"),
        (lambda t: (REST, REST, REST + 1e300), InputError, r"^qdd of the motion at t = 0 s holds 1e\+300"),
        (lambda t: "abc", InputTypeError, "^q of the motion"),
    ],
)
def test_motions_of_computed_torque(motion, kind, text):
    control = ComputedTorque(motion, 100, 20)
    for each in (
        lambda: ARM.simulate(REST, REST, control=control, duration=0.01, dt=0.001),
        lambda: control(ARM, 0.0, REST, REST),
    ):
        with pytest.raises(kind, match=text):
            each()


def test_a_motion_keeps_its_leading_axes():
    control = ComputedTorque(lambda t: np.zeros((3, 2, N) if t > 0.0035 else (3, N)), 100, 20)
    with pytest.raises(InputError, match=r"^the motion at t = 0.004 s has leading axes \(2,\)"):
        ARM.simulate(np.zeros((2, N)), REST, control=control, duration=0.01, dt=0.001)


@pytest.mark.parametrize("gain", [1e300, -1, np.nan, np.inf])
def test_gains(gain):
    for make in (lambda: PD(REST, gain, 1), lambda: PD(REST, 1, gain), lambda: ComputedTorque(exit, gain, 1)):
        with pytest.raises(InputError, match=r"^k[pd] holds"):
            make()


@pytest.mark.parametrize("t", [[0.0, 0.05], [], np.zeros((2, 2)), "x", None, np.nan, -1.0, 1.0])
def test_the_state_of_a_simulation_is_that_of_one_time(t):
    run = ARM.simulate(REST, REST, duration=0.1, dt=0.05)
    with pytest.raises((InputError, InputTypeError), match=r"^t "):
        run(t)


def test_a_simulation_needs_velocities():
    with pytest.raises(InputTypeError, match=r"^qd is None"):
        ARM.simulate(REST, None, duration=0.1, dt=0.05)
    with pytest.raises(InputError, match=r"^qd holds 1e\+300"):
        ARM.simulate(REST, REST + 1e300, duration=0.1, dt=0.05)


@pytest.mark.parametrize("floating", [False, True])
def test_robots_without_joints_keep_their_parameters(floating):
    body = Inertial(1.0, (0.1, 0.0, 0.2), np.eye(3))
    joint = Joint("weld", "fixed", "base", "plate")
    robot = cs.Robot(
        Description("block", (Link("base", body), Link("plate", body)), (joint,)), floating=floating
    )
    pi = cs.dynamics.parameters(robot)
    assert np.allclose(cs.dynamics.parameters(with_parameters(robot, pi)), pi)


def test_exciting_trajectories_at_no_time():
    motion = exciting_trajectory(ARM, trials=1, rng=0)
    assert [each.shape for each in motion([])] == [(0, N)] * 3
    assert [each.shape for each in motion(np.zeros((2, 0)))] == [(2, 0, N)] * 3


@pytest.mark.parametrize("size", [1e-300, 1e-200, 1.0, 1e200, 1e300])
def test_effective_masses_do_not_depend_on_the_length_of_the_direction(size):
    felt = ARM.operational_space(ARM.named_poses["ready"])
    direction = np.array([1.0, -2.0, 0.5])
    assert np.isclose(felt.effective_mass(direction * size), felt.effective_mass(direction), rtol=1e-12)


def test_one_lost_direction_is_one():
    assert "1 direction lost" in repr(ARM.operational_space(REST))


@pytest.mark.parametrize("value", ["panda", None, 3])
def test_what_is_no_robot(value):
    for each in (
        lambda: cs.dynamics.inertia_report(value),
        lambda: cs.dynamics.operational_space(value, REST),
        lambda: cs.dynamics.inverse_dynamics(value, REST, REST, REST, dtype=np.float32),
    ):
        with pytest.raises(InputTypeError, match="must be a Robot"):
            each()


def test_identification_names_what_is_missing_or_too_large():
    q = np.zeros((4, N))
    for k, word in enumerate(("q", "qd", "qdd", "tau")):
        given = [q] * 4
        if word != "q":
            given[k] = None
            with pytest.raises(InputTypeError, match=f"^{word} is None"):
                identify(ARM, *given)
        given[k] = q + 1e300
        with pytest.raises(InputError, match=rf"^{word} holds 1e\+300"):
            identify(ARM, *given)


LOOPS: dict[str, Callable[..., Any]] = {
    "forward_dynamics": lambda q, qd, last: LINKAGE.forward_dynamics(q, qd, last),
    "inverse_dynamics": lambda q, qd, last: LINKAGE.inverse_dynamics(q, qd, last, ["crank"]),
    "loop_wrenches": lambda q, qd, last: LINKAGE.loop_wrenches(q, qd, last, last),
    "accelerations": lambda q, qd, last: LINKAGE.accelerations(q, qd, {"crank": 1.0}),
    "simulate": lambda q, qd, last: LINKAGE.simulate(q, qd, duration=0.01, dt=0.01),
}


@pytest.mark.parametrize("name", LOOPS)
def test_states_of_loops(name):
    with pytest.raises(InputTypeError, match=r"^qd is None"):
        LOOPS[name](CLOSED, None, STILL)
    for value in (1e300, np.nan):
        with pytest.raises(InputError, match=r"^qd holds"):
            LOOPS[name](CLOSED, STILL + value, STILL)
        with pytest.raises(InputError, match=r"^q holds"):
            LOOPS[name](CLOSED + value, STILL, STILL)


@pytest.mark.parametrize(
    "driven",
    [None, "crank", ["crank"], 3, {"crank": "x"}, {"crank": np.nan}, {"crank": 1e300}, {"knee": 1.0}],
)
def test_driven_rates(driven):
    for each in (
        lambda: LINKAGE.velocities(CLOSED, driven),
        lambda: LINKAGE.accelerations(CLOSED, STILL, driven),
    ):
        with pytest.raises(CspaceError, match=r"driven|joint"):
            each()


READY = {
    "four_bar": LINKAGE,
    "slider_crank": SliderCrank(0.3, 0.9),
    "delta": Delta(0.2, 0.06, 0.25, 0.6),
    "stewart": Stewart.of_radii(base_radius=0.5, platform_radius=0.3, height=0.6),
}


@pytest.mark.parametrize("name", READY)
def test_driven_values_of_assembly_modes(name):
    mechanism = READY[name]
    first = mechanism.joint_names[0]
    for driven in (None, "crank", [1], {first: "x"}, {first: np.nan}, {first: 1e300}, {"knee": 1.0}):
        with pytest.raises(CspaceError, match=r"driven|joint"):
            mechanism.assembly_modes(driven, starts=1)
    for driven in ({first: [0.9, 1.0]}, {each: np.zeros(2) for each in mechanism.joint_names[-6:]}):
        with pytest.raises(InputError, match="expected one number each"):
            mechanism.assembly_modes(driven, starts=1)
    with pytest.raises(InputError, match=r"^near holds 1e\+300"):
        mechanism.close(near=np.full(len(mechanism.joint_names), 1e300))


@pytest.mark.parametrize(
    ("wrenches", "kind"),
    [
        ([1], InputTypeError),
        ("x", InputTypeError),
        ({"coupler": np.zeros(5)}, InputError),
        ({"coupler": np.full(6, 1e300)}, InputError),
        ({"knee": np.zeros(6)}, UnknownNameError),
    ],
)
def test_wrenches_on_loops(wrenches, kind):
    for given in (wrenches, lambda t, q, qd: wrenches):
        with pytest.raises(kind, match=r"wrench|frame"):
            simulate_loops(LINKAGE.constraints, CLOSED, STILL, duration=0.01, dt=0.005, wrenches=given)


def test_rows_of_torques_and_wrenches_on_loops_are_rows_of_states():
    state = {"duration": 0.01, "dt": 0.005}
    wrenches = {"coupler": np.zeros((3, 6))}
    assert simulate_loops(LINKAGE.constraints, CLOSED, STILL, wrenches=wrenches, **state).q.shape == (3, 3, 3)
    assert LINKAGE.simulate(CLOSED, STILL, control=np.zeros((2, 3)), **state).q.shape == (2, 3, 3)
    with pytest.raises(InputError, match=r"^wrench at 'coupler' has shape \(3, 6\)"):
        simulate_loops(LINKAGE.constraints, CLOSED, STILL, wrenches=lambda t, q, qd: wrenches, **state)
    with pytest.raises(InputError, match=r"^the torque of control at "):
        LINKAGE.simulate(CLOSED, STILL, control=lambda t, q, qd: np.zeros((2, 3)), **state)


@pytest.mark.parametrize(
    "tau", [0.0, np.zeros(2), np.zeros((2, 2)), np.full(3, np.nan), np.full(3, 1e300), "x", None]
)
def test_torques_of_loops(tau):
    state = {"duration": 0.01, "dt": 0.005}
    with pytest.raises((InputError, InputTypeError), match=r"^the torque of control at "):
        LINKAGE.simulate(CLOSED, STILL, control=lambda t, q, qd: tau, **state)
    if isinstance(tau, np.ndarray | str):
        with pytest.raises((InputError, InputTypeError), match=r"^control "):
            LINKAGE.simulate(CLOSED, STILL, control=tau, **state)


def test_constant_torques_of_loops():
    tau, state = np.array([0.7, 0.0, -0.2]), {"duration": 0.02, "dt": 0.005}
    held = LINKAGE.simulate(CLOSED, STILL, control=tau, **state)
    asked = LINKAGE.simulate(CLOSED, STILL, control=lambda t, q, qd: tau, **state)
    rows = LINKAGE.simulate(np.stack([CLOSED] * 2), STILL, control=np.stack([tau, 0 * tau]), **state)
    assert np.array_equal(held.q, asked.q)
    assert np.array_equal(held.tau, asked.tau)
    assert np.allclose(rows.q[0], held.q)
    assert not np.allclose(rows.q[1], held.q)
