"""Polynomials in plain symbols and in the cosines and sines of angles.

Angles of one group belong to parallel axes: products of their cosines and sines become those of sums,
c2 c3 − s2 s3 = c23, and c² + s² = 1; those of different groups stay products. So every polynomial has one
form, and link matrices come out as books print them.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from cspace.math import typeset
from cspace.tables import tabulate
from cspace.tolerances import INTEGER_ROUNDING, PRINTED_ROUNDING

Plain = tuple[tuple[str, int], ...]
"""Symbols with their powers, in the order of their names."""
Turn = tuple[int, str, typeset.Combination]
"""The group of an angle, "c" or "s", and the angle as a sum."""
Monomial = tuple[Plain, tuple[Turn, ...]]


@tabulate()
@dataclass(frozen=True)
class Angle:
    """An angle that formulas know: its number, and the group of parallel axes that it belongs to."""

    index: int
    group: int


@tabulate("terms")
class TrigPolynomial:
    """A sum of numbers times symbols, cosines and sines; immutable. terms: factor per product."""

    __slots__ = ("terms",)

    def __init__(self, terms: Mapping[Monomial, float] | None = None) -> None:
        kept = {key: snap_to_integer(value) for key, value in (terms or {}).items()}
        self.terms: dict[Monomial, float] = {key: value for key, value in kept.items() if value}

    @classmethod
    def number(cls, value: float) -> TrigPolynomial:
        """A constant."""
        return cls({((), ()): float(value)})

    @classmethod
    def symbol(cls, name: str) -> TrigPolynomial:
        """A symbol such as p_x."""
        return cls({(((name, 1),), ()): 1.0})

    @classmethod
    def cos(cls, *angles: Angle) -> TrigPolynomial:
        """The cosine of a sum of angles of one group."""
        return cls(dict([turn_monomial("c", *combine_angles(angles))]))

    @classmethod
    def sin(cls, *angles: Angle) -> TrigPolynomial:
        """The sine of a sum of angles of one group."""
        return cls(dict([turn_monomial("s", *combine_angles(angles))]))

    def __add__(self, other: Any) -> TrigPolynomial:
        terms = dict(self.terms)
        for key, value in as_polynomial(other).terms.items():
            terms[key] = terms.get(key, 0.0) + value
        return TrigPolynomial(terms)

    def __mul__(self, other: Any) -> TrigPolynomial:
        terms: dict[Monomial, float] = {}
        for a, x in self.terms.items():
            for b, y in as_polynomial(other).terms.items():
                for key, value in multiply_monomials(a, b):
                    terms[key] = terms.get(key, 0.0) + x * y * value
        return TrigPolynomial(terms)

    __radd__ = __add__
    __rmul__ = __mul__

    def __neg__(self) -> TrigPolynomial:
        return TrigPolynomial({key: -value for key, value in self.terms.items()})

    def __sub__(self, other: Any) -> TrigPolynomial:
        return self + (-as_polynomial(other))

    def __rsub__(self, other: Any) -> TrigPolynomial:
        return as_polynomial(other) - self

    def __len__(self) -> int:
        return len(self.terms)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, TrigPolynomial) and not (self - other).terms

    __hash__ = None  # type: ignore[assignment]

    def evaluate(self, values: Mapping[str, Any]) -> Any:
        """The value, (...) where the values of the symbols are; that of angle 3 is named t_3 [rad]."""
        total: Any = 0.0
        for (plain, turns), factor in self.terms.items():
            term: Any = factor
            for name, power in plain:
                term = term * values[name] ** power
            for _, kind, angle in turns:
                theta = sum(times * values[f"t_{index}"] for index, times in angle)
                term = term * (np.cos(theta) if kind == "c" else np.sin(theta))
            total = total + term
        return total

    def with_numbers(self, values: Mapping[str, float]) -> TrigPolynomial:
        """The same with numbers in the place of some symbols."""
        terms: dict[Monomial, float] = {}
        for (plain, turns), factor in self.terms.items():
            left: list[tuple[str, int]] = []
            for name, power in plain:
                if name in values:
                    factor *= values[name] ** power
                else:
                    left.append((name, power))
            key = (tuple(left), turns)
            terms[key] = terms.get(key, 0.0) + factor
        return TrigPolynomial(terms)

    def symbols(self) -> set[str]:
        """The names of its symbols and angles."""
        return {name for plain, _ in self.terms for name, _ in plain} | {
            f"t_{index}" for _, turns in self.terms for _, _, angle in turns for index, _ in angle
        }

    @property
    def largest_factor(self) -> float:
        """The largest factor of a term, without its sign; 0 for no terms."""
        return max(map(abs, self.terms.values()), default=0.0)

    def text(self, *, least: float = 0.0) -> str:
        """As plain text; terms with factors below `least`, or a rounding of the largest, are left out."""
        return typeset.sum_of_terms(list(self._written(least, latex=False)))

    def latex(self, *, least: float = 0.0) -> str:
        """As LaTeX; terms with factors below `least`, or a rounding of the largest, are left out."""
        return typeset.sum_of_terms(list(self._written(least, latex=True))).replace("−", "-")

    __str__ = text

    def __repr__(self) -> str:
        return f"<TrigPolynomial {self.text()}>"

    def _written(self, least: float, *, latex: bool) -> Iterator[tuple[float, str]]:
        in_order = sorted(self.terms.items(), key=lambda term: [angle for _, _, angle in term[0][1]])
        bound = max(least, PRINTED_ROUNDING * self.largest_factor)
        kept = [term for term in in_order if abs(term[1]) >= bound]
        ahead = next((k for k, (_, factor) in enumerate(kept) if factor > 0), 0)
        for (plain, turns), factor in [*kept[ahead : ahead + 1], *kept[:ahead], *kept[ahead + 1 :]]:
            lengths = [each for each in plain if not each[0].startswith(("p_", "r_"))]
            goal = [each for each in plain if each[0].startswith(("p_", "r_"))]
            words = [power_of(name, power, latex=latex) for name, power in lengths]
            words += [typeset.write_turn(kind, angle, latex=latex) for _, kind, angle in turns]
            words += [power_of(name, power, latex=latex) for name, power in goal]
            yield factor, " ".join(words)


def power_of(name: str, power: int, *, latex: bool) -> str:
    """A symbol to a power."""
    exponent = "" if power == 1 else "²" if power == 2 and not latex else f"^{power}"
    return typeset.write_symbol(name, latex=latex) + exponent


def as_polynomial(value: Any) -> TrigPolynomial:
    """A polynomial, made from a number if need be."""
    return value if isinstance(value, TrigPolynomial) else TrigPolynomial.number(value)


def snap_to_integer(value: float) -> float:
    """A number without the rounding about an integer."""
    nearest = round(value)
    return float(nearest) if abs(value - nearest) < INTEGER_ROUNDING else value


def combine_angles(angles: tuple[Angle, ...]) -> tuple[int, typeset.Combination]:
    """The group and the sum of some angles."""
    groups = {angle.group for angle in angles}
    if len(groups) != 1:
        raise ValueError("angles of one group make a sum")
    return groups.pop(), tuple(sorted((angle.index, 1) for angle in angles))


def turn_monomial(kind: str, group: int, angle: typeset.Combination) -> tuple[Monomial, float]:
    """The cosine or sine of a sum, its first angle taken positively, as a monomial and its factor."""
    if not angle:
        return ((), ()), 1.0 if kind == "c" else 0.0
    sign = 1.0
    if angle[0][1] < 0:
        angle = tuple((index, -times) for index, times in angle)
        sign = 1.0 if kind == "c" else -1.0
    return ((), ((group, kind, angle),)), sign


def multiply_monomials(a: Monomial, b: Monomial) -> list[tuple[Monomial, float]]:
    """The product of two monomials as a sum of monomials."""
    powers = dict(a[0])
    for name, power in b[0]:
        powers[name] = powers.get(name, 0) + power
    plain = tuple(sorted(powers.items()))
    out: list[tuple[tuple[Turn, ...], float]] = [((), 1.0)]
    first, second = ({each[0]: each for each in side[1]} for side in (a, b))
    for group in sorted({*first, *second}):
        if group in first and group in second:
            choices = product_of_turns(first[group], second[group])
        else:
            choices = [((first.get(group) or second[group],), 1.0)]
        out = [(turns + more, x * y) for turns, x in out for more, y in choices]
    return [((plain, turns), factor) for turns, factor in out]


def product_of_turns(a: Turn, b: Turn) -> list[tuple[tuple[Turn, ...], float]]:
    """cos x cos y = ½ cos(x − y) + ½ cos(x + y), and similar."""
    (group, f, x), (_, g, y) = a, b
    plus, minus = add_angles(x, y, 1), add_angles(x, y, -1)
    kind = "c" if f == g else "s"
    if f == g:
        parts = [(minus, 0.5), (plus, 0.5 if f == "c" else -0.5)]
    else:  # sin x cos y = ½ sin(x + y) + ½ sin(x − y), cos x sin y = ½ sin(x + y) − ½ sin(x − y)
        parts = [(plus, 0.5), (minus, 0.5 if f == "s" else -0.5)]
    out = []
    for angle, factor in parts:
        key, sign = turn_monomial(kind, group, angle)
        if sign:
            out.append((key[1], sign * factor))
    return out


def add_angles(x: typeset.Combination, y: typeset.Combination, sign: int) -> typeset.Combination:
    """The sum (or difference) of two sums of angles."""
    times = dict(x)
    for index, count in y:
        times[index] = times.get(index, 0) + sign * count
    return tuple(sorted((index, count) for index, count in times.items() if count))
