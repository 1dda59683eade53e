"""What the bodies of MJCF weigh: as written, or as their geoms have it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from cspace.arrays import Array
from cspace.model.attributes import complain_at, fault_at
from cspace.model.link import Inertial
from cspace.model.mjcf.geoms import SOLIDS, Geom
from cspace.model.mjcf.given import Given
from cspace.model.mjcf.settings import ORIENTATIONS, Settings
from cspace.model.tree import lump_bodies


def read_inertial(given: Given, T_body_frame: Array, settings: Settings) -> Inertial:
    """What <inertial> says, in a frame of its body."""
    element = given.element
    given.floats("pos", None, 3)  # must be there
    T = T_body_frame @ settings.placement(given)
    mass, full = given.number("mass"), given.holder("fullinertia")
    if full is not None:
        if "diaginertia" in element.attributes or given.holder(*ORIENTATIONS) is not None:
            raise fault_at(
                element, "fullinertia stands in the axes of its body; it takes neither diaginertia nor a turn"
            )
        xx, yy, zz, xy, xz, yz = given.floats("fullinertia", None, 6)
        local = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
    else:
        local = np.diag(given.floats("diaginertia", (0.0, 0.0, 0.0), 3))
    R = T[:3, :3]
    return complain_at(element, lambda: Inertial(mass, T[:3, 3], R @ local @ R.T))


def has_weight(geom: Geom, settings: Settings) -> bool:
    """Whether a geom counts for the mass of its body."""
    low, high = settings.groups
    return low <= geom.given.number("group", 0.0) <= high


def weight_of_geoms(geoms: Sequence[Geom]) -> Inertial | None:
    """The geoms of a body as one, of mass 0 where there are none; None where only a mesh file could tell."""
    parts = [weight_of_geom(geom) for geom in geoms]
    known = [part for part in parts if part is not None]
    if len(known) < len(parts):
        return None
    mass, com, inertia = lump_bodies([(part, np.eye(4)) for part in known])
    return Inertial(mass, com, inertia)


def weight_of_geom(geom: Geom) -> Inertial | None:
    """One geom: its mass, or density times volume; None where only a file could tell."""
    given, T = geom.given, geom.T_body_geom
    density = given.number("density", 1000.0)
    mass = None if given.holder("mass") is None else given.number("mass")
    if geom.kind in ("plane", "hfield") or mass == 0.0 or (mass is None and density == 0.0):
        return Inertial(0.0, T[:3, 3], np.zeros((3, 3)))
    if geom.kind not in SOLIDS or given.flag("shellinertia", False):
        return None
    volume, diagonal = unit_inertia(geom.kind, geom.half)
    total = density * volume if mass is None else mass
    R = T[:3, :3]
    return complain_at(given.element, lambda: Inertial(total, T[:3, 3], total * (R * diagonal) @ R.T))


def unit_inertia(kind: str, half: Sequence[float]) -> tuple[float, Array]:
    """The volume [m³] of a solid and, per kg, its moments of inertia (3,) about the centre [m²].

    half: its half sizes [m]. A capsule is a cylinder with two half balls, each 3/8 r beyond its base.
    """
    r = half[0]
    if kind == "box":
        x, y, z = (side * side / 3.0 for side in half)
        return 8.0 * math.prod(half), np.array([y + z, x + z, x + y])
    if kind in ("sphere", "ellipsoid"):
        sides = half if kind == "ellipsoid" else (r, r, r)
        x, y, z = (side * side / 5.0 for side in sides)
        return 4.0 / 3.0 * math.pi * math.prod(sides), np.array([y + z, x + z, x + y])
    h = half[1]
    ends = 4.0 / 3.0 * r if kind == "capsule" else 0.0  # as long a tube would have their volume
    share = 2.0 * h / (2.0 * h + ends)
    across = share * (r * r / 4.0 + h * h / 3.0) + (1.0 - share) * (0.4 * r * r + h * h + 0.75 * h * r)
    along = share * r * r / 2.0 + (1.0 - share) * 0.4 * r * r
    return math.pi * r * r * (2.0 * h + ends), np.array([across, across, along])


def correct_inertial(inertial: Inertial | None, settings: Settings) -> Inertial | None:
    """The masses of one body after boundmass, boundinertia and balanceinertia."""
    if inertial is None or not (settings.least_mass or settings.least_inertia or settings.balance):
        return inertial
    moments, axes = np.linalg.eigh(inertial.inertia)
    moments = np.maximum(moments, settings.least_inertia)
    if settings.balance and moments[0] + moments[1] < moments[2]:
        moments = np.full(3, moments.mean())
    return Inertial(max(inertial.mass, settings.least_mass), inertial.com, (axes * moments) @ axes.T)


def scale_inertials(inertials: dict[str, Inertial | None], settings: Settings) -> dict[str, Inertial | None]:
    """The masses of all bodies after settotalmass; all unknown where one of them is."""
    if settings.total_mass is None:
        return inertials
    known = {body: inertial for body, inertial in inertials.items() if inertial is not None}
    total = sum(inertial.mass for inertial in known.values())
    if len(known) < len(inertials) or total == 0.0:
        return dict.fromkeys(inertials)
    factor = settings.total_mass / total
    return {
        body: replace(one, mass=factor * one.mass, inertia=factor * one.inertia)
        for body, one in known.items()
    }
