"""The angular velocity of a rotation exp(φ) whose rotation vector moves, and its rate."""

from __future__ import annotations

from typing import Final

import numpy as np

from cspace.arrays import Array
from cspace.spatial.vectors import cross

SMALL_ANGLE: Final = 0.1
"""[rad] Below, the factors are summed as series: their closed forms lose digits."""


def angular_rates(turn: Array, rate: Array, bend: Array) -> tuple[Array, Array]:
    """ω and ω' of the rotation exp(φ), in fixed axes, from φ, φ' and φ'' (n, 3).

    ω = φ' + a φ×φ' + b φ×(φ×φ') with a = (1 − cos θ)/θ², b = (θ − sin θ)/θ³, θ = |φ| (the left Jacobian of
    SO(3); Chirikjian 2012, section 10.7); ω' is its derivative.
    """
    a, b, a_slope, b_slope = left_jacobian_factors(np.sum(turn * turn, axis=1))
    squared_rate = 2.0 * np.sum(turn * rate, axis=1, keepdims=True)  # of θ²
    once = cross(turn, rate)
    twice = cross(turn, once)
    omega = rate + a * once + b * twice
    once_rate = cross(turn, bend)
    twice_rate = cross(rate, once) + cross(turn, once_rate)
    slope = squared_rate * (a_slope * once + b_slope * twice)
    return omega, bend + a * once_rate + b * twice_rate + slope


def left_jacobian_factors(squared: Array) -> tuple[Array, Array, Array, Array]:
    """a, b and their derivatives by θ², each (n, 1), from θ² (n,)."""
    x = squared[:, None]
    small = x < SMALL_ANGLE**2
    safe = np.where(small, 1.0, x)
    angle = np.sqrt(safe)
    sine, cosine = np.sin(angle), np.cos(angle)
    a, b = (1.0 - cosine) / safe, (angle - sine) / (safe * angle)
    a_slope = (0.5 * sine / angle - a) / safe
    b_slope = (0.5 * (1.0 - cosine) / safe - 1.5 * b) / safe
    series = (
        1 / 2 - x * (1 / 24 - x * (1 / 720 - x / 40320)),
        1 / 6 - x * (1 / 120 - x * (1 / 5040 - x / 362880)),
        -1 / 24 + x * (1 / 360 - x * (1 / 13440 - x / 907200)),
        -1 / 120 + x * (1 / 2520 - x * (1 / 120960 - x / 9979200)),
    )
    pairs = zip(series, (a, b, a_slope, b_slope), strict=True)
    first, second, third, fourth = (np.where(small, near, far) for near, far in pairs)
    return first, second, third, fourth
