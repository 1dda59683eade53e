"""Counts and steps whose arrays exceed any memory are refused by name."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

import cspace as cs

MANY = 10**15

CALLS: dict[str, Callable[[], Any]] = {
    f"n is {MANY}": lambda: cs.load_robot("ur5e").random_configuration(MANY),
    f"n is {10**18}": lambda: cs.load_robot("ur5e").random_configuration(10**18),
    f"size is {MANY}": lambda: cs.random_pose(MANY),
    f"size is ({MANY}, 10)": lambda: cs.random_rotation((MANY, 10)),
    f"size is {10**15 + 1}": lambda: cs.random_pose_2d(10**15 + 1),
    f"size is {10**18}": lambda: cs.random_rotation_2d(10**18),
    "spacing is 1e-15": lambda: cs.navigation.dubins((0, 0, 0), (10, 0, 1), 1.0).sample(1e-15),
    "spacing is 1e-300": lambda: cs.navigation.reeds_shepp((0, 0, 0), (10, 0, 1), 1.0).sample(1e-300),
}


@pytest.mark.parametrize("message", CALLS)
def test_what_exceeds_the_memory_is_refused_by_name(message: str) -> None:
    with pytest.raises(cs.errors.InputError, match=r"exceed the memory, (draw fewer|give a larger)") as told:
        CALLS[message]()
    assert str(told.value).startswith(message)
