"""Degrees of freedom of points, bodies, arms and floating trees, and of linkages by counting."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from numbers import Real
from typing import Any, Final

from cspace.errors import InputError, InputTypeError, shown, suggest
from cspace.model.description import Description
from cspace.model.joint import FREEDOMS

BODY: Final = {2: 3, 3: 6}
"""Degrees of freedom of a rigid body in the plane and in space."""


def point_freedoms(dimension: int = 3) -> int:
    """The numbers that place a point: 2 in the plane, 3 in space."""
    return _checked_dimension(dimension)


def body_freedoms(dimension: int = 3) -> int:
    """The numbers that place a rigid body: 3 in the plane (x, y, θ), 6 in space."""
    return BODY[_checked_dimension(dimension)]


def tree_freedoms(description: Description, *, floating: bool = False) -> int:
    """The numbers that place all links of a tree: 1 per revolute or prismatic joint, 6 for a floating base.

    Joints that mimic add none; a floating joint in the file counts 6, a planar one 3.
    """
    joints = _checked_description(description).joints
    return sum(joint.freedoms for joint in joints) + (6 if floating else 0)


def mobility(
    description: Description | None = None,
    *,
    links: int | None = None,
    joints: Sequence[Any] | None = None,
    dimension: int = 3,
) -> int:
    """The degrees of freedom of a linkage by the formula of Grübler and Kutzbach.

    M = λ (N − 1 − J) + Σ f_i = parameters λ (N − 1) − constraints Σ (λ − f_i), with λ = 6 in space and 3 in
    the plane, N links counting the ground, J joints with f_i freedoms each.

    Either a description, with its loops, or links=N and joints=[f_1, …], numbers or joint types. The formula
    counts every constraint as independent: where the axes of a loop are parallel or meet in a point in
    space it counts too low (take dimension=2 for planar linkages), and the answer may be negative (a rigid
    frame).
    Raises InputError for counts that make no sense. Sources: Grübler 1883, Kutzbach 1929.
    """
    size = BODY[_checked_dimension(dimension)]
    if description is not None:
        if links is not None or joints is not None:
            raise InputError("give either a description or links= and joints=, not both")
        links = len(_checked_description(description).links)
        joints = [joint.freedoms for joint in description.joints]
        joints += [FREEDOMS[loop.type] for loop in description.loops]
    if links is None or joints is None:
        raise InputError(
            "mobility needs a description, or links= (including the ground) and joints= (freedoms)"
        )
    if isinstance(joints, str) or not isinstance(joints, Iterable):
        raise InputTypeError(f"joints is a list of freedoms or joint types, got {joints!r}")
    if links < 1:
        raise InputError(f"links is {links}; it must be at least 1, the ground")
    freedoms = [_freedoms(joint, size) for joint in joints]
    return size * (links - 1 - len(freedoms)) + sum(freedoms)


def task_word(dof: int, task: int) -> str:
    """The relation of an arm with `dof` freedoms to a task of `task` numbers.

    "over-constrained" (dof < task), "exact" (dof = task) or "redundant" (dof > task).
    """
    if dof < 0 or task < 0:
        raise InputError(f"dof and task must not be negative, got {dof} and {task}")
    return "over-constrained" if dof < task else "redundant" if dof > task else "exact"


def _checked_description(description: object) -> Description:
    if not isinstance(description, Description):
        raise InputTypeError(
            f"expected a Description, got {type(description).__name__}; that of a robot is robot.description"
        )
    return description


def _checked_dimension(dimension: int) -> int:
    if not isinstance(dimension, Real) or dimension not in BODY:
        raise InputError(f"dimension is {shown(dimension)}; expected 2 (the plane) or 3 (space)")
    return dimension


def _freedoms(joint: Any, size: int) -> int:
    """The freedoms of one joint given as a number or a type."""
    if isinstance(joint, str):
        if joint not in FREEDOMS:
            raise suggest("joint type", joint, FREEDOMS)
        joint = FREEDOMS[joint]
    possible = isinstance(joint, Real) and joint in range(size + 1)
    if not possible:
        raise InputError(f"a joint has {joint!r} freedoms; expected 0 to {size}")
    return int(joint)
