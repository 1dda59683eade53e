"""Displacements whose entries are polynomials in cosines and sines."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import reduce
from operator import matmul
from typing import Any

import numpy as np

from cspace.arrays import Array
from cspace.math.trig_polynomial import Angle, TrigPolynomial, as_polynomial
from cspace.tables import one_line, show_fields, tabulate
from cspace.tolerances import PRINTED_ROUNDING


@tabulate("entries")
class TrigMatrix:
    """A square matrix of polynomials; immutable. entries: row by row."""

    __slots__ = ("entries",)

    def __init__(self, entries: Sequence[Sequence[Any]]) -> None:
        self.entries = tuple(tuple(as_polynomial(entry) for entry in row) for row in entries)

    @classmethod
    def turn(cls, axis: str, cos: Any, sin: Any) -> TrigMatrix:
        """The rotation about x or z (4, 4) with a cosine and a sine."""
        c, s = as_polynomial(cos), as_polynomial(sin)
        if axis == "z":
            return cls([[c, -s, 0, 0], [s, c, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]])
        return cls([[1, 0, 0, 0], [0, c, -s, 0], [0, s, c, 0], [0, 0, 0, 1]])

    @classmethod
    def about_z(cls, angle: Angle) -> TrigMatrix:
        """Rz of an angle."""
        return cls.turn("z", TrigPolynomial.cos(angle), TrigPolynomial.sin(angle))

    @classmethod
    def shift(cls, x: Any = 0, y: Any = 0, z: Any = 0) -> TrigMatrix:
        """The translation (4, 4)."""
        return cls([[1, 0, 0, x], [0, 1, 0, y], [0, 0, 1, z], [0, 0, 0, 1]])

    @classmethod
    def symbols(cls, before: str = "") -> TrigMatrix:
        """The goal: entries r_11 … r_33 and p_x, p_y, p_z; before: what their names begin with."""
        names = [(f"r_{i}1", f"r_{i}2", f"r_{i}3", f"p_{axis}") for i, axis in enumerate("xyz", 1)]
        rows = [[TrigPolynomial.symbol(before + name) for name in row] for row in names]
        return cls([*rows, [0, 0, 0, 1]])

    def __getitem__(self, place: tuple[int, int]) -> TrigPolynomial:
        return self.entries[place[0]][place[1]]

    def __matmul__(self, other: TrigMatrix) -> TrigMatrix:
        n = len(self.entries)
        return TrigMatrix(
            [
                [sum((self[i, k] * other[k, j] for k in range(n)), TrigPolynomial()) for j in range(n)]
                for i in range(n)
            ]
        )

    def inverse(self) -> TrigMatrix:
        """The inverse of a displacement: Rᵀ and −Rᵀ p."""
        turned = [[self[j, i] for j in range(3)] for i in range(3)]
        moved = [-sum((turned[i][j] * self[j, 3] for j in range(3)), TrigPolynomial()) for i in range(3)]
        return TrigMatrix([[*turned[i], moved[i]] for i in range(3)] + [[0, 0, 0, 1]])

    def evaluate(self, values: Mapping[str, Any]) -> Array:
        """The matrix (..., 4, 4) for values (...) of its symbols."""
        rows = [[entry.evaluate(values) for entry in row] for row in self.entries]
        shape = np.broadcast_shapes(*(np.shape(entry) for row in rows for entry in row))
        return np.stack(
            [np.stack([np.broadcast_to(entry, shape) for entry in row], axis=-1) for row in rows], axis=-2
        ).astype(np.float64)

    def with_numbers(self, values: Mapping[str, float]) -> TrigMatrix:
        """The same with numbers in the place of some symbols."""
        return TrigMatrix([[entry.with_numbers(values) for entry in row] for row in self.entries])

    def texts(self, *, latex: bool = False, least: float = 0.0, least_shift: float = 0.0) -> list[list[str]]:
        """The entries as texts; least, least_shift: factors of rotations and lengths below are left out.

        Always left out are those below a rounding of the largest of the rotation, or of the lengths.
        """
        columns = list(zip(*self.entries, strict=True))
        lengths = max(entry.largest_factor for entry in columns[-1][:-1])
        bounds = [max(least, PRINTED_ROUNDING)] * (len(columns) - 1)
        bounds.append(max(least_shift, PRINTED_ROUNDING * lengths))
        return [
            [
                entry.latex(least=bound) if latex else entry.text(least=bound)
                for entry, bound in zip(row, bounds, strict=True)
            ]
            for row in self.entries
        ]

    def text(self, *, least: float = 0.0, least_shift: float = 0.0) -> str:
        """Four lines, the columns aligned."""
        texts = self.texts(least=least, least_shift=least_shift)
        widths = [max(map(len, column)) for column in zip(*texts, strict=True)]
        return "\n".join(
            "[ " + "   ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)) + " ]"
            for row in texts
        )

    def latex(self, *, least: float = 0.0, least_shift: float = 0.0) -> str:
        """A bmatrix."""
        texts = self.texts(latex=True, least=least, least_shift=least_shift)
        rows = r" \\ ".join(" & ".join(row) for row in texts)
        return rf"\begin{{bmatrix}} {rows} \end{{bmatrix}}"

    __str__ = text

    def __repr__(self) -> str:
        side = len(self.entries)
        return one_line("TrigMatrix", f"{side} × {side}: " + "; ".join(map(", ".join, self.texts())))


@show_fields
@dataclass(frozen=True)
class Product:
    """A product of displacements, written by the names of its factors. factors: text, LaTeX, matrix."""

    factors: tuple[tuple[str, str, TrigMatrix], ...]

    def text(self) -> str:
        """The names of the factors."""
        return " ".join(text for text, _, _ in self.factors)

    def latex(self) -> str:
        """The same in LaTeX."""
        return r" \, ".join(latex for _, latex, _ in self.factors)

    def matrix(self) -> TrigMatrix:
        """The product."""
        return reduce(matmul, (factor for _, _, factor in self.factors))

    def evaluate(self, values: Mapping[str, Any]) -> Array:
        """Its value (..., 4, 4), factor by factor."""
        return reduce(matmul, (factor.evaluate(values) for _, _, factor in self.factors))
