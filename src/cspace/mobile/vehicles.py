"""Vehicles of the plane and their limits."""

from __future__ import annotations

from dataclasses import astuple, dataclass, fields
from math import pi, tan

import numpy as np

from cspace.arrays import bounded_number
from cspace.errors import InputError

MAY_BE_ZERO = ("max_reverse", "rear", "radius")


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

    @property
    def _limits(self) -> list[float]:
        return [0.0, *astuple(self)[:5]]

    @property
    def _footprint(self) -> list[float]:
        return [0.0, 0.0, 0.0, self.radius]


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
