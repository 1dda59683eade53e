"""Plan: a path of configurations, or why there is none."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from cspace.arrays import Array, positive_number
from cspace.errors import InputError, Renamed
from cspace.planning.plan_files import write_path
from cspace.tables import one_line, shown, tabulate

if TYPE_CHECKING:
    from cspace.planning.space import ArmSpace
    from cspace.search import Planner

STATUSES = ("found", "unreachable", "undetermined", "local_minimum", "invalid_start", "invalid_goal")
"""What a plan can be: only "found" has a path; "unreachable" is proved; "undetermined" used up its budget;
"local_minimum" is where the descent of a potential stopped away from the goal."""

CLEARANCE_STEP = 1.0 / 32.0
"""Distance of the configurations at which `Plan.clearance` looks [L2 norm of the joints]."""


@tabulate()
@dataclass(frozen=True, eq=False)
class Plan(Renamed):
    """A way of an arm from a start to a goal; truthy if there is one.

    status: one of STATUSES. reason: the verdict in words. path (m, dof) [rad or m]: the corners, joined by
    straight motions; the first is the start and the last the goal as given (a joint that wraps ends at the
    goal plus a multiple of 2π); (0, dof) without a path. cost: its length (L2 norm of the joints); inf
    without. start, goal: which of those given, −1 without. certified: every motion is proved free over its
    whole length. stats: what the search did, and seconds per stage. space, planner: as used.
    """

    status: str
    reason: str
    path: Array
    cost: float
    start: int
    goal: int
    certified: bool
    stats: Mapping[str, Any]
    space: ArmSpace
    planner: Planner

    _elsewhere: ClassVar = MappingProxyType(
        dict.fromkeys(("waypoints", "q"), "path has the corners, sample(step) configurations between them")
        | dict.fromkeys(("success", "solved", "found"), "a Plan is truthy if there is a path")
        | {"length": "use cost", "trajectory": "a path has no times, only corners"}
    )

    def __post_init__(self) -> None:
        object.__setattr__(self, "reason", add_remark(self.reason, self.space))

    @classmethod
    def _of_fields(cls, *, reason: str, space: ArmSpace, **fields: Any) -> Plan:
        """As Plan(**fields), in a sixth of its time."""
        made = object.__new__(cls)
        made.__dict__.update(fields, reason=add_remark(reason, space), space=space)
        return made

    def __bool__(self) -> bool:
        return self.status == "found"

    def __len__(self) -> int:
        """The number of corners of the path."""
        return len(self.path)

    def sample(self, step: float = CLEARANCE_STEP) -> Array:
        """Configurations (k, dof) along the path, at most `step` apart (L2 norm), corners included.

        Raises InputError for a step that is not positive.
        """
        step = positive_number(step, "step", "it must be one positive number [rad or m]")
        if not len(self.path):
            return self.path
        rows = [self.path[:1]]
        for a, b in zip(self.path[:-1], self.path[1:], strict=True):
            n = max(1, int(np.ceil(np.linalg.norm(b - a) / step)))
            rows.append(a + np.linspace(0.0, 1.0, n + 1)[1:, None] * (b - a))
        return np.concatenate(rows)

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the corners of the path, by the ending of the file as YAML, JSON or CSV.

        Angles are in radians. The file is complete or untouched. Raises InputError for another ending, and
        for a plan without a path.
        """
        if not len(self.path):
            raise InputError(f"the plan has no path to save: {self.reason}")
        write_path(path, self.space.geometry, self.path, certified=self.certified)

    @cached_property
    def clearance(self) -> float:
        """The least distance from a contact at samples along the path [m]; inf with nothing to touch."""
        found = self.space.clearance(self.sample()).distance if len(self.path) else [np.inf]
        return float(np.min(found))

    def __repr__(self) -> str:
        if not self:
            return one_line("Plan", f"{self.status}: {self.reason}")
        proof = "certified" if self.certified else "not certified"
        return one_line("Plan", f"found: {len(self)} corners, cost {shown(self.cost)}, {proof}")


def add_remark(reason: str, space: ArmSpace) -> str:
    """The reason, with what the links are taken for where that is not their shapes."""
    remark = space.geometry.remark
    return reason if remark in reason else reason + remark
