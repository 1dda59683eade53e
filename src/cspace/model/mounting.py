"""A robot with what stands before its base and after its tip, as one description."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import replace

from cspace.arrays import Array
from cspace.errors import InputError
from cspace.model.chain import rigid_group, zero_poses
from cspace.model.description import Description
from cspace.model.joint import Joint
from cspace.model.link import Inertial, Link
from cspace.model.tree import lump_bodies
from cspace.model.values import IDENTITY
from cspace.spatial.poses import invert_pose


def with_frame(
    description: Description, parent: str, T_parent_frame: Array, name: str = "tool"
) -> Description:
    """The robot with one more link, fixed to `parent` at T_parent_frame (4, 4).

    name: of the new link, with "_" added where it is taken. Raises UnknownNameError for an unknown parent.
    """
    link = free_name(name, description.link_by_name)
    joint = free_name(f"{link}_fixed", description.joint_by_name)
    fixed = Joint(joint, "fixed", description.link(parent).name, link, T_parent_frame)
    return replace(description, links=(*description.links, Link(link)), joints=(*description.joints, fixed))


def with_body(
    description: Description, link: str, body: Inertial, T_link_body: Array = IDENTITY
) -> Description:
    """The robot with one more body, fixed to a link: the link has the mass properties of both.

    T_link_body (4, 4): the frame of the body in the link. Raises UnknownNameError for an unknown link.
    """
    old = description.link(link)
    parts = [] if old.inertial is None else [(old.inertial, IDENTITY)]
    parts.append((body, T_link_body))
    heavier = replace(old, inertial=Inertial(*lump_bodies(parts)))
    return replace(description, links=tuple(heavier if each is old else each for each in description.links))


def mounted(description: Description, base: str, T_world_base: Array, name: str = "world") -> Description:
    """The robot on a new root link, in which its link `base` stands at T_world_base (4, 4).

    Raises InputError where `base` moves against the root: a tree can be mounted at its root only.
    """
    if base not in rigid_group(description, description.root):
        raise InputError(
            f"link {base!r} moves against the root {description.root!r} of robot {description.name!r},"
            " so the file cannot contain the pose of its base; write the robot without with_base"
        )
    T_world_root = T_world_base @ invert_pose(zero_poses(description)[base])
    link = free_name(name, description.link_by_name)
    joint = free_name(f"{link}_fixed", description.joint_by_name)
    fixed = Joint(joint, "fixed", link, description.root, T_world_root)
    return replace(description, links=(Link(link), *description.links), joints=(fixed, *description.joints))


def free_name(name: str, taken: Collection[str]) -> str:
    """`name`, with as many "_" after it as it needs to be new."""
    while name in taken:
        name += "_"
    return name
