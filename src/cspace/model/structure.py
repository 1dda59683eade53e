"""Is it a tree? The checks on names, links and joints, each fault with the element that it is about."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Protocol

from cspace.errors import DescriptionError, suggest
from cspace.model.joint import Joint
from cspace.model.link import Link
from cspace.model.values import BEYOND
from cspace.tolerances import LARGEST_NUMBER


class Named(Protocol):
    """Anything with a name."""

    @property
    def name(self) -> str: ...


class ElementError(DescriptionError):
    """A fault of one link, joint or loop (None: of the robot); a reader adds its file and line."""

    def __init__(self, message: str, part: Named | None = None) -> None:
        super().__init__(message)
        self.part = part


def unique_names(elements: Iterable[Named], kind: str, robot: str) -> None:
    """Raise ElementError if two elements have one name."""
    seen: set[str] = set()
    for element in elements:
        if element.name in seen:
            raise ElementError(f"two {kind}s of robot {robot!r} are named {element.name!r}", element)
        seen.add(element.name)


def check_tree(robot: str, links: Sequence[Link], joints: Sequence[Joint]) -> tuple[str, ...]:
    """Link names from the root outward, depth first.

    Raises ElementError unless every joint ties two existing links, every link has at most one parent, there
    is exactly one root, and no chain of joints closes on itself.
    """
    names = {link.name for link in links}
    if not names:
        raise ElementError(f"robot {robot!r} has no links")
    carried_by: dict[str, Joint] = {}
    carries: dict[str, list[str]] = {name: [] for name in names}
    for joint in joints:
        _check_ends(robot, joint, names)
        other = carried_by.get(joint.child)
        if other is not None:
            raise ElementError(
                f"link {joint.child!r} is the child of two joints, {other.name!r} and {joint.name!r};"
                " a link has one parent (describe a closed loop by a Loop, not by a joint)",
                joint,
            )
        carried_by[joint.child] = joint
        carries[joint.parent].append(joint.child)
    roots = [link for link in links if link.name not in carried_by]
    if not roots:
        raise _cycle(links[0].name, carried_by)
    if len(roots) > 1:
        shown = ", ".join(repr(root.name) for root in roots[:5]) + (", …" if len(roots) > 5 else "")
        raise ElementError(
            f"robot {robot!r} has {len(roots)} roots: {shown}; every link except one must be the child of "
            "a joint",
            roots[1],
        )
    order = _depth_first(roots[0].name, carries)
    if len(order) < len(links):
        reached = set(order)
        raise _cycle(next(link.name for link in links if link.name not in reached), carried_by)
    return order


def _check_ends(robot: str, joint: Joint, names: set[str]) -> None:
    for end, link in (("parent", joint.parent), ("child", joint.child)):
        if link not in names:
            error = suggest("link", link, names, owner=f"robot {robot!r}")
            raise ElementError(f"{end} of joint {joint.name!r}: {error}", joint)
    if joint.parent == joint.child:
        raise ElementError(f"joint {joint.name!r} connects link {joint.child!r} with itself", joint)


def _depth_first(root: str, carries: dict[str, list[str]]) -> tuple[str, ...]:
    order: list[str] = []
    stack = [root]
    while stack:
        name = stack.pop()
        order.append(name)
        stack.extend(reversed(carries[name]))
    return tuple(order)


def _cycle(start: str, carried_by: dict[str, Joint]) -> ElementError:
    """The fault of the cycle that `start` hangs on."""
    seen: dict[str, None] = {}
    link = start
    while link not in seen:
        seen[link] = None
        link = carried_by[link].parent
    path = list(seen)
    circle = [link, *reversed(path[path.index(link) :])]
    joint = carried_by[circle[-1]]
    shown = " → ".join(repr(name) for name in circle[:12]) + (" → …" if len(circle) > 12 else "")
    return ElementError(f"the joints close a cycle: {shown}; a robot must be a tree", joint)


def check_mimics(robot: str, joints: Sequence[Joint]) -> None:
    """Raise ElementError where a joint follows itself, an unknown joint or one without a single value."""
    by_name = {joint.name: joint for joint in joints}
    sound: dict[str, tuple[float, float]] = {}  # the multiplier and the offset, combined along the leaders
    for joint in joints:
        if joint.mimic is None:
            continue
        if joint.type not in ("revolute", "continuous", "prismatic"):
            raise ElementError(f"joint {joint.name!r} is {joint.type} and cannot mimic", joint)
        row: dict[str, Joint] = {}
        follower = joint
        while follower.mimic is not None and follower.name not in sound:
            leader = by_name.get(follower.mimic.joint)
            if leader is None:
                error = suggest("joint", follower.mimic.joint, by_name, owner=f"robot {robot!r}")
                raise ElementError(f"joint {follower.name!r} mimics: {error}", follower)
            row[follower.name] = follower
            if leader.name in row:
                raise ElementError(f"joint {joint.name!r} mimics itself through a cycle of joints", joint)
            if leader.type not in ("revolute", "continuous", "prismatic"):
                message = f"joint {follower.name!r} mimics {leader.name!r}, which is {leader.type}"
                raise ElementError(message, follower)
            follower = leader
        factor, shift = sound.get(follower.name, (1.0, 0.0))
        for follower in reversed(row.values()):
            if (mimic := follower.mimic) is None:
                continue
            factor, shift = mimic.multiplier * factor, mimic.multiplier * shift + mimic.offset
            if abs(largest := max(factor, shift, key=abs)) > LARGEST_NUMBER:
                raise ElementError(
                    f"joint {follower.name!r} mimics joints that mimic others, and their multipliers and "
                    f"offsets combine to {largest:g}; {BEYOND}; use smaller ones",
                    follower,
                )
            sound[follower.name] = factor, shift
