"""Locked joints as callers name them: which joints, at which values."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from typing import Any

import numpy as np

from cspace.arrays import as_floats
from cspace.errors import InputError, InputTypeError, name_type, suggest
from cspace.kinematics import KinematicModel
from cspace.tolerances import FARTHEST


def headings_of(solver: KinematicModel) -> list[str]:
    """The headings of joints in tables: q1, q2 …"""
    return [f"q{k + 1}" for k in range(len(solver.joint_names))]


def joint_named(solver: KinematicModel, key: str) -> int:
    """The number of a joint by its name, or by its heading in tables: "q7" is the seventh, number 6."""
    names = solver.joint_names
    if key in names:
        return int(names.index(key))
    if key in (headings := headings_of(solver)):
        return headings.index(key)
    raise suggest("joint", key, names, owner=solver.name)


def joint_number(solver: KinematicModel, key: Any, subject: str) -> int:
    """The number of a joint by its name, its heading or its number, from the end where it is negative."""
    names = solver.joint_names
    if isinstance(key, str):
        return joint_named(solver, key)
    if isinstance(key, bool) or not isinstance(key, (int, np.integer)):
        raise InputTypeError(f"{subject} contains {name_type(key)}; name joints by their name or number")
    if not -len(names) <= key < len(names):
        raise InputError(f"{subject} has joint {key}, but {solver.name} has joints 0 to {len(names) - 1}")
    return int(key) % len(names)


def locked_values(solver: KinematicModel, locked: Any, own: KinematicModel | None = None) -> dict[int, Any]:
    """The locked joints by number, ascending, each with a number or an array of them.

    own: the user's arm, whose numbers count, where `solver` has the virtual joints of a partial goal too;
    each joint then takes one value.
    """
    if locked is None:
        return {}
    if not isinstance(locked, Mapping):
        raise InputTypeError(
            f"locked is {name_type(locked)}, expected a dict from joints to values: {{'joint_7': 0.3}}"
        )
    out: dict[int, Any] = {}
    for key, value in locked.items():
        name = key
        if own is not None and (not isinstance(key, str) or key in headings_of(own)):
            name = own.joint_names[joint_number(own, key, "locked")]
        joint = joint_number(solver, name, "locked")
        if joint in out:
            raise InputError(f"locked names {solver.joint_names[joint]!r} twice; give each joint one value")
        out[joint] = as_floats(value, f"locked[{key!r}]", largest=FARTHEST)
        if own is not None and out[joint].ndim:
            raise InputTypeError(
                f"locked[{key!r}] is {name_type(value)}, expected one number with parts of a pose"
            )
    if len(out) >= len(solver.joint_names):
        raise InputError(f"locked names every joint of {solver.name}; at least one must stay free to move")
    return dict(sorted(out.items()))


def locked_in_words(solver: KinematicModel, locked: Mapping[int, Any]) -> str:
    """Joints with the values at which they are locked: lift = 0.2 m, wrist = 1.5 rad."""
    values = ((solver.joint_names[k], value_in_words(solver, k, value)) for k, value in locked.items())
    return ", ".join(f"{name} = {value}" for name, value in values)


def value_in_words(solver: KinematicModel, joint: int, value: Any) -> str:
    """A joint's value with its unit."""
    return f"{float(value):.6g} {'rad' if solver.joint_types[joint] == 'R' else 'm'}"


def between_others(n: int, locked: Collection[int]) -> tuple[int, ...]:
    """The locked joints of n that stand between joints that move: they change a link."""
    moving = [k for k in range(n) if k not in locked]
    return tuple(k for k in sorted(locked) if moving[0] < k < moving[-1])
