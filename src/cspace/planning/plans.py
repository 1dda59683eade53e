"""Plans: the plans of many problems, each made when it is first read."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from cspace.arrays import Array
from cspace.planning.plan_result import Plan
from cspace.tables import html_table, one_line, shown


class PlanSource:
    """Plans by number. One that is not given is made when it is first read, and kept.

    A subclass defines `_make_plan`, and may define `path`. dof: of the configurations.
    """

    def __init__(self, plans: Iterable[Plan | None], dof: int) -> None:
        self._plans, self.dof = list(plans), dof

    def read(self, k: int) -> Plan:
        """Plan k, the same object each time."""
        plan = self._plans[k]
        if plan is None:
            plan = self._plans[k] = self._make_plan(k)
        return plan

    def path(self, k: int) -> Array:
        """The path of plan k (m, dof)."""
        return self.read(k).path

    def _make_plan(self, k: int) -> Plan:
        raise NotImplementedError(f"{type(self).__name__} defines no _make_plan(k)")


class Plans(Sequence[Plan]):
    """The plans of many problems: plans[k] is a Plan, and a slice has some of them.

    status: of each. cost (n,): inf without a path. corners (n,): how many corners each path has, 0 without
    one. found (n,): which have one. path (n, m, dof): the corners, NaN beyond the last of each.

    All of these are there at once. A Plan with its reason and statistics is made when it is first read.
    """

    def __init__(self, plans: Iterable[Plan]) -> None:
        made = list(plans)
        self._fill(
            PlanSource(made, made[0].space.dof if made else 0),
            range(len(made)),
            tuple(each.status for each in made),
            np.array([each.cost for each in made], dtype=np.float64),
            np.array([len(each) for each in made], dtype=np.int64),
        )

    def _fill(
        self,
        source: PlanSource,
        numbers: range,
        status: tuple[str, ...],
        cost: Array,
        corners: npt.NDArray[np.int64],
    ) -> None:
        self._source, self._numbers = source, numbers
        self.status, self.cost, self.corners = status, cost, corners
        self.found = np.isfinite(cost)

    @classmethod
    def _of_source(
        cls,
        source: PlanSource,
        numbers: range,
        status: tuple[str, ...],
        cost: Array,
        corners: npt.NDArray[np.int64],
    ) -> Plans:
        """The plans of these numbers, with what is known of them before they are made."""
        made = cls.__new__(cls)
        made._fill(source, numbers, status, cost, corners)
        return made

    def _replace(self, count: int, others: Mapping[int, Plan], places: Sequence[int]) -> Plans:
        """So many plans: these at their places, and others by number, which come first."""
        if not others:
            return self
        plans = [others.get(k) for k in range(count)]
        status, cost = [""] * count, np.empty(count)
        corners = np.empty(count, dtype=np.int64)
        origin = dict(zip(places, range(len(self)), strict=True))
        for n, k in enumerate(places):
            status[k], cost[k], corners[k] = self.status[n], self.cost[n], self.corners[n]
        for k, each in others.items():
            status[k], cost[k], corners[k] = each.status, each.cost, len(each)
        source = _PlacedPlans(plans, self, origin)
        return self._of_source(source, range(count), tuple(status), cost, corners)

    @property
    def path(self) -> Array:
        """The corners (n, m, dof), NaN beyond the last of each."""
        shape = len(self), int(self.corners.max(initial=0)), self._source.dof
        rows: Array = np.full(shape, np.nan, dtype=np.float64)
        for row, k, n in zip(rows, self._numbers, self.corners.tolist(), strict=True):
            row[:n] = self._source.path(k)
        return rows

    def __len__(self) -> int:
        return len(self._numbers)

    def __getitem__(self, k: Any) -> Any:
        numbers = self._numbers[k]
        if not isinstance(numbers, range):
            return self._source.read(numbers)
        return self._of_source(self._source, numbers, self.status[k], self.cost[k], self.corners[k])

    def __reduce__(self) -> tuple[type[Plans], tuple[list[Plan]]]:
        """All plans, made."""
        return type(self), (list(self),)

    def __repr__(self) -> str:
        counts = ", ".join(f"{n} {status}" for status, n in Counter(self.status).items())
        return one_line(
            "Plans", f"of {len(self)} problem{'' if len(self) == 1 else 's'}{': ' if counts else ''}{counts}"
        )

    def _repr_html_(self) -> str:
        columns = self.status, self.corners.tolist(), self.cost.tolist()
        rows = [
            (str(k), status, str(corners), shown(cost))
            for k, (status, corners, cost) in enumerate(zip(*columns, strict=True))
        ]
        return html_table(repr(self)[1:-1], ("problem", "status", "corners", "cost"), rows)


class _PlacedPlans(PlanSource):
    """Plans that are given, and those of others at their places."""

    def __init__(self, plans: Iterable[Plan | None], others: Plans, origin: Mapping[int, int]) -> None:
        super().__init__(plans, others._source.dof)
        self._others, self._origin = others, origin

    def path(self, k: int) -> Array:
        """See PlanSource."""
        plan, others = self._plans[k], self._others
        return others._source.path(others._numbers[self._origin[k]]) if plan is None else plan.path

    def _make_plan(self, k: int) -> Plan:
        plan: Plan = self._others[self._origin[k]]
        return plan
