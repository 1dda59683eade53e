"""Shares that are estimated from samples: the standard error and the interval of Wilson."""

from __future__ import annotations

from typing import Any, Final

import numpy as np

from cspace.arrays import Array

NORMAL_95: Final = 1.959963984540054
"""Quantile of the standard normal distribution: 95 % of it lies between its negative and itself."""


def find_standard_error(share: Any, samples: int) -> Any:
    """The standard error √(p (1 − p)/n) of a share p (...) that was found in n samples."""
    return np.sqrt(share * (1.0 - share) / samples)


def find_wilson_interval(share: Any, samples: int) -> Array:
    """The interval (2, ...) that contains the true share with 95 % confidence, of one found in n samples.

    (p + z²/2n ± z √(p (1 − p)/n + z²/4n²)) / (1 + z²/n): unlike p ± z s it is no point at 0 and 1.

    Wilson 1927, "Probable inference, the law of succession, and statistical inference".
    """
    square = NORMAL_95**2 / samples
    middle = share + 0.5 * square
    half = NORMAL_95 * np.sqrt(share * (1.0 - share) / samples + 0.25 * square / samples)
    low, high = (middle - half) / (1.0 + square), (middle + half) / (1.0 + square)
    return np.stack([np.where(share == 0.0, 0.0, low), np.where(share == 1.0, 1.0, high)])
