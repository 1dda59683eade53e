"""What a planner answers: a path, or why there is none, and what finding it cost."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final, NamedTuple

from cspace import _core
from cspace.arrays import Array
from cspace.errors import Renamed
from cspace.tables import count_things, show_fields, tabulate

if TYPE_CHECKING:
    from cspace.search.planner import Trace

STATUSES: Final = ("found", "unreachable", "undetermined", "local_minimum")
"""The verdicts, in the order of the compiled core."""


@show_fields
class Stats(NamedTuple):
    """What a search cost."""

    nodes: int
    """States expanded, or steps taken."""
    edges: int
    """Edges looked at."""
    seconds: float
    """Wall time of the compiled search."""


@tabulate("status", "reason", "planner", "length", "path", "stats")
class Route(Renamed, _core.RouteBase):
    """The answer of one planner to one question; truthy if a path was found.

    path: (m, 2) [m] from start to goal, (1, 2) where they are the same point; of a robot that walks, the
    walk it made, also where it came to rest elsewhere or proved that no path exists. length [m] of the
    path, whatever the verdict; inf where the path is empty, as it is of planners with a map that find no
    way. start, goal: (2,) [m]. world, planner: what was asked. `status` is "found", "unreachable" (proven),
    "undetermined" (the search ended without a proof) or "local_minimum"; `reason` says it as one sentence.
    """

    @property
    def status(self) -> str:
        """The verdict: "found", "unreachable", "undetermined" or "local_minimum"."""
        return STATUSES[self._verdict]

    @property
    def reason(self) -> str:
        """The verdict as one sentence, with what backs it."""
        if self and len(self.path) == 1:
            return "start and goal are the same point"
        said: str = getattr(self._evidence, "reason", None) or self._asked.explain_route(self)
        if self.world.kind == "grid" and self._given_world.kind == "polygons":
            said += f"; polygons became cells of {self.world.resolution:g} m"
        return said

    @property
    def planner(self) -> str:
        """The name of the planner."""
        name: str = self._asked.name
        return name

    @property
    def stats(self) -> Stats:
        """Nodes, edges and seconds that the search took."""
        return Stats(*self._numbers)

    @property
    def evidence(self) -> Any:
        """What backs the verdict: each planner's page says what it is; None where path and status say all."""
        return self._evidence

    @property
    def trace(self) -> Trace:
        """What the planner did, event after event; made by asking it once more with a record kept."""
        if "trace" not in self.__dict__:
            self.__dict__["trace"] = self._asked.trace_route(self)
        made: Trace = self.__dict__["trace"]
        return made

    @property
    def options(self) -> dict[str, Any]:
        """The options of the planner with the values in force: those that were given, and the defaults as
        they came out for this world."""
        return dict(self._asked.values)

    @property
    def clearance(self) -> float:
        """The least distance [m] between the path and a wall of the world that was asked; NaN without a path.

        A wall is a side of a polygon or of the bounds, in a grid the square of a blocked cell or the border.
        It is that of the robot's centre: of a disc, `radius` less is left beside it.
        """
        if (least := self.__dict__.get("clearance")) is None:
            least = self.__dict__["clearance"] = self._given_world.path_clearance(self.path)
        return float(least)

    @property
    def _given_world(self) -> Any:
        """The world before it was grown by a radius, or converted."""
        return self.__dict__.get("given_world", self.world)

    def __reduce__(self) -> tuple[Any, ...]:
        """What it was made from: copies and pickles are made from that again."""
        ends, found = (self.start, self.goal), (self.status, self.path, self.length)
        made = (self.world, self._asked, ends, *found, self.stats, self.evidence)
        return new_route, made, {"given_world": self._given_world}

    def __repr__(self) -> str:
        if self:
            return (
                f"<Route {self.planner}: found, {self.length:.6g} m, {count_things(len(self.path), 'point')}>"
            )
        return f"<Route {self.planner}: {self.status}>"


_core._route_class(Route)


def new_route(
    world: Any,
    planner: Any,
    ends: tuple[Array, Array],
    status: str,
    path: Array,
    length: float,
    stats: Stats,
    evidence: Any = None,
) -> Route:
    """A route of a planner with the options in force. path: (m, 2) [m]; ends: start and goal, (2,) each."""
    verdict = STATUSES.index(status)
    made: Route = _core._route_make(world, planner, *ends, verdict, path, length, *stats, evidence)
    return made
