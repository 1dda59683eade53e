"""What kinematics moves: joints of one freedom each, taken from the joints of a description."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from cspace.arrays import Array
from cspace.errors import DescriptionError
from cspace.model.joint import Joint, Limits
from cspace.model.values import IDENTITY
from cspace.tables import show_fields


@dataclass(frozen=True, eq=False)
class Elementary:
    """One rotation or translation: kind "R" or "P", placed by `origin` (4, 4), about or along `axis` (3,).

    name: of the joint; the three parts of a planar joint are name/x, name/y and name/turn.
    joint: where it comes from, with its limits.
    """

    name: str
    kind: str
    origin: Array
    axis: Array
    joint: Joint


@show_fields
@dataclass(frozen=True, eq=False)
class Coordinates:
    """The independent coordinates q of a row of joints: joint k has the value multiplier·q[index] + offset.

    names: of the coordinates, in the order in which their joints come. index (n,) integers, multiplier (n,),
    offset (n,): per joint. limits: of the coordinates.
    """

    names: tuple[str, ...]
    index: np.ndarray[tuple[int], np.dtype[np.intp]]
    multiplier: Array
    offset: Array
    limits: Limits


def elementary_joints(joint: Joint) -> tuple[Elementary, ...]:
    """The rotations and translations of which a joint consists, outermost first.

    A planar joint has two translations in its plane, then a rotation about its normal; the first direction
    is a coordinate axis of the joint frame made perpendicular to the normal (x for the normal z).
    Raises DescriptionError for a floating joint, which has no such coordinates.
    """
    if joint.type in ("revolute", "continuous"):
        return (Elementary(joint.name, "R", joint.origin, joint.axis, joint),)
    if joint.type == "prismatic":
        return (Elementary(joint.name, "P", joint.origin, joint.axis, joint),)
    if joint.type == "planar":
        first = np.eye(3)[(int(np.argmax(np.abs(joint.axis))) + 1) % 3]
        first = first - joint.axis * (first @ joint.axis)
        first /= np.linalg.norm(first)
        second = np.cross(joint.axis, first)
        return (
            Elementary(f"{joint.name}/x", "P", joint.origin, first, joint),
            Elementary(f"{joint.name}/y", "P", IDENTITY, second, joint),
            Elementary(f"{joint.name}/turn", "R", IDENTITY, joint.axis, joint),
        )
    if joint.type == "fixed":
        return ()
    raise DescriptionError(
        f"joint {joint.name!r} is floating: it has no single coordinate;"
        f" use base={joint.child!r} and give its pose as T_world_base"
    )


def coordinates_of(joints: tuple[Elementary, ...], by_name: Mapping[str, Joint]) -> Coordinates:
    """The coordinates of `joints`: a mimic joint shares the coordinate of its leader."""
    position: dict[str, int] = {}
    leaders: list[Joint] = []
    index, multiplier, offset = [], [], []
    for part in joints:
        leader, factor, shift = leading_joint(part.joint, by_name)
        name = part.name if leader is part.joint else leader.name
        if name not in position:
            position[name] = len(position)
            leaders.append(leader)
        index.append(position[name])
        multiplier.append(factor)
        offset.append(shift)
    return Coordinates(
        names=tuple(position),
        index=np.array(index, dtype=np.intp),
        multiplier=np.array(multiplier, dtype=np.float64),
        offset=np.array(offset, dtype=np.float64),
        limits=Limits.of(leaders),
    )


def leading_joint(joint: Joint, by_name: Mapping[str, Joint]) -> tuple[Joint, float, float]:
    """The joint at the head of a row of mimics, with the combined multiplier and offset."""
    factor, shift = 1.0, 0.0
    while joint.mimic is not None:
        shift += factor * joint.mimic.offset
        factor *= joint.mimic.multiplier
        joint = by_name[joint.mimic.joint]
    return joint, factor, shift
