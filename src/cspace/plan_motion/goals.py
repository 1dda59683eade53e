"""Goals: the configurations of a goal, or why there are none."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, TypeAlias

from numpy.typing import ArrayLike

from cspace.arrays import Array
from cspace.planning import Region
from cspace.spatial.checks import PoseLike

GoalLike: TypeAlias = ArrayLike | PoseLike | Mapping[str, Any] | Region
"""A goal as `plan` takes it."""


@dataclass(frozen=True, eq=False)
class Goals:
    """The configurations of a goal.

    rows (g, dof) [rad or m]. reason: why there are none. is_given: they were given as configurations.
    is_whole: they are all that reach the goal, not samples. find_more: where they are few samples, a function
    that takes many; None otherwise.
    """

    rows: Array
    reason: str = ""
    is_given: bool = False
    is_whole: bool = True
    find_more: Callable[[], Goals] | None = None

    @property
    def status(self) -> str:
        """Of a plan to it if none of its rows can be reached."""
        return "unreachable" if self.is_whole else "undetermined"
