"""LaserSlam: where the robot was, the map, the graph, and every loop with what became of it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

from cspace.arrays import Array
from cspace.errors import check_known
from cspace.localization.graph import PoseGraph
from cspace.localization.log import Scans
from cspace.maps import EvidenceGrid
from cspace.mobile import TimedPoses
from cspace.tables import count_things, one_line, show_fields, tabulate


@show_fields
class LoopClosure(NamedTuple):
    """A scan that was matched against those of an earlier pass."""

    first: int
    """The row of the earlier scan."""
    second: int
    """The row of the later one."""
    pose: Array
    """Of the later one in the earlier one, (3,): x, y [m], θ [rad]."""
    covariance: Array
    """(3, 3) of ξ in T exp ξ, at the later one."""
    score: float
    """Of the match, 0 to 1."""
    accepted: bool
    reason: str
    """Why it was rejected, or "accepted"."""


@show_fields
@dataclass(frozen=True)
class LaserSlamStats:
    """What was done: scans used, and skipped because the odometry does not cover their times; scans that no
    match confirmed; searches of loops; loops accepted and rejected; optimizations while driving; the factors
    of the odometry (distance, turn, drift [rad/m]); seconds of wall time."""

    scans: int
    skipped: int
    unmatched: int
    tried: int
    accepted: int
    rejected: int
    optimizations: int
    factors: tuple[float, float, float]
    seconds: float


@tabulate()
@dataclass(frozen=True, eq=False, repr=False)
class LaserSlam:
    """A drive with its map; truthy if the robot is localised on it at the end.

    times (n,) [s]: of the scans. poses (n, 3): x, y [m], θ [rad] of base, in the frame of `start`.
    covariances (n, 3, 3) of ξ in T exp ξ, in base. graph: the PoseGraph with the poses as its start, the
    accepted loops after the edges between neighbouring scans. loops: every loop that was found. stages:
    trajectories by name, "odometry", "calibrated", "matched" and "closed", as far as each was done. scans:
    those that were used. scores (n,): of their matches, 0 to 1; 0 where none confirms the odometry, NaN for
    the first one. status: "mapped", "lost" (the last scans match nothing) or "time_limit"; reason.
    """

    times: Array
    poses: Array
    covariances: Array
    graph: PoseGraph
    loops: tuple[LoopClosure, ...]
    stages: Mapping[str, TimedPoses]
    scans: Scans
    scores: Array
    status: str
    reason: str
    stats: LaserSlamStats
    resolution: float
    max_range: float

    def __bool__(self) -> bool:
        return self.status == "mapped"

    def __len__(self) -> int:
        """How many poses there are."""
        return len(self.times)

    def __repr__(self) -> str:
        s = self.stats
        text = f"{count_things(len(self), 'pose')}, {count_things(s.accepted, 'loop')}: {self.status}"
        return one_line("LaserSlam", text)

    @cached_property
    def map(self) -> EvidenceGrid:
        """The map of the scans at the poses."""
        return self.map_at("closed" if "closed" in self.stages else "matched")

    def map_at(self, stage: str) -> EvidenceGrid:
        """The map of the scans at the poses of a stage; UnknownNameError for one that is not there."""
        check_known("stage", stage, self.stages)
        return EvidenceGrid.from_scans(
            self.scans, self.stages[stage].poses, self.resolution, max_range=self.max_range
        )
