"""Arms of up to three joints, revolute or prismatic: the steps of include/cspace/ik/position/."""

from __future__ import annotations

from typing import Any

import numpy as np

from cspace.ik.explain.findings import Step
from cspace.ik.explain.screws import (
    Vector,
    dot_product,
    move_point,
    number_vector,
    symbol_vector,
)
from cspace.math import Equation, TrigPolynomial
from cspace.spatial.vectors import perpendicular


def invariants_of(chain: Any, i: int, x: Vector) -> list[tuple[TrigPolynomial, str]]:
    """The two functions of a point that joint i does not change, and their units."""
    h, o = chain.axes[i], chain.points[i]
    d = [x[k] - float(o[k]) for k in range(3)]
    if chain.joint_types[i] == "R":
        return [(dot_product(h, d), "m"), (sum((part * part for part in d), TrigPolynomial()), "m²")]
    across = perpendicular(h)
    return [(dot_product(across, d), "m"), (dot_product(np.cross(h, across), d), "m")]


def equate_invariants(
    f: list[tuple[TrigPolynomial, str]], g: list[tuple[TrigPolynomial, str]]
) -> tuple[Equation, ...]:
    """Equations between the invariants of a joint on both sides, without trivial ones."""
    pairs = [Equation(x, y, unit=unit) for (x, unit), (y, _) in zip(f, g, strict=True)]
    return tuple(each for each in pairs if (each.left - each.right).terms)


def few_joint_steps(chain: Any, goal: Vector | None = None) -> list[Step]:
    """The steps that bring the tip to a point, by default p."""
    kinds, n = chain.joint_types, len(chain.joint_types)
    goal, tip = symbol_vector("p") if goal is None else goal, number_vector(chain.T_zero[:3, 3])
    if n == 1:
        return [last_step(chain, 0, tip, goal)]
    middle = 0 if n == 2 else 1
    behind = move_point(chain, n - 1, tip)
    before = goal if n == 2 else move_point(chain, 0, goal, back=True)
    names = [f"${'t' if kinds[k] == 'R' else 'q'}_{k + 1}$" for k in ((1,) if n == 2 else (0, 2))]
    what = (
        "its height along the axis and its distance from a point of the axis"
        if kinds[middle] == "R"
        else "its two coordinates across the slide"
    )
    first = Step(
        " and ".join(names),
        f"Joint {middle + 1} maps one point to another exactly if its invariants agree: {what}.",
        equate_invariants(invariants_of(chain, middle, before), invariants_of(chain, middle, behind)),
        method="subproblem 5" if kinds == "RRR" else "",
        ways=2 if n == 2 else 4,
    )
    return [first, last_step(chain, middle, behind, before)]


def last_step(chain: Any, i: int, x: Vector, y: Vector) -> Step:
    """Joint i maps x to y."""
    turning = chain.joint_types[i] == "R"
    carried = move_point(chain, i, x)
    equations = (Equation(carried[k], y[k], unit="m") for k in range(3))
    return Step(
        f"$t_{i + 1}$" if turning else f"$q_{i + 1}$",
        f"Joint {i + 1} {'rotates' if turning else 'translates'} one point into the other.",
        tuple(each for each in equations if (each.left - each.right).terms),
        method="subproblem 1" if turning else "",
    )
