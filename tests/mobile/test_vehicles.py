"""Vehicles: inverse after forward, slip, saturation, and arcs against ten thousand Euler steps."""

from __future__ import annotations

import numpy as np
import pytest

import cspace as cs
from cspace.errors import InputError
from cspace.mobile import DifferentialDrive, Mecanum, Omni, Tracked, arc_jacobians, drive

VEHICLES = [
    DifferentialDrive(0.04, 0.31),
    Omni(),
    Omni(0.03, angles=(0.1, 1.2, 2.9, 4.4), distance=0.3),
    Mecanum(),
    Tracked(icr_left=0.5, icr_right=-0.3, icr_x=0.1),
    Tracked.symmetric(0.1, 0.9),
]
IDS = [f"{type(v).__name__}-{k}" for k, v in enumerate(VEHICLES)]


def random_twists(vehicle, rng, count=40):
    return rng.normal(size=(5, count // 5, vehicle.allowed_twists.shape[1])) @ vehicle.allowed_twists.T


@pytest.mark.parametrize("vehicle", VEHICLES, ids=IDS)
def test_wheel_speeds_of_a_twist_give_it_back_without_slip(vehicle):
    twists = random_twists(vehicle, np.random.default_rng(1))
    wheels = vehicle.wheel_speeds(twists)
    assert wheels.shape == (5, 8, len(vehicle.wheel_matrix))
    np.testing.assert_allclose(vehicle.twist(wheels), twists, atol=1e-12)
    np.testing.assert_allclose(vehicle.slip(wheels), 0.0, atol=1e-10)


@pytest.mark.parametrize("vehicle", VEHICLES, ids=IDS)
def test_a_wheel_rolls_as_its_contact_point_moves(vehicle):
    """Oracle: speed of the contact point along the rolling direction, over the radius."""
    twist = random_twists(vehicle, np.random.default_rng(2))[0, 0]
    if isinstance(vehicle, DifferentialDrive):
        points, along = np.array([[0, 0.5], [0, -0.5]]) * vehicle.track, np.array([[1.0, 0.0]] * 2)
    elif isinstance(vehicle, Omni):
        a = np.array(vehicle.angles)
        points = vehicle.distance * np.stack([np.cos(a), np.sin(a)], axis=-1)
        along = np.stack([-np.sin(a), np.cos(a)], axis=-1)
    elif isinstance(vehicle, Mecanum):  # the roller takes the component along its axis, at 45 degrees
        x, y = 0.5 * vehicle.wheelbase, 0.5 * vehicle.track
        points = np.array([[x, y], [x, -y], [-x, y], [-x, -y]])
        along = np.array([[1.0, -1.0], [1.0, 1.0], [1.0, 1.0], [1.0, -1.0]])
    else:
        points = np.array([[vehicle.icr_x, vehicle.icr_left], [vehicle.icr_x, vehicle.icr_right]])
        along = np.array([[1.0, 0.0]] * 2)
    velocity = twist[:2] + twist[2] * np.stack([-points[:, 1], points[:, 0]], axis=-1)
    expected = (velocity * along).sum(axis=-1) / vehicle.wheel_radius
    np.testing.assert_allclose(vehicle.wheel_speeds(twist), expected, atol=1e-12)


@pytest.mark.parametrize("vehicle", [Mecanum(), Omni(angles=(0.0, 1.0, 2.5, 4.0))], ids=["Mecanum", "Omni"])
def test_slip_is_what_no_twist_explains(vehicle):
    rng = np.random.default_rng(3)
    wheels = rng.normal(size=(20, 4))
    slip = vehicle.slip(wheels)
    assert np.abs(slip).max() > 0.1
    np.testing.assert_allclose(vehicle.twist(slip), 0.0, atol=1e-12)
    np.testing.assert_allclose(vehicle.wheel_matrix.T @ slip.T, 0.0, atol=1e-10)


@pytest.mark.parametrize("vehicle", VEHICLES, ids=IDS)
def test_saturation_keeps_the_curvature_and_the_limit(vehicle):
    slow = type(vehicle)(**{**vars_of(vehicle), "max_wheel_speed": 3.0})
    wheels = slow.wheel_speeds(random_twists(slow, np.random.default_rng(4)))
    bounded = slow.saturate(wheels)
    assert np.abs(bounded).max() <= 3.0 + 1e-12
    before, after = slow.twist(wheels), slow.twist(bounded)
    np.testing.assert_allclose(np.cross(before, after), 0.0, atol=1e-9)
    free = np.abs(wheels).max(axis=-1) <= 3.0
    np.testing.assert_array_equal(bounded[free], wheels[free])


def vars_of(vehicle):
    return {name: getattr(vehicle, name) for name in vehicle.__dataclass_fields__}


@pytest.mark.parametrize("vehicle", [cs.Unicycle(), cs.Car()], ids=["Unicycle", "Car"])
def test_controls_of_a_twist_give_it_back(vehicle):
    controls = np.random.default_rng(5).uniform([0.2, -0.5], [2.0, 0.5], size=(30, 2))
    np.testing.assert_allclose(vehicle.controls(vehicle.twist(controls)), controls, atol=1e-12)


def euler(twist, dt, n):
    T, step = np.eye(3), np.eye(3) + cs.hat_se2(twist) * dt / n
    for _ in range(n):
        T = T @ step
    return T


def test_an_arc_is_the_limit_of_euler_steps():
    twist, dt = np.random.default_rng(6).normal(size=3), 1.3
    coarse, fine = euler(twist, dt, 10_000), euler(twist, dt, 20_000)
    np.testing.assert_allclose(drive(np.eye(3), twist, dt), 2 * fine - coarse, atol=1e-6)


@pytest.mark.parametrize("turn", [1.0, 1e-5, 1e-9, 0.0, np.pi])
def test_driving_twice_half_as_long_is_driving_once(turn):
    twist = np.array([0.7, -0.2, turn])
    whole = drive(np.eye(3), twist, 1.0)
    np.testing.assert_allclose(drive(drive(np.eye(3), twist, 0.5), twist, 0.5), whole, atol=1e-15)


def test_a_vehicle_drives_as_the_simulator_of_paths_does():
    run = cs.navigation.follow([(0.0, 0.0), (2.0, 0.0), (4.0, 1.0)], vehicle=cs.Unicycle())
    T = cs.pose_2d(xytheta=run.poses)
    dt = np.diff(run.times)
    moved = drive(T[:-1], cs.Unicycle().twist(run.controls[1:]), dt)
    np.testing.assert_allclose(moved, T[1:], atol=1e-9)


@pytest.mark.parametrize("turn", [0.8, 1e-7, 0.0, 3.14])
def test_jacobians_of_an_arc_are_its_differences(turn):
    twist, dt, h = np.array([0.5, 0.2, turn]), 0.9, 1e-6
    F, G = arc_jacobians(twist, dt)
    end = cs.exp_se2(twist * dt)
    for k in range(3):
        d = np.zeros(3)
        d[k] = h
        start = np.linalg.inv(end) @ cs.exp_se2(d) @ end
        np.testing.assert_allclose(cs.log_se2(start) / h, F[:, k], atol=1e-5)
        np.testing.assert_allclose(
            cs.log_se2(np.linalg.inv(end) @ cs.exp_se2((twist + d) * dt)) / h, G[:, k], atol=1e-5
        )


@pytest.mark.parametrize(
    ("call", "part"),
    [
        (lambda: DifferentialDrive().wheel_speeds([1.0, 0.2, 0.0]), "vy must be 0"),
        (lambda: DifferentialDrive(track=0.0), "track is 0.0"),
        (lambda: DifferentialDrive().twist([1.0, 2.0, 3.0]), "wheel speeds has shape (3,)"),
        (lambda: Tracked(icr_left=-0.1), "icr_left is -0.1"),
        (lambda: Omni(angles=(0.0, 1.0)), "three angles"),
        (lambda: Omni(angles=(0.0, 0.0, 0.0)), "do not determine"),
        (lambda: Mecanum(max_wheel_speed=-1.0), "max_wheel_speed is -1.0"),
        (lambda: cs.Car().controls([0.0, 0.0, 1.0]), "turns on the spot"),
        (lambda: cs.Unicycle().controls([1.0, 1.0, 0.0]), "slides sideways"),
        (lambda: drive(np.eye(3), [1.0, np.nan, 0.0], 1.0), "must be finite"),
    ],
)
def test_a_misuse_is_named(call, part):
    with pytest.raises(InputError) as error:
        call()
    assert part in str(error.value)
