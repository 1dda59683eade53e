"""What <compiler> says: units, conventions, and where masses come from."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from cspace.arrays import Array
from cspace.model.attributes import complain_at, fault_at
from cspace.model.mjcf.given import Given
from cspace.model.values import IDENTITY, from_wxyz, rotation_about, translation_by
from cspace.model.xml import Element
from cspace.tolerances import AXIS_LENGTH, MJCF_SAME_AXIS

ORIENTATIONS = ("quat", "axisangle", "euler", "xyaxes", "zaxis")
"""The attributes of which one may say how a frame is turned."""

AXES = {letter: axis for letter, axis in zip("xyz", np.eye(3), strict=True)}


@dataclass(frozen=True)
class Settings:
    """The conventions of one document.

    unit: of angles [rad]. sequence: letters of Euler angles, small ones about the axes as turned so far,
    capitals about the fixed ones. autolimits: whether a range alone makes a limit. mesh_folder, strip: how
    mesh files are named. from_geoms: "true", "false", "auto". groups: geoms that count for masses. least_mass
    [kg], least_inertia [kg·m²], balance, total_mass [kg] (or None): how masses are corrected.
    """

    unit: float
    sequence: str
    autolimits: bool
    mesh_folder: str
    strip: bool
    from_geoms: str
    groups: tuple[float, float]
    least_mass: float
    least_inertia: float
    balance: bool
    total_mass: float | None

    def placement(self, given: Given) -> Array:
        """The frame (4, 4) of an element: its `pos`, turned by the one of ORIENTATIONS that it gives."""
        holder = given.holder(*ORIENTATIONS)
        if holder is None and given.holder("pos") is None:
            return IDENTITY
        T = IDENTITY if holder is None else self.rotation(holder)
        x = given.floats("pos", (0.0, 0.0, 0.0), 3)
        return translation_by(np.array(x)) @ T

    def rotation(self, element: Element) -> Array:
        """The rotation (4, 4) that one element gives."""
        names = [name for name in ORIENTATIONS if name in element.attributes]
        if len(names) > 1:
            raise fault_at(element, f"<{element.tag}> is turned twice, by {names[0]!r} and {names[1]!r}")
        given = Given(element)
        if names[0] == "quat":
            numbers = given.floats("quat", None, 4)
            return complain_at(element, lambda: from_wxyz(numbers, f"quat of <{element.tag}>"))
        if names[0] == "axisangle":
            *axis, angle = given.floats("axisangle", None, 4)
            return rotation_about(unit_direction(axis, element, "axisangle"), angle * self.unit)
        if names[0] == "euler":
            return self.from_euler(given.floats("euler", None, 3))
        if names[0] == "zaxis":
            return shortest_rotation(unit_direction(given.floats("zaxis", None, 3), element, "zaxis"))
        return from_xy(given.floats("xyaxes", None, 6), element)

    def from_euler(self, angles: list[float]) -> Array:
        """Three turns, one per letter of the sequence."""
        T = IDENTITY
        for letter, angle in zip(self.sequence, angles, strict=True):
            turn = rotation_about(AXES[letter.lower()], angle * self.unit)
            T = T @ turn if letter.islower() else turn @ T
        return T


def unit_direction(vector: list[float], element: Element, name: str) -> Array:
    """The direction of a vector; `element` is where a complaint belongs."""
    length = math.hypot(*vector)
    if length < AXIS_LENGTH:
        raise fault_at(element, f"{name} of <{element.tag}> is no direction: it has the length {length:g}")
    return np.asarray(np.array(vector) / length)


def shortest_rotation(z: Array) -> Array:
    """The smallest rotation (4, 4) that takes the z axis to the unit vector `z` (3,); about x to −z."""
    axis = np.cross((0.0, 0.0, 1.0), z)
    sine = math.hypot(*axis)
    if sine < MJCF_SAME_AXIS:
        return IDENTITY if z[2] > 0.0 else rotation_about(AXES["x"], math.pi)
    return rotation_about(axis / sine, math.atan2(sine, float(z[2])))


def from_xy(numbers: list[float], element: Element) -> Array:
    """The rotation (4, 4) with the given x axis, and y as near to the given one as possible."""
    x = unit_direction(numbers[:3], element, "xyaxes")
    y = np.array(numbers[3:])
    y = unit_direction((y - x * (x @ y)).tolist(), element, "the y axis in xyaxes")
    T = np.eye(4)
    T[:3, :3] = np.column_stack([x, y, np.cross(x, y)])
    return T


def settings_of(root: Element) -> Settings:
    """The settings of a document: all its <compiler> elements together, the last word counting."""
    elements = list(root.all("compiler"))
    given = Given(elements[-1], elements[-2::-1]) if elements else Given(Element("compiler", {}, root.line))
    if given.text("coordinate", "local") != "local":
        text = "global coordinates were dropped from MJCF; save the file with MuJoCo 2.3.3 first"
        raise fault_at(given.place("coordinate"), text)
    sequence = given.text("eulerseq", "xyz")
    if len(sequence) != 3 or not set(sequence.lower()) <= set("xyz"):
        text = f"eulerseq is {sequence[:20]!r}; it holds three letters out of x, y, z, X, Y, Z"
        raise fault_at(given.place("eulerseq"), text)
    total = given.number("settotalmass", -1.0)
    low, high = given.floats("inertiagrouprange", (0.0, 5.0), 2)
    return Settings(
        unit=math.radians(1.0) if given.word("angle", "degree", ("degree", "radian")) == "degree" else 1.0,
        sequence=sequence,
        autolimits=given.flag("autolimits", True),
        mesh_folder=given.text("meshdir", given.text("assetdir")),
        strip=given.flag("strippath", False),
        from_geoms=given.word("inertiafromgeom", "auto", ("true", "false", "auto")),
        groups=(low, high),
        least_mass=given.number("boundmass", 0.0),
        least_inertia=given.number("boundinertia", 0.0),
        balance=given.flag("balanceinertia", False),
        total_mass=total if total > 0.0 else None,
    )
