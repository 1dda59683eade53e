"""SRDF, the semantic files of MoveIt: groups of joints, named poses, and pairs of links that may touch."""

from __future__ import annotations

import logging
import os
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, Final

from cspace.errors import DescriptionError, suggest
from cspace.model.attributes import fault_at, read_floats, slip_in, text_of
from cspace.model.description import Description
from cspace.model.joint import Joint
from cspace.model.transmissions import read_rotors
from cspace.model.xml import Element, parse_source
from cspace.tables import one_line, show_fields, tabulate

CHILDREN: Final[dict[str, frozenset[str]]] = {
    "robot": frozenset(
        {
            "group",
            "group_state",
            "end_effector",
            "virtual_joint",
            "passive_joint",
            "joint_property",
            "link_sphere_approximation",
            "disable_collisions",
            "disable_default_collisions",
            "enable_collisions",
            "rotor_params",
        }
    ),
    "group": frozenset({"chain", "joint", "link", "group"}),
    "group_state": frozenset({"joint"}),
}
ATTRIBUTES: Final[dict[str, frozenset[str]]] = {
    "group": frozenset({"name"}),
    "chain": frozenset({"base_link", "tip_link"}),
    "link": frozenset({"name"}),
    "group_state": frozenset({"name", "group"}),
    "disable_collisions": frozenset({"link1", "link2", "reason"}),
    "enable_collisions": frozenset({"link1", "link2", "reason"}),
    "disable_default_collisions": frozenset({"link"}),
}
"""The elements and attributes of SRDF, to tell a slip of the pen from an extension."""
JOINT_ATTRIBUTES: Final = {"group": frozenset({"name"}), "group_state": frozenset({"name", "value"})}
"""Of <joint>, which means two things."""

MOST_SHOWN: Final = 12
"""Names that a message lists."""

MOST_VALUES: Final = 7
"""Of one joint: a floating one has a position and a quaternion."""

LOG: Final = logging.getLogger("cspace")


@show_fields
@dataclass(frozen=True)
class JointGroup:
    """A named part of a robot, as the file gives it.

    links, joints: names. chains: pairs of base and tip links. groups: names of groups that it includes.
    """

    name: str
    links: tuple[str, ...] = ()
    joints: tuple[str, ...] = ()
    chains: tuple[tuple[str, str], ...] = ()
    groups: tuple[str, ...] = ()


@show_fields
@dataclass(frozen=True)
class GroupState:
    """A named configuration of a group: joint name → values [rad or m], several for joints of several."""

    name: str
    group: str
    values: Mapping[str, tuple[float, ...]]


@tabulate()
@dataclass(frozen=True, repr=False)
class Srdf:
    """The content of an SRDF file, by the names that it uses, whether a robot has them or not.

    robot: the name of the robot. groups: by name. states: named configurations. allowed_pairs: (link, link,
    reason) of links that are not checked for collisions. allowed_links: links that are checked with none but
    the links of required_pairs. virtual_joints: names of joints that tie the robot to the world, which groups
    may list. armatures: joint name → inertia of its rotor behind its gear [kg·m² or kg]. path: the file, None
    for a text.
    """

    robot: str
    groups: Mapping[str, JointGroup]
    states: tuple[GroupState, ...]
    allowed_pairs: tuple[tuple[str, str, str], ...]
    allowed_links: tuple[str, ...] = ()
    required_pairs: tuple[tuple[str, str], ...] = ()
    virtual_joints: tuple[str, ...] = ()
    armatures: Mapping[str, float] = field(default_factory=dict)
    path: str | None = None

    def __repr__(self) -> str:
        counts = f"{len(self.groups)} groups, {len(self.states)} named poses, {len(self.allowed_pairs)} pairs"
        return one_line("Srdf", f"of {self.robot}: {counts}")

    def fault(self, message: str) -> DescriptionError:
        """An error that names the file."""
        return DescriptionError(message, path=self.path)


def read_srdf(source: str | os.PathLike[str] | bytes) -> Srdf:
    """The content of an SRDF file (Semantic Robot Description Format, wiki.ros.org/srdf).

    source: a path, or the text itself (a string that starts with "<", or bytes). Groups, group states and
    disabled collisions are read, and Pinocchio's <rotor_params>; end effectors, passive joints and sphere
    approximations are not. Names are not compared with a robot here, see with_srdf.

    Raises DescriptionError with file and line for malformed XML, misspelled elements and attributes, doubled
    names, and a pair of one link.
    """
    root = parse_source(source)
    check_root(root)
    check_words(root)
    groups = read_groups(root)
    return Srdf(
        robot=root.attributes.get("name", "").strip(),
        groups=groups,
        states=read_states(root, groups),
        allowed_pairs=tuple(
            (*ends_of(element), element.attributes.get("reason", "").strip())
            for element in root.all("disable_collisions")
        ),
        allowed_links=tuple(text_of(element, "link") for element in root.all("disable_default_collisions")),
        required_pairs=tuple(ends_of(element) for element in root.all("enable_collisions")),
        virtual_joints=tuple(text_of(element, "name") for element in root.all("virtual_joint")),
        armatures=read_rotors(root),
        path=root.path,
    )


def check_root(root: Element) -> None:
    """Complain unless the document is SRDF, saying what it is instead."""
    if any(element.tag.startswith("xacro:") for element in root.walk()):
        raise fault_at(root, "this SRDF is a xacro file; expand it first: xacro x.srdf.xacro > x.srdf")
    if root.tag != "robot":
        raise fault_at(root, f"this is not SRDF: the root element is <{root.tag}>, not <robot>")
    if root.first("link") is not None:
        raise fault_at(root, "this is a URDF file: it has links; SRDF has groups, poses and pairs of links")


def check_words(root: Element) -> None:
    """Complain about what looks like a slip of the pen: an element left out in silence is worse."""
    stack = [root]
    while stack:
        element = stack.pop()
        known = CHILDREN[element.tag]
        attributes = dict(ATTRIBUTES)
        if element.tag in JOINT_ATTRIBUTES:
            attributes["joint"] = JOINT_ATTRIBUTES[element.tag]
        slip = slip_in(element, known, known, attributes)
        if slip is not None:
            raise fault_at(slip[1], slip[0])
        stack += [child for child in element.children if element is root and child.tag in CHILDREN]


def ends_of(element: Element) -> tuple[str, str]:
    """The two links of a pair."""
    a, b = text_of(element, "link1"), text_of(element, "link2")
    if a == b:
        raise fault_at(element, f"<{element.tag}> names link {a!r} twice; a pair is of two different links")
    return a, b


def read_groups(root: Element) -> dict[str, JointGroup]:
    """The groups by name."""
    groups: dict[str, JointGroup] = {}
    for element in root.all("group"):
        name = text_of(element, "name")
        if name in groups:
            raise fault_at(element, f"two groups are named {name!r}")
        links, joints, others = (
            tuple(text_of(child, "name") for child in element.all(tag)) for tag in ("link", "joint", "group")
        )
        chains = tuple(
            (text_of(child, "base_link"), text_of(child, "tip_link")) for child in element.all("chain")
        )
        groups[name] = JointGroup(name, links, joints, chains, others)
    for element in root.all("group"):
        for child in element.all("group"):
            if child.attributes["name"].strip() not in groups:
                error = suggest("group", child.attributes["name"], groups, owner="this file")
                raise fault_at(child, str(error))
    return groups


def read_states(root: Element, groups: Mapping[str, JointGroup]) -> tuple[GroupState, ...]:
    """The named configurations, each name once per group and each joint once per configuration."""
    states: dict[tuple[str, str], GroupState] = {}
    for element in root.all("group_state"):
        name, group = text_of(element, "name"), text_of(element, "group")
        if group not in groups:
            raise fault_at(element, str(suggest("group", group, groups, owner="this file")))
        if (name, group) in states:
            raise fault_at(element, f"two states of group {group!r} are named {name!r}")
        values: dict[str, tuple[float, ...]] = {}
        for child in element.all("joint"):
            joint = text_of(child, "name")
            if joint in values:
                raise fault_at(child, f"state {name!r} gives joint {joint!r} twice")
            values[joint] = tuple(read_floats(child, "value", None, 1, MOST_VALUES))
        states[name, group] = GroupState(name, group, values)
    return tuple(states.values())


def with_srdf(description: Description, srdf: Srdf | str | os.PathLike[str] | bytes) -> Description:
    """The description with the named poses, the allowed pairs and the armatures of an SRDF file.

    srdf: a path, the text, or what read_srdf returned. Poses replace those of the same name. States of one
    name of several groups become one pose; where two give one joint different values, each is named
    "group/state". Reasons of pairs are kept. A file often covers more than the robot, such as a gripper:
    pairs with links and values of joints that the robot lacks are left out, and the log lists them; joints of
    several coordinates are left out as well. Raises DescriptionError, with the file, as read_srdf, and for a
    file with pairs or poses of which the robot has none.
    """
    content = srdf if isinstance(srdf, Srdf) else read_srdf(srdf)
    pairs, unknown_links = known_pairs(description, content)
    poses, unknown_joints = known_poses(description, content.states)
    joints, strange = known_rotors(description, content.armatures)
    unknown_joints = list(dict.fromkeys([*unknown_joints, *strange]))
    if (unknown_links or unknown_joints) and not (pairs or poses or joints != description.joints):
        raise content.fault(
            f"the file is of robot {content.robot!r} and shares no link and no joint with robot"
            f" {description.name!r}; it names {list_names([*unknown_links, *unknown_joints])}"
        )
    for kind, names in (("links", unknown_links), ("joints", unknown_joints)):
        if names:
            LOG.warning("%s: robot %r has no %s %s", content.path, description.name, kind, list_names(names))
    return replace(
        description,
        joints=joints,
        poses={**description.poses, **poses},
        allowed_pairs=merge_pairs([*description.allowed_pairs, *pairs], content.required_pairs),
    )


def known_pairs(description: Description, content: Srdf) -> tuple[list[tuple[str, str, str]], list[str]]:
    """The allowed pairs of links that the robot has, and the links that it lacks."""
    links = description.link_by_name
    pairs = [pair for pair in content.allowed_pairs if pair[0] in links and pair[1] in links]
    for link in content.allowed_links:
        pairs += [(link, other, "Default") for other in links if link in links and other != link]
    named = [name for pair in content.allowed_pairs for name in pair[:2]] + list(content.allowed_links)
    return pairs, unknown_names(named, links)


def merge_pairs(
    pairs: Iterable[tuple[str, str, str]], required: Iterable[tuple[str, str]]
) -> tuple[tuple[str, str, str], ...]:
    """Each pair once, in either order, with its first reason; without those that must be checked."""
    checked = {frozenset(pair) for pair in required}
    found: dict[frozenset[str], tuple[str, str, str]] = {}
    for pair in pairs:
        key = frozenset(pair[:2])
        if key not in checked:
            found.setdefault(key, pair)
    return tuple(found.values())


def known_poses(
    description: Description, states: Sequence[GroupState]
) -> tuple[dict[str, dict[str, float]], list[str]]:
    """The named poses of joints that the robot has, and the joints that it lacks."""
    joints = description.joint_by_name
    single = {
        (state.name, state.group): {
            joint: values[0] for joint, values in state.values.items() if joint in joints and len(values) == 1
        }
        for state in states
    }
    poses: dict[str, dict[str, float]] = {}
    clashing = set()
    for (name, _), values in single.items():
        merged = poses.setdefault(name, {})
        if any(merged.get(joint, value) != value for joint, value in values.items()):
            clashing.add(name)
        merged.update(values)
    for (name, group), values in single.items():
        if name in clashing:
            poses.pop(name, None)
            poses[f"{group}/{name}"] = values
    named = [joint for state in states for joint in state.values]
    return {name: values for name, values in poses.items() if values}, unknown_names(named, joints)


def known_rotors(
    description: Description, armatures: Mapping[str, float]
) -> tuple[tuple[Joint, ...], list[str]]:
    """The joints of the robot with the armatures that are given for them, and the joints that it lacks."""
    joints = tuple(
        replace(joint, armature=armatures[joint.name]) if joint.name in armatures else joint
        for joint in description.joints
    )
    return joints, unknown_names(armatures, description.joint_by_name)


def unknown_names(names: Iterable[str], known: Mapping[str, Any]) -> list[str]:
    """The names that are not known, each once."""
    return [name for name in dict.fromkeys(names) if name not in known]


def list_names(names: Sequence[str]) -> str:
    """The first names, and how many more there are."""
    more = f" and {len(names) - MOST_SHOWN} more" if len(names) > MOST_SHOWN else ""
    return ", ".join(map(repr, names[:MOST_SHOWN])) + more
