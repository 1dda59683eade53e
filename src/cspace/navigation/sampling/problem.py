"""What the planners that draw samples share: their options, their one bound call, their words."""

from __future__ import annotations

import operator
from typing import TYPE_CHECKING, Any, Final, NamedTuple

import numpy as np

from cspace import _core
from cspace.arrays import as_floats, as_generator
from cspace.errors import InputError, InputTypeError
from cspace.navigation.text import counted, divided
from cspace.search.trace import Trace
from cspace.tolerances import SAMPLE_STEP

if TYPE_CHECKING:
    from cspace.maps import PolygonWorld
    from cspace.navigation.route import Route

__all__ = ["Sampled", "ask", "count_of", "fraction_of", "seed_of", "step_of", "trace_of"]
__all__ += ["tree_options", "verdict_of"]

WORDS: Final = ("connect", "rewire")
KINDS: Final = ("prm", "rrt", "rrt_star")
MOST_SAMPLES: Final = 10**8


class Sampled(NamedTuple):
    """What a planner that draws samples has done; all 0 where no path can exist."""

    samples: int
    """Points drawn from free space, or the goal in their place."""
    nodes: int
    """Points kept, start among them."""
    edges: int
    """Segments tested."""


def ask(world: PolygonWorld, planner: str, options: dict[str, Any], start: Any, goal: Any) -> Route:
    """The route of a planner with checked options."""
    given = world, planner, options, Sampled, world._core
    settings = _settings(planner, options)
    route: Route | None = _core._sampling(*given, start, goal, settings)
    if route is None:
        ends = world.check_free(start, "start"), world.check_free(goal, "goal")
        route = _core._sampling(*given, *ends, settings)
        assert route is not None
    return route


def trace_of(route: Route) -> Trace:
    """The search again, with the same samples."""
    settings = _settings(route.planner, route.options)
    return Trace(WORDS, *_core._sampling_trace(route.world._core, route.start, route.goal, settings))


def verdict_of(route: Route, found: str) -> str:
    """The verdict as one sentence; `found` where there is a path."""
    done: Sampled = route.evidence
    tried = f"{counted(done.samples, 'sample')}, {counted(done.nodes, 'node')}"
    if route:
        return found
    if route.status == "unreachable":
        return f"{divided(route.world.components)}; this is known from the map, without a sample"
    return (
        f"no path among {tried} and {counted(done.edges, 'segment')} tested; that "
        "proves nothing: one exists, and more samples= may find it"
    )


def _settings(planner: str, options: dict[str, Any]) -> tuple[int, int, int, int, float, float]:
    return (
        KINDS.index(planner),
        options["samples"],
        options["rng"],
        options.get("neighbours") or 0,
        options.get("step", 1.0),
        options.get("goal_bias", 0.0),
    )


def tree_options(
    world: PolygonWorld,
    samples: int,
    step: float | None,
    goal_bias: float,
    rng: int | np.random.Generator | None,
) -> dict[str, Any]:
    """The options of a planner that grows a tree, checked."""
    return {
        "samples": count_of("samples", samples, 1),
        "step": step_of(world, step),
        "goal_bias": fraction_of("goal_bias", goal_bias),
        "rng": seed_of(rng),
    }


def seed_of(rng: int | np.random.Generator | None) -> int:
    """64 bits from an int, a Generator or None; InputError for an int that does not fit."""
    generator = as_generator(rng)
    if rng is None or isinstance(rng, np.random.Generator):
        return int(generator.integers(2**64, dtype=np.uint64))
    if rng >= 2**64:
        raise InputError(f"rng is {rng}; a seed must be below 2**64")
    return int(rng)


def count_of(name: str, value: Any, least: int, most: int = MOST_SAMPLES) -> int:
    """A whole number between two bounds; InputTypeError and InputError name what is not."""
    try:
        count = None if isinstance(value, bool) else operator.index(value)
    except TypeError:
        count = None
    if count is None:
        raise InputTypeError(f"{name} is a {type(value).__name__}; it must be a whole number")
    if not least <= count <= most:
        raise InputError(f"{name} is {count}; it must be {least} to {most}")
    return count


def step_of(world: PolygonWorld, step: float | None) -> float:
    """The longest step [m] as given, or that of the world; InputError where it is not positive."""
    if step is None:
        left, low, right, high = world.bounds
        return float(SAMPLE_STEP * max(right - left, high - low))
    length = _number("step", step)
    if not length > 0:
        raise InputError(f"step is {length:g}; it must be positive [m]")
    return length


def fraction_of(name: str, value: float) -> float:
    """A number from 0 to 1; InputError elsewhere."""
    fraction = _number(name, value)
    if not 0 <= fraction <= 1:
        raise InputError(f"{name} is {fraction:g}; it must be 0 to 1")
    return fraction


def _number(name: str, value: Any) -> float:
    array = as_floats(value, name)
    if array.shape != ():
        raise InputError(f"{name} has shape {array.shape}; it must be one number")
    return float(array)
