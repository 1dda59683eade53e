"""Shared by the bug algorithms: hands, evidence, verdicts and traces.

Each robot receives only sensor readings of walls, and nothing else of the world. A robot keeps a hand on
the wall: with the left hand the wall is on its left.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final, NamedTuple

import numpy as np
import numpy.typing as npt

from cspace import _core
from cspace.arrays import Array
from cspace.errors import suggest
from cspace.navigation.text import counted
from cspace.search.trace import Trace

if TYPE_CHECKING:
    from cspace.navigation.route import Route

__all__ = ["BUG_1", "BUG_2", "TANGENT_BUG", "BugEvidence", "hand_of", "reason", "search", "traced"]

BUG_1: Final = 0
BUG_2: Final = 1
TANGENT_BUG: Final = 2

HANDS: Final = {"left": 0, "right": 1}
EITHER: Final = 2
WORDS: Final = ("go", "hit", "follow", "leave")


class BugEvidence(NamedTuple):
    """The k stretches of wall that a robot followed, and the loop that encloses its goal."""

    hits: Array
    """(k, 2) [m]: where it met a wall."""
    leaves: Array
    """(k, 2) [m]: where it left that wall, or stopped."""
    walked: Array
    """(k,) [m]: the distance followed along the wall."""
    rings: npt.NDArray[np.int64]
    """(k,): the boundary loop, an index of `world.walls`."""
    shut: tuple[int, tuple[float, float]] | None
    """For an unreachable goal: the boundary loop that encloses it, and a point (x, y) of the loop where the
    line to the goal enters the wall; else None."""


def hand_of(hand: object) -> int:
    """The number of a hand; UnknownNameError suggests the nearest name."""
    number = HANDS.get(hand) if isinstance(hand, str) else None
    if number is None:
        raise suggest("hand", hand, HANDS)
    return number


def search(
    world: Any,
    start: Any,
    goal: Any,
    name: str,
    options: dict[str, Any],
    kind: int,
    hand: int,
    reach: float = 0.0,
) -> Route:
    """Runs a robot from start to goal (2,) [m]; hand: its number; reach [m]: the range of its sensor."""
    made: Route | None
    made = _core._bug(world, name, options, BugEvidence, world._core, kind, hand, reach, start, goal)
    if made is None:
        ends = world.check_free(start, "start"), world.check_free(goal, "goal")
        made = _core._bug(world, name, options, BugEvidence, world._core, kind, hand, reach, *ends)
        assert made is not None
    return made


def traced(route: Route, kind: int, hand: int, reach: float = 0.0) -> Trace:
    """The motion: straight lines "go" and stretches "follow" along walls, with "hit" and "leave" between
    them. start, end: (k, 2) [m]. value [m]: the distance followed along the wall, else the remaining
    distance to the goal."""
    return Trace(WORDS, *_core._bug_trace(route.world._core, kind, hand, reach, route.start, route.goal))


def reason(route: Route) -> str:
    """The verdict of a robot without a map, as one sentence."""
    found: BugEvidence = route.evidence
    walls = len(found.rings)
    if route:
        return f"arrived after {route.length:.6g} m, having followed walls {counted(walls, 'time')}"
    if found.shut is None:
        return f"gave up after {route.length:.6g} m: rounding hides which walls are nearer to the goal"
    ring, (x, y) = found.shut
    return (
        f"the robot followed the whole ring of walls {ring}, and the goal lies beyond it: "
        f"at ({x:.6g}, {y:.6g}) the line to the goal enters the wall"
    )
