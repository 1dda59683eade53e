"""Why there is no path, in words."""

from __future__ import annotations

from typing import Any

from cspace.tables import count_things


def explain_division(world: Any) -> str:
    """Why there is no path in a PolygonWorld whose free space has several parts."""
    parts = count_things(world.components, "part")
    return f"walls separate start from goal: no path connects the {parts} of free space"


def explain_entry(at: tuple[float, float]) -> str:
    """Where the line to an unreachable goal enters the boundary loop that encloses it."""
    return f"at ({at[0]:.6g}, {at[1]:.6g}) the line to the goal enters the wall"
