"""Planners are values: checked when they are made, compared, copied and pickled; users write their own."""

from __future__ import annotations

import copy
import dataclasses
import pickle
from dataclasses import dataclass

import numpy as np
import pytest

import cspace as cs
from cspace.errors import InputError, InputTypeError, UnknownNameError
from cspace.navigation import PLANNERS, PlanePlanner, option

nav = cs.navigation
SHED = cs.PolygonWorld([[(4, 2), (6, 2), (6, 8), (4, 8)]], (0, 0, 10, 10))


@dataclass(frozen=True)
class Corner(PlanePlanner):
    """By way of one point."""

    x: float = option(5.0, "of the point.", unit="m")
    y: float = option(9.5, "of the point.", unit="m", minimum=0, maximum=10)

    def plan(self, world, start, goal):
        path = [start, (self.x, self.y), goal]
        return self.make_route(world, start, goal, path if world.path_clearance(path) > 0 else ())


@pytest.mark.parametrize("planner", PLANNERS.values(), ids=PLANNERS)
def test_planners_are_values(planner):
    again = type(planner)(**planner.values)
    assert again == planner
    assert hash(again) == hash(planner)
    assert copy.deepcopy(planner) == pickle.loads(pickle.dumps(planner)) == planner
    assert planner.name in PLANNERS
    for field in dataclasses.fields(planner):
        with pytest.raises(dataclasses.FrozenInstanceError):
            setattr(planner, field.name, getattr(planner, field.name))


def test_planners_with_other_values_are_others():
    assert nav.AStar(metric="manhattan") != nav.AStar() != nav.Dijkstra()
    costs = np.ones((2, 3))
    assert nav.AStar(costs=costs) == nav.AStar(costs=costs.copy()) != nav.AStar(costs=costs + 1)


def test_an_object_answers_as_its_name_does():
    for planner in (nav.AStar(corners="one"), nav.RRT(rng=3, step=2.0), nav.PotentialField(rho_0=1.0)):
        route = cs.navigate(SHED, (1, 5), (9, 5), planner)
        named = cs.navigate(SHED, (1, 5), (9, 5), planner.name, **route.options)
        np.testing.assert_array_equal(route.path, named.path)
        assert (route.planner, route.options, route.reason) == (planner.name, named.options, named.reason)
        more = cs.navigate(SHED, (1, 5), (9, 5), type(planner)(), **route.options)
        np.testing.assert_array_equal(route.path, more.path)


def test_plans_with_different_options_do_not_mix():
    """The values in force are kept with a planner: those of one world do not reach another."""
    wide = cs.PolygonWorld([], (0, 0, 100, 100))
    planner = nav.RRT(rng=1)
    for world, step in ((SHED, 1.0), (wide, 10.0), (SHED, 1.0)):
        assert cs.navigate(world, (1, 5), (9, 5), planner).options["step"] == step
    assert planner.step is None


def test_a_planner_of_a_user():
    route = cs.navigate(SHED, (1, 5), (9, 5), Corner())
    assert route
    assert route.length == pytest.approx(2 * np.hypot(4, 4.5))
    assert (route.planner, route.options, len(route.trace)) == ("Corner", {"x": 5.0, "y": 9.5}, 0)
    low = cs.navigate(SHED, (1, 5), (9, 5), Corner(y=5))
    assert (low.status, low.reason) == ("undetermined", "no path was found")
    grown = cs.navigate(SHED, (1, 5), (9, 5), Corner(), radius=0.2)
    assert grown.world.bounds == (0.2, 0.2, 9.8, 9.8)
    again = pickle.loads(pickle.dumps(route))
    assert (again.length, again.options, again.reason) == (route.length, route.options, route.reason)
    grid = SHED.to_grid(0.5)
    assert cs.navigate(grid, (1, 5), (9, 5), Corner()).world.kind == "polygons"


@pytest.mark.parametrize(
    ("make", "error", "said"),
    [
        (lambda: Corner(y=11), InputError, "y is 11; it must be 0 to 10"),
        (lambda: Corner(y=np.nan), InputError, "y holds nan; all must be finite"),
        (lambda: nav.AStar(metric="octal"), UnknownNameError, "no metric 'octal'.* did you mean 'octile'"),
        (
            lambda: nav.RRT(step=0),
            InputError,
            r"step is 0; it must be positive \[m\], or None for the default",
        ),
        (lambda: nav.TangentBug(range=-1), InputError, "range is -1; it must be zero or more .*, or inf"),
        (lambda: nav.PRM(samples=True), InputTypeError, "samples is a bool; it must be a whole number"),
        (lambda: cs.navigate(SHED, (1, 5), (9, 5), nav.AStar), InputTypeError, r"give an object: AStar\(\)"),
        (lambda: cs.navigate(SHED, (1, 5), (9, 5), Corner(), z=1), InputTypeError, "no option 'z'"),
        (lambda: cs.navigate(SHED, (1, 5), (9, 5), 7), UnknownNameError, "no planner '7'"),
        (lambda: PlanePlanner().plan(SHED, (1, 5), (9, 5)), NotImplementedError, "defines no plan"),
    ],
)
def test_a_wrong_value_is_named(make, error, said):
    with pytest.raises(error, match=said):
        make()


def test_a_planner_that_is_not_derived_is_named():
    class Own:
        def plan(self, world, start, goal): ...

    with pytest.raises(InputTypeError, match="type Own; derive its class from PlanePlanner"):
        cs.navigate(SHED, (1, 5), (9, 5), Own())
