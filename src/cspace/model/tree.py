"""The whole robot as arrays: moving joints in topological order, frames and bodies folded onto them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np

from cspace.arrays import Array
from cspace.model.description import Description
from cspace.model.elementary import Coordinates, Elementary, coordinates_of, elementary_joints
from cspace.model.link import Inertial
from cspace.model.values import freeze_array
from cspace.tables import show_fields


@show_fields
@dataclass(frozen=True, eq=False)
class Tree:
    """The turns and slides of a robot, each after its parent.

    T_root_k(q) = T_root_parent[k](q) · placement[k] · motion(axis[k], q_k), with body k carried by joint k.

    joint_names, joint_types: n names and a string of "R" and "P". parent (n,) integers: the joint before, −1
    for the root. placement (n, 4, 4): joint frame in the frame of the joint before, fixed joints multiplied
    in. axes (n, 3): unit directions in the joint frame. coordinates: the independent q behind the joints.
    frames: every link, name → (joint that carries it or −1, its pose (4, 4) in the frame of that joint).
    mass (n + 1,) [kg], com (n + 1, 3) [m], inertia (n + 1, 3, 3) about the com [kg·m²]: of the links carried
    by joint k, in its frame, at index k + 1; the root body at index 0. massless: links without inertial data.
    root: the link at the origin; floating: whether the file lets it float.
    """

    name: str
    root: str
    floating: bool
    joint_names: tuple[str, ...]
    joint_types: str
    parent: np.ndarray[tuple[int], np.dtype[np.intp]]
    placement: Array
    axes: Array
    coordinates: Coordinates
    frames: Mapping[str, tuple[int, Array]]
    mass: Array
    com: Array
    inertia: Array
    massless: tuple[str, ...]


def tree(description: Description) -> Tree:
    """The robot as a Tree.

    Where the root is tied to the rest by a floating joint alone (a "world" link), the tree starts at the
    child of that joint and is marked floating; frames above it are left out.
    Raises DescriptionError for a floating joint anywhere else.
    """
    root, floating = _floating_root(description)
    frames: dict[str, tuple[int, Array]] = {root: (-1, np.eye(4))}
    parts: list[Elementary] = []
    parent: list[int] = []
    placement: list[Array] = []
    for link in description.ordered_links:
        joint = description.parent_joint.get(link)
        if joint is None or link == root or joint.parent not in frames:
            continue
        carrier, pose = frames[joint.parent]
        steps = elementary_joints(joint)
        if not steps:
            frames[link] = (carrier, pose @ joint.origin)
            continue
        for step in steps:
            parts.append(step)
            parent.append(carrier)
            placement.append(pose @ step.origin)
            carrier, pose = len(parts) - 1, np.eye(4)
        frames[link] = (carrier, pose)
    n = len(parts)
    mass, com, inertia, massless = lump_links(description, frames, n)
    for _, pose in frames.values():
        freeze_array(pose)
    return Tree(
        name=description.name,
        root=root,
        floating=floating,
        joint_names=tuple(part.name for part in parts),
        joint_types="".join(part.kind for part in parts),
        parent=np.array(parent, dtype=np.intp),
        placement=freeze_array(np.array(placement).reshape(n, 4, 4)),
        axes=freeze_array(np.array([part.axis for part in parts]).reshape(n, 3)),
        coordinates=coordinates_of(tuple(parts), description.joint_by_name),
        frames=MappingProxyType(frames),
        mass=mass,
        com=com,
        inertia=inertia,
        massless=massless,
    )


def _floating_root(description: Description) -> tuple[str, bool]:
    """The link where the tree starts, and whether a floating joint carries it."""
    here = description.root
    while True:
        carried = description.child_joints[here]
        if len(carried) != 1 or carried[0].type not in ("fixed", "floating"):
            return description.root, False
        here = carried[0].child
        if carried[0].type == "floating":
            return here, True


def lump_links(
    description: Description, frames: Mapping[str, tuple[int, Array]], n: int
) -> tuple[Array, Array, Array, tuple[str, ...]]:
    """Mass, centre of mass and inertia of what the base and each joint carry rigidly; links without a mass.

    frames: link → (the joint that carries it or −1, its pose (4, 4) in the frame of that joint).
    """
    carried: list[list[tuple[Inertial, Array]]] = [[] for _ in range(n + 1)]
    massless = []
    for name, (joint, pose) in frames.items():
        inertial = description.link_by_name[name].inertial
        if inertial is None:
            massless.append(name)
        else:
            carried[joint + 1].append((inertial, pose))
    mass, com, inertia = np.zeros(n + 1), np.zeros((n + 1, 3)), np.zeros((n + 1, 3, 3))
    for k, parts in enumerate(carried):
        if parts:
            mass[k], com[k], inertia[k] = lump_bodies(parts)
    return freeze_array(mass), freeze_array(com), freeze_array(inertia), tuple(massless)


def lump_bodies(parts: list[tuple[Inertial, Array]]) -> tuple[float, Array, Array]:
    """One body out of several: Σm, Σm c / Σm, and Σ(R I Rᵀ + m (|d|² 1 − d dᵀ)) about it (Steiner)."""
    if len(parts) == 1:  # as on most links
        inertial, pose = parts[0]
        R = pose[:3, :3]
        return inertial.mass, R @ inertial.com + pose[:3, 3], R @ inertial.inertia @ R.T
    mass = sum(inertial.mass for inertial, _ in parts)
    places = [pose[:3, :3] @ inertial.com + pose[:3, 3] for inertial, pose in parts]
    weighted = [inertial.mass * place for (inertial, _), place in zip(parts, places, strict=True)]
    com = np.sum(weighted, axis=0) / mass if mass > 0.0 else np.zeros(3)
    inertia = np.zeros((3, 3))
    for (inertial, pose), place in zip(parts, places, strict=True):
        d = place - com
        R = pose[:3, :3]
        inertia += R @ inertial.inertia @ R.T + inertial.mass * ((d @ d) * np.eye(3) - np.outer(d, d))
    return mass, com, inertia
