"""The feasible intervals of a redundant joint, as the core computes them for a pose."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from cspace import _core
from cspace.arrays import Array
from cspace.errors import InputError, InputTypeError
from cspace.ik.locked_joints import joint_number, locked_values, value_in_words
from cspace.ik.redundancy.result import Interval, Redundancy
from cspace.ik.solver import Solver
from cspace.tolerances import MOVING_JOINT

END_NOTHING, END_FOLD = -1, -2


def redundancy_of_pose(
    solver: Solver, T: Array, parameter: Any, locked: Any, own: Solver | None = None
) -> Redundancy:
    """The feasible intervals for a pose of the solver's arm. own: as of locked_values."""
    values = locked_values(solver, locked, own)
    if any(np.ndim(value) for value in values.values()):
        raise InputTypeError("locked= takes one value per joint here")
    others = solver.lock({joint: float(value) for joint, value in values.items()})
    degree = others.redundancy_degree()
    if degree != 1:
        raise InputError(
            f"{solver.name} has {degree} redundant joints here, expected one: "
            + ("lock the others with locked=" if degree > 1 else "the goal determines all of them")
        )
    usual = others.redundant_joints[0]
    if parameter is None:
        joint = usual
    else:
        number = joint_number(solver, parameter, "parameter")
        if number in values:
            name = solver.joint_names[number]
            raise InputError(f"parameter {name!r} is locked by locked=; choose another joint")
        joint = others.joint_names.index(solver.joint_names[number])
    found = intervals_of(others, T, joint)
    if not found and joint != usual:
        check_moves(others, T, joint)
    if values:

        def with_locked(q: Array) -> Array:
            row = np.array([float(values.get(k, np.nan)) for k in range(solver.dof)])
            row[np.isnan(row)] = q
            return row

        found = found._of_arm(solver, with_locked)
    return found if is_bounded(others, joint) else replace(found, complete=False)


def is_bounded(solver: Solver, joint: int) -> bool:
    """Whether the parameter has limits or is an angle: of a prismatic joint without limits the search covers
    the length of the arm."""
    bounds = solver.limits.lower[joint], solver.limits.upper[joint]
    return solver.joint_types[joint] == "R" or bool(np.isfinite(bounds).all())


def check_moves(solver: Solver, T: Array, joint: int) -> None:
    """Raise InputError for a joint that rests during the self-motion: the goal determines it."""
    usual = solver.redundant_joints[0]
    seen = intervals_of(solver, T, usual)
    if not seen:
        return
    J = solver.jacobian(np.array([interval.q for interval in seen]))
    if np.abs(np.linalg.svd(J)[2][:, -1, joint]).max() > MOVING_JOINT:
        return
    at = ", ".join(sorted({value_in_words(solver, joint, interval.q[joint]) for interval in seen}))
    raise InputError(
        f"parameter {solver.joint_names[joint]!r} is determined by the goal, at {at}, and is not free; "
        f"take another joint, such as {solver.joint_names[usual]!r}"
    )


def intervals_of(solver: Solver, T: Array, joint: int) -> Redundancy:
    rows, inside, complete = _core._ik_intervals(solver, joint, T)
    names, slides = solver.joint_names, solver.joint_types[joint] == "P"

    def end(what: int, side: int) -> str:
        if what == END_FOLD:
            return "fold"
        return "nothing" if what == END_NOTHING else f"{names[what]} at {'upper' if side else 'lower'} limit"

    made = [
        Interval(low, high, branch + 1, (end(a, sa), end(b, sb)), q, slides)
        for (low, high, branch, a, sa, b, sb), q in zip(rows, inside, strict=True)
    ]
    made.sort(key=lambda interval: (interval.branch, interval.lower))
    return Redundancy(solver, T, names[joint], tuple(made), complete, slides)
