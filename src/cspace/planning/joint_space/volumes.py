"""Volume: how much of a configuration space is free, by random samples."""

from __future__ import annotations

from dataclasses import dataclass

from cspace.planning.joint_space.shares import find_standard_error, find_wilson_interval
from cspace.tables import one_line, tabulate


@tabulate()
@dataclass(frozen=True)
class Volume:
    """The free share of the configurations within the limits, and what blocks the others.

    share: free. self_share: the robot touches itself or what it carries. obstacle_share: it touches obstacles
    alone. The three add up to one. samples: uniform ones. complete: whether it was as many as asked for,
    before the time was up. size [rad and m, to the power of their numbers]: of everything within the limits.
    limit_share: what the limits leave of one turn of each revolute joint, as a product; exact.
    """

    share: float
    self_share: float
    obstacle_share: float
    samples: int
    complete: bool
    size: float
    limit_share: float

    @property
    def standard_error(self) -> float:
        """The standard error of `share`."""
        return float(find_standard_error(self.share, self.samples))

    @property
    def interval(self) -> tuple[float, float]:
        """Between which numbers the true share lies with 95 % confidence (Wilson 1927)."""
        low, high = find_wilson_interval(self.share, self.samples).tolist()
        return low, high

    @property
    def free_size(self) -> float:
        """The volume of free space [as `size`]: its share of `size`."""
        return self.share * self.size

    def __repr__(self) -> str:
        low, high = self.interval
        return one_line(
            "Volume",
            f"{self.share:.2%} free ({low:.2%} to {high:.2%}), {self.self_share:.2%} touch themselves,"
            f" {self.obstacle_share:.2%} obstacles; {self.samples} samples",
        )
