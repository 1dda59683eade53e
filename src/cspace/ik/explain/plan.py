"""The explanation of an arm's solver as an object that prints: as blocks of a page, and as plain data."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Final

import numpy as np

from cspace.ik.explain import page
from cspace.ik.explain.findings import Findings, Step
from cspace.ik.explain.screws import vector_text
from cspace.math import Equation, MatrixEquation
from cspace.tables import align_cells, one_line, shown
from cspace.tolerances import PRINTED_FACTOR, PRINTED_MISS

MOST_TERMS: Final = 16
"""An equation of more terms is printed with symbols alone."""


class IkPlan(Findings):
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


def lay_out_plan(plan: IkPlan) -> list[page.Block]:
    """The page of an explanation."""
    out: list[page.Block] = [page.lay_out_paragraph(f"**{plan.robot}**: {plan.summary}")]
    if plan.reason:
        out.append(page.lay_out_paragraph(plan.reason))
    out += geometry_blocks(plan)
    out += [page.lay_out_paragraph(note) for note in plan.notes]
    for name, table in plan.tables.items():
        out += [page.lay_out_heading(name), table]
    for name, T in plan.matrices.items():
        out.append(page.lay_out_formulas([(matrix_text(name, T), matrix_latex(name, T))]))
    if plan.steps:
        out += [page.lay_out_heading("Steps"), *step_blocks(plan, plan.steps)]
        out.append(page.lay_out_paragraph(f"Together {count_solutions(plan.steps)} solutions{plan.counted}."))
    for name, steps in plan.other_ways.items():
        out += [page.lay_out_heading(name), *step_blocks(plan, steps)]
        out.append(page.lay_out_paragraph(f"Together {count_solutions(steps)} solutions."))
    if plan.calls:
        out += [page.lay_out_heading("What calls do"), *map(page.lay_out_paragraph, plan.calls)]
    return out


def step_blocks(plan: IkPlan, steps: Sequence[Step]) -> list[page.Block]:
    """Steps with their equations."""
    out: list[page.Block] = []
    for number, step in enumerate(steps, 1):
        ways = "" if step.ways == 1 else f"up to {step.ways} ways"
        how = ", ".join(word for word in (ways, step.method) if word)
        how = f" ({how})" if how else ""
        out.append(page.lay_out_paragraph(f"{number}. {step.finds}{how}. {step.words}"))
        out += equation_blocks(plan, step)
    return out


def count_solutions(steps: Sequence[Step]) -> str:
    """How many solutions the steps have together, with the product."""
    factors = [str(step.ways) for step in steps if step.ways > 1]
    most = int(np.prod([step.ways for step in steps]))
    product = r" \times ".join(factors)
    return f"up to ${product} = {most}$" if len(factors) > 1 else f"up to {most}"


def geometry_blocks(plan: IkPlan) -> list[page.Block]:
    """The tables of what the axes share."""
    out: list[page.Block] = []
    if plan.relations:
        rows = [
            (
                f"{each.joints[0]}, {each.joints[1]}",
                f"`{plan.joints[each.joints[0] - 1]}`, `{plan.joints[each.joints[1] - 1]}`",
                shown(np.degrees(each.angle)),
                shown(each.distance) if np.isfinite(each.distance) else "–",
                each.words,
            )
            for each in plan.relations
        ]
        head = ("axes", "joints", "angle [°]", "distance [m]", "relation")
        out += [page.lay_out_heading("Neighbouring axes"), page.lay_out_table(head, rows)]
    for point in plan.invariant_points:
        meet = f"meet in a point, ({vector_text(point.place)}) m at zero{miss_text(point.miss, 'm')}"
        words = f"Axes {list_joints(point.joints)} {meet}: their joints do not move it."
        out.append(page.lay_out_paragraph(words))
    for each in plan.invariant_directions:
        parallel = f"are parallel to ({vector_text(each.direction)}) at zero{miss_text(each.miss, 'rad')}"
        still = "their joints change neither heights along it nor angles with it."
        out.append(page.lay_out_paragraph(f"Axes {list_joints(each.joints)} {parallel}: {still}"))
    return out


def miss_text(miss: float, unit: str) -> str:
    """By how much axes fail to meet or to be parallel, if it is more than rounding."""
    return f" (missed by {miss:.1g} {unit})" if miss > PRINTED_MISS else ""


def list_joints(joints: tuple[int, ...]) -> str:
    """4, 5 and 6."""
    return ", ".join(map(str, joints[:-1])) + f" and {joints[-1]}"


def equation_blocks(plan: IkPlan, step: Step) -> list[page.Block]:
    """The equations of a step as symbols and, where they fit, with the arm's numbers."""
    symbols = step.equations
    out: list[page.Block] = []
    general = [equation_line(plan, each, numbers=False) for each in symbols if refers_to_the_arm(plan, each)]
    if general:
        out.append(page.lay_out_formulas(general))
    special = [
        equation_line(plan, each, numbers=True)
        for each in symbols
        if not refers_to_the_arm(plan, each) or fits_line(plan, each)
    ]
    if special:
        if general:
            out.append(page.lay_out_paragraph("With this arm's numbers:"))
        out.append(page.lay_out_formulas(special))
    return out


def refers_to_the_arm(plan: IkPlan, equation: Equation | MatrixEquation) -> bool:
    """Whether an equation holds symbols of the arm, which have numbers."""
    return isinstance(equation, Equation) and bool(
        equation.symbols() & (set(plan.constants) - {equation.defines})
    )


def fits_line(plan: IkPlan, equation: Equation | MatrixEquation) -> bool:
    """Whether an equation is short enough to be printed with numbers."""
    if not isinstance(equation, Equation):
        return True
    return len(equation.with_numbers(plan.constants)) <= MOST_TERMS


def equation_line(plan: IkPlan, equation: Equation | MatrixEquation, *, numbers: bool) -> tuple[str, str]:
    """An equation as text and LaTeX."""
    if isinstance(equation, MatrixEquation) or not numbers:
        return equation.text(), equation.latex()
    special = equation.with_numbers(plan.constants)
    if len(special) > MOST_TERMS:
        terms = len(special.right)
        return (
            f"{special.left.text()} = … ({terms} terms)",
            rf"{special.left.latex()} &= \text{{{terms} terms}}",
        )
    least = PRINTED_FACTOR * plan.length ** {"m": 1, "m²": 2, "m⁴": 4}.get(equation.unit, 0)
    return special.text(least=least), special.latex(least=least)


def matrix_text(name: str, T: Any) -> str:
    """A matrix of numbers behind its name."""
    lines = align_cells([[shown(x) for x in row] for row in T]).splitlines()
    before = f"{name} = "
    return ("\n    ").join((before if k == 0 else " " * len(before)) + row for k, row in enumerate(lines))


def matrix_latex(name: str, T: Any) -> str:
    """The same in LaTeX."""
    rows = r" \\ ".join(" & ".join(shown(x) for x in row) for row in T)
    symbol = f"{name[0]}_{{{name[1:]}}}" if name[1:] else name
    return rf"{symbol} &= \begin{{bmatrix}} {rows} \end{{bmatrix}}"


def plan_document(plan: IkPlan) -> dict[str, Any]:
    """An explanation as data."""
    return {
        "robot": plan.robot,
        "joints": list(plan.joints),
        "family": plan.family,
        "summary": page.plain_sentence(plan.summary.replace("**", "")),
        "reason": plan.reason,
        "branches": plan.branches,
        "relations": [
            {
                "axes": list(each.joints),
                "angle": each.angle,
                "distance": each.distance if np.isfinite(each.distance) else None,
                "words": each.words,
            }
            for each in plan.relations
        ],
        "points": [
            {"place": list(map(float, each.place)), "joints": list(each.joints), "miss": each.miss}
            for each in plan.invariant_points
        ],
        "directions": [
            {"direction": list(map(float, each.direction)), "joints": list(each.joints), "miss": each.miss}
            for each in plan.invariant_directions
        ],
        "notes": [page.plain_sentence(note) for note in plan.notes],
        "constants": dict(plan.constants),
        "matrices": {name: np.asarray(T).tolist() for name, T in plan.matrices.items()},
        "steps": [step_document(plan, step) for step in plan.steps],
        "calls": [page.plain_sentence(call) for call in plan.calls],
        "locked": list(plan.locked),
        "counted": plan.counted.strip(),
        "other_ways": {
            name: [step_document(plan, step) for step in steps] for name, steps in plan.other_ways.items()
        },
    }


def step_document(plan: IkPlan, step: Step) -> dict[str, Any]:
    """A step as data; numbers: the equation with this arm's numbers, all of its terms."""
    equations = []
    for each in step.equations:
        special = each.with_numbers(plan.constants) if isinstance(each, Equation) else each
        equations.append({"text": each.text(), "latex": each.latex(), "numbers": special.text()})
    return {
        "finds": page.plain_sentence(step.finds),
        "ways": step.ways,
        "method": step.method,
        "words": page.plain_sentence(step.words),
        "equations": equations,
    }
