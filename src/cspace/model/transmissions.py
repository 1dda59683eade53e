"""The inertia of rotors behind their gears, from and to the transmissions of URDF."""

from __future__ import annotations

import logging
from collections.abc import Collection
from typing import Final

from cspace.errors import suggest
from cspace.model.attributes import fault_at, read_number, text_of
from cspace.model.xml import Element

NAMESPACE: Final = "http://drake.mit.edu"
"""Of the elements that Drake adds to URDF."""

ROTOR: Final = "drake:rotor_inertia"
GEAR: Final = "drake:gear_ratio"

LOG: Final = logging.getLogger("cspace")


def read_armatures(root: Element, joints: Collection[str]) -> dict[str, float]:
    """The inertia of the rotors on each joint as the joint feels it, by its name [kg·m² or kg].

    n² J with <drake:rotor_inertia> J and <drake:gear_ratio> n (one unless given) of an <actuator>, which are
    Drake's extension of URDF; several motors on one joint add up. As in Drake <mechanicalReduction> does not
    count, which is logged. joints: those of the robot. Raises DescriptionError for a joint that is not one of
    them.
    """
    found: dict[str, float] = {}
    for transmission in root.all("transmission"):
        actuators = [actuator for actuator in transmission.all("actuator") if actuator.first(ROTOR)]
        if not actuators:
            continue
        inertia = sum(map(read_actuator, actuators))
        names = [text_of(joint, "name") for joint in transmission.all("joint")]
        for name in names:
            if name not in joints:
                raise fault_at(transmission, f"transmission: {suggest('joint', name, joints)}")
        if len(names) != 1:
            LOG.warning(
                "%s:%d: a transmission ties %d joints to its rotors; their inertia is left out",
                transmission.path,
                transmission.line,
                len(names),
            )
            continue
        found[names[0]] = found.get(names[0], 0.0) + inertia
    return found


def read_actuator(actuator: Element) -> float:
    """The inertia of one rotor behind its gear [kg·m² or kg]."""
    rotor, gear = actuator.first(ROTOR), actuator.first(GEAR)
    if gear is None and actuator.first("mechanicalReduction") is not None:
        LOG.warning(
            "%s:%d: the rotor has no <%s>; its <mechanicalReduction> does not count, and the ratio is 1",
            actuator.path,
            actuator.line,
            GEAR,
        )
    ratio = 1.0 if gear is None else read_number(gear, "value")
    return 0.0 if rotor is None else ratio * ratio * read_number(rotor, "value")


def transmission_lines(joint: str, armature: float) -> list[str]:
    """The lines of a transmission whose rotor, behind a gear of ratio one, has this inertia [kg·m² or kg].

    joint: its name with its quotation marks.
    """
    return [
        f"  <transmission name={joint}>",
        "    <type>transmission_interface/SimpleTransmission</type>",
        f"    <joint name={joint}/>",
        f"    <actuator name={joint}>",
        f'      <{ROTOR} value="{armature!r}"/>',
        f'      <{GEAR} value="1.0"/>',
        "    </actuator>",
        "  </transmission>",
    ]
