"""Why a cell of the table of claims is not what is claimed: by row and column."""

from __future__ import annotations

NOTES = {
    ("potential_field", "map"): (
        "The lecture gives it a map. Walls farther away than ρ₀ do not act on it: a robot that senses as far "
        "as ρ₀ walks the same way."
    ),
}
