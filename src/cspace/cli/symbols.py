"""Link matrices written with the cosine and sine of the joint angle as symbols."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np

from cspace.arrays import Array

if TYPE_CHECKING:
    from cspace.model import DHTable


ZERO: Final = 1e-9
"""Factors below this are printed as 0: the cosine of a right angle."""


def link_matrix(table: DHTable, i: int) -> Array:
    """The matrix (4, 4) of row i with the joint at zero."""
    from cspace.model import dh_matrix

    row = (table.alpha[i], table.a[i], table.d[i], table.theta_offset[i])
    return dh_matrix(*row, convention=table.convention)


def entry_texts(table: DHTable, i: int) -> list[list[str]]:
    """The entries (4, 4) of row i as texts in c, s of theta(i) and, for a prismatic joint, its d."""
    ca, sa = np.cos(table.alpha[i]), np.sin(table.alpha[i])
    a, d = float(table.a[i]), float(table.d[i])
    slide = f"q{i + 1}" if table.joint_types[i] == "P" else ""
    turning = table.joint_types[i] == "R"
    c, s = (f"c{i + 1}", f"s{i + 1}") if turning else ("", "")
    theta = table.theta_offset[i]
    cn, sn = (1.0, 1.0) if turning else (np.cos(theta), np.sin(theta))
    if table.convention == "modified":
        rows = [
            [term(cn, c), term(-sn, s), "0", term(a, "")],
            [term(sn * ca, s), term(cn * ca, c), term(-sa, ""), along(-sa, d, slide)],
            [term(sn * sa, s), term(cn * sa, c), term(ca, ""), along(ca, d, slide)],
        ]
    else:
        rows = [
            [term(cn, c), term(-sn * ca, s), term(sn * sa, s), term(a * cn, c)],
            [term(sn, s), term(cn * ca, c), term(-cn * sa, c), term(a * sn, s)],
            ["0", term(sa, ""), term(ca, ""), along(1.0, d, slide)],
        ]
    return [*rows, ["0", "0", "0", "1"]]


def term(factor: float, symbol: str) -> str:
    """A factor times a symbol: 0, c1, -s2, 0.5 c1."""
    if abs(factor) < ZERO:
        return "0"
    if not symbol:
        return f"{factor:.6g}"
    if abs(abs(factor) - 1.0) < ZERO:
        return symbol if factor > 0 else "-" + symbol
    return f"{factor:.6g} {symbol}"


def along(factor: float, d: float, slide: str) -> str:
    """A factor times the offset d, to which a prismatic joint adds q: 0.4, q3, 0.4 + q3, -q3."""
    fixed, moving = term(factor * d, ""), term(factor, slide) if slide else "0"
    if moving == "0" or fixed == "0":
        return fixed if moving == "0" else moving
    return f"{fixed} - {moving[1:]}" if moving.startswith("-") else f"{fixed} + {moving}"


def angle_text(angle: float, *, degrees: bool) -> str:
    """An angle in the selected unit; in radians simple fractions of 2π are written with pi."""
    if abs(angle) < ZERO:
        return "0"
    if degrees:
        return f"{np.degrees(angle):.6g}"
    for divisor in (1, 2, 3, 4, 6):
        times = angle * divisor / np.pi
        if abs(times - round(times)) < ZERO:
            sign, count = "-" if times < 0 else "", abs(round(times))
            return sign + ("pi" if count == 1 else f"{count}pi") + ("" if divisor == 1 else f"/{divisor}")
    return f"{angle:.6g}"
