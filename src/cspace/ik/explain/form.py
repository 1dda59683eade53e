"""The table of a closed form, from the core, as symbols: its angles, its links, its goal."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from cspace.arrays import Array
from cspace.ik.explain.page import Block, lay_out_table
from cspace.ik.explain.screws import goal_values
from cspace.ik.geometry import as_arrays
from cspace.math import Angle, Product, TrigMatrix, TrigPolynomial
from cspace.tables import shown

symbol = TrigPolynomial.symbol


@dataclass(frozen=True, eq=False)
class Form:
    """Six joints in standard Denavit–Hartenberg form, T_base_tip = B A_1 … A_6 C with A_i of t_i.

    joint: the arm's joint behind each (from 0), −1 for a virtual one. sign, offset: t_i = sign q + offset.
    a, d, ca, sa: columns of the table. parallel, meeting: what neighbouring axes share. base, tool: B and C
    (4, 4). reversed: the form is of the arm read from the tip, and its goal the inverse.
    """

    joint: tuple[int, ...]
    sign: tuple[float, ...]
    offset: tuple[float, ...]
    a: tuple[float, ...]
    d: tuple[float, ...]
    ca: tuple[float, ...]
    sa: tuple[float, ...]
    parallel: tuple[bool, ...]
    meeting: tuple[bool, ...]
    base: Array
    tool: Array
    reversed: bool
    length: float

    @classmethod
    def of(cls, plan: Mapping[str, Any]) -> Form:
        """From the numbers of a plan in closed form."""
        table = as_arrays(plan["form"])
        columns: dict[str, Any] = {
            name: tuple(table[name]) for name in ("offset", "a", "d", "ca", "sa", "parallel", "meeting")
        }
        columns |= {name: table[name] for name in ("base", "tool", "length")}
        return cls(tuple(plan["joint"]), tuple(plan["sign"]), **columns, reversed=plan["reversed"])

    @property
    def angles(self) -> tuple[Angle, ...]:
        """t_1 … t_6, those of consecutive parallel axes in one group."""
        groups = np.concatenate([[0], np.cumsum(np.logical_not(self.parallel))])
        return tuple(Angle(i + 1, int(group)) for i, group in enumerate(groups))

    def cos(self, *joints: int) -> TrigPolynomial:
        """The cosine of a sum of angles by their numbers from 1."""
        return TrigPolynomial.cos(*(self.angles[i - 1] for i in joints))

    def sin(self, *joints: int) -> TrigPolynomial:
        """The sine of a sum of angles by their numbers from 1."""
        return TrigPolynomial.sin(*(self.angles[i - 1] for i in joints))

    def twist(self, i: int) -> tuple[TrigPolynomial, TrigPolynomial]:
        """Cosine and sine of α_i as symbols, or 1 and 0 between parallel axes."""
        if i < 6 and self.parallel[i - 1]:
            return TrigPolynomial.number(self.ca[i - 1]), TrigPolynomial()
        return symbol(f"ca_{i}"), symbol(f"sa_{i}")

    def constants(self) -> dict[str, float]:
        """The numeric values of a_i, d_i, ca_i, sa_i."""
        out: dict[str, float] = {}
        for i in range(5):
            out |= {f"a_{i + 1}": self.a[i], f"ca_{i + 1}": self.ca[i], f"sa_{i + 1}": self.sa[i]}
            if i:
                out[f"d_{i + 1}"] = self.d[i]
        return out

    def about_z(self, i: int) -> tuple[str, str, TrigMatrix]:
        """Rz(t_i) with its names."""
        return f"Rz(t{i})", f"R_z(t_{i})", TrigMatrix.about_z(self.angles[i - 1])

    def about_x(self, i: int) -> tuple[str, str, TrigMatrix]:
        """Rx(α_i) with its names."""
        return f"Rx(α{i})", rf"R_x(\alpha_{i})", TrigMatrix.turn("x", *self.twist(i))

    def seen_from(self, count: int) -> Product:
        """Rz(t_1) Rx(α_1) … of the first `count` joints: what turns in front of the wrist."""
        return Product(tuple(f for i in range(1, count + 1) for f in (self.about_z(i), self.about_x(i))))

    def turned_goal(self, count: int) -> TrigMatrix:
        """M = (Rz(t_1) Rx(α_1) …)ᵀ R with the numbers of the twists."""
        turn = self.seen_from(count).matrix().with_numbers(self.constants())
        rows = [[TrigPolynomial() if 3 in (i, j) else turn[j, i] for j in range(4)] for i in range(4)]
        goal = TrigMatrix.symbols()
        rotation = [[goal[i, j] if 3 not in (i, j) else TrigPolynomial() for j in range(4)] for i in range(4)]
        return TrigMatrix(rows) @ TrigMatrix(rotation)

    def table(self, names: tuple[str, ...], numbers: tuple[int, ...] | None = None) -> Block:
        """The table of the form with the joints behind it. numbers: theirs in the arm, else 1, 2, …"""
        rows = []
        for i, joint in enumerate(self.joint):
            name = f"`{names[joint]}`" if joint >= 0 else "virtual, locked at 0"
            alpha = np.degrees(np.arctan2(self.sa[i], self.ca[i]))
            entries = (shown(x) for x in (alpha, self.a[i], self.d[i]))
            rows.append((f"{i + 1}", name, *entries, self.angle_text(i, numbers)))
        return lay_out_table(("i", "joint", r"$\alpha_i$ [°]", "$a_i$ [m]", "$d_i$ [m]", "$t_i$ [°]"), rows)

    def angle_text(self, i: int, numbers: tuple[int, ...] | None) -> str:
        """t_i from the joint's own angle: $q_2$ + 180."""
        offset = shown(np.degrees(self.offset[i]))
        if self.joint[i] < 0:
            return offset
        number = self.joint[i] + 1 if numbers is None else numbers[self.joint[i]]
        q = f"{'−' if self.sign[i] < 0 else ''}$q_{{{number}}}$"
        if offset == "0":
            return q
        return f"{q} − {offset[1:]}" if offset.startswith("-") else f"{q} + {offset}"

    def values(self, q: Array, T: Array) -> dict[str, Any]:
        """The numeric values of angles and goal at configurations q (..., n) that reach T (..., 4, 4)."""
        out: dict[str, Any] = {}
        for i, joint in enumerate(self.joint):
            out[f"t_{i + 1}"] = (self.sign[i] * q[..., joint] if joint >= 0 else 0.0) + self.offset[i]
        goal = (
            np.linalg.inv(self.base) @ (np.linalg.inv(T) if self.reversed else T) @ np.linalg.inv(self.tool)
        )
        return out | goal_values(np.asarray(goal, dtype=np.float64))
