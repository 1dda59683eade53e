"""Models of sensors: what a pose makes them read, and how uncertain that is."""

from __future__ import annotations

from dataclasses import dataclass
from math import inf, pi

from cspace.arrays import one_array, one_number, positive_number
from cspace.errors import InputError


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
        if self.most_range != inf:
            set_positive(self, "most_range")
        if self.bearing_sigma > pi:
            raise InputError(f"bearing_sigma is {self.bearing_sigma:g} rad; give radians, below π")


@dataclass(frozen=True)
class Compass:
    """A sensor of the heading. sigma [rad]: its standard deviation. bias [rad]: what it reads too much, such
    as
    the declination. Raises InputError for a deviation that is not above zero."""

    sigma: float = 0.05
    bias: float = 0.0

    def __post_init__(self) -> None:
        set_positive(self, "sigma")
        object.__setattr__(self, "bias", one_number(self.bias, "bias"))


@dataclass(frozen=True)
class Gps:
    """A sensor of its own position. sigma [m]: standard deviation of x and of y. lever (2,): where on base
    its
    antenna is [m]. Raises InputError for a deviation that is not above zero."""

    sigma: float = 2.0
    lever: tuple[float, float] = (0.0, 0.0)

    def __post_init__(self) -> None:
        set_positive(self, "sigma")
        object.__setattr__(self, "lever", tuple(map(float, one_array(self.lever, "lever", (2,)))))


def set_positive(sensor: RangeBearing | Compass | Gps, *names: str) -> None:
    """InputError for a field that is no number above zero."""
    for name in names:
        object.__setattr__(sensor, name, positive_number(getattr(sensor, name), name))


def read_share(value: float, subject: str) -> float:
    """A number in (0, 1); InputError for others."""
    share = one_number(value, subject)
    if not 0.0 < share < 1.0:
        raise InputError(f"{subject} is {value!r}; it must lie between 0 and 1")
    return share
