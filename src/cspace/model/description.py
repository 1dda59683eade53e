"""A robot is data: links, joints, named poses and where each number comes from."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from types import MappingProxyType
from typing import Any

import numpy as np

from cspace.arrays import Array
from cspace.errors import InputError, suggest
from cspace.model.joint import Joint, Loop
from cspace.model.link import Link
from cspace.model.structure import ElementError, check_mimics, check_tree, unique_names
from cspace.model.values import finite_number, name_of
from cspace.tables import one_line, show_fields, tabulate


@show_fields
@dataclass(frozen=True)
class Source:
    """Where a group of numbers comes from, and under which licence."""

    source: str
    licence: str = ""


@show_fields
@dataclass(frozen=True)
class Provenance:
    """Who made the robot and who published its numbers.

    title: what a person calls it. vendor: its maker. sources: per group of fields (joints, limits, …).
    missing: the groups nobody published. aliases: other names of the same robot.
    """

    title: str = ""
    vendor: str = ""
    sources: Mapping[str, Source] = field(default_factory=dict)
    missing: tuple[str, ...] = ()
    aliases: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        object.__setattr__(self, "sources", MappingProxyType(dict(self.sources)))
        object.__setattr__(self, "missing", tuple(self.missing))
        object.__setattr__(self, "aliases", tuple(self.aliases))

    def __reduce__(self) -> tuple[Any, ...]:
        """Read-only mappings cannot be pickled; what they were made from can."""
        return type(self), (self.title, self.vendor, dict(self.sources), self.missing, self.aliases)


@tabulate()
@dataclass(frozen=True, eq=False)
class Description:
    """A robot as a tree of links and joints, all of them kept, fixed ones too.

    name: the robot. links, joints: in file order; every link but one (the root) is the child of one joint.
    loops: joints that close loops. poses: named configurations, joint name → value [rad or m].
    allowed_pairs: pairs of links that are not checked for collisions, each (link, link, reason).
    T_child at q is the product of the joint transforms from the root (see Joint).

    Raises DescriptionError for doubled names, missing links, cycles and two roots.
    """

    name: str
    links: tuple[Link, ...]
    joints: tuple[Joint, ...] = ()
    loops: tuple[Loop, ...] = ()
    poses: Mapping[str, Mapping[str, float]] = field(default_factory=dict)
    provenance: Provenance = field(default_factory=Provenance)
    allowed_pairs: tuple[tuple[str, str, str], ...] = ()
    ordered_links: tuple[str, ...] = field(init=False, repr=False)
    """Link names from the root outward, depth first, children in file order."""

    def __repr__(self) -> str:
        return one_line("Description", f"{self.name}: {len(self.links)} links, {len(self.joints)} joints")

    def __post_init__(self) -> None:
        name_of(self.name, "robot")
        store = object.__setattr__
        store(self, "links", tuple(self.links))
        store(self, "joints", tuple(self.joints))
        store(self, "loops", tuple(self.loops))
        unique_names(self.links, "link", self.name)
        unique_names((*self.joints, *self.loops), "joint", self.name)
        store(self, "ordered_links", check_tree(self.name, self.links, self.joints))
        check_mimics(self.name, self.joints)
        for loop in self.loops:
            for end in (loop.parent, loop.child):
                if end not in self.link_by_name:
                    error = suggest("link", end, self.link_by_name, owner=f"robot {self.name!r}")
                    raise ElementError(f"loop {loop.name!r}: {error}", loop)
        store(self, "allowed_pairs", tuple(map(self._checked_pair, self.allowed_pairs)))
        store(self, "poses", MappingProxyType({k: self._checked_pose(k, v) for k, v in self.poses.items()}))

    def __reduce__(self) -> tuple[Any, ...]:
        """Read-only mappings cannot be pickled; what they were made from can."""
        poses = {pose: dict(values) for pose, values in self.poses.items()}
        fields = (self.name, self.links, self.joints, self.loops, poses, self.provenance, self.allowed_pairs)
        return type(self), fields

    def _checked_pair(self, pair: Any) -> tuple[str, str, str]:
        a, b, reason = pair
        for name in (a, b):
            self.link(name)
        if a == b:
            raise InputError(f"the allowed pair names link {a!r} twice; a pair is of two different links")
        return a, b, str(reason)

    def _checked_pose(self, pose: str, values: Mapping[str, float]) -> Mapping[str, float]:
        for joint in values:
            if joint not in self.joint_by_name:
                raise suggest("joint", joint, self.joint_by_name, owner=f"pose {pose!r}")
        checked = {joint: finite_number(v, f"{joint} in pose {pose!r}") for joint, v in values.items()}
        return MappingProxyType(checked)

    @cached_property
    def link_by_name(self) -> Mapping[str, Link]:
        """The links by name, in file order."""
        return MappingProxyType({link.name: link for link in self.links})

    @cached_property
    def joint_by_name(self) -> Mapping[str, Joint]:
        """The joints by name, in file order."""
        return MappingProxyType({joint.name: joint for joint in self.joints})

    @cached_property
    def parent_joint(self) -> Mapping[str, Joint]:
        """For each link but the root, the joint that carries it."""
        return MappingProxyType({joint.child: joint for joint in self.joints})

    @cached_property
    def child_joints(self) -> Mapping[str, tuple[Joint, ...]]:
        """For each link the joints that it carries, in file order."""
        carried: dict[str, list[Joint]] = {link.name: [] for link in self.links}
        for joint in self.joints:
            carried[joint.parent].append(joint)
        return MappingProxyType({link: tuple(joints) for link, joints in carried.items()})

    @property
    def root(self) -> str:
        """The link that no joint carries."""
        return self.ordered_links[0]

    @cached_property
    def leaves(self) -> tuple[str, ...]:
        """The links that carry nothing, from the root outward."""
        return tuple(link for link in self.ordered_links if not self.child_joints[link])

    @cached_property
    def moving_joints(self) -> tuple[Joint, ...]:
        """The joints that are not fixed, from the root outward."""
        carriers = (self.parent_joint[link] for link in self.ordered_links[1:])
        return tuple(joint for joint in carriers if joint.moving)

    def link(self, name: str) -> Link:
        """The link of that name, or UnknownNameError with the nearest names."""
        if not isinstance(name, str) or name not in self.link_by_name:
            raise suggest("link", name, self.link_by_name, owner=f"robot {self.name!r}")
        return self.link_by_name[name]

    def joint(self, name: str) -> Joint:
        """The joint of that name, or UnknownNameError with the nearest names."""
        if name not in self.joint_by_name:
            raise suggest("joint", name, self.joint_by_name, owner=f"robot {self.name!r}")
        return self.joint_by_name[name]

    def renamed(self, name: str) -> Description:
        """The same robot under another name."""
        return replace(self, name=name)


class NamedPoses(dict[str, Array]):
    """Configurations by name; an unknown name gets suggestions."""

    def __init__(self, robot: str, poses: Mapping[str, Array]) -> None:
        super().__init__(poses)
        self.robot = robot

    def __missing__(self, name: str) -> Array:
        raise suggest("named pose", name, self, owner=f"robot {self.robot!r}")

    def __reduce__(self) -> tuple[Any, ...]:
        """A dict with arguments is not pickled as one."""
        return type(self), (self.robot, dict(self))


def named_poses(description: Description, joints: Sequence[str]) -> dict[str, Array]:
    """The named poses as configurations q (n,) [rad or m] of these joints, in their order.

    A pose without a value for one of the joints is left out. The arrays are copies. An unknown name raises
    UnknownNameError with the similar ones.
    """
    whole = {name: values for name, values in description.poses.items() if all(j in values for j in joints)}
    found = {name: np.array([values[j] for j in joints], dtype=np.float64) for name, values in whole.items()}
    return NamedPoses(description.name, found)
