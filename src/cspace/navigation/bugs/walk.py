"""What the planners without a map share: hands, evidence, verdicts in words, traces.

Each of them is shown a robot that feels (or sees) walls, and nothing else of the world. A robot keeps a hand
on the wall: with the left hand it walks with the wall on its left.
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
    """The stretches that a robot followed walls, k of them, and what shuts off its goal."""

    hits: Array
    """(k, 2) [m]: where it met a wall."""
    leaves: Array
    """(k, 2) [m]: where it left that wall again, or ended."""
    walked: Array
    """(k,) [m]: how far it followed the wall."""
    rings: npt.NDArray[np.int64]
    """(k,): the ring of walls, an index of `world.walls`."""
    shut: tuple[int, tuple[float, float]] | None
    """Unreachable: the ring that shuts the goal off, and a point (x, y) of it where the line to the goal
    enters the wall; else None."""


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
    """Lets a robot walk from start to goal (2,) [m]; hand: its number; reach [m]: how far the robot sees."""
    made: Route | None
    made = _core._bug(world, name, options, BugEvidence, world._core, kind, hand, reach, start, goal)
    if made is None:
        ends = world.check_free(start, "start"), world.check_free(goal, "goal")
        made = _core._bug(world, name, options, BugEvidence, world._core, kind, hand, reach, *ends)
        assert made is not None
    return made


def traced(route: Route, kind: int, hand: int, reach: float = 0.0) -> Trace:
    """The walk: straight ways "go" and stretches "follow" along walls, with "hit" and "leave" between them.

    start, end: (k, 2) [m]. value [m]: how far the wall has been followed, else the distance left to the goal.
    """
    return Trace(WORDS, *_core._bug_trace(route.world._core, kind, hand, reach, route.start, route.goal))


def reason(route: Route) -> str:
    """The verdict of a robot without a map, in a sentence."""
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
