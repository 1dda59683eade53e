"""The options of planners as data: whole, in words, and the same that routes say are in force."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

import cspace as cs
from cspace.navigation import PLANNERS

YARD = [[(2, 2), (5, 2), (5, 5), (2, 5)], [(6, 1), (8.5, 1.5), (7, 4)]]
OFF = {"costs", "hand", "neighbours"}
"""Options with None for a value in its own right, which their meaning explains."""
ALL = [(name, option) for name, row in PLANNERS.items() for option in row.options.values()]


@pytest.mark.parametrize(("planner", "option"), ALL, ids=[f"{p}.{o.name}" for p, o in ALL])
def test_every_option_is_told(planner, option):
    (field,) = (f for f in dataclasses.fields(PLANNERS[planner]) if f.name == option.name)
    assert option.default is field.default
    assert option.type.split(" | ")[0] == field.type.split(" | ")[0]
    assert option.type
    assert option.meaning.endswith(".")
    assert not any(word in option.meaning for word in ("route.evidence", "Error", "status", "as for"))
    if option.default is None:
        assert "default" in option.meaning or "None" in option.meaning


def test_units_are_told_of_lengths():
    units = {option.name: option.unit for _, option in ALL}
    assert units["step"] == units["rho_0"] == units["range"] == units["slow_within"] == "m"
    assert units["hand"] == units["samples"] == ""


@pytest.mark.parametrize("planner", sorted(PLANNERS))
def test_routes_say_what_is_in_force(planner):
    world = cs.PolygonWorld(YARD, bounds=(0, 0, 10, 10))
    route = cs.navigate(world, (1, 1), (9, 9), planner)
    assert list(route.options) == list(PLANNERS[planner].options)
    assert all(value is not None for name, value in route.options.items() if name not in OFF)
    again = cs.navigate(world, (1, 1), (9, 9), planner, **route.options)
    assert again.options == route.options
    assert np.array_equal(again.path, route.path)
    assert again.length == route.length
