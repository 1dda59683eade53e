"""How hard the actuators of MJCF can push a joint."""

from __future__ import annotations

import math
from collections.abc import Iterable

from cspace.model.mjcf.given import Defaults, Given
from cspace.model.xml import Element


def read_efforts(actuators: Iterable[Element], defaults: Defaults) -> dict[str, float]:
    """The largest force or torque of all actuators on each joint, by its name [N or N·m]; inf where unknown.

    Force is gear · forcerange; of a <motor>, whose force is its control, gear · ctrlrange serves as well.
    """
    found: dict[str, float] = {}
    for element in actuators:
        given = defaults.given(element)
        joint = given.text("joint") or given.text("jointinparent")
        if joint:
            found[joint] = found.get(joint, 0.0) + read_effort(given)
    return found


def read_effort(given: Given) -> float:
    """The largest force of one actuator on its joint."""
    gear = abs(given.floats("gear", (1.0,), 1, 6)[0])
    force = largest_magnitude(given, "force")
    if given.element.tag == "motor":
        force = min(force, largest_magnitude(given, "ctrl"))
    return gear * force if math.isfinite(force) else math.inf


def largest_magnitude(given: Given, what: str) -> float:
    """The largest magnitude within a range; inf where it does not count."""
    low, high = given.span(f"{what}range")
    limited = given.word(f"{what}limited", "auto", ("true", "false", "auto"))
    return max(abs(low), abs(high)) if limited != "false" and low < high else math.inf
