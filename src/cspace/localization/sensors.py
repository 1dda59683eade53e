"""Models of sensors: what a pose makes them read, and how uncertain that is."""

from __future__ import annotations

from dataclasses import dataclass
from math import inf, pi
from typing import Final, TypeVar

import numpy as np

from cspace.arrays import Array, bounded_number, one_array, one_number, positive_number, whole_number
from cspace.errors import InputError, check_kind, check_known
from cspace.tables import show_fields


@show_fields
@dataclass(frozen=True)
class RangeBearing:
    """A sensor that measures ranges and bearings of landmarks, or only one of the two.

    range_sigma [m], bearing_sigma [rad]: standard deviations. range_bias [m], bearing_bias [rad]: what it
    reads too much. delay [s]: how late its stamps are. mount: pose x, y, θ of the sensor on base (3,) [m,
    rad]. most_range [m] and field_of_view [rad], centred on its x axis: which landmarks it can see; readings
    without a name are associated with these alone. Raises InputError for a deviation that is not above zero.
    """

    range_sigma: float = 0.15
    bearing_sigma: float = 0.015
    range_bias: float = 0.0
    bearing_bias: float = 0.0
    delay: float = 0.0
    mount: tuple[float, float, float] = (0.0, 0.0, 0.0)
    most_range: float = inf
    field_of_view: float = 2 * pi

    def __post_init__(self) -> None:
        set_positive(self, "range_sigma", "bearing_sigma", "field_of_view")
        for name in ("range_bias", "bearing_bias", "delay"):
            object.__setattr__(self, name, one_number(getattr(self, name), name))
        object.__setattr__(self, "mount", tuple(map(float, one_array(self.mount, "mount", (3,)))))
        if not is_unlimited(self.most_range):
            set_positive(self, "most_range")
        if self.bearing_sigma > pi:
            raise InputError(f"bearing_sigma is {self.bearing_sigma:g} rad; give radians, below π")


@show_fields
@dataclass(frozen=True)
class Compass:
    """A sensor of the heading. sigma [rad]: its standard deviation. bias [rad]: what it reads too much, such
    as the declination. Raises InputError for a deviation that is not above zero."""

    sigma: float = 0.05
    bias: float = 0.0

    def __post_init__(self) -> None:
        set_positive(self, "sigma")
        object.__setattr__(self, "bias", one_number(self.bias, "bias"))


@show_fields
@dataclass(frozen=True)
class Gps:
    """A sensor of its own position. sigma [m]: standard deviation of x and of y. lever (2,): where on base
    its antenna is [m]. Raises InputError for a deviation that is not above zero."""

    sigma: float = 2.0
    lever: tuple[float, float] = (0.0, 0.0)

    def __post_init__(self) -> None:
        set_positive(self, "sigma")
        object.__setattr__(self, "lever", tuple(map(float, one_array(self.lever, "lever", (2,)))))


LASER_MODELS: Final = ("likelihood_field", "beam")
"""How a particle filter may weigh a scan."""
MOST_BEAMS: Final = 10_000
"""The most beams of a scan."""


@show_fields
@dataclass(frozen=True)
class LaserScanner:
    """A planar laser range finder, as particle filters weigh its scans and as `simulate` draws them.

    model: "likelihood_field" (how near the ends of beams are to walls) or "beam" (along each ray). beams: how
    many of a scan are used, spread evenly along what it saw. independent: how many independent beams a scan
    counts for, as the errors of beams next to each other are not independent. sigma [m]: the standard
    deviation of the distance of an end from its wall, errors of the map included. floor: the likelihood of a
    beam that ends anywhere, over that on a wall. least_range, most_range [m]: what is used of a scan.

    For "beam" and `simulate`: range_sigma [m] of a range; hit, short, max, rand: shares of beams that end on
    the wall, before it, nowhere, and anywhere, which are scaled to the sum 1; short_rate [1/m] of the ends
    before the wall. For `simulate`: readings: beams of a scan; field_of_view [rad]; mount: pose x, y, θ of
    the laser on base (3,). Raises InputError for values outside of their ranges. Source: Thrun, Burgard & Fox
    2005, sections 6.3 and 6.4.
    """

    model: str = "likelihood_field"
    beams: int = 60
    independent: float = 12.0
    sigma: float = 0.1
    floor: float = 0.1
    least_range: float = 0.1
    most_range: float = 25.0
    range_sigma: float = 0.03
    hit: float = 0.85
    short: float = 0.05
    max: float = 0.05
    rand: float = 0.05
    short_rate: float = 0.5
    readings: int = 181
    field_of_view: float = pi
    mount: tuple[float, float, float] = (0.0, 0.0, 0.0)

    def __post_init__(self) -> None:
        check_known("model of a laser scanner", self.model, LASER_MODELS)
        set_positive(self, "independent", "sigma", "most_range", "range_sigma", "short_rate", "field_of_view")
        for name in ("beams", "readings"):
            object.__setattr__(self, name, whole_number(getattr(self, name), name, 1, MOST_BEAMS))
        object.__setattr__(self, "floor", read_share(self.floor, "floor"))
        for name in ("least_range", "hit", "short", "max", "rand"):
            value = bounded_number(getattr(self, name), name, 0.0, "it must not be below zero")
            object.__setattr__(self, name, value)
        object.__setattr__(self, "mount", tuple(map(float, one_array(self.mount, "mount", (3,)))))
        if not self.hit > 0 or not self.rand > 0:
            raise InputError(
                "hit and rand are shares of beams above zero; without rand a beam excludes poses"
            )
        if self.least_range >= self.most_range:
            raise InputError(
                f"least_range is {self.least_range:g} m and most_range {self.most_range:g} m; it must be less"
            )

    @property
    def angles(self) -> Array:
        """The directions of the beams that `simulate` draws, (readings,) [rad], in the frame of the laser."""
        half = 0.5 * self.field_of_view
        return np.linspace(-half, half, self.readings)

    @property
    def shares(self) -> tuple[float, float, float, float]:
        """Hit, short, max and rand, of sum 1."""
        total = self.hit + self.short + self.max + self.rand
        return self.hit / total, self.short / total, self.max / total, self.rand / total


Sensor = TypeVar("Sensor", RangeBearing, LaserScanner, Compass, Gps)


def read_sensor(sensor: object, kind: type[Sensor], subject: str = "sensor") -> Sensor:
    """A sensor of a kind, with its defaults where none is given."""
    if sensor is None:
        return kind()
    check_kind(subject, sensor, kind, f"give a cspace.localization.{kind.__name__}(...)")
    assert isinstance(sensor, kind)
    return sensor


def set_positive(sensor: RangeBearing | Compass | Gps | LaserScanner, *names: str) -> None:
    """InputError for a field that is no number above zero."""
    for name in names:
        object.__setattr__(sensor, name, positive_number(getattr(sensor, name), name))


def is_unlimited(value: object) -> bool:
    """Whether a value is the number inf."""
    return isinstance(value, (float, np.floating)) and value == inf


def read_share(value: float, subject: str) -> float:
    """A number in (0, 1); InputError for others."""
    share = one_number(value, subject)
    if not 0.0 < share < 1.0:
        raise InputError(f"{subject} is {value!r}; it must lie between 0 and 1")
    return share
