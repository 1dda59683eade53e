"""The feasible intervals of a redundant joint for one goal."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, replace

import numpy as np

from cspace import _core
from cspace.arrays import Array, as_floats, whole_number
from cspace.errors import InputError, Renamed
from cspace.ik.solver import Solver
from cspace.math.wrapping import wrap_near
from cspace.tables import html_table, one_line, shown, tabulate
from cspace.tolerances import FARTHEST, ON_LIMIT

MOST_SAMPLES = 100_000
"""Values of a free joint that one call answers for."""


@tabulate()
@dataclass(frozen=True, eq=False)
class Interval:
    """Values of the parameter, lower to upper [rad or m], at which one branch keeps all limits.

    branch: its number, as in the names of solutions; for arms without a closed form, and with a parameter of
    one's own choice, the pieces of the self-motion between its turns are numbered instead. None is longer
    than 2π. ends: what ends it below and above: a joint at a limit ("elbow at lower limit"), a "fold", where
    the branch meets another one and both vanish, or "nothing" for a full revolution and where a longer piece
    is cut. q (dof,): a configuration inside it.
    """

    lower: float
    upper: float
    branch: int
    ends: tuple[str, str]
    q: Array
    _slides: bool = field(repr=False, default=False)

    def __repr__(self) -> str:
        ends = f"{self.lower:.6g} … {self.upper:.6g}, from {self.ends[0]} to {self.ends[1]}"
        return one_line("Interval", f"branch {self.branch}: {ends}")

    def __contains__(self, value: object) -> bool:
        number = float(value)  # type: ignore[arg-type]
        if not self._slides and math.isfinite(number):
            number = float(wrap_near(number, 0.5 * (self.lower + self.upper)))
        return self.lower - ON_LIMIT <= number <= self.upper + ON_LIMIT


@dataclass(frozen=True, eq=False)
class Redundancy(Renamed):
    """The feasible intervals of a parameter for one goal, falsy if there is none.

    parameter: the joint that is locked. intervals: sorted by branch and lower end; they are computed from
    the limits that joints reach and from the folds of the branches, not sampled. complete: whether none is
    missing. Changes closer together than 1e-6 (1e-4 for axes rounded in a file) count as one, so an
    interval shorter than that may be left out.
    """

    solver: Solver
    goal: Array
    parameter: str
    intervals: tuple[Interval, ...]
    complete: bool
    _slides: bool = field(repr=False, default=False)

    def __bool__(self) -> bool:
        return bool(self.intervals)

    def __len__(self) -> int:
        return len(self.intervals)

    def __iter__(self) -> Iterator[Interval]:
        return iter(self.intervals)

    def _of_arm(self, solver: Solver, joints: Callable[[Array], Array]) -> Redundancy:
        """The same for an arm with other joints. joints: the configuration of that arm from one of this."""
        rows = tuple(replace(interval, q=joints(interval.q)) for interval in self.intervals)
        return replace(self, solver=solver, intervals=rows)

    def feasible(self, value: float) -> tuple[int, ...]:
        """The branches that keep all limits at this value of the parameter [rad or m], up to turns of 2π."""
        number = as_floats(value, "value", largest=FARTHEST)
        if number.ndim:
            raise InputError(f"value has shape {number.shape}, expected one number; call it in a loop")
        return tuple(interval.branch for interval in self.intervals if value in interval)

    def union(self) -> Array:
        """Where some branch is feasible: disjoint (lower, upper), ascending, (k, 2)."""
        return np.array(_core._ik_union(self._ends), dtype=np.float64).reshape(-1, 2)

    def spread(self, n: int) -> Array:
        """n values of the parameter, (n,): the middles of n equal parts of all that is feasible."""
        count = whole_number(n, "n", 1, MOST_SAMPLES)
        return np.array(_core._ik_spread(self._ends, count), dtype=np.float64)

    @property
    def _ends(self) -> list[tuple[float, float]]:
        return [(float(i.lower), float(i.upper)) for i in self.intervals]

    @property
    def _title(self) -> str:
        unit = "m" if self._slides else "rad"
        if not self:
            return f"{self.solver.name} reaches the goal within its limits for no value of {self.parameter}"
        more = "" if self.complete else "; some may be missing"
        return f"{self.solver.name}: feasible intervals of {self.parameter} [{unit}]{more}"

    def __repr__(self) -> str:
        return one_line("Redundancy", f"of {self.solver.name} in {self.parameter}: {len(self)} intervals")

    def _repr_html_(self) -> str:
        rows = [[str(i.branch), shown(i.lower), shown(i.upper), *i.ends] for i in self.intervals]
        return html_table(self._title, ["branch", "lower", "upper", "from", "to"], rows)

    def __str__(self) -> str:
        rows = [
            f"  branch {i.branch:2d}  {i.lower: .6f} … {i.upper: .6f}  from {i.ends[0]} to {i.ends[1]}"
            for i in self.intervals
        ]
        return "\n".join([self._title, *rows])
