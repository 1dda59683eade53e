"""Colours that differ in hue alone: equally light, equally strong, so that no ghost outshines another."""

from __future__ import annotations

from typing import Final

import numpy as np

from cspace.arrays import Array

INK: Final = (0.16, 0.19, 0.24)
"""Text, outlines."""
LINK: Final = (0.90, 0.91, 0.925)
"""The links of a solid robot."""
JOINT: Final = (0.28, 0.56, 0.88)
"""The joints of a solid robot."""
BARRED: Final = (0.50, 0.51, 0.53)
"""Configurations out of limits: without a hue."""
STAND: Final = (0.80, 0.82, 0.85)
"""The pillar below a robot whose base is above the floor."""
AXES: Final = ((0.84, 0.18, 0.20), (0.18, 0.62, 0.28), (0.16, 0.38, 0.88))
"""The x, y and z axes of a frame."""
WALL: Final = (0.36, 0.39, 0.44)
"""Obstacles."""
OBSTACLE: Final = (0.93, 0.84, 0.70)
"""Obstacles around an arm."""
PUSHING: Final = (0.95, 0.62, 0.50)
"""Obstacles that push an arm where its descent stopped."""
CARRIED: Final = (0.55, 0.75, 0.45)
"""Objects that an arm carries."""
PATH: Final = AXES[0]
"""The path that a planner found, and a vehicle's forwards."""
FIRST_HUE: Final = 252.0
"""Hue of the first colour [deg]: a calm blue."""

RGB_OF_LMS: Final = np.array(
    [
        [4.0767416621, -3.3077115913, 0.2309699292],
        [-1.2684380046, 2.6097574011, -0.3413193965],
        [-0.0041960863, -0.7034186147, 1.7076147010],
    ]
)
LMS_OF_LAB: Final = np.array(
    [
        [1.0, 0.3963377774, 0.2158037573],
        [1.0, -0.1055613458, -0.0638541728],
        [1.0, -0.0894841775, -1.2914855480],
    ]
)


def color_of_oklch(lightness: float, chroma: float, hue: float) -> Array:
    """The sRGB colour (3,) in [0, 1] of a lightness, a chroma and a hue [deg] in OKLab (Ottosson 2020)."""
    h = np.radians(hue)
    lab = np.array([lightness, chroma * np.cos(h), chroma * np.sin(h)])
    linear = np.clip(RGB_OF_LMS @ (LMS_OF_LAB @ lab) ** 3, 0.0, 1.0)
    srgb = np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)
    return np.asarray(srgb, dtype=np.float64)


def make_palette(count: int) -> Array:
    """`count` colours (count, 3), evenly spaced in hue; neighbours in the list are far apart where it helps.

    Up to eight go around the circle in order (a family of solutions reads as a rainbow); more alternate
    between two lightnesses so that close hues still differ.
    """
    hues = FIRST_HUE + 360.0 * np.arange(count) / max(count, 1)
    light = [0.66 if count <= 8 or k % 2 == 0 else 0.52 for k in range(count)]
    return np.array([color_of_oklch(light[k], 0.145, hues[k]) for k in range(count)]).reshape(count, 3)


def mix_colors(
    color: Array | tuple[float, float, float], other: tuple[float, float, float], share: float
) -> Array:
    """`color` with a share of `other` in it."""
    return (1.0 - share) * np.asarray(color, dtype=np.float64) + share * np.asarray(other, dtype=np.float64)
