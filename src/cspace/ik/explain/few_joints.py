"""Arms of up to three joints, alone or with a wrist behind them, and three turns with three prismatic joints:
the steps of include/cspace/ik/position/ and general/decoupled.hpp."""

from __future__ import annotations

import numpy as np

from cspace.arrays import Array
from cspace.ik.explain.findings import Step
from cspace.ik.explain.screws import (
    Screws,
    Vector,
    dot_product,
    move_point,
    number_vector,
    symbol_vector,
    turn_direction,
)
from cspace.math import Equation, MatrixEquation, TrigPolynomial
from cspace.model import Chain
from cspace.spatial.vectors import perpendicular


def invariants_of(chain: Chain | Screws, i: int, x: Vector) -> list[tuple[TrigPolynomial, str]]:
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


def few_joint_steps(chain: Chain | Screws, goal: Vector | None = None) -> list[Step]:
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


def last_step(chain: Chain | Screws, i: int, x: Vector, y: Vector) -> Step:
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


AXES = "xyz"


def goal_turns(v: Array) -> Vector:
    """R v for the rotation R of the goal."""
    return [
        sum((float(v[j]) * TrigPolynomial.symbol(f"r_{i + 1}{j + 1}") for j in range(3)), TrigPolynomial())
        for i in range(3)
    ]


def placed_wrist_steps(arm: Screws, centre: Array) -> list[Step]:
    """Joints 1, 2, 3 position the centre (3,) of the wrist, joints 4, 5, 6 rotate about it."""
    in_tip = (np.linalg.inv(arm.T_zero) @ np.append(centre, 1.0))[:3]
    p, offset = symbol_vector("p"), goal_turns(in_tip)
    wanted = tuple(Equation.definition(f"w_{AXES[k]}", p[k] + offset[k], "m") for k in range(3))
    T_zero = np.eye(4)
    T_zero[:3, 3] = centre
    first = Screws(arm.joint_types[:3], arm.axes[:3], arm.points[:3], T_zero)
    place = few_joint_steps(first, symbol_vector("w"))
    where = Step("$w$", "The goal fixes where the centre of the wrist has to be.", wanted)
    return [where, *place, *three_turns(arm, (3, 4, 5), before=(0, 1, 2))]


def three_turns(arm: Screws, turns: tuple[int, int, int], before: tuple[int, ...]) -> list[Step]:
    """Three revolute joints give the remaining rotation: the middle one first."""
    i, _, k = turns
    h, R_tip = arm.axes, arm.T_zero[:3, :3]
    left = goal_turns(R_tip.T @ h[k])  # where the last axis points, seen behind the joints before
    for joint in before:
        left = turn_direction(arm, joint, left, back=True)
    seen = tuple(Equation.definition(f"g_{AXES[n]}", left[n]) for n in range(3))
    back = number_vector(h[i])
    for joint in reversed(before):
        back = turn_direction(arm, joint, back)
    words = (
        f"$g$ is the goal direction of axis {k + 1}, seen behind the joints before. Its angle with "
        f"axis {i + 1} depends on $t_{turns[1] + 1}$ alone.",
        f"Joint {i + 1} rotates axis {k + 1} to its goal.",
        f"The same from the other side: the direction of axis {i + 1}, seen from the tip.",
    )
    return rotation_steps(arm, turns, symbol_vector("g"), turned_back_by_goal(back, R_tip), words, seen)


def rotation_steps(
    arm: Chain | Screws,
    turns: tuple[int, int, int],
    ahead: Vector,
    behind: Vector,
    words: tuple[str, str, str],
    given: tuple[Equation, ...] = (),
) -> list[Step]:
    """Three axes make a rotation, the middle one first. ahead: where the rotation takes the last axis;
    behind: where its inverse takes the first. words: of each step; given: equations before the first one."""
    i, j, k = turns
    h = arm.axes
    middle = turn_direction(arm, j, number_vector(h[k]))
    first = Equation(dot_product(h[i], ahead), dot_product(h[i], middle))
    onto = equate_vectors(ahead, turn_direction(arm, i, middle), but=first)
    last = turn_direction(arm, k, turn_direction(arm, j, number_vector(h[i]), back=True), back=True)
    return [
        Step(f"$t_{j + 1}$", words[0], (*given, first), method="subproblem 4", ways=2),
        Step(f"$t_{i + 1}$", words[1], onto, method="subproblem 1"),
        Step(f"$t_{k + 1}$", words[2], equate_vectors(behind, last, but=first), method="subproblem 1"),
    ]


def equate_vectors(left: Vector, right: Vector, *, but: Equation) -> tuple[Equation, ...]:
    """The equations of two vectors, without those that say nothing, or the same as another."""
    pairs = (Equation(a, b) for a, b in zip(left, right, strict=True))
    said = (TrigPolynomial(), but.left - but.right, but.right - but.left)
    return tuple(each for each in pairs if each.left - each.right not in said)


def turned_back_by_goal(v: Vector, R_tip: Array) -> Vector:
    """R_tip Rᵀ v for the rotation R of the goal."""
    seen = [
        sum((TrigPolynomial.symbol(f"r_{i + 1}{j + 1}") * v[i] for i in range(3)), TrigPolynomial())
        for j in range(3)
    ]
    return [sum((float(R_tip[n, j]) * seen[j] for j in range(3)), TrigPolynomial()) for n in range(3)]


def orientation_steps(six: Screws, chain: MatrixEquation) -> list[Step]:
    """Three revolute joints give the orientation, then three prismatic joints the position."""
    turns = [k for k, kind in enumerate(six.joint_types) if kind == "R"]
    slides = [f"$q_{k + 1}$" for k, kind in enumerate(six.joint_types) if kind == "P"]
    return [
        *three_turns(six, (turns[0], turns[1], turns[2]), before=()),
        Step(
            ", ".join(slides),
            "With the angles known, the position is linear in the prismatic joints: three equations.",
            (chain,),
        ),
    ]
