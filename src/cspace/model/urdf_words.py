"""The elements and attributes of URDF, to tell a slip of the pen from an extension."""

from __future__ import annotations

import difflib
from collections.abc import Iterable, Mapping, Set
from typing import Final

from cspace.model.xml import Element

CHILDREN: Final[dict[str, frozenset[str]]] = {
    "robot": frozenset({"link", "joint", "material", "transmission", "gazebo"}),
    "link": frozenset({"inertial", "visual", "collision"}),
    "joint": frozenset({"origin", "parent", "child", "axis", "limit", "mimic", "dynamics", "calibration"}),
    "inertial": frozenset({"origin", "mass", "inertia"}),
    "visual": frozenset({"origin", "geometry", "material"}),
    "collision": frozenset({"origin", "geometry", "material"}),
}
ATTRIBUTES: Final[dict[str, frozenset[str]]] = {
    "origin": frozenset({"xyz", "rpy"}),
    "axis": frozenset({"xyz"}),
    "limit": frozenset({"lower", "upper", "velocity", "effort", "acceleration", "jerk"}),
    "mimic": frozenset({"joint", "multiplier", "offset"}),
    "dynamics": frozenset({"damping", "friction"}),
    "inertia": frozenset({"ixx", "ixy", "ixz", "iyy", "iyz", "izz"}),
    "mesh": frozenset({"filename", "scale"}),
}
LIKENESS: Final = 0.65
"""How much of two words must agree (Ratcliff and Metzener 1988) for one to be meant for the other."""


def slip_in(
    element: Element, known: Set[str], missing: Set[str], attributes: Mapping[str, Set[str]]
) -> tuple[str, Element] | None:
    """A message about a misspelled name in an element or its children, and its place; else None.

    known, missing: the elements that may stand in this one, and those that a name can be meant for.
    attributes: those of the children, by tag. A name that is not known is an extension, unless it is close to
    one that is not there.
    """
    for child in element.children:
        meant = closest_word(child.tag, missing) if known and child.tag not in known else None
        if meant:
            return f"<{element.tag}> has no <{child.tag}>; did you mean <{meant}>?", child
        names = attributes.get(child.tag, child.attributes.keys())
        for name in child.attributes.keys() - names:
            meant = closest_word(name, names - child.attributes.keys())
            if meant:
                return f"<{child.tag}> has no attribute {name!r}; did you mean {meant!r}?", child
    return None


def closest_word(word: str, known: Iterable[str]) -> str | None:
    """The known word that `word` was meant for, if any; names of another namespace are never meant so."""
    if ":" in word:
        return None
    return next(iter(difflib.get_close_matches(word, sorted(known), 1, LIKENESS)), None)
