"""The explanation of an arm's solver as an object that prints."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from cspace.ik.explain.document import lay_out_plan, plan_document
from cspace.ik.explain.findings import Findings
from cspace.tables import one_line


class IkPlan(Findings):
    """How `robot.ik` solves an arm; prints, has to_markdown() and to_latex(), and is false if it does not.

    robot: its name; joints: their names. family: the geometry that is used, "general", "fewer than six
    joints", "other" or "none". summary: the method as one sentence. branches: how many solutions a goal has
    at most. reason: why nothing solves the arm, else "". relations, invariant_points, invariant_directions:
    the geometry found. steps: what is done, with equations; constants: the numbers of their symbols;
    matrices: named displacements (4, 4). residuals(q, T): how far each equation is off at configurations q
    (..., n).
    """

    def to_text(self) -> str:
        """As plain text."""
        return join_blocks(block.plain for block in lay_out_plan(self))

    def to_markdown(self) -> str:
        """As Markdown with formulas between dollar signs."""
        return join_blocks(block.markdown for block in lay_out_plan(self))

    def to_latex(self) -> str:
        """As LaTeX for the body of a document that loads amsmath."""
        return join_blocks(block.latex for block in lay_out_plan(self))

    __str__ = to_text
    _repr_markdown_ = to_markdown

    def __repr__(self) -> str:
        return one_line("IkPlan", f"of {self.robot}: {self.family}, up to {self.branches} solutions")

    def to_dict(self) -> dict[str, Any]:
        """As plain data, angles in radians and lengths in metres."""
        return plan_document(self)


def join_blocks(texts: Iterable[str]) -> str:
    return "\n\n".join(texts) + "\n"
