"""What planners compute of a world once, kept with the world."""

from __future__ import annotations

from collections.abc import Callable, Hashable
from typing import Any, TypeVar

from cspace import _core

T = TypeVar("T")


def keep_with(world: Any, slot: str, key: Hashable, make: Callable[[], T], most: int = 1) -> T:
    """What `make` returns, kept in a slot of the world for the next call with a key; `most` keys stay."""
    kept: dict[Hashable, T] = vars(world).setdefault(slot, {})
    if key not in kept:
        while len(kept) >= most:
            kept.pop(next(iter(kept)))
        kept[key] = make()
    return kept[key]


def clearance_field(grid: Any) -> Any:
    """The ClearanceField of a grid: the distances of its cells from walls."""
    return keep_with(grid, "_clearance", None, lambda: _core.ClearanceField(grid))
