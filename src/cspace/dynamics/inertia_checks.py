"""What a mass and a tensor of inertia must obey to belong to a rigid body."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

import numpy as np

from cspace.arrays import Array
from cspace.model import Description, Geometry, Link
from cspace.tables import show_fields
from cspace.tolerances import INERTIA_ROUNDING, LEAST_GYRATION

MOST_GYRATION: Final = 10.0
"""Radius of gyration of a link over its extent beyond which its units are doubted: kg·mm² make it a thousand,
and the mass of no link lies outside of it."""


SPACING: Final = 16.0 * np.finfo(float).eps
"""Rounding of the eigenvalues of a symmetric matrix (3, 3), relative to the largest."""


@show_fields
@dataclass(frozen=True)
class InertiaFault:
    """What is wrong with the mass properties of one part of a robot.

    part: a link, or a joint with what is fixed to it. fault: in a few words. detail: the numbers and the
    rule. mass [kg] and moments (3,), the principal moments of inertia [kg·m²] in rising order, of the part.
    hint: no law is broken, but it may be a slip.
    """

    part: str
    fault: str
    detail: str
    mass: float
    moments: tuple[float, float, float]
    hint: bool = False


def check_body(part: str, mass: float, inertia: Array) -> list[InertiaFault]:
    """What breaks the laws of rigid bodies in a mass [kg] and an inertia (3, 3) about its centre [kg·m²].

    With the moments a ≤ b ≤ c about the principal axes, a ≥ 0, and a + b ≥ c since a + b − c = 2 ∫ z² dm,
    with z along the axis of c.
    """
    a, b, c = moments = principal_moments(inertia)
    largest = max(abs(a), abs(c))
    if mass > 0.0 and largest <= mass * LEAST_GYRATION**2:
        text = f"{mass:.4g} kg without inertia about the centre of mass"
        return [InertiaFault(part, "point mass", text, mass, moments, hint=True)]
    shown = f"the principal moments are {a:.4g}, {b:.4g} and {c:.4g} kg·m²"
    found: list[tuple[str, str]] = []
    if mass == 0.0 and largest > 0.0:
        found.append(("inertia without mass", f"{shown}, but the mass is zero"))
    if a < -INERTIA_ROUNDING * largest:
        found.append(("not positive", f"{shown}; none may be negative"))
    elif a + b < (1.0 - INERTIA_ROUNDING) * c:
        rule = f"no body has one above the sum of the others, {a + b:.4g}"
        found.append(("triangle inequality", f"{shown}; {rule}"))
    return [InertiaFault(part, fault, text, mass, moments) for fault, text in found]


def principal_moments(inertia: Array) -> tuple[float, float, float]:
    """The principal moments of an inertia (3, 3) in rising order [kg·m²], zero where they are rounding."""
    values = np.linalg.eigvalsh(inertia)
    a, b, c = np.where(np.abs(values) > SPACING * np.abs(values).max(), values, 0.0).tolist()
    return a, b, c


def check_size(description: Description, link: Link) -> list[InertiaFault]:
    """A hint where the inertia of a link is that of a body many times its extent."""
    inertial = link.inertial
    if inertial is None or inertial.mass == 0.0:
        return []
    moments = principal_moments(inertial.inertia)
    gyration = math.sqrt(max(moments[-1], 0.0) / inertial.mass)
    extent = link_extent(description, link)
    if extent == 0.0 or gyration <= MOST_GYRATION * extent:
        return []
    text = f"the radius of gyration is {gyration:.3g} m, of a link of {extent:.3g} m; is it in kg and m?"
    return [InertiaFault(link.name, "size", text, inertial.mass, moments, hint=True)]


def link_extent(description: Description, link: Link) -> float:
    """How far a link reaches from its origin [m]: to its shapes, its centre of mass and the next joints.

    Meshes count with their origins. Without anything else to go by it is the length of the whole robot.
    """
    points = [joint.origin[:3, 3] for joint in description.child_joints[link.name]]
    points += [] if link.inertial is None else [link.inertial.com]
    reaches = [float(np.linalg.norm(point)) for point in points]
    reaches += [shape_reach(shape) for shape in (*link.visual, *link.collision)]
    own = max(reaches, default=0.0)
    return own or sum(float(np.linalg.norm(joint.origin[:3, 3])) for joint in description.joints)


def shape_reach(shape: Geometry) -> float:
    """How far a shape reaches from the origin of its link [m], a mesh to its origin."""
    away = float(np.linalg.norm(shape.origin[:3, 3]))
    if shape.shape == "box":
        return away + math.hypot(*shape.size) / 2.0
    if shape.shape == "capsule":
        return away + shape.size[0] + shape.size[1] / 2.0
    if shape.shape == "cylinder":
        return away + math.hypot(shape.size[0], shape.size[1] / 2.0)
    return away + sum(shape.size)  # the radius of a sphere, nothing of a mesh
