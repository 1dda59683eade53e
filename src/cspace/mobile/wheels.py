"""Vehicles as one matrix: wheel speeds = J [vx, vy, ω], with the twists that the wheels allow."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass, fields
from functools import cached_property
from math import inf
from typing import Any

import numpy as np
import numpy.typing as npt

from cspace import tolerances
from cspace.arrays import Array, as_floats, bounded_number, one_number, positive_number
from cspace.errors import InputError, name_type
from cspace.mobile.arcs import drive
from cspace.tables import join_words, show_fields, tabulate
from cspace.tolerances import FARTHEST_POINT

Floats = npt.ArrayLike


class WheelBase(ABC):
    """A vehicle whose wheel speeds are a linear function of its body twist, w = J ξ.

    The twists that the wheels allow are ξ = N u: of a robot that cannot slide, N leaves out vy. Forwards is
    ξ = N (J N)⁺ w, the least-squares twist of measured wheel speeds; what J ξ leaves of w is slip. Twists are
    [vx, vy, ω] in base [m/s, rad/s], wheel speeds in [rad/s]. Sources: Campion, Bastin & D'Andréa-Novel 1996;
    Siegwart, Nourbakhsh & Scaramuzza 2011, section 3.2.
    """

    wheel_radius: float
    max_wheel_speed: float

    @cached_property
    def wheel_matrix(self) -> Array:
        """J (k, 3) [1/m, and rad for ω]: a row per wheel."""
        return self._rows() / self.wheel_radius

    @cached_property
    def allowed_twists(self) -> Array:
        """N (3, r): the columns span the twists that no wheel opposes; r is 3 or, without slides, 2."""
        return np.eye(3)

    def twist(self, wheels: Floats) -> Array:
        """The body twist of wheel speeds, by least squares: (..., k) [rad/s] → [vx, vy, ω] (..., 3)."""
        return np.asarray(self._read_wheels(wheels) @ self._inverse.T)

    def wheel_speeds(self, twist: Floats) -> Array:
        """The wheel speeds of a body twist: [vx, vy, ω] (..., 3) → (..., k) [rad/s].

        Raises InputError for a twist that the wheels do not allow, such as a slide of a differential drive.
        """
        xi = as_floats(twist, "twist", last=(3,), largest=FARTHEST_POINT)
        self._check_allowed(xi)
        return np.asarray(xi @ self.wheel_matrix.T)

    def slip(self, wheels: Floats) -> Array:
        """What no twist explains of measured wheel speeds, w − J ξ: (..., k) [rad/s] → (..., k) [rad/s].

        It is zero for two wheels, which every twist of theirs explains; of more wheels it raises the alarm.
        """
        w = self._read_wheels(wheels)
        return np.asarray(w - w @ self._inverse.T @ self.wheel_matrix.T)

    def saturate(self, wheels: Floats) -> Array:
        """Wheel speeds scaled alike until none exceeds max_wheel_speed: (..., k) [rad/s] → (..., k).

        Scaled alike they keep the direction of the twist, and so the curvature of the path.
        """
        w = self._read_wheels(wheels)
        most = np.abs(w).max(axis=-1, keepdims=True)
        return np.asarray(w * np.where(most > self.max_wheel_speed, self.max_wheel_speed / most, 1.0))

    def drive(self, T_map_base: Any, twist: Floats, dt: Floats) -> Array:
        """The pose after a constant twist for a time, as cspace.mobile.drive: (..., 3, 3) → (..., 3, 3)."""
        return drive(T_map_base, twist, dt)

    @cached_property
    def _inverse(self) -> Array:
        N = self.allowed_twists
        return np.asarray(N @ np.linalg.pinv(self.wheel_matrix @ N))

    @abstractmethod
    def _rows(self) -> Array:
        """The wheel matrix J (k, 3)."""

    def _read_wheels(self, wheels: Floats) -> Array:
        return as_floats(wheels, "wheel speeds", last=(len(self.wheel_matrix),))

    def _check_allowed(self, xi: Array) -> None:
        N = self.allowed_twists
        rest = np.abs(xi - xi @ np.linalg.pinv(N).T @ N.T).max(axis=-1)
        beyond = rest > tolerances.SIDE_SLIP * np.maximum(1.0, np.abs(xi).max(axis=-1))
        if beyond.any():
            first = join_words([f"{x:g}" for x in xi[beyond][0]])
            raise InputError(
                f"the wheels of {name_type(self)} do not allow the twist [vx, vy, ω] = {first}; " + self._rule
            )

    _rule = "project it with vehicle.allowed_twists"


@tabulate()
@dataclass(frozen=True)
class DifferentialDrive(WheelBase):
    """Two driven wheels on one axle, left then right: rows (1, 0, ∓track/2)/r of J.

    wheel_radius [m]; track, the distance of the wheels [m]; max_wheel_speed [rad/s] of `saturate`. Base lies
    in the middle of the axle, x forwards. Raises InputError for a number that is not above zero.
    """

    wheel_radius: float = 0.05
    track: float = 0.3
    max_wheel_speed: float = inf

    def __post_init__(self) -> None:
        check_sizes(self)

    @cached_property
    def allowed_twists(self) -> Array:
        """N (3, 2): vx and ω."""
        return np.array([[1.0, 0.0], [0.0, 0.0], [0.0, 1.0]])

    def _rows(self) -> Array:
        half = 0.5 * self.track
        return np.array([[1.0, 0.0, -half], [1.0, 0.0, half]])

    _rule = "it cannot slide, so vy must be 0"


@show_fields
@dataclass(frozen=True)
class Omni(WheelBase):
    """Omnidirectional wheels on a circle: rows (−sin αᵢ, cos αᵢ, L)/r of J.

    wheel_radius [m]; angles αᵢ (k,) [rad], where the wheels are as seen from the centre, by default three,
    evenly; distance L of the wheels from it [m]; max_wheel_speed [rad/s]. A wheel rolls tangentially,
    counter- clockwise, and slides radially. Raises InputError for fewer than three wheels, or if all are on
    one line.
    """

    wheel_radius: float = 0.05
    angles: tuple[float, ...] = (np.pi / 3, np.pi, -np.pi / 3)
    distance: float = 0.2
    max_wheel_speed: float = inf

    def __post_init__(self) -> None:
        angles = as_floats(self.angles, "angles")
        if angles.ndim != 1 or len(angles) < 3:
            raise InputError(f"angles has shape {angles.shape}; give three angles or more, (k,) [rad]")
        object.__setattr__(self, "angles", tuple(map(float, angles)))
        check_sizes(self)
        if np.linalg.matrix_rank(self.wheel_matrix, tol=tolerances.SIDE_SLIP / self.wheel_radius) < 3:
            raise InputError("the wheels at these angles do not determine the twist; spread the angles")

    def _rows(self) -> Array:
        a = np.array(self.angles)
        return np.stack([-np.sin(a), np.cos(a), np.full_like(a, self.distance)], axis=-1)


@tabulate()
@dataclass(frozen=True)
class Mecanum(WheelBase):
    """Four mecanum wheels: rows (1, ∓1, ∓(lx + ly))/r of J, front left, front right, rear left, rear right.

    wheel_radius [m]; wheelbase 2 lx, from front to rear axle [m]; track 2 ly [m]; max_wheel_speed [rad/s].
    The rollers that touch the ground point towards the centre at the front (seen from above, the wheels form
    an X). Source: Muir & Neuman 1987.
    """

    wheel_radius: float = 0.05
    wheelbase: float = 0.4
    track: float = 0.3
    max_wheel_speed: float = inf

    def __post_init__(self) -> None:
        check_sizes(self)

    def _rows(self) -> Array:
        arm = 0.5 * (self.wheelbase + self.track)
        return np.array([[1.0, -1.0, -arm], [1.0, 1.0, arm], [1.0, 1.0, -arm], [1.0, -1.0, arm]])


@tabulate()
@dataclass(frozen=True)
class Tracked(WheelBase):
    """Two tracks, left then right, that turn about their instantaneous centres of rotation (ICR).

    Rows (1, 0, −y)/r of J with y the place of the ICR of a track across base, and vy = −x_icr ω: a tracked
    vehicle turns as a differential drive whose wheels are at its ICRs, farther out than its tracks.
    wheel_radius of the sprockets [m]; icr_left > 0 > icr_right and icr_x [m]; max_wheel_speed [rad/s].
    Tracked.symmetric(radius, width) has both at half of an effective width. Source: Martínez et al. 2005.
    """

    wheel_radius: float = 0.1
    icr_left: float = 0.4
    icr_right: float = -0.4
    icr_x: float = 0.0
    max_wheel_speed: float = inf

    def __post_init__(self) -> None:
        for name in ("icr_left", "icr_right", "icr_x"):
            object.__setattr__(self, name, one_number(getattr(self, name), name))
        if not self.icr_right < 0 < self.icr_left:
            raise InputError(
                f"icr_left is {self.icr_left:g} and icr_right {self.icr_right:g}; left is above zero, right"
                " below"
            )
        check_sizes(self, ("wheel_radius",))

    @classmethod
    def symmetric(cls, wheel_radius: float, width: float, *, max_wheel_speed: float = inf) -> Tracked:
        """Tracks with their ICRs at half of an effective width [m] to either side."""
        half = 0.5 * positive_number(width, "width")
        return cls(wheel_radius, half, -half, 0.0, max_wheel_speed)

    @cached_property
    def allowed_twists(self) -> Array:
        """N (3, 2): vx, and ω with the slide that it brings."""
        return np.array([[1.0, 0.0], [0.0, -self.icr_x], [0.0, 1.0]])

    def _rows(self) -> Array:
        return np.array([[1.0, 0.0, -self.icr_left], [1.0, 0.0, -self.icr_right]])

    _rule = "it slides by vy = −icr_x ω alone"


def check_sizes(vehicle: WheelBase, names: tuple[str, ...] = ()) -> None:
    """InputError for a size that is no number above zero, or a max_wheel_speed that is none (inf is one)."""
    known = [field.name for field in fields(vehicle)]  # type: ignore[arg-type]
    for name in names or [name for name in known if name not in ("angles", "max_wheel_speed")]:
        object.__setattr__(vehicle, name, positive_number(getattr(vehicle, name), name))
    limit: object = vehicle.max_wheel_speed
    if not (isinstance(limit, (float, np.floating)) and limit == inf):
        least = np.finfo(np.float64).smallest_subnormal
        speed = bounded_number(
            vehicle.max_wheel_speed, "max_wheel_speed", least, "give one number above zero, or inf"
        )
        object.__setattr__(vehicle, "max_wheel_speed", speed)
