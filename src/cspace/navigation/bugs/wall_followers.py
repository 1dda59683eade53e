"""Bug algorithms that follow walls: Bug 1, Bug 2 and Tangent Bug.

Each robot receives only sensor readings of walls, and nothing else of the world. A robot keeps a hand on
the wall: with the left hand the wall is on its left.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import inf
from typing import Any, ClassVar, Final, NamedTuple

import numpy as np
import numpy.typing as npt

from cspace import _core
from cspace.arrays import Array
from cspace.navigation.planner import PlanePlanner
from cspace.navigation.route import Route
from cspace.navigation.text import explain_entry
from cspace.search import option
from cspace.tables import count_things, show_fields

HANDS: Final = {"left": 0, "right": 1, None: 2}
"""The numbers of hands in the compiled core; None: either."""


@show_fields
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


class WallFollower(PlanePlanner):
    """A robot without a map that follows walls in a PolygonWorld.

    route.path is the path travelled even where no path exists; route.evidence is a BugEvidence; route.stats
    counts the pieces of wall and the straight lines followed. The trace contains straight lines "go" and
    stretches "follow" along walls, with "hit" and "leave" between them; its value is the distance followed
    along the wall [m], else the remaining distance to the goal [m].
    """

    sensing = "contact"
    events = ("go", "hit", "follow", "leave")
    kind: ClassVar[int]
    """The number of the algorithm in the core."""

    @cached_property
    def _settings(self) -> tuple[int, int, float]:
        """The algorithm, the hand, the range of the sensor [m]."""
        return self.kind, HANDS[self.values["hand"]], self.values.get("range", 0.0)

    def _search(self, traced: bool, world: Any, start: Any, goal: Any) -> Any:
        return _core._bug(traced, world, world._core, self, start, goal, *self._settings, BugEvidence)

    def explain_route(self, route: Route) -> str:
        found: BugEvidence = route.evidence
        walls = len(found.rings)
        if route:
            return (
                f"reached the goal after {route.length:.6g} m; followed walls {count_things(walls, 'time')}"
            )
        if found.shut is None:
            return f"stopped after {route.length:.6g} m: rounding hides which walls are nearer to the goal"
        ring, at = found.shut
        loop = f"the robot followed the whole boundary loop {ring}, which separates it from the goal"
        return f"{loop}: {explain_entry(at)}"


@dataclass(frozen=True, eq=False)
class ContactBug(WallFollower):
    """A wall follower that only feels walls."""

    hand: str = option(
        "left",
        'the side of the robot on which it keeps the wall, "left" or "right".',
        choices=("left", "right"),
    )


class Bug1(ContactBug):
    """Bug 1: circumnavigates each obstacle and leaves it at the point nearest to the goal (Lumelsky &
    Stepanov 1987).

    A robot with only a contact sensor moves straight to the goal. At a wall it follows the whole boundary
    loop, returns the shorter way to the loop's point nearest to the goal and leaves the wall there. No loop
    is met twice. The path is therefore no longer than the distance from start to goal plus one and a half
    times the perimeters of the loops met. If the line to the goal enters the wall at that point, no path
    exists.
    """

    name = "bug_1"
    summary = "walks around each obstacle and leaves at the point nearest to the goal; contact sensor"
    kind = 0


class Bug2(ContactBug):
    """Bug 2: follows the M-line from start to goal, and walls back to it (Lumelsky & Stepanov 1987).

    A robot with only a contact sensor follows the line from start to goal, the M-line. At a wall it follows
    the wall to a point of the M-line that is nearer to the goal and from which the line is free. If it
    returns to the point where it met the wall, no path exists. The path is no longer than the distance from
    start to goal plus, for each boundary loop, its perimeter times the number of times the line enters it.
    """

    name = "bug_2"
    summary = "follows walls back to the line from start to goal; contact sensor"
    kind = 1


@dataclass(frozen=True, eq=False)
class TangentBug(WallFollower):
    """Tangent Bug: moves toward the visible edge with the shortest estimated path (Kamon, Rimon & Rivlin
    1998).

    A range sensor detects walls up to a distance. The robot moves to the goal, and passes an obstacle at the
    visible edge that minimises the estimated remaining path. Where every visible edge is farther from the
    goal than the robot itself, it follows the wall. It leaves the wall when a visible point is nearer to the
    goal than every point of the wall followed so far. A boundary loop that has been followed completely is
    judged as in Bug 1.
    """

    name = "tangent_bug"
    summary = "follows the visible tangents of obstacles; range sensor"
    sensing = "range"
    kind = 2

    hand: str | None = option(
        None,
        'the side of the robot on which it keeps the wall, "left" or "right"; None turns it to the better '
        "visible edge.",
        choices=("left", "right"),
    )
    range: float = option(
        inf,
        "of the sensor; 0 is contact only, inf is limited only by walls.",
        unit="m",
        minimum=0,
        may_be_infinite=True,
    )
