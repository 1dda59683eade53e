"""Spheres that stand for the links of a robot, given by hand or in a file."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from cspace.arrays import Array, as_floats
from cspace.collision.scene_files import parse_json
from cspace.errors import DescriptionError, InputError
from cspace.files import path_of, read_text
from cspace.model import Description, Geometry, from_urdf
from cspace.model.toml_table import Document, parse_toml
from cspace.tolerances import DESCRIPTION_BYTES, LARGEST_NUMBER

RULE = "a file of spheres has tables of link, center and radius in a list named spheres, or rows per link"
"""What JSON and TOML files contain."""


def replace_spheres(
    description: Description, spheres: Mapping[str, Any] | str | os.PathLike[str]
) -> Description:
    """The description with spheres in place of its collision elements.

    spheres: link → rows (n, 4) of centres in the frame of the link and radii [m], or the path of a file; see
    Robot.with_spheres, which also names the errors.
    """
    rows = spheres if isinstance(spheres, Mapping) else read_spheres(spheres)
    given = {description.link(name).name: check_spheres(name, values) for name, values in rows.items()}
    links = tuple(
        replace(link, collision=tuple(map(sphere_geometry, given.get(link.name, ()))))
        for link in description.links
    )
    missing = tuple(field for field in description.provenance.missing if field != "collision")
    provenance = replace(description.provenance, missing=missing)
    return replace(description, links=links, provenance=provenance)


def check_spheres(link: str, values: Any) -> Array:
    """Rows (n, 4) of centres and positive radii."""
    rows = as_floats(values, f"spheres of link {link!r}", last=(4,), largest=LARGEST_NUMBER)
    rows = rows.reshape(-1, 4) if rows.ndim == 1 else rows
    if rows.ndim != 2:
        raise InputError(f"spheres of link {link!r} have shape {rows.shape}; they must be rows (n, 4)")
    for k in np.flatnonzero(rows[:, 3] <= 0.0).tolist():
        raise InputError(f"sphere {k} of link {link!r} has the radius {rows[k, 3]:g} m; it must be positive")
    return rows


def sphere_geometry(row: Array) -> Geometry:
    """A sphere x, y, z, radius as an element of a link."""
    T = np.eye(4)
    T[:3, 3] = row[:3]
    return Geometry("sphere", (float(row[3]),), T)


def read_spheres(path: str | os.PathLike[str]) -> dict[str, Any]:
    """Rows (n, 4) of spheres per link from a file: JSON, TOML, or a URDF with spheres as collision elements.

    Raises DescriptionError for a file that cannot be read or has another content.
    """
    file = path_of(path, "spheres are given as a mapping of links or by the path of a file")
    suffix = Path(file).suffix.lower()
    if suffix == ".urdf":
        return urdf_spheres(file)
    if suffix not in (".json", ".toml"):
        raise DescriptionError(
            f"a file of spheres cannot have the suffix {suffix!r}; use .json, .toml or .urdf", path=file
        )
    document = Document(read_text(file, "file of spheres", DESCRIPTION_BYTES, DescriptionError), file)
    values = (parse_json if suffix == ".json" else parse_toml)(document).values
    try:
        return group_spheres(values["spheres"]) if isinstance(values.get("spheres"), list) else values
    except (ValueError, TypeError, KeyError) as error:
        raise document.fault(f"{type(error).__name__} {error}: {RULE}") from None


def group_spheres(spheres: list[Any]) -> dict[str, Any]:
    """Tables of link, center and radius as rows per link."""
    rows: dict[str, Any] = {}
    for sphere in spheres:
        x, y, z = sphere["center"]
        rows.setdefault(sphere["link"], []).append([x, y, z, sphere["radius"]])
    return rows


def urdf_spheres(path: str) -> dict[str, Any]:
    """The spheres among the collision elements of a URDF file, by link."""
    rows: dict[str, Any] = {}
    for link in from_urdf(path).links:
        for geometry in link.collision:
            if geometry.shape != "sphere":
                raise DescriptionError(
                    f"link {link.name!r} has a {geometry.shape}; a URDF file of spheres has spheres alone",
                    path=path,
                )
            rows.setdefault(link.name, []).append([*geometry.origin[:3, 3], *geometry.size])
    return rows
