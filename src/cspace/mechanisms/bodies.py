"""The links of the ready-made mechanisms: uniform rods and discs."""

from __future__ import annotations

import numpy as np

from cspace.arrays import Array, positive_number
from cspace.model import Inertial


def make_rod(mass: float, length: float, axis: int = 0) -> Inertial:
    """A thin uniform rod from the origin along an axis of its frame. mass [kg], length [m]; axis: its
    number."""
    direction = np.eye(3)[axis]
    across = np.eye(3) - np.outer(direction, direction)
    return Inertial(mass, 0.5 * length * direction, mass * length**2 / 12.0 * across)


def make_disc(mass: float, radius: float) -> Inertial:
    """A thin uniform disc about the origin, its normal along z. mass [kg], radius [m]."""
    return Inertial(mass, np.zeros(3), mass * radius**2 * np.diag([0.25, 0.25, 0.5]))


def check_lengths(lengths: dict[str, float]) -> dict[str, float]:
    """Lengths by name [m]. Raises InputError for one that is not positive."""
    return {name: positive_number(value, name, "it must be above zero") for name, value in lengths.items()}


def rotate_vector(angle: float, length: float) -> Array:
    """The vector (2,) of a length [m] at an angle [rad]."""
    result: Array = length * np.array([np.cos(angle), np.sin(angle)])
    return result
