"""Counted things in sentences."""

from __future__ import annotations

from typing import Any


def count_things(number: int, noun: str, plural: str = "") -> str:
    """ "1 cell", "2 cells": a number and what it counts; plural: where it is not the noun and an s."""
    return f"{number} {noun if number == 1 else plural or noun + 's'}"


def explain_division(world: Any) -> str:
    """Why there is no path in a PolygonWorld whose free space has several parts."""
    parts = count_things(world.components, "part")
    return f"walls separate start from goal: no path connects the {parts} of free space"


def explain_entry(at: tuple[float, float]) -> str:
    """Where the line to an unreachable goal enters the boundary loop that encloses it."""
    return f"at ({at[0]:.6g}, {at[1]:.6g}) the line to the goal enters the wall"
