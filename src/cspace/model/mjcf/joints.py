"""The joints of MJCF, each with its own link behind it, and the couplings between them."""

from __future__ import annotations

import logging
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Final

from cspace.arrays import Array
from cspace.errors import suggest
from cspace.model.attributes import complain_at, fault_at
from cspace.model.joint import Joint, Mimic
from cspace.model.mjcf.actuators import Drive, add_known, largest_magnitude, read_resistance
from cspace.model.mjcf.given import Defaults, Given
from cspace.model.mjcf.settings import Settings
from cspace.model.values import IDENTITY, X_AXIS, rotation_about, translation_by, unit_axis
from cspace.model.xml import Element

KINDS: Final = ("hinge", "slide", "free", "ball")

LOG: Final = logging.getLogger("cspace")


@dataclass(frozen=True, eq=False)
class Draft:
    """A joint of a body, before it is known which joints follow others.

    kind: "hinge", "slide", "free" or "fixed". anchor (4, 4): where it acts, in the body. axis (3,): a unit
    vector in the body. ref: its value where the body is as drawn [rad or m]. lower, upper, effort, damping,
    friction, armature: as in Joint.
    """

    name: str
    kind: str
    element: Element
    anchor: Array = field(default_factory=lambda: IDENTITY)
    axis: Array = field(default_factory=lambda: X_AXIS)
    ref: float = 0.0
    lower: float = -math.inf
    upper: float = math.inf
    effort: float = math.inf
    damping: float | None = None
    friction: float | None = None
    armature: float | None = None

    def motion(self, by: float) -> Array:
        """The motion (4, 4) by an angle [rad] or a distance [m]."""
        return rotation_about(self.axis, by) if self.kind == "hinge" else translation_by(by * self.axis)

    def joint(self, parent: str, child: str, place: Array, coupling: Coupling | None, drive: Drive) -> Joint:
        """The joint between two links, standing at `place` (4, 4) in its parent, with what drives it."""
        if self.kind in ("free", "fixed"):
            return Joint(self.name, "floating" if self.kind == "free" else "fixed", parent, child, place)
        place = place @ self.motion(-self.ref)
        if coupling is not None and coupling.leader is None:
            place = place @ self.motion(self.ref + coupling.offset)
            return Joint(self.name, "fixed", parent, child, place)
        limited = math.isfinite(self.lower)
        kind = "prismatic" if self.kind == "slide" else "revolute" if limited else "continuous"
        mimic = None if coupling is None else coupling.mimic(self)
        numbers: dict[str, Any] = {"lower": self.lower, "upper": self.upper, "friction": self.friction}
        numbers |= {"effort": min(drive.effort, self.effort)}
        numbers |= {"damping": add_known(self.damping, drive.damping)}
        numbers |= {"armature": add_known(self.armature, drive.armature)}
        return Joint(self.name, kind, parent, child, place, self.axis, mimic=mimic, **numbers)


def read_joint(given: Given, name: str, T_body_frame: Array, settings: Settings) -> Draft:
    """The joint of an element that stands in a frame of its body."""
    element = given.element
    kind = "free" if element.tag == "freejoint" else given.word("type", "hinge", KINDS)
    if kind == "free":
        return Draft(name, kind, element)
    if kind == "ball":
        raise fault_at(
            given.place("type"),
            f"joint {name!r} is a ball joint, which has no single coordinate; write it as three hinges with"
            " one 'pos' and perpendicular axes",
        )
    unit = settings.unit if kind == "hinge" else 1.0
    R = T_body_frame[:3, :3]
    anchor = R @ given.floats("pos", (0.0, 0.0, 0.0), 3) + T_body_frame[:3, 3]
    direction = given.floats("axis", (0.0, 0.0, 1.0), 3)
    axis = complain_at(given.place("axis"), lambda: unit_axis(R @ direction, f"axis of joint {name!r}"))
    lower, upper = read_limits(given, name, unit, settings)
    resistances = (read_resistance(given, key) for key in ("damping", "frictionloss", "armature"))
    ref, effort = given.number("ref", 0.0) * unit, largest_magnitude(given, "actuatorfrc")
    place = translation_by(anchor)
    return Draft(name, kind, element, place, axis, ref, lower, upper, effort, *resistances)


def read_limits(given: Given, name: str, unit: float, settings: Settings) -> tuple[float, float]:
    """The range of a joint [rad or m]; ±inf where it has none."""
    holder = given.holder("range")
    low, high = given.span("range")
    limited = given.word("limited", "auto", ("true", "false", "auto"))
    if limited == "auto" and not settings.autolimits and holder is not None:
        rule = "say limited= as well, or leave autolimits on in <compiler>"
        raise fault_at(holder, f"joint {name!r} has a range, and autolimits is off; {rule}")
    if limited == "false" or (limited == "auto" and not low < high):
        return -math.inf, math.inf
    if not low < high:
        text = f"joint {name!r} is limited to the range {low:g} to {high:g}; the first must be less"
        raise fault_at(given.place("range"), text)
    return low * unit, high * unit


@dataclass(frozen=True)
class Coupling:
    """An equality of joints: q − ref = offset + factor · (q(leader) − ref(leader)), or offset alone."""

    leader: Draft | None
    offset: float
    factor: float
    element: Element

    def mimic(self, follower: Draft) -> Mimic | None:
        """The rule in terms of q alone."""
        if self.leader is None:
            return None
        leader = self.leader
        offset = self.offset + follower.ref - self.factor * leader.ref
        return complain_at(self.element, lambda: Mimic(leader.name, self.factor, offset))


def read_couplings(
    equalities: Sequence[Element], defaults: Defaults, drafts: Mapping[str, Draft]
) -> dict[str, Coupling]:
    """The couplings of joints that are straight lines, by the joint that follows.

    A polynomial of higher degree has no place in a Description: its joints stay independent, which is logged.
    """
    found: dict[str, Coupling] = {}
    for element in equalities:
        given = defaults.given(element)
        if element.tag != "joint" or not given.flag("active", True):
            continue
        follower = joint_named(element, "joint1", drafts)
        leader = joint_named(element, "joint2", drafts) if element.attributes.get("joint2") else None
        offset, factor, *rest = read_coefficients(given)
        if leader is not None and any(rest):
            LOG.warning(
                "%s:%d: joints %r and %r are coupled by a polynomial of degree two or more; they are read as"
                " independent",
                element.path,
                element.line,
                follower.name,
                leader.name,
            )
            continue
        if follower.name in found:
            raise fault_at(element, f"joint {follower.name!r} is coupled twice; it can follow one joint")
        found[follower.name] = Coupling(leader, offset, factor, element)
    return found


def read_coefficients(given: Given) -> list[float]:
    """The five coefficients of a coupling, the constant first; as in MuJoCo those left out are 0 1 0 0 0."""
    numbers = given.floats("polycoef", (0.0, 1.0), 1, 5)
    return [*numbers, *(0.0, 1.0, 0.0, 0.0, 0.0)[len(numbers) :]]


def joint_named(element: Element, attribute: str, drafts: Mapping[str, Draft]) -> Draft:
    """The joint that an equality names."""
    name = element.attributes.get(attribute, "").strip()
    if name not in drafts:
        raise fault_at(element, f"{attribute} of an equality: {suggest('joint', name, drafts)}")
    if drafts[name].kind == "free":
        raise fault_at(element, f"joint {name!r} is free and can be in no equality")
    return drafts[name]
