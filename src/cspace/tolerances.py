"""Every threshold of the library: its name, its unit and the reason for its value."""

from __future__ import annotations

from typing import Final

__all__ = ["ROTATION_ERROR", "ROTATION_PROJECTION"]

ROTATION_ERROR: Final = 1e-6
"""Largest ‖RᵀR − I‖ (max norm, unitless) accepted as a rotation: a matrix typed with seven digits passes, a
shear or a scaled matrix does not."""

ROTATION_PROJECTION: Final = 0.1
"""Largest ‖RᵀR − I‖ that projection to the nearest rotation mends: beyond it the input is no worn rotation
but another matrix, and the nearest rotation would be an invention."""
