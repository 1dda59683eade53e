"""A robot with other masses, inertias and resistances of its joints."""

from __future__ import annotations

from dataclasses import replace
from typing import Any, TypeVar, cast

import numpy as np
from numpy.typing import ArrayLike

from cspace.arrays import Array, one_array
from cspace.dynamics.regressor import (
    BODY,
    RESISTANCES,
    TENSOR,
    count_parameters,
    moving_bodies,
    moving_joints,
)
from cspace.errors import InputError
from cspace.kinematics.batch import check_robot
from cspace.kinematics.kinematic_model import KinematicModel
from cspace.model import Description, Inertial, Joint, Link
from cspace.tables import join_words

Model = TypeVar("Model", bound=KinematicModel)


def with_parameters(robot: Model, pi: ArrayLike) -> Model:
    """The same robot with other dynamic parameters, such as those of an Identification.

    What a joint carries becomes the mass of its first link; links fixed to this one have none. pi (n,): as
    parameters(robot) returns them, with or without friction; without, damping and dry friction stay.

    Returns a robot; the one given is not changed.
    Raises InputError for another number of parameters, a negative mass, a mass that no link of the
    description can have, and planar joints whose three parts differ.
    """
    check_robot(robot)
    counts = [count_parameters(robot._assembly, friction) for friction in (True, False)]
    if np.ndim(pi) == 1 and np.isnan(np.asarray(pi, dtype=float)).any():
        raise InputError("pi holds NaN, as where data do not determine a parameter; identify(physical=True)")
    row = one_array(pi, "pi", (None,), "the parameters of the robot")
    if len(row) not in counts:
        raise InputError(
            f"pi has {len(row)} entries, {robot.name} has {counts[0]}, or {counts[1]} without friction"
        )
    source = cast(Any, robot)
    bodies = count_parameters(robot._assembly, False) - robot._assembly.n_joints
    description: Description = source.description
    joints = robot._assembly.n_joints
    kinds = row[bodies:].reshape((len(row) - bodies) // max(1, joints), joints)
    description = replace(
        description,
        links=replace_masses(robot, description, row[:bodies].reshape(bodies // len(BODY), len(BODY))),
        joints=replace_resistances(robot, description, kinds),
    )
    return cast(Model, source._constructor(description=description)())


def replace_masses(robot: KinematicModel, description: Description, rows: Array) -> tuple[Link, ...]:
    """The links, those that move with other masses; rows (bodies, 10)."""
    assembly = robot._assembly
    found: dict[str, Inertial | None] = {}
    carriers = dict(zip(assembly.frame_index, assembly.frame_joint.tolist(), strict=True))
    joints = moving_joints(robot)
    for body, row in zip(moving_bodies(assembly), rows, strict=True):
        if not body.name and row.any():
            raise InputError(
                f"joint {joints[body.joint]} of {robot.name} carries no link, so its mass must be zero"
            )
        found.update({name: None for name, joint in carriers.items() if joint == body.joint})
        if body.name:
            found[body.name] = read_inertial(body.name, row)
    return tuple(
        replace(link, inertial=found[link.name]) if link.name in found else link for link in description.links
    )


def read_inertial(name: str, row: Array) -> Inertial | None:
    """Mass, centre and inertia about it of the ten parameters of a body, None for zeros."""
    if not row.any():
        return None
    m = float(row[0])
    if m < 0.0 or (m == 0.0 and row[1:4].any()):
        raise InputError(
            f"m_{name} is {m:g}; a body needs a positive mass (identify with physical=True finds one)"
        )
    c = row[1:4] / m if m > 0.0 else np.zeros(3)
    return Inertial(m, c, row[4:][TENSOR] - m * (c @ c * np.eye(3) - np.outer(c, c)))


def replace_resistances(robot: KinematicModel, description: Description, rows: Array) -> tuple[Joint, ...]:
    """The joints with other armatures, damping and friction; rows (1 or 3, joints)."""
    found: dict[str, dict[str, Any]] = {}
    for name, values in zip(moving_joints(robot), rows.T.tolist(), strict=True):
        joint = name if name in description.joint_by_name else name.rpartition("/")[0]
        fields = dict(zip(RESISTANCES, values, strict=False))
        if found.setdefault(joint, fields) != fields:
            raise InputError(
                f"the parts of the planar joint {joint} differ; it has one {join_words(list(fields))}"
            )
    return tuple(
        replace(joint, **found[joint.name]) if joint.name in found else joint for joint in description.joints
    )
