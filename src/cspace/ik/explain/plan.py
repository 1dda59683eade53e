"""The explanation of an arm's solver: the geometry, the steps, the equations; it prints."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Final

import numpy as np

from cspace.arrays import Array, as_floats, leading_axes
from cspace.ik.explain.document import lay_out_plan, plan_document
from cspace.ik.explain.page import Block
from cspace.ik.explain.survey import InvariantDirection, InvariantPoint, Relation
from cspace.math import Equation, MatrixEquation
from cspace.spatial import as_pose
from cspace.tables import one_line
from cspace.tolerances import FARTHEST

Values = Callable[[Array, Array], dict[str, Any]]
"""From configurations and the poses that they reach to the numbers of the symbols."""


WAYS: Final = {"subproblem 3": 2, "subproblem 4": 2, "subproblem 5": 4, "subproblem 6": 4}
"""How many answers a subproblem has at most; one if it is not listed."""


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
class IkPlan:
    """How `robot.ik` solves an arm; prints, has to_markdown() and to_latex(), and is false if it does not.

    robot: its name; joints: their names. family: the geometry that is used, "general", "fewer than six
    joints", "other" or "none". summary: the method as one sentence. branches: how many solutions a goal has
    at most. reason: why nothing solves the arm, else "". relations, invariant_points, invariant_directions:
    the geometry found. notes: sentences about signs, frames and goals. tables: named rows of numbers that
    the equations refer to. matrices: named displacements (4, 4). constants: numbers of the symbols that
    belong to the arm. steps: what is done. locked: the joints that are parameters. counted: whose solutions
    `branches` counts, where that needs saying. calls: how the functions that ask for solutions use the
    steps. other_ways: further ways to a solution, by name, each with its steps. residuals(q, T): how far
    each equation is off at configurations q (..., n).
    """

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

    def to_text(self) -> str:
        """As plain text."""
        return self._joined("plain")

    def to_markdown(self) -> str:
        """As Markdown with formulas between dollar signs."""
        return self._joined("markdown")

    def to_latex(self) -> str:
        """As LaTeX for the body of a document that loads amsmath."""
        return self._joined("latex")

    __str__ = to_text
    _repr_markdown_ = to_markdown

    def _joined(self, form: str) -> str:
        """The blocks of the page in one of their forms."""
        return "\n\n".join(getattr(block, form) for block in lay_out_plan(self)) + "\n"

    def __repr__(self) -> str:
        return one_line("IkPlan", f"of {self.robot}: {self.family}, up to {self.branches} solutions")

    def to_dict(self) -> dict[str, Any]:
        """As plain data, angles in radians and lengths in metres."""
        return plan_document(self)

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
