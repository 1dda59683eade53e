"""Angles modulo 2π."""

from __future__ import annotations

from typing import Final

import numpy as np

from cspace.arrays import Array

TURN: Final = 2.0 * np.pi


def wrap_angle(angle: Array) -> Array:
    """Angles (...) in (−π, π] [rad]."""
    return np.pi - np.mod(np.pi - angle, TURN)


def count_turns(difference: Array | float) -> Array:
    """How many times 2π the multiple of 2π nearest to differences (...) is."""
    return np.asarray(np.round(difference / TURN))


def wrap_near(angle: Array | float, seed: Array | float) -> Array:
    """Angles (...) moved by the multiples of 2π that bring them closest to a seed, which broadcasts."""
    return np.asarray(angle - TURN * count_turns(angle - seed))


def wrap_above(angle: Array, start: Array | float) -> Array:
    """Angles (...) moved by multiples of 2π into [start, start + 2π); the start broadcasts."""
    return np.asarray(start + np.mod(angle - start, TURN))


def turns_within(
    least: Array | float, most: Array | float, lower: Array | float, upper: Array | float
) -> tuple[Array, Array]:
    """The fewest and the most turns that move angles from `least` to `most` between limits; the fewest exceed
    the most where none do."""
    with np.errstate(invalid="ignore"):  # limits at infinity
        return np.ceil((lower - least) / TURN), np.floor((upper - most) / TURN)
