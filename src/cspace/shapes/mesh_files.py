"""Mesh files as vertices and triangles: STL, OBJ, PLY, COLLADA."""

from __future__ import annotations

import os
from collections.abc import Callable
from typing import Final

import numpy as np

from cspace.arrays import Array
from cspace.errors import CspaceError, MeshError
from cspace.files import path_of, read_regular
from cspace.shapes.collada import parse_collada
from cspace.shapes.obj import parse_obj
from cspace.shapes.ply import parse_ply
from cspace.shapes.stl import parse_stl
from cspace.shapes.triangles import Faces
from cspace.tolerances import MESH_BYTES

PARSERS: Final[dict[str, Callable[[bytes], tuple[Array, Faces]]]] = {
    ".stl": parse_stl,
    ".obj": parse_obj,
    ".ply": parse_ply,
    ".dae": parse_collada,
}
"""The suffixes that are read, and the function for each."""


def read_mesh(path: str | os.PathLike[str]) -> tuple[Array, Faces]:
    """Vertices (k, 3) in the units of the file and triangles (m, 3); polygons are cut into fans.

    Raises MeshError with the file for an unknown suffix, malformed data, NaN, and a file without triangles.
    """
    name = path_of(path, "a mesh file is given by its path")
    suffix = os.path.splitext(name)[1].lower()
    if suffix not in PARSERS:
        known = ", ".join(PARSERS)
        raise MeshError(
            f"no mesh of the suffix {suffix!r} can be read; convert it to one of {known}", path=name
        )
    data = read_regular(name, "mesh", MESH_BYTES, MeshError)
    try:
        vertices, faces = PARSERS[suffix](data)
    except MeshError as error:
        raise MeshError(str(error), path=name, line=error.line) from None
    except (ValueError, IndexError, KeyError, OverflowError) as error:
        if isinstance(error, CspaceError):
            raise
        raise MeshError(f"malformed {suffix[1:].upper()} file: {error}", path=name) from None
    if not len(faces):
        raise MeshError("the file has no triangles", path=name)
    if not np.isfinite(vertices).all():
        raise MeshError("the file has vertices that are not finite", path=name)
    if not 0 <= faces.min() <= faces.max() < len(vertices):
        raise MeshError(f"a triangle names a vertex outside of 0 to {len(vertices) - 1}", path=name)
    return vertices, faces
