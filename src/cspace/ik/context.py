"""What a result carries beside its rows when its goal is not a plain pose."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from cspace.arrays import Array

__all__ = ["About"]


@dataclass(frozen=True, eq=False)
class About:
    """Beside the solutions of one goal.

    goal: what was asked, an object with residual(T), a sentence as text, and value, the goal as the user
    gave it; None for a pose. whole, q: the arm with the joints that stand for what the goal leaves open, and
    its configurations, row by row. freedom: the names of the parameters that the goal leaves free.
    """

    goal: Any = None
    whole: Any = None
    q: Array | None = None
    freedom: tuple[str, ...] = ()

    def take(self, rows: Any) -> About:
        """The same beside some of the solutions."""
        return About(self.goal, self.whole, None if self.q is None else self.q[rows], self.freedom)
