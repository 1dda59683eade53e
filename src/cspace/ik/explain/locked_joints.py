"""Arms of which joints are locked: a parameter takes their place, and the others are an arm of their own."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import numpy as np

from cspace import _core
from cspace.arrays import Array
from cspace.errors import InputError
from cspace.ik.explain.arm_angle import swivel_steps, swivel_values
from cspace.ik.explain.describe import ONE_CALL, settled_plan
from cspace.ik.explain.findings import Step
from cspace.ik.explain.page import Block, lay_out_table
from cspace.ik.explain.plan import IkPlan
from cspace.ik.explain.screws import goal_values
from cspace.ik.locked_joints import between_others, value_in_words
from cspace.ik.solver import MAX_SETTLED, Solver
from cspace.math import Angle, Equation, MatrixEquation, Product, TrigMatrix, TrigPolynomial
from cspace.model import Chain
from cspace.model.screws import twists
from cspace.spatial import exp_se3
from cspace.spatial.vectors import frame_along
from cspace.tolerances import SQUARE_WRIST

AHEAD = 100
"""Locked joints are angles of their own: those of the six that move are numbered from 1."""
GOLDEN = 0.6180339887498949
FIRST_MEET = 1
WHOLE, INNER = "whole_", "inner_"
"""What the symbols of the whole arm's goal and of that of the moving joints begin with."""


@dataclass(frozen=True, eq=False)
class Split:
    """Which joints are locked, which move (from 0). at: the values of the locked ones between others."""

    solver: Solver
    locked: tuple[int, ...]
    at: dict[int, float]

    @property
    def moving(self) -> tuple[int, ...]:
        """The joints that move."""
        return tuple(k for k in range(len(self.solver.joint_names)) if k not in self.locked)

    @property
    def between(self) -> tuple[int, ...]:
        """The locked joints between others: they change a link."""
        return between_others(len(self.solver.joint_names), self.locked)

    def others(self) -> Solver:
        """The arm of the joints that move; locked ones at the ends at zero, which leaves the plan alone."""
        return self.solver.lock({k: self.at[k] if k in self.between else 0.0 for k in self.locked})

    def frame(self, k: int) -> Array:
        """A frame (4, 4) on the axis of a joint at an end, z along it: in the base, or in the tip."""
        chain = self.solver.chain
        z = chain.axes[k]
        T = np.eye(4)
        T[:3, :3] = frame_along(z)
        T[:3, 3] = chain.points[k] - (chain.points[k] @ z) * z
        if k < self.moving[0]:
            return T
        frame = np.asarray(np.linalg.inv(chain.T_zero) @ T)
        frame[:3, 3] -= (frame[:3, 3] @ frame[:3, 2]) * frame[:3, 2]
        return frame

    def goal(self, q: Array, T: Array) -> Array:
        """The goals (..., 4, 4) of the joints that move."""
        chain, tip = self.solver.chain, self.solver.chain.T_zero
        before, after = np.eye(4), np.eye(4)
        for k in self.locked:
            if k in self.between:
                continue
            twist = twists(chain.axes[k : k + 1], chain.points[k : k + 1], chain.joint_types[k])[0]
            motion = exp_se3(twist * q[..., k, None])
            if k < self.moving[0]:
                before = before @ motion
            else:
                after = after @ motion
        behind = np.linalg.inv(tip) @ np.linalg.inv(after) @ tip
        return np.asarray(np.linalg.inv(before) @ T @ behind, dtype=np.float64)


def locked_plan(solver: Solver, locked: Mapping[int, float], survey: IkPlan) -> IkPlan:
    """An arm with redundant joints, or with locked joints. locked: values of joints that the user locks."""
    others = solver.lock(dict(locked))
    redundancy_degree = others.redundancy_degree()
    default = tuple(solver.joint_names.index(others.joint_names[k]) for k in others.redundant_joints)
    at = {**{k: typical_value(solver, k) for k in default}, **locked}
    split = Split(solver, tuple(sorted(at)), at)
    others = split.others()
    inner = settled_plan(
        others, replace(bare_survey(others), length=survey.length), tuple(k + 1 for k in split.moving)
    )
    steps = swivel_of(solver) if not locked else ()
    tables = dict(inner.tables)
    if redundancy_degree == 1 and not locked:
        tables = {"Joints that may be locked": list_choices(solver, default), **tables}
    notes = [*describe_reasons(split, default), *describe_numbering(split), *inner.notes]
    ends = [k for k in split.locked if k not in split.between]
    first = (locked_step(split, ends),) if inner else ()
    return replace(
        survey,
        length=inner.length,
        family="redundant" if redundancy_degree else "locked",
        summary=summarise_split(split, redundancy_degree, inner),
        branches=inner.branches if inner else solver.max_solutions,
        notes=tuple(notes),
        tables=tables,
        matrices={**{f"M{k + 1}": split.frame(k) for k in ends}, **inner.matrices},
        constants=inner.constants,
        steps=(*first, *inner.steps),
        locked=tuple(solver.joint_names[k] for k in split.locked),
        counted=f"{inner.counted}, for each value of {names_of(split, split.locked)}",
        calls=describe_answers(split, default, others) if redundancy_degree else ONE_CALL,
        other_ways={"By the swivel (`swivel=`)": steps} if steps else {},
        _values=values_of(split, inner),
        _other_values=partial(swivel_values, solver) if steps else None,
    )


def names_of(split: Split, joints: tuple[int, ...]) -> str:
    """`joint_1` and `joint_2`."""
    names = [f"`{split.solver.joint_names[k]}`" for k in joints]
    return ", ".join(names[:-1]) + f" and {names[-1]}" if len(names) > 1 else names[0]


def typical_value(solver: Solver, k: int) -> float:
    """The value of a joint at which nothing special is expected."""
    lower, upper = float(solver.limits.lower[k]), float(solver.limits.upper[k])
    if not np.isfinite([lower, upper]).all():
        lower, upper = -1.0, 1.0
    return lower + (0.2 + 0.6 * (GOLDEN * (k + 1) % 1.0)) * (upper - lower)


def summarise_split(split: Split, redundancy_degree: int, inner: IkPlan) -> str:
    """The method as one sentence."""
    n, solver = len(split.solver.joint_names), split.solver
    moving = len(split.moving)
    if redundancy_degree and moving == MAX_SETTLED:
        more = f"{n} joints, {n - MAX_SETTLED} more than the {MAX_SETTLED} that a pose settles"
    elif redundancy_degree:
        more = f"{n} joints, {redundancy_degree} more than the tip has ways to move"
    else:
        more = f"{n} joints, some of them locked"
    how = inner.summary if inner else "nothing solves exactly: members are found by descents from 48 starts"
    role = "is a parameter" if len(split.locked) == 1 else "are parameters"
    locked = f"{names_of(split, split.locked)} {role} of each call"
    return f"{more}. {locked}; the other {moving} of {solver.name}: {how}"


def describe_reasons(split: Split, default: tuple[int, ...]) -> list[str]:
    """Why these joints are locked."""
    out = []
    one = len(default) == 1
    if default:
        ends = not split.between
        cause = (
            ("it only moves" if one else "they only move")
            + " the goal, so that one plan of the others serves every value; of the choices at the ends "
            + ("this one leaves" if one else "these leave")
            + " the others the simplest method (the last joints where it makes no difference)"
            if ends
            else "neighbours alone have no method, and with one locked between others there is one"
        )
        out.append(
            f"The choice is made when the solver is built. Locked {'is' if one else 'are'} "
            f"{names_of(split, default)}: {cause}."
        )
    if split.between:
        values = {k: value_in_words(split.solver, k, split.at[k]) for k in split.between}
        at = ", ".join(f"$q_{k + 1}$ = {value}" for k, value in values.items())
        out.append(
            f"A joint locked between others changes a link: the numbers below are for {at}. Other values "
            "give other numbers, and the others are classified anew, which takes microseconds."
        )
    return out


def describe_numbering(split: Split) -> list[str]:
    """Which joints the six angles of the equations belong to, where their numbers differ."""
    moving = split.moving
    if moving == tuple(range(len(moving))):
        return []
    listed = ", ".join(f"`{split.solver.joint_names[k]}`" for k in moving)
    return [f"Joints 1 to {len(moving)} of the steps are those that move: {listed}."]


def list_choices(solver: Solver, default: tuple[int, ...]) -> Block:
    """For every joint that may be locked how the six others are solved."""
    rows = []
    for k, name in enumerate(solver.joint_names):
        split = Split(solver, (k,), {k: typical_value(solver, k)})
        others = settled_plan(split.others(), bare_survey(solver))
        place = "between others" if split.between else "at an end"
        kind = others.family if others else "descents from many starts"
        count = str(others.branches) if others else "a sample"
        rows.append((f"`{name}`", place, kind, count, "locked" if k in default else ""))
    return lay_out_table(("joint", "place", "the six others", "solutions up to", "by default"), rows)


def bare_survey(solver: Solver) -> IkPlan:
    """An arm without what its axes share: for plans inside of plans."""
    return IkPlan(solver.name, tuple(solver.joint_names))


def describe_answers(split: Split, default: tuple[int, ...], others: Solver) -> tuple[str, ...]:
    """How a goal is answered that leaves freedom."""
    locked = names_of(split, default)
    one = len(default) == 1
    usual = (
        f"all branches at 16 values of {locked}, spread over its feasible intervals"
        if one
        else "the configuration nearest to the middle of the limits"
    )
    out = [
        f"`robot.ik(T, locked=…)` gives {locked} and gets every solution of the steps above. Without it the "
        f"answer is {usual}."
    ]
    out.append(
        "`near=`: Newton's method on the distance from the seed and on the pose together, with exact second "
        f"derivatives, starts at the seed. Then {locked} {'is' if one else 'are'} sampled around the seed, "
        + ("as far as a nearer configuration could have it" if one else "ever farther")
        + ", each sample solved by the steps above, and the lowest settled by the same method. If "
        "a joint is then out of its limits, the search is repeated within limits."
    )
    if one:
        out.append(f"`robot.redundancy(T)`, the feasible intervals of {locked}: {describe_intervals(others)}")
    out.append(
        "`robot.track(poses)` follows the least motion of the joints, $q' = J^+ t$ for the twist $t$ of the "
        "path, from `start=` or from the configuration nearest to the middle of the limits; no joint is "
        "locked."
    )
    return tuple(out)


def describe_intervals(others: Solver) -> str:
    """How the feasible intervals are found."""
    limits = (
        "every other joint is locked at each of its limits, and what is left is solved: all points where a "
        "limit is reached. "
    )
    if folds_known(others):
        return (
            limits + "Branches also end at folds, where two of them meet. The first angle solves "
            "$a \\cos t_3 + b \\sin t_3 = r$ with $r$ linear in cosine and sine of the parameter, so it "
            "folds at the roots of $a^2 + b^2 - r^2$, of degree 2; the second at those of a product over "
            "both ways, of degree 4. Between two neighbouring values of all these one value decides."
        )
    return (
        limits
        + "From each of them the self-motion is followed along its tangent and its bend to the next, and "
        "each turn of the parameter is noted: folds are not known beforehand. Arcs that touch no limit are "
        "met by the solutions at some values."
    )


def folds_known(others: Solver) -> bool:
    """Whether the folds of the locked joint are roots of polynomials."""
    kind, plan = _core._ik_numbers(others)
    if kind != "closed" or not plan["on_lanes"] or plan["virtual_joints"] or not plan["wrist"]:
        return False
    first, last = plan["wrist"]["first"], plan["wrist"]["last"]
    return bool(first["kind"] == FIRST_MEET and max(abs(last["ca4"]), abs(last["ca5"])) < SQUARE_WRIST)


def swivel_of(solver: Solver) -> tuple[Step, ...]:
    """The steps by the swivel, for an arm that has one."""
    try:
        solver.check_swivel()
    except InputError:
        return ()
    return swivel_steps(solver.chain)


# --- the goal of the others -------------------------------------------------------------------------------
def locked_step(split: Split, ends: list[int]) -> Step:
    """What locked joints at the ends do to the goal."""
    chain, number = split.solver.chain, [f"$q_{k + 1}$" for k in split.locked]
    words = ""
    if ends:
        words += (
            "Locked joints at the ends move the goal: $T$, what is left for the others, is the goal of all "
            "that follows. $M_i$ is a frame on axis i, its z along the axis, in the base for a joint before "
            "the others, in the tip for one behind them."
        )
    if split.between:
        words += "A joint locked between others stands at the value that the numbers below belong to."
    words = words.strip()
    goal = ("Tgoal", r"T_{\text{goal}}", TrigMatrix.symbols(WHOLE))
    left = [part for k in reversed(ends) if k < split.moving[0] for part in undo_joint(split, k, chain)]
    right = [part for k in reversed(ends) if k > split.moving[-1] for part in undo_joint(split, k, chain)]
    parts = (*left, goal, *right)
    equations: list[Equation | MatrixEquation] = []
    if ends:
        equations.append(MatrixEquation(Product((("T", "T", TrigMatrix.symbols(INNER)),)), Product(parts)))
    for k in split.between:
        equations.append(
            Equation(TrigPolynomial.symbol(f"locked_{k + 1}"), TrigPolynomial.number(split.at[k]))
        )
    return Step(", ".join(number), words, tuple(equations), method="given")


def undo_joint(split: Split, k: int, chain: Chain) -> list[tuple[str, str, TrigMatrix]]:
    """M Rz(−q) M⁻¹: the motion of a locked joint taken back."""
    M, i = split.frame(k), k + 1
    frame, back = TrigMatrix(M.tolist()), TrigMatrix(np.linalg.inv(M).tolist())
    if chain.joint_types[k] == "P":
        back_by = -TrigPolynomial.symbol(f"q_{AHEAD + i}")
        turn = (f"Tz(−q{i})", f"T_z(-q_{i})", TrigMatrix.shift(z=back_by))
    else:
        turn = (f"Rz(−q{i})", f"R_z(-q_{i})", TrigMatrix.about_z(Angle(AHEAD + i, AHEAD + i)).inverse())
    return [(f"M{i}", f"M_{i}", frame), turn, (f"M{i}⁻¹", f"M_{i}^{{-1}}", back)]


def values_of(split: Split, inner: IkPlan) -> Any:
    """From configurations of the whole arm to the numbers of the symbols."""
    if inner._values is None:
        return None

    def values(q: Array, T: Array) -> dict[str, Any]:
        goal = split.goal(q, T)
        out = dict(inner._values(q[..., list(split.moving)], goal)) if inner._values else {}
        out |= goal_values(T, WHOLE) | goal_values(goal, INNER)
        out |= {f"locked_{k + 1}": q[..., k] for k in split.between}
        kinds = split.solver.chain.joint_types
        out |= {f"{'t' if kinds[k] == 'R' else 'q'}_{AHEAD + k + 1}": q[..., k] for k in split.locked}
        return out

    return values
