"""Robots from MJCF, with the file and the line in every complaint."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from functools import partial
from itertools import accumulate
from pathlib import Path
from typing import Any, Final

from cspace.arrays import Array
from cspace.model.attributes import complain_at, fault_at, read_floats
from cspace.model.description import Description
from cspace.model.files import check_folders
from cspace.model.link import Geometry, Inertial, Link
from cspace.model.mjcf.actuators import Drive, read_drives
from cspace.model.mjcf.document import Includes
from cspace.model.mjcf.geoms import Geom, Geoms
from cspace.model.mjcf.given import Defaults, Given
from cspace.model.mjcf.joints import Coupling, Draft, read_couplings, read_joint
from cspace.model.mjcf.masses import (
    correct_inertial,
    has_weight,
    read_inertial,
    scale_inertials,
    weight_of_geoms,
)
from cspace.model.mjcf.settings import settings_of
from cspace.model.mjcf.skeleton import WORLD, Skeleton, read_loops, two_ends
from cspace.model.mjcf.words import check_words
from cspace.model.structure import ElementError
from cspace.model.values import IDENTITY
from cspace.model.xml import Element

MAKERS: Final = {
    "replicate": "copies of a body",
    "attach": "another model",
    "composite": "many bodies",
    "flexcomp": "a soft body",
}
"""Elements that MuJoCo expands into bodies."""

PART: Final = "mujocoinclude"
"""What MuJoCo's own files call the root of a part."""

Part = tuple[Element, Array, "str | None"]
"""An element of a body, the frame (4, 4) in that body where it stands, and the class around it."""


def mjcf_description(root: Element, package_paths: Sequence[Any] = ()) -> Description:
    """The robot of the root element of an MJCF document; errors as in from_mjcf."""
    if root.tag != "mujoco":
        part = "; it is a part, so give the file that includes it" if root.tag == PART else ""
        raise fault_at(root, f"this is no MJCF: the root element is <{root.tag}>, not <mujoco>{part}")
    Includes(root).resolve()
    check_words(root)
    return complain_at(root, _Reader(root, package_paths).read)


class _Reader:
    """Reads one document: first the bodies, then what ties them."""

    def __init__(self, root: Element, package_paths: Sequence[Any]) -> None:
        self.root = root
        self.defaults = Defaults(root)
        self.settings = settings_of(root)
        self.geoms = Geoms(root, self.defaults, self.settings, check_folders(package_paths))
        self.skeleton = Skeleton(root)
        self.weights: dict[str, Inertial | None] = {}
        self.visual: dict[str, list[Geometry]] = {}
        self.collision: dict[str, list[Geometry]] = {}

    def read(self) -> Description:
        for world in self.root.all("worldbody"):
            self.tree(world)
        skeleton = self.skeleton
        equalities = self.sections("equality")
        followers = read_couplings(equalities, self.defaults, skeleton.drafts)
        driven = read_drives(self.sections("actuator"), self.defaults)
        weights = scale_inertials(self.weights, self.settings)
        links = tuple(self.link(name, weights.get(name)) for name in skeleton.links)
        joints = []
        for draft, parent, child, place in skeleton.segments:
            drive = driven.get(draft.name, Drive())
            make = partial(draft.joint, parent, child, place, followers.get(draft.name), drive)
            joints.append(complain_at(draft.element, make))
        ties = read_loops(equalities, self.defaults, skeleton)
        poses = read_keyframes(self.sections("keyframe"), skeleton.drafts, followers)
        pairs = read_excludes(self.sections("contact"), skeleton.bodies)
        unnamed = "robot" if self.root.path is None else Path(self.root.path).stem
        name = self.root.attributes.get("model", "").strip() or unnamed
        try:
            return Description(name, links, tuple(joints), ties, poses, allowed_pairs=pairs)
        except ElementError as error:
            culprit = None if error.part is None else skeleton.drafts.get(error.part.name)
            raise fault_at(self.root if culprit is None else culprit.element, str(error)) from None

    def sections(self, tag: str) -> list[Element]:
        """What all sections of that tag hold."""
        return [element for section in self.root.all(tag) for element in section.children]

    def link(self, name: str, weight: Inertial | None) -> Link:
        """The link of that name; a mass of zero is none."""
        inertial = weight if weight is not None and weight.mass > 0.0 else None
        return Link(name, inertial, tuple(self.visual.get(name, ())), tuple(self.collision.get(name, ())))

    def tree(self, world: Element) -> None:
        """Read the bodies from the world outward, each before those that it carries."""
        stack: list[tuple[Part, str]] = [((world, IDENTITY, None), "")]
        while stack:
            (element, T_parent_frame, around), parent = stack.pop()
            around = element.attributes.get("childclass", around)
            parts = list(self.parts(element, around))
            if element is world:
                name = self.world(parts)
            else:
                place = T_parent_frame @ self.settings.placement(Given(element))
                name = self.body(element, parent, place, parts)
            self.fill(element, name, parts)
            stack.extend((part, name) for part in reversed(parts) if part[0].tag == "body")

    def parts(self, body: Element, around: str | None) -> Iterator[Part]:
        """What stands in a body, in order, each with its place; frames are gone."""
        stack: list[Part] = [(child, IDENTITY, around) for child in reversed(body.children)]
        while stack:
            element, T, around = stack.pop()
            if element.tag in MAKERS:
                raise fault_at(
                    element,
                    f"<{element.tag}> makes {MAKERS[element.tag]} and is not read here; let MuJoCo write the"
                    " whole model first (mujoco.mj_saveLastXML)",
                )
            if element.tag != "frame":
                yield element, T, around
                continue
            T = T @ self.settings.placement(Given(element))
            around = element.attributes.get("childclass", around)
            stack.extend((child, T, around) for child in reversed(element.children))

    def world(self, parts: Sequence[Part]) -> str:
        """The world, which nothing moves."""
        for element, _, _ in parts:
            if element.tag in ("joint", "freejoint", "inertial"):
                raise fault_at(
                    element, f"<{element.tag}> stands in the world, which neither moves nor weighs"
                )
        return WORLD

    def body(self, element: Element, parent: str, place: Array, parts: Sequence[Part]) -> str:
        """A body with its joints and its mass."""
        name = self.skeleton.body_name(element)
        drafts: list[Draft] = []
        for part, T, around in parts:
            if part.tag in ("joint", "freejoint"):
                joint = self.skeleton.joint_name(part, name)
                drafts.append(read_joint(self.defaults.given(part, around), joint, T, self.settings))
        free = next((draft for draft in drafts if draft.kind == "free"), None)
        if free is not None and (parent != WORLD or len(drafts) > 1):
            raise fault_at(
                free.element, f"the free joint of {name!r} must be its only one, and its body in the world"
            )
        self.skeleton.add_body(element, name, parent, place, drafts)
        return name

    def fill(self, body: Element, name: str, parts: Sequence[Part]) -> None:
        """The shapes, the frames and the mass of a body."""
        geoms: list[Geom] = []
        inertial: list[Inertial] = []
        for element, T, around in parts:
            if element.tag == "geom":
                geoms.append(self.geoms.geom(self.defaults.given(element, around), T))
            elif element.tag == "site" and element.attributes.get("name"):
                self.site(self.defaults.given(element, around), name, T)
            elif element.tag == "inertial":
                if inertial:
                    raise fault_at(element, f"body {name!r} has two <inertial>")
                inertial.append(read_inertial(Given(element), T, self.settings))
        shapes = [self.geoms.shapes(geom) for geom in geoms]
        self.visual.setdefault(name, []).extend(drawn for drawn, _ in shapes if drawn is not None)
        self.collision.setdefault(name, []).extend(solid for _, solid in shapes if solid is not None)
        if name == WORLD:
            return
        rule = self.settings.from_geoms
        heavy = [geom for geom in geoms if has_weight(geom, self.settings)] if rule != "false" else []
        if inertial and (rule != "true" or not heavy):
            weight: Inertial | None = inertial[0]
        else:
            weight = complain_at(body, lambda: weight_of_geoms(heavy))
        self.weights[name] = complain_at(body, lambda: correct_inertial(weight, self.settings))

    def site(self, given: Given, body: str, T_body_frame: Array) -> None:
        """A site, where it is."""
        long = given.holder("fromto") is not None
        place = self.geoms.between(given, given.text("type"))[0] if long else self.settings.placement(given)
        self.skeleton.add_site(given.element, body, T_body_frame @ place)


def read_excludes(contacts: Iterable[Element], bodies: Mapping[str, int]) -> tuple[tuple[str, str, str], ...]:
    """The pairs of bodies that <exclude> keeps from touching, each with the name of the element as reason."""
    pairs = []
    for element in contacts:
        if element.tag == "exclude":
            first, second = two_ends(element, "body", bodies)
            if first == second:
                raise fault_at(element, f"<exclude> names body {first!r} twice; a pair is of two bodies")
            pairs.append((first, second, element.attributes.get("name", "") or "excluded"))
    return tuple(pairs)


def read_keyframes(
    keys: Iterable[Element], drafts: Mapping[str, Draft], followers: Mapping[str, Coupling]
) -> dict[str, dict[str, float]]:
    """The named keyframes as poses of the joints that move by themselves [rad or m]."""
    widths = {name: 7 if draft.kind == "free" else 1 for name, draft in drafts.items()}
    count = sum(widths.values())
    poses = {}
    for key in keys:
        if not key.attributes.get("name") or "qpos" not in key.attributes:
            continue
        numbers = read_floats(key, "qpos", None, count)
        ends = accumulate(widths.values())
        values = {name: numbers[end - 1] for name, end in zip(drafts, ends, strict=True)}
        independent = [name for name in drafts if widths[name] == 1 and name not in followers]
        poses[key.attributes["name"]] = {name: values[name] for name in independent}
    return poses
