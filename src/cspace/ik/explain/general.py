"""Six joints in general position: the steps of include/cspace/ik/general/."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from cspace.arrays import Array
from cspace.ik.explain.findings import Step
from cspace.ik.explain.page import Block, lay_out_table
from cspace.ik.explain.screws import Screws, goal_values, joint_values
from cspace.ik.geometry import as_arrays
from cspace.math import Angle, MatrixEquation, Product, TrigMatrix, TrigPolynomial

Factor = tuple[str, str, TrigMatrix]


def read_formulation(number: int) -> tuple[int, tuple[int, ...], bool]:
    """Its number, the joints behind a_0 … a_5 (from 0), and whether the loop is read backwards: from number 6
    on, where they count from the tip."""
    shifted = [(number + k) % 6 for k in range(6)]
    backwards = number >= 6
    return number, tuple(5 - k if backwards else k for k in shifted), backwards


@dataclass(frozen=True, eq=False)
class Loop:
    """The loop that arm and goal close. six: the joints in metres, virtual ones behind the arm's own.

    links: L1 … L5 (4, 4) from the frame on axis i to the next one. first, last: from the base to axis 1, from
    axis 6 to the tip (4, 4); lengths over `length` [m]. order: the formulations as they are asked: number,
    the joints behind a_0 … a_5 (from 0), whether read backwards. neighbours: whether arms beside it are
    asked. wrist: None, or whether the wrist behind three joints is at the base.
    """

    six: Screws
    links: tuple[Array, ...]
    first: Array
    last: Array
    length: float
    order: tuple[tuple[int, tuple[int, ...], bool], ...]
    perturbed_arms: bool
    wrist: bool | None

    @classmethod
    def of(cls, arm: Mapping[str, Any]) -> Loop:
        """From the numbers of a general arm."""
        plan = as_arrays(arm["plan"])
        chain, frames, length = plan["chain"], plan["frames"], plan["length"]
        kinds = "".join("P" if slides else "R" for slides in chain["prismatic"])
        tip = chain["tip"].copy()
        tip[:3, 3] *= length
        six = Screws(kinds, np.array(chain["axis"]), length * np.array(chain["point"]), tip)
        order = tuple(read_formulation(number) for number in plan["order"] if plan["slides"] < 3)
        wrist = arm["position_first"].get("backwards")
        links = tuple(frames["between"])
        return cls(six, links, frames["first"], frames["last"], length, order, arm["has_perturbed"], wrist)

    @property
    def slides(self) -> int:
        """How many of the six joints slide."""
        return self.six.joint_types.count("P")

    def values(self, q: Array, T: Array) -> dict[str, Any]:
        """The numeric values of angles and goal, lengths over the arm's."""
        joints = joint_values(self.six.joint_types, q, length=self.length)
        return joints | goal_values(T, length=self.length)

    def symbol(self, joint: int) -> str:
        """t_i or q_i of a joint (from 0), for sentences."""
        return f"${'t' if self.six.joint_types[joint] == 'R' else 'q'}_{joint + 1}$"

    def matrices(self) -> dict[str, Array]:
        """The matrices that the equations name."""
        return {"F": self.first, **{f"L{i + 1}": link for i, link in enumerate(self.links)}, "H": self.last}

    def formulations(self, names: tuple[str, ...]) -> Block:
        """The formulations that serve, in the order in which they are asked."""
        rows = []
        for k, (_, joints, backwards) in enumerate(self.order, 1):
            said = [f"`{names[j]}`" if j < len(names) else f"virtual joint {j + 1}" for j in joints]
            read = "tip to base" if backwards else "base to tip"
            rows.append((str(k), said[0], f"{said[1]}, {said[2]}", f"{said[4]}, {said[5]}", said[3], read))
        head = ("order", "hidden", "in the null vector", "eliminated", "left alone", "read")
        return lay_out_table(head, rows)

    def steps(self) -> list[Step]:
        """The steps of the formulation that is asked first."""
        _, joints, backwards = self.order[0]
        t = [self.symbol(joint) for joint in joints]
        loop = Step(
            "The loop",
            "A frame on each axis, its z along the axis, makes the arm a product of joints and links. "
            "Any joint may come first, and the loop may be read backwards; asked first is the one that "
            f"begins with {t[0]}.",
            (self.chain_equation(), self.split_equation(joints, backwards)),
        )
        return [loop, *(self.two_prismatic_steps(t) if self.slides == 2 else self.elimination(t))]

    def elimination(self, t: list[str]) -> list[Step]:
        """At most one prismatic joint: the elimination of Raghavan and Roth."""
        slides = " (a prismatic joint has powers instead of sines and cosines)" if self.slides else ""
        return [
            Step(
                t[0],
                "Both sides map the z axis to the same direction $l$ and the origin to the same point $p$, "
                f"and {t[3]} changes neither. Both sides agree in $p$, $l$, $p \\cdot p$, $p \\cdot l$, "
                "$p \\times l$ and $(p \\cdot p) l - 2 (p \\cdot l) p$: fourteen equations (Raghavan and "
                f"Roth 1990). Six combinations of them do not contain {t[4]} and {t[5]}. Multiplied by the "
                f"sine and cosine of half of {t[1]}, they are twelve linear equations in twelve products of "
                f"{t[1]} and {t[2]}{slides}. Their determinant, a trigonometric polynomial of degree 8 in "
                f"{t[0]}, the hidden angle, vanishes at the solutions: up to 16.",
                method="elimination",
                ways=16,
            ),
            Step(
                f"{t[1]}, {t[2]}",
                "At a root the null vector contains the products of both.",
                method="null vector",
            ),
            Step(
                f"{t[4]}, {t[5]}, {t[3]}",
                "The loop closes with the joints that were eliminated and the one that was left alone; a "
                "Newton step on the arm itself takes out what rounding left.",
            ),
        ]

    def two_prismatic_steps(self, t: list[str]) -> list[Step]:
        """Two prismatic joints: the orientation is made by four turns."""
        turns = [each for each in t[1:] if "t" in each]
        slides = [each for each in t if "q" in each]
        return [
            Step(
                t[0],
                f"Four turns make the orientation, so {t[0]} is free; given it, a corner of the rotation "
                "fixes one more angle in two ways, and the others follow. What the position still lacks "
                "must lie in the plane of both slides. The product of that condition over both ways is a "
                f"trigonometric polynomial of degree 4 in {t[0]}, the hidden angle: up to 8 roots.",
                method="two sheets",
                ways=8,
            ),
            Step(", ".join(turns), "The way on which the condition vanishes makes the orientation."),
            Step(
                ", ".join(slides),
                "Two linear equations: the slides make up for what the position lacks.",
            ),
        ]

    def turn(self, joint: int, *, back: bool = False) -> Factor:
        """Rz of a joint's angle, or of minus it; Tz of a prismatic joint."""
        sign, number = "−" if back else "", joint + 1
        if self.six.joint_types[joint] == "P":
            matrix = TrigMatrix.shift(z=TrigPolynomial.symbol(f"q_{number}"))
            latex = f"T_z({'-' if back else ''}q_{number})"
            return f"Tz({sign}q{number})", latex, matrix.inverse() if back else matrix
        matrix = TrigMatrix.about_z(Angle(number, joint))
        latex = f"R_z({'-' if back else ''}t_{joint + 1})"
        return f"Rz({sign}t{joint + 1})", latex, matrix.inverse() if back else matrix

    def link(self, i: int, *, back: bool = False) -> Factor:
        """L_i (from 1), or its inverse; L6 closes the loop through the goal."""
        if i == 6:
            goal = TrigMatrix.symbols().inverse()
            matrix = constant_matrix(self.last) @ goal @ constant_matrix(self.first)
        else:
            matrix = constant_matrix(self.links[i - 1])
        if back:
            return f"L{i}⁻¹", f"L_{i}^{{-1}}", matrix.inverse()
        return f"L{i}", f"L_{i}", matrix

    def chain_equation(self) -> MatrixEquation:
        """The arm in these frames: F Rz(t1) L1 Rz(t2) … Rz(t6) H = T."""
        factors: list[Factor] = [("F", "F", constant_matrix(self.first))]
        for i in range(6):
            factors.append(self.turn(i))
            factors.append(self.link(i + 1) if i < 5 else ("H", "H", constant_matrix(self.last)))
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


def constant_matrix(T: Array) -> TrigMatrix:
    """A matrix of numbers."""
    return TrigMatrix(T.tolist())
