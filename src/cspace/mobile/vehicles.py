"""Vehicles of the plane and their limits."""

from __future__ import annotations

from dataclasses import astuple, dataclass, fields
from math import pi, tan
from typing import Any

import numpy as np
import numpy.typing as npt

from cspace.arrays import Array, as_floats, bounded_number
from cspace.errors import InputError
from cspace.mobile.arcs import drive
from cspace.tables import tabulate

MAY_BE_ZERO = ("max_reverse", "rear", "radius")


@tabulate()
@dataclass(frozen=True)
class Unicycle:
    """A robot with two driven wheels: it drives along its heading and turns as it likes, on the spot too.

    x' = v cos θ, y' = v sin θ, θ' = ω. max_speed, max_reverse [m/s]; acceleration [m/s²]; max_turn_rate of ω
    [rad/s]; turn_acceleration of it [rad/s²]; radius [m] of the disc that it covers. Raises InputError for a
    number that is not above zero (max_reverse and radius may be zero).
    """

    max_speed: float = 1.0
    max_reverse: float = 0.0
    acceleration: float = 1.0
    max_turn_rate: float = 2.0
    turn_acceleration: float = 4.0
    radius: float = 0.2

    def __post_init__(self) -> None:
        check_limits(self)

    def twist(self, controls: npt.ArrayLike) -> Array:
        """The body twist of speed and turn rate: (v, ω) (..., 2) [m/s, rad/s] → [vx, vy, ω] (..., 3)."""
        v, rate = np.moveaxis(as_floats(controls, "controls", last=(2,)), -1, 0)
        return np.stack([v, np.zeros_like(v), rate], axis=-1)

    def controls(self, twist: npt.ArrayLike) -> Array:
        """Speed and turn rate of a body twist: [vx, vy, ω] (..., 3) → (v, ω) (..., 2) [m/s, rad/s].

        Raises InputError for a slide, vy ≠ 0.
        """
        xi = read_rolling_twist(twist, "unicycle")
        return xi[..., [0, 2]]

    def drive(self, T_map_base: Any, twist: npt.ArrayLike, dt: npt.ArrayLike) -> Array:
        """The pose after a constant twist for a time, as cspace.mobile.drive: (..., 3, 3) → (..., 3, 3)."""
        return drive(T_map_base, twist, dt)

    @property
    def _limits(self) -> list[float]:
        return [0.0, *astuple(self)[:5]]

    @property
    def _footprint(self) -> list[float]:
        return [0.0, 0.0, 0.0, self.radius]


@tabulate()
@dataclass(frozen=True)
class Car:
    """A car as a bicycle model: it steers with its front wheels; its place is the middle of its rear axle.

    x' = v cos θ, y' = v sin θ, θ' = v tan δ / wheelbase. wheelbase [m]; max_speed, max_reverse [m/s];
    acceleration [m/s²]; max_steering of δ [rad], below a quarter turn; steering_rate of it [rad/s]. It covers
    a rectangle of length and width [m], of which `rear` [m] lies behind the rear axle. Raises InputError for
    a number that is not above zero (max_reverse and rear may be zero).
    """

    wheelbase: float = 2.7
    max_speed: float = 10.0
    max_reverse: float = 2.0
    acceleration: float = 2.0
    max_steering: float = 0.6
    steering_rate: float = 0.8
    length: float = 4.4
    width: float = 1.8
    rear: float = 0.9

    def __post_init__(self) -> None:
        check_limits(self)
        if self.max_steering >= pi / 2:
            raise InputError(f"max_steering is {self.max_steering:g}; wheels turn by less than π/2 rad")

    @property
    def turning_radius(self) -> float:
        """The radius [m] of the tightest circle of the rear axle."""
        return self.wheelbase / tan(self.max_steering)

    def twist(self, controls: npt.ArrayLike) -> Array:
        """The body twist of speed and steering angle: (v, δ) (..., 2) [m/s, rad] → [vx, vy, ω] (..., 3)."""
        v, steering = np.moveaxis(as_floats(controls, "controls", last=(2,)), -1, 0)
        if (np.abs(steering) >= 0.5 * np.pi).any():
            raise InputError(
                f"the steering angle is {np.abs(steering).max():g} rad; it must be less than π/2"
            )
        return np.stack([v, np.zeros_like(v), v * np.tan(steering) / self.wheelbase], axis=-1)

    def controls(self, twist: npt.ArrayLike) -> Array:
        """Speed and steering angle of a body twist: [vx, vy, ω] (..., 3) → (v, δ) (..., 2) [m/s, rad].

        A car at rest has δ = 0. Raises InputError for a slide, vy ≠ 0, and for a turn on the spot.
        """
        xi = read_rolling_twist(twist, "car")
        v, rate = xi[..., 0], xi[..., 2]
        if ((v == 0) & (rate != 0)).any():
            raise InputError(
                "the twist turns on the spot, vx = 0 and ω ≠ 0; a car cannot, so vx must not be 0"
            )
        return np.stack([v, np.arctan(self.wheelbase * rate / np.where(v == 0, 1.0, v))], axis=-1)

    def drive(self, T_map_base: Any, twist: npt.ArrayLike, dt: npt.ArrayLike) -> Array:
        """The pose after a constant twist for a time, as cspace.mobile.drive: (..., 3, 3) → (..., 3, 3)."""
        return drive(T_map_base, twist, dt)

    @property
    def _limits(self) -> list[float]:
        return list(astuple(self)[:6])

    @property
    def _footprint(self) -> list[float]:
        return [self.rear, self.length - self.rear, 0.5 * self.width, 0.0]


def check_limits(vehicle: Unicycle | Car) -> None:
    """InputError for a limit that is no number above zero."""
    for field in fields(vehicle):
        name = field.name
        least = 0.0 if name in MAY_BE_ZERO else np.finfo(np.float64).smallest_subnormal
        value = bounded_number(getattr(vehicle, name), name, least, "give one number above zero")
        object.__setattr__(vehicle, name, value)


def read_rolling_twist(twist: npt.ArrayLike, vehicle: str) -> Array:
    """A twist (..., 3) without a slide; InputError for one with vy ≠ 0."""
    xi = as_floats(twist, "twist", last=(3,))
    if (xi[..., 1] != 0).any():
        first = xi[xi[..., 1] != 0][0, 1]
        raise InputError(
            f"the twist slides sideways, vy = {first:g} m/s; a {vehicle} cannot, so vy must be 0"
        )
    return xi
