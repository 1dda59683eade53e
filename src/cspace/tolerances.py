"""Every threshold of the library: its name, its unit and the reason for its value."""

from __future__ import annotations

from typing import Final

__all__ = ["AXIS_LENGTH", "INERTIA_SYMMETRY", "ROTATION_ERROR", "ROTATION_PROJECTION"]

ROTATION_ERROR: Final = 1e-6
"""Largest ‖RᵀR − I‖ (max norm, unitless) accepted as a rotation: a matrix typed with seven digits passes, a
shear or a scaled matrix does not."""

ROTATION_PROJECTION: Final = 0.1
"""Largest ‖RᵀR − I‖ that projection to the nearest rotation mends: beyond it the input is no worn rotation
but another matrix, and the nearest rotation would be an invention."""

AXIS_LENGTH: Final = 1e-6
"""Shortest vector accepted as a joint axis (unitless, or m where a DH or CAD tool exports lengths): below it
the direction is made of rounding noise, and the file most likely meant zero."""

INERTIA_SYMMETRY: Final = 1e-6
"""Largest difference of opposite inertia entries, relative to the largest entry (at least 1 kg·m²): tables
are printed with six digits; more is a typing error."""
