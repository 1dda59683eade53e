"""The actuators of MJCF as their joints feel them: forces, damping and armature behind their gears."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass

from cspace.model.mjcf.given import Defaults, Given
from cspace.model.xml import Element


@dataclass(frozen=True)
class Drive:
    """What the actuators of a joint give and add to it; all as the joint feels it, behind their gears.

    effort: their largest force or torque [N or N·m], inf where unknown. damping, armature: as in Joint.
    """

    effort: float = math.inf
    damping: float | None = None
    armature: float | None = None


def read_drives(actuators: Iterable[Element], defaults: Defaults) -> dict[str, Drive]:
    """The actuators of each joint as one, by its name."""
    found: dict[str, Drive] = {}
    for element in actuators:
        given = defaults.given(element)
        joint = given.text("joint") or given.text("jointinparent")
        if joint:
            found[joint] = add_drives(found.get(joint, Drive(effort=0.0)), read_drive(given))
    return found


def add_drives(a: Drive, b: Drive) -> Drive:
    """Two actuators of one joint as one."""
    damping, armature = add_known(a.damping, b.damping), add_known(a.armature, b.armature)
    return Drive(a.effort + b.effort, damping, armature)


def read_drive(given: Given) -> Drive:
    """One actuator on its joint: gear · forcerange, and gear² · its damping and armature.

    The force of a <motor> is its control, so ctrlrange serves as well.
    """
    gear = abs(given.floats("gear", (1.0,), 1, 6)[0])
    force = largest_magnitude(given, "force")
    if given.element.tag == "motor":
        force = min(force, largest_magnitude(given, "ctrl"))
    own = (read_resistance(given, name) for name in ("damping", "armature"))
    damping, armature = (None if value is None else gear * gear * value for value in own)
    return Drive(gear * force if math.isfinite(force) else math.inf, damping, armature)


def largest_magnitude(given: Given, what: str) -> float:
    """The largest magnitude within a range; inf where it does not count."""
    low, high = given.span(f"{what}range")
    limited = given.word(f"{what}limited", "auto", ("true", "false", "auto"))
    return max(abs(low), abs(high)) if limited != "false" and low < high else math.inf


def read_resistance(given: Given, name: str) -> float | None:
    """A damping, friction or armature, None where it is not given; of a polynomial the linear term."""
    return None if given.holder(name) is None else given.floats(name, None, 1, 9)[0]


def add_known(a: float | None, b: float | None) -> float | None:
    """The sum of what is known of two numbers."""
    return a if b is None else b if a is None else a + b
