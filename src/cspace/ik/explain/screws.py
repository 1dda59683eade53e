"""Points and directions carried along by joints, as formulas."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from cspace.arrays import Array
from cspace.ik.explain.page import Block, lay_out_table
from cspace.math import Angle, TrigPolynomial
from cspace.model import Chain
from cspace.tables import shown
from cspace.tolerances import SYMBOL_PARALLEL

Vector = list[TrigPolynomial]


@dataclass(frozen=True, eq=False)
class Screws:
    """Joints as screws at zero: axes, points (n, 3) [m], joint_types, T_zero (4, 4)."""

    joint_types: str
    axes: Array
    points: Array
    T_zero: Array

    @classmethod
    def of(cls, chain: Chain) -> Screws:
        """The joints of a robot."""
        return cls(chain.joint_types, chain.axes, chain.points, chain.T_zero)

    def table(self, names: Sequence[str]) -> Block:
        """Where the joints are at zero; a joint without a name is virtual."""
        rows = []
        for i, kind in enumerate(self.joint_types):
            name = f"`{names[i]}`" if i < len(names) and names[i] else "virtual, locked at 0"
            point = vector_text(self.points[i]) if kind == "R" else "–"
            what = "revolute" if kind == "R" else "prismatic"
            rows.append((f"{i + 1}", name, what, vector_text(self.axes[i]), point))
        return lay_out_table(("i", "joint", "type", "along", "through [m]"), rows)

    def reversed(self) -> Screws:
        """The same joints read from the tip."""
        back = np.linalg.inv(self.T_zero)
        axes = -(self.axes @ back[:3, :3].T)[::-1]
        points = (self.points @ back[:3, :3].T + back[:3, 3])[::-1]
        return Screws(self.joint_types[::-1], axes, points, np.asarray(back, dtype=np.float64))


def vector_text(v: Any) -> str:
    """A vector without rounding noise."""
    return ", ".join(shown(round(float(x), 8)) for x in v)


def joint_values(kinds: str, q: Array, *, length: float = 1.0) -> dict[str, Any]:
    """The values of t_i and q_i (slides over `length`); zero for joints behind those of q (..., n)."""
    out: dict[str, Any] = {}
    for i, kind in enumerate(kinds):
        value = q[..., i] if i < q.shape[-1] else np.zeros(q.shape[:-1])
        out[f"{'t' if kind == 'R' else 'q'}_{i + 1}"] = value if kind == "R" else value / length
    return out


def goal_values(T: Array, before: str = "", *, length: float = 1.0) -> dict[str, Any]:
    """The numeric values of p (over `length`) and r_ij; before: as of TrigMatrix.symbols."""
    out: dict[str, Any] = {}
    for i, axis in enumerate("xyz"):
        out[f"{before}p_{axis}"] = T[..., i, 3] / length
        for j in range(3):
            out[f"{before}r_{i + 1}{j + 1}"] = T[..., i, j]
    return out


def number_vector(v: Any) -> Vector:
    """A vector of numbers."""
    return [TrigPolynomial.number(float(x)) for x in v]


def symbol_vector(name: str) -> Vector:
    """name_x, name_y, name_z."""
    return [TrigPolynomial.symbol(f"{name}_{axis}") for axis in "xyz"]


def dot_product(h: Array, x: Vector) -> TrigPolynomial:
    """h · x."""
    return sum((float(h[k]) * x[k] for k in range(3)), TrigPolynomial())


def group_of(chain: Chain | Screws, i: int) -> int:
    """The group of parallel axes that joint i belongs to: the first joint of its kind."""
    for k in range(i):
        if np.linalg.norm(np.cross(chain.axes[k], chain.axes[i])) < SYMBOL_PARALLEL:
            return k
    return i


def turn_direction(chain: Chain | Screws, i: int, v: Vector, *, back: bool = False) -> Vector:
    """The direction v turned by joint i, or back; a prismatic joint leaves it."""
    if chain.joint_types[i] == "P":
        return v
    h, angle = chain.axes[i], Angle(i + 1, group_of(chain, i))
    c, s = TrigPolynomial.cos(angle), (-1.0 if back else 1.0) * TrigPolynomial.sin(angle)
    along = dot_product(h, v)
    out = []
    for k in range(3):
        i1, i2 = (k + 1) % 3, (k + 2) % 3
        across = float(h[i1]) * v[i2] - float(h[i2]) * v[i1]
        out.append(float(h[k]) * along + c * (v[k] - float(h[k]) * along) + s * across)
    return out


def move_point(chain: Chain | Screws, i: int, x: Vector, *, back: bool = False) -> Vector:
    """The point x carried along by joint i: e^{ξ q} x, or back by e^{−ξ q}."""
    h, o = chain.axes[i], chain.points[i]
    if chain.joint_types[i] == "P":
        slide = (-1.0 if back else 1.0) * TrigPolynomial.symbol(f"q_{i + 1}")
        return [x[k] + float(h[k]) * slide for k in range(3)]
    d = turn_direction(chain, i, [x[k] - float(o[k]) for k in range(3)], back=back)
    return [d[k] + float(o[k]) for k in range(3)]
