"""The content of an explanation: the geometry, the steps, the equations."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Final

import numpy as np

from cspace.arrays import Array, as_floats, leading_axes
from cspace.errors import Renamed
from cspace.ik.explain.page import Block
from cspace.ik.explain.survey import InvariantDirection, InvariantPoint, Relation
from cspace.math import Equation, MatrixEquation
from cspace.spatial import as_pose
from cspace.tables import show_fields
from cspace.tolerances import FARTHEST

Values = Callable[[Array, Array], dict[str, Any]]
"""From configurations and the poses that they reach to the numbers of the symbols."""


WAYS: Final = {"subproblem 3": 2, "subproblem 4": 2, "subproblem 5": 4, "subproblem 6": 4}
"""How many answers a subproblem has at most; one if it is not listed."""


@show_fields
@dataclass(frozen=True, eq=False)
class Step:
    """One step of a solver. finds: the unknowns, as $t_1$. words: what happens, a sentence.

    equations: what holds, definitions first. method: what solves it. ways: how many answers it has at most.
    angles: what the equations of a closed form fix, by joints: "3", "1 5" for two, "234" for a sum.
    """

    finds: str
    words: str
    equations: tuple[Equation | MatrixEquation, ...] = ()
    method: str = ""
    ways: int = 1
    angles: str = ""

    @classmethod
    def of_angles(cls, angles: str, method: str, words: str, *equations: Equation) -> Step:
        """A step that fixes angles."""
        finds = "t_" + ", t_".join(word if len(word) == 1 else f"{{{word}}}" for word in angles.split())
        if len(angles) > 1 and " " not in angles:
            finds += " = " + " + ".join(f"t_{i}" for i in angles)
        return cls(f"${finds}$", words, equations, method, WAYS.get(method, 1), angles)


@dataclass(frozen=True, eq=False)
class Findings(Renamed):
    """The content of an IkPlan, which says what the fields are."""

    robot: str
    joints: tuple[str, ...]
    family: str = "none"
    summary: str = ""
    branches: int = 0
    reason: str = ""
    relations: tuple[Relation, ...] = ()
    invariant_points: tuple[InvariantPoint, ...] = ()
    invariant_directions: tuple[InvariantDirection, ...] = ()
    notes: tuple[str, ...] = ()
    tables: Mapping[str, Block] = field(default_factory=dict)
    matrices: Mapping[str, Array] = field(default_factory=dict)
    constants: Mapping[str, float] = field(default_factory=dict)
    steps: tuple[Step, ...] = ()
    locked: tuple[str, ...] = ()
    counted: str = ""
    calls: tuple[str, ...] = ()
    other_ways: Mapping[str, tuple[Step, ...]] = field(default_factory=dict)
    length: float = 1.0
    _values: Values | None = field(default=None, repr=False)
    _other_values: Values | None = field(default=None, repr=False)
    _dof: int | None = field(default=None, repr=False)

    def __bool__(self) -> bool:
        return not self.reason

    @property
    def equations(self) -> tuple[Equation | MatrixEquation, ...]:
        """Every equation of every step, in order, those of other ways behind."""
        ways = (self.steps, *self.other_ways.values())
        return tuple(equation for steps in ways for step in steps for equation in step.equations)

    def residuals(self, q: Any, T: Any) -> Array:
        """How far each equation is off, (..., k), at configurations q (..., n) that reach T (..., 4, 4).

        Lengths count in units of the arm's length. Definitions introduce symbols for those behind them and
        are never off. Raises InputError for a wrong shape, NaN, and a value that is not a pose.
        """
        n = len(self.joints) if self._dof is None else self._dof
        q, T = as_floats(q, "q", last=(n,), largest=FARTHEST), as_pose(T, "T")
        shape = leading_axes(q=q.shape[:-1], T=T.shape[:-2])
        q = np.broadcast_to(q, (*shape, n))
        if self._values is None:
            return np.zeros((*shape, 0))
        out = self._off(self.steps, {**self.constants, **self._values(q, T)}, shape)
        for steps in self.other_ways.values():
            out += self._off(steps, dict(self._other_values(q, T)) if self._other_values else {}, shape)
        return np.stack(out, axis=-1) if out else np.zeros((*shape, 0))

    def _off(self, steps: Sequence[Step], values: dict[str, Any], shape: tuple[int, ...]) -> list[Array]:
        """How far the equations of some steps are off, (...) each."""
        out = []
        for equation in (each for step in steps for each in step.equations):
            if isinstance(equation, Equation) and equation.defines:
                values[equation.defines] = equation.right.evaluate(values)
            scale = self.length ** {"m": 1, "m²": 2, "m⁴": 4}.get(equation.unit, 0)
            out.append(np.broadcast_to(np.abs(equation.residual(values)) / scale, shape))
        return out
