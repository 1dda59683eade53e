"""Equations that print and can be checked: both sides are data."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from cspace.math.trig_matrix import Product
from cspace.math.trig_polynomial import TrigPolynomial
from cspace.tables import show_fields


@show_fields
@dataclass(frozen=True, eq=False)
class Equation:
    """left = right. defines: the symbol that the equation introduces (its left side), or "".

    unit: what both sides are measured in, "m", "m²" or "" for a plain number.
    """

    left: TrigPolynomial
    right: TrigPolynomial
    defines: str = ""
    unit: str = ""

    @classmethod
    def definition(cls, name: str, right: TrigPolynomial, unit: str = "") -> Equation:
        """A symbol and its meaning."""
        return cls(TrigPolynomial.symbol(name), right, name, unit)

    def residual(self, values: Mapping[str, Any]) -> Any:
        """left − right (...) at values (...) of the symbols."""
        return self.left.evaluate(values) - self.right.evaluate(values)

    def with_numbers(self, values: Mapping[str, float]) -> Equation:
        """The same with numbers in the place of some symbols; a symbol that it defines stays."""
        known = {name: value for name, value in values.items() if name != self.defines}
        return Equation(
            self.left.with_numbers(known), self.right.with_numbers(known), self.defines, self.unit
        )

    def symbols(self) -> set[str]:
        """The names of the symbols and angles of both sides."""
        return self.left.symbols() | self.right.symbols()

    def __len__(self) -> int:
        return len(self.left) + len(self.right)

    def text(self, *, least: float = 0.0) -> str:
        """As plain text."""
        return f"{self.left.text(least=least)} = {self.right.text(least=least)}"

    def latex(self, *, least: float = 0.0) -> str:
        """As LaTeX, the equals sign to be aligned."""
        return f"{self.left.latex(least=least)} &= {self.right.latex(least=least)}"

    __str__ = text


@show_fields
@dataclass(frozen=True, eq=False)
class MatrixEquation:
    """left = right, both products of displacements written by the names of their factors."""

    left: Product
    right: Product
    unit: str = ""

    def residual(self, values: Mapping[str, Any]) -> Any:
        """The largest entry of left − right (...) at values (...) of the symbols."""
        gap = self.left.evaluate(values) - self.right.evaluate(values)
        return np.abs(gap).max(axis=(-2, -1))

    def text(self) -> str:
        """As plain text."""
        return f"{self.left.text()} = {self.right.text()}"

    def latex(self) -> str:
        """As LaTeX, the equals sign to be aligned."""
        return f"{self.left.latex()} &= {self.right.latex()}"

    __str__ = text
