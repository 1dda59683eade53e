"""Counted things in sentences."""

from __future__ import annotations

__all__ = ["counted", "divided"]


def counted(number: int, noun: str, plural: str = "") -> str:
    """ "1 cell", "2 cells": a number and what it counts; plural: where it is not the noun and an s."""
    return f"{number} {noun if number == 1 else plural or noun + 's'}"


def divided(parts: int) -> str:
    """Why there is no path in a world whose free space has several parts."""
    return f"walls divide start from goal: no path connects the {counted(parts, 'part')} of free space"
