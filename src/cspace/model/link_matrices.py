"""The matrices of an arm's links and their products as symbols, in the notation of lectures."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Final

import numpy as np

from cspace.arrays import Array, as_floats
from cspace.math import Angle, TrigMatrix, TrigPolynomial
from cspace.model.dh import DHTable
from cspace.tolerances import PRINTED_FACTOR, SYMBOL_PARALLEL

MOST_TERMS: Final = 24
"""Entries of more terms than these are counted rather than printed."""
NAMES: Final = (("n_x", "o_x", "a_x", "p_x"), ("n_y", "o_y", "a_y", "p_y"), ("n_z", "o_z", "a_z", "p_z"))
"""The entries of a displacement: the axes n, o, a of its frame, its origin p."""


@dataclass(frozen=True, eq=False)
class LinkMatrices:
    """The link matrices A_i of a Denavit–Hartenberg table and their products, with the angles as symbols.

    c1, s12 … are the cosine and sine of t1, t1 + t2 … with t_i = q_i + theta offset of row i; a slide is q_i.
    Sums stand where axes are parallel: c1 c2 − s1 s2 = c12. table: the DHTable. matrices: A_1 … A_n.
    """

    table: DHTable
    matrices: tuple[TrigMatrix, ...]

    @cached_property
    def products(self) -> tuple[TrigMatrix, ...]:
        """A_1, A_1 A_2, …, A_1 … A_n: link i in frame 0."""
        out: list[TrigMatrix] = []
        for A in self.matrices:
            out.append(out[-1] @ A if out else A)
        return tuple(out)

    def values(self, q: Any) -> dict[str, Array]:
        """The numbers of the symbols at configurations q (..., n) [rad or m]."""
        q = as_floats(q, "q", last=(sum(kind != "F" for kind in self.table.joint_types),))
        out: dict[str, Array] = {}
        column = 0
        for i, kind in enumerate(self.table.joint_types):
            if kind == "R":
                out[f"t_{i + 1}"] = q[..., column] + self.table.theta_offset[i]
            elif kind == "P":
                out[f"q_{i + 1}"] = q[..., column]
            column += kind != "F"
        return out

    def fk(self, q: Any) -> Array:
        """The tip in the base (..., 4, 4) at q (..., n), by the symbols: T_base A_1 … A_n T_tool."""
        T: Array = np.asarray(self.table.T_base)
        values = self.values(q)
        for A in self.matrices:
            T = T @ A.evaluate(values)
        return np.asarray(T @ self.table.T_tool)

    def text(self) -> str:
        """The table, every matrix and every product as plain text."""
        least, shift = self._least.values()
        left_out = f"factors below {least:g} ({shift:.2g} m) are left out"
        parts = [str(self.table), f"ci and si are the cosine and sine of t_i = θ_i; {left_out}"]
        parts += [f"A{i + 1}\n{A.text(**self._least)}" for i, A in enumerate(self.matrices)]
        return "\n\n".join([*parts, *self.product_texts()])

    def product_texts(self) -> list[str]:
        """A1 A2, A1 A2 A3 … as plain text, entry by entry."""
        out = []
        for i, T in enumerate(self.products[1:], 2):
            name = " ".join(f"A{k + 1}" for k in range(i))
            lines = [f"  {entry.replace('_', '')} = {self._shown(T, r, c)}" for r, c, entry in entry_places()]
            out.append("\n".join([name, *lines]))
        return out

    def product_formulas(self) -> list[str]:
        """The same as LaTeX."""
        out = []
        for i, T in enumerate(self.products[1:], 2):
            name = " ".join(f"A_{{{k + 1}}}" for k in range(i))
            rows = [f"{entry} &= {self._shown(T, r, c, latex=True)}" for r, c, entry in entry_places()]
            body = " \\\\\n".join(rows)
            out.append(f"{name}: \\quad \\begin{{aligned}}\n{body}\n\\end{{aligned}}")
        return out

    def to_markdown(self) -> str:
        """The matrices and products as formulas between $$."""
        return "\n\n".join(f"$$\n{formula}\n$$" for formula in self._formulas()) + "\n"

    def to_latex(self) -> str:
        r"""The matrices and products as LaTeX, between \[ and \]."""
        return "\n\n".join(f"\\[\n{formula}\n\\]" for formula in self._formulas()) + "\n"

    __str__ = text
    _repr_markdown_ = to_markdown

    def __repr__(self) -> str:
        return f"<LinkMatrices: {len(self.matrices)} links, {self.table.convention} convention>"

    @property
    def _least(self) -> dict[str, float]:
        lengths = np.abs(self.table.rows[:, 1:3])
        usual = float(np.median(lengths[lengths > 0.0])) if lengths.any() else 1.0
        return {"least": PRINTED_FACTOR, "least_shift": PRINTED_FACTOR * usual}

    def _shown(self, T: TrigMatrix, row: int, column: int, *, latex: bool = False) -> str:
        """An entry as text, or how many terms it has."""
        entry, least = T[row, column], self._least["least" if column < 3 else "least_shift"]
        if len(entry) > MOST_TERMS:
            return rf"\text{{{len(entry)} terms}}" if latex else f"{len(entry)} terms"
        return entry.latex(least=least) if latex else entry.text(least=least)

    def _formulas(self) -> list[str]:
        matrices = [f"A_{{{i + 1}}} = {A.latex(**self._least)}" for i, A in enumerate(self.matrices)]
        return matrices + self.product_formulas()


def entry_places() -> list[tuple[int, int, str]]:
    """Row, column and name of the twelve entries, column by column."""
    return [(row, column, NAMES[row][column]) for column in range(4) for row in range(3)]


def link_matrices(table: DHTable) -> LinkMatrices:
    """The link matrices of a Denavit–Hartenberg table as symbols.

    Standard: A_i = Rz(t_i) Tz(d_i) Tx(a_i) Rx(α_i); modified: Rx(α_{i−1}) Tx(a_{i−1}) Rz(t_i) Tz(d_i).
    Angles of consecutive parallel axes belong to one group, so that their sums appear.
    """
    groups = groups_of(table)
    matrices = []
    for i, kind in enumerate(table.joint_types):
        ca, sa = np.cos(table.alpha[i]), np.sin(table.alpha[i])
        slide = TrigPolynomial.symbol(f"q_{i + 1}") if kind == "P" else TrigPolynomial()
        if kind == "R":
            turn = TrigMatrix.about_z(Angle(i + 1, groups[i]))
        else:
            turn = TrigMatrix.turn("z", np.cos(table.theta_offset[i]), np.sin(table.theta_offset[i]))
        along = turn @ TrigMatrix.shift(z=slide + float(table.d[i]))
        across = TrigMatrix.shift(x=float(table.a[i])) @ TrigMatrix.turn("x", ca, sa)
        matrices.append(across @ along if table.convention == "modified" else along @ across)
    return LinkMatrices(table, tuple(matrices))


def groups_of(table: DHTable) -> Sequence[int]:
    """For each row the number of its group of consecutive parallel axes."""
    twist = np.abs(np.sin(table.alpha)) > SYMBOL_PARALLEL
    before = twist[:-1] if table.convention == "standard" else twist[1:]
    return [int(group) for group in np.concatenate([[0], np.cumsum(before)])]
