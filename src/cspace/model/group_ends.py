"""The chain of a group of joints: from which link to which link it runs."""

from __future__ import annotations

from collections.abc import Mapping

from cspace.errors import InputError, suggest
from cspace.model.chain import find_path
from cspace.model.description import Description
from cspace.model.joint import Joint
from cspace.model.srdf import Srdf, list_names


def group_ends(description: Description, srdf: Srdf, group: str) -> tuple[str, str]:
    """The base and the tip link of a group of an SRDF file, for Robot(description, base, tip).

    A group of one chain has the ends of that chain. Otherwise its joints are those that it lists, those that
    carry its links, those of its chains and those of the groups that it includes; they must form one chain,
    which fixed joints of the group extend. Raises UnknownNameError for a group that the file does not have,
    InputError for a group whose joints branch or leave gaps, that moves nothing, or that names links or
    joints that the robot lacks.
    """
    owner = f"the SRDF file of robot {srdf.robot!r}"
    if group not in srdf.groups:
        raise suggest("group", group, srdf.groups, owner=owner)
    found = srdf.groups[group]
    if len(found.chains) == 1 and not (found.links or found.joints or found.groups):
        base, tip = found.chains[0]
        find_ends(description, group, base, tip)
        return base, tip
    joints = {name: description.joint(name) for name in joints_of(description, srdf, group, ())}
    return ends_of_joints(description, srdf, group, joints)


def find_ends(description: Description, group: str, base: str, tip: str) -> list[Joint]:
    """The joints from base to tip; InputError for links that the robot lacks."""
    for link in (base, tip):
        check_member(group, "link", link, link in description.link_by_name, description)
    return [joint for joint, _ in find_path(description, base, tip)]


def check_member(group: str, kind: str, name: str, known: bool, description: Description) -> None:
    """InputError for a link or joint of a group that the robot lacks."""
    if not known:
        names = description.link_by_name if kind == "link" else description.joint_by_name
        error = suggest(kind, name, names, owner=f"robot {description.name!r}")
        raise InputError(f"group {group!r}: {error}")


def joints_of(description: Description, srdf: Srdf, group: str, above: tuple[str, ...]) -> list[str]:
    """The names of the joints of a group, with those of the groups that it includes."""
    if group in above:
        raise InputError(f"group {group!r} includes itself, by way of {' → '.join((*above, group))}")
    found = srdf.groups[group]
    names = [joint for joint in found.joints if joint not in srdf.virtual_joints]
    for joint in names:
        check_member(group, "joint", joint, joint in description.joint_by_name, description)
    for link in found.links:
        check_member(group, "link", link, link in description.link_by_name, description)
        names += [description.parent_joint[link].name] if link in description.parent_joint else []
    for base, tip in found.chains:
        names += [joint.name for joint in find_ends(description, group, base, tip)]
    for other in found.groups:
        names += joints_of(description, srdf, other, (*above, group))
    return names


def ends_of_joints(
    description: Description, srdf: Srdf, group: str, joints: Mapping[str, Joint]
) -> tuple[str, str]:
    """The ends of the chain that joints form, by name."""
    moving = [joint for joint in joints.values() if joint.moving]
    if not moving:
        raise InputError(f"group {group!r} moves no joint of {description.name!r}; {choices(srdf, group)}")
    path = max((joints_to(description, joint) for joint in moving), key=len)
    off = [joint.name for joint in moving if joint not in path]
    if off:
        raise InputError(
            f"group {group!r} branches: the chain to {path[-1].child!r} is without {list_names(off)};"
            f" {choices(srdf, group)}"
        )
    first = next(k for k, joint in enumerate(path) if joint in moving)
    gaps = [joint.name for joint in path[first:] if joint.moving and joint.name not in joints]
    if gaps:
        left_out = list_names(gaps)
        raise InputError(f"group {group!r} leaves out {left_out} of its chain; {choices(srdf, group)}")
    base, tip = path[first].parent, path[-1].child
    fixed = [joint for joint in joints.values() if not joint.moving]
    while len(onward := [joint for joint in fixed if joint.parent == tip]) == 1:
        tip = onward[0].child
    while (carrier := description.parent_joint.get(base)) in fixed and carrier is not None:
        base = carrier.parent
    return base, tip


def joints_to(description: Description, joint: Joint) -> list[Joint]:
    """The joints from the root to a joint, which is the last."""
    path = [joint]
    while (carrier := description.parent_joint.get(path[-1].parent)) is not None:
        path.append(carrier)
    return path[::-1]


def choices(srdf: Srdf, group: str) -> str:
    """The remedy: the other groups."""
    others = [name for name in srdf.groups if name != group]
    named = f"one of the groups {list_names(others)}, or " if others else ""
    return f"choose {named}the ends of a chain by base= and tip="
