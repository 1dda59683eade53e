"""The links, joints and loops of an MJCF document while it is read: every name once, every place known."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from functools import partial
from typing import Final

import numpy as np

from cspace.arrays import Array
from cspace.errors import suggest
from cspace.model.attributes import complain_at, fault_at
from cspace.model.joint import Loop
from cspace.model.mjcf.given import Defaults, Given
from cspace.model.mjcf.joints import Draft
from cspace.model.mounting import free_name
from cspace.model.values import IDENTITY, from_wxyz, translation_by
from cspace.model.xml import Element
from cspace.spatial.poses import invert_pose

WORLD: Final = "world"
"""The link of <worldbody>, as MuJoCo calls it."""


Segment = tuple[Draft, str, str, Array]
"""A joint of the description to be, its parent and its child, and where it stands in its parent (4, 4)."""


class Skeleton:
    """The links and joints read so far.

    bodies: their names and numbers, those of MuJoCo. links: bodies and the links made beside them.
    segments: the joints. drafts: the joints that the file gives, by name, in the order of MuJoCo's
    coordinates. rest: where each link is in the world (4, 4) with every joint at its `ref`. sites: name of a
    site → its link.
    """

    def __init__(self, root: Element) -> None:
        inside = [part for world in root.all("worldbody") for part in world.walk()]
        named = {tag: [e.attributes.get("name", "") for e in inside if e.tag == tag] for tag in TAGS}
        self.link_names = {WORLD, *named["body"]}
        self.joint_names = {*named["joint"], *named["freejoint"]}
        self.given_joints: set[str] = set()
        self.bodies = {WORLD: 0}
        self.links = [WORLD]
        self.segments: list[Segment] = []
        self.drafts: dict[str, Draft] = {}
        self.rest: dict[str, Array] = {WORLD: IDENTITY}
        self.sites: dict[str, str] = {}

    def body_name(self, element: Element) -> str:
        """The name of a body, made up where it has none."""
        name = element.attributes.get("name", "")
        if name in self.bodies:
            raise fault_at(element, f"a second body is named {name!r}")
        return name or new_name(f"body_{len(self.bodies)}", self.link_names)

    def joint_name(self, element: Element, body: str) -> str:
        """The name of a joint, made up where it has none."""
        name = element.attributes.get("name", "")
        if name in self.given_joints:
            raise fault_at(element, f"a second joint is named {name!r}")
        name = name or new_name(f"{body}_joint", self.joint_names)
        self.given_joints.add(name)
        return name

    def add_body(
        self, element: Element, name: str, parent: str, place: Array, drafts: Sequence[Draft]
    ) -> None:
        """A body that stands at `place` (4, 4) in its parent, moved by its joints, the first outermost.

        T_parent_body(q) = place · ∏ᵢ anchorᵢ · motionᵢ(qᵢ − refᵢ) · anchorᵢ⁻¹
        """
        self.rest[name] = self.rest[parent] @ place
        self.bodies[name] = len(self.bodies)
        here, last = parent, drafts[-1] if drafts else None
        for draft in drafts:
            self.drafts[draft.name] = draft
            whole = draft is last and np.array_equal(draft.anchor, IDENTITY)
            link = name if whole else new_name(f"{name}/{draft.name}", self.link_names)
            self.segments.append((draft, here, link, place @ draft.anchor))
            self.links.append(link)
            here, place = link, invert_pose(draft.anchor)
        if here != name:
            self.add_fixed(element, name, here, place)

    def add_site(self, element: Element, body: str, place: Array) -> None:
        """A site with a name, as a link that stands at `place` (4, 4) in its body."""
        name = element.attributes["name"]
        if name in self.sites:
            raise fault_at(element, f"a second site is named {name!r}")
        link = new_name(f"{name}_site" if name in self.link_names else name, self.link_names)
        self.sites[name] = link
        self.rest[link] = self.rest[body] @ place
        self.add_fixed(element, link, body, place)

    def add_fixed(self, element: Element, link: str, parent: str, place: Array) -> None:
        """A link that is fixed to its parent at `place` (4, 4)."""
        self.links.append(link)
        draft = Draft(new_name(f"{link}_fixed", self.joint_names), "fixed", element)
        self.segments.append((draft, parent, link, place))


def new_name(wish: str, taken: set[str]) -> str:
    """A name that is none of those taken, which it joins."""
    name = free_name(wish, taken)
    taken.add(name)
    return name


TAGS: Final = ("body", "joint", "freejoint")


def read_loops(equalities: Sequence[Element], defaults: Defaults, skeleton: Skeleton) -> tuple[Loop, ...]:
    """A spherical loop for each <connect> and a rigid one for each <weld> that is active."""
    found: list[Loop] = []
    for element in equalities:
        if element.tag not in ("connect", "weld") or not defaults.given(element).flag("active", True):
            continue
        wish = element.attributes.get("name", "") or f"{element.tag}_{len(found) + 1}"
        name = new_name(wish, skeleton.joint_names)
        found.append(complain_at(element, partial(read_loop, name, element, skeleton)))
    return tuple(found)


def read_loop(name: str, element: Element, skeleton: Skeleton) -> Loop:
    """Two bodies that share a point, or are one: at two sites; else where the anchor in the first is when all
    is at rest, or as `relpose` says or the rest has it."""
    kind = "spherical" if element.tag == "connect" else "fixed"
    if element.attributes.keys() & {"site1", "site2"}:
        first, second = two_ends(element, "site", skeleton.sites)
        return Loop(name, kind, skeleton.sites[first], skeleton.sites[second])
    first, second = two_ends(element, "body", skeleton.bodies, WORLD)  # the world where one is left out
    if kind == "fixed":
        return Loop(name, kind, first, second, relative_pose(element, first, second, skeleton))
    origin = translation_by(np.array(Given(element).floats("anchor", None, 3)))
    far = invert_pose(skeleton.rest[second]) @ skeleton.rest[first] @ origin
    return Loop(name, kind, first, second, origin, far)


def relative_pose(element: Element, first: str, second: str, skeleton: Skeleton) -> Array:
    """The pose (4, 4) of the second body in the first; a quaternion of zeros means that of the rest."""
    numbers = Given(element).floats("relpose", (0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0), 7)
    if not any(numbers[3:]):
        return invert_pose(skeleton.rest[first]) @ skeleton.rest[second]
    return translation_by(np.array(numbers[:3])) @ from_wxyz(numbers[3:], "relpose")


def two_ends(element: Element, kind: str, known: Collection[str], default: str = "") -> tuple[str, str]:
    """The two sites, or bodies, that an equality names."""
    first, second = (element.attributes.get(f"{kind}{i}", default) for i in (1, 2))
    for name in (first, second):
        if name not in known:
            raise fault_at(element, f"<{element.tag}>: {suggest(kind, name, known)}")
    return first, second
