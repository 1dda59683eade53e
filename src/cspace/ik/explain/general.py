"""Six turning joints in general position: the steps of include/cspace/ik/general/."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from cspace.arrays import Array
from cspace.ik.explain.findings import Step
from cspace.ik.explain.page import Rows
from cspace.math import Angle, MatrixEquation, Product, TrigMatrix

__all__ = ["Loop"]

Factor = tuple[str, str, TrigMatrix]


@dataclass(frozen=True, eq=False)
class Loop:
    """The loop that arm and goal close. links: L1 … L5 (4, 4) from the frame on axis i to the next one.

    first, last: from the base to axis 1, from axis 6 to the tip (4, 4); lengths over `length` [m]. order: the
    formulations as they are asked: number, the joints behind a_0 … a_5 (from 0), whether read backwards.
    """

    links: tuple[Array, ...]
    first: Array
    last: Array
    length: float
    order: tuple[tuple[int, tuple[int, ...], bool], ...]

    @classmethod
    def of(cls, loop: Mapping[str, Any]) -> Loop:
        """From what the core says."""
        order = tuple((number, tuple(joints), backwards) for number, joints, backwards in loop["order"])
        links = tuple(np.array(link) for link in loop["between"])
        return cls(links, np.array(loop["first"]), np.array(loop["last"]), loop["length"], order)

    def values(self, q: Array, T: Array) -> dict[str, Any]:
        """The numbers of angles and goal, lengths over the arm's."""
        out: dict[str, Any] = {f"t_{i + 1}": q[..., i] for i in range(6)}
        for i, axis in enumerate("xyz"):
            out[f"p_{axis}"] = T[..., i, 3] / self.length
            for j in range(3):
                out[f"r_{i + 1}{j + 1}"] = T[..., i, j]
        return out

    def matrices(self) -> dict[str, Array]:
        """The matrices that the equations name."""
        return {"F": self.first, **{f"L{i + 1}": link for i, link in enumerate(self.links)}, "H": self.last}

    def formulations(self, names: tuple[str, ...]) -> Rows:
        """The formulations that serve, in the order in which they are asked."""
        rows = []
        for k, (_, joints, backwards) in enumerate(self.order, 1):
            said = [f"`{names[j]}`" for j in joints]
            rows.append(
                (
                    str(k),
                    said[0],
                    f"{said[1]}, {said[2]}",
                    f"{said[4]}, {said[5]}",
                    said[3],
                    "tip to base" if backwards else "base to tip",
                )
            )
        return Rows(("asked", "hidden", "in the null vector", "eliminated", "left alone", "read"), rows)

    def steps(self, names: tuple[str, ...]) -> list[Step]:
        """The steps of the formulation that is asked first."""
        _, joints, backwards = self.order[0]
        t = [f"$t_{joint + 1}$" for joint in joints]
        return [
            Step(
                "The loop",
                1,
                "",
                "A frame on each axis, its z along the axis, makes the arm a product of turns and links. "
                "Any joint may "
                f"come first, and the loop may be read backwards; asked first is the one that begins with "
                f"{t[0]}.",
                (self.chain_equation(), self.split_equation(joints, backwards)),
            ),
            Step(
                t[0],
                16,
                "elimination",
                f"Both sides move the z axis and the origin alike, and {t[3]} moves neither. Six "
                f"combinations of the "
                f"fourteen invariants do not see {t[4]} and {t[5]}; times sine and cosine of half of "
                f"{t[1]} they are "
                f"twelve linear equations in twelve products of {t[1]} and {t[2]}. Their determinant, a "
                f"trigonometric "
                f"polynomial of degree 8 in {t[0]}, the hidden angle, vanishes at the solutions: up to 16.",
            ),
            Step(
                f"{t[1]}, {t[2]}",
                1,
                "null vector",
                "At a root the null vector holds the products of both half angles.",
            ),
            Step(
                f"{t[4]}, {t[5]}, {t[3]}",
                1,
                "",
                "The loop closes with the joints that were eliminated and the one that was left alone; a "
                "Newton step on "
                "the arm itself takes out what rounding left.",
            ),
        ]

    def turn(self, joint: int, *, back: bool = False) -> Factor:
        """Rz of a joint's angle, or of minus it."""
        matrix = TrigMatrix.about_z(Angle(joint + 1, joint))
        sign = "−" if back else ""
        latex = f"R_z({'-' if back else ''}t_{joint + 1})"
        return f"Rz({sign}t{joint + 1})", latex, matrix.inverse() if back else matrix

    def link(self, i: int, *, back: bool = False) -> Factor:
        """L_i (from 1), or its inverse; L6 closes the loop through the goal."""
        if i == 6:
            goal = TrigMatrix.symbols().inverse()
            matrix = constant(self.last) @ goal @ constant(self.first)
        else:
            matrix = constant(self.links[i - 1])
        if back:
            return f"L{i}⁻¹", f"L_{i}^{{-1}}", matrix.inverse()
        return f"L{i}", f"L_{i}", matrix

    def chain_equation(self) -> MatrixEquation:
        """The arm in these frames: F Rz(t1) L1 Rz(t2) … Rz(t6) H = T."""
        factors: list[Factor] = [("F", "F", constant(self.first))]
        for i in range(6):
            factors.append(self.turn(i))
            factors.append(self.link(i + 1) if i < 5 else ("H", "H", constant(self.last)))
        return MatrixEquation(Product(tuple(factors)), Product((("T", "T", TrigMatrix.symbols()),)))

    def split_equation(self, joints: tuple[int, ...], backwards: bool) -> MatrixEquation:
        """M5 Rz(a0) M0 Rz(a1) M1 Rz(a2) M2 = Rz(−a5) M4⁻¹ Rz(−a4) M3⁻¹ Rz(−a3)."""

        def angle(k: int, *, inverse: bool = False) -> Factor:
            return self.turn(joints[k], back=backwards != inverse)

        def between(k: int, *, inverse: bool = False) -> Factor:
            """M_k, which leads from the axis of a_k to the next."""
            here = joints[k] + 1
            number = (here - 2) % 6 + 1 if backwards else here
            return self.link(number, back=backwards != inverse)

        left = (between(5), angle(0), between(0), angle(1), between(1), angle(2), between(2))
        right = (
            angle(5, inverse=True),
            between(4, inverse=True),
            angle(4, inverse=True),
            between(3, inverse=True),
            angle(3, inverse=True),
        )
        return MatrixEquation(Product(left), Product(right))


def constant(T: Array) -> TrigMatrix:
    """A matrix of numbers."""
    return TrigMatrix(T.tolist())
