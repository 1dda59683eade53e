"""Angles modulo 2π."""

from __future__ import annotations

from typing import Final

import numpy as np

from cspace.arrays import Array

TURN: Final = 2.0 * np.pi


def wrap_angle(angle: Array) -> Array:
    """Angles (...) in (−π, π] [rad]."""
    return np.pi - np.mod(np.pi - angle, TURN)


def wrap_near(angle: Array | float, seed: Array | float) -> Array:
    """Angles (...) moved by the multiples of 2π that bring them closest to a seed, which broadcasts."""
    return np.asarray(angle - TURN * np.round((angle - seed) / TURN))
