"""The equalities of MJCF that tie bodies, as loops."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from functools import partial

import numpy as np

from cspace.arrays import Array
from cspace.errors import suggest
from cspace.model.attributes import complain_at, fault_at
from cspace.model.joint import Loop
from cspace.model.mjcf.given import Defaults, Given
from cspace.model.mjcf.skeleton import WORLD, Skeleton, new_name
from cspace.model.values import from_wxyz, translation_by
from cspace.model.xml import Element
from cspace.spatial.poses import invert_pose


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
