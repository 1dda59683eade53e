"""Robots from MJCF, the format of MuJoCo."""

from __future__ import annotations

import os
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from cspace.model.description import Description

__all__ = ["from_mjcf"]


def from_mjcf(source: str | os.PathLike[str] | bytes, *, package_paths: Sequence[Any] = ()) -> Description:
    """A robot from MJCF (the XML format of MuJoCo, mujoco.readthedocs.io/en/stable/XMLreference.html).

    source: a path, or the text itself (a string that starts with "<", or bytes). package_paths: folders where
    package:// names of meshes are looked for first.
    Each body is a link of its name, <worldbody> the root link "world", each named site a link fixed to its
    body. Several joints in a body get a massless link "body/joint" between them, and so does a joint whose
    `pos` is not the body's origin. Hinges, slides and free joints are read, with default classes, includes,
    frames, all ways to say an orientation, `ref`, limits, equalities of joints (a mimic) and of bodies (a
    loop), keyframes (named poses), and masses, from <inertial> or from the geoms. Geoms of the groups 0 to 2
    are visual, geoms that can touch are collision shapes, ellipsoids as the boxes around them; planes, height
    fields and distance functions are left out, which is logged where they can touch.
    Meshes are not opened; a body whose mass only a mesh could tell has none.
    Raises DescriptionError with file and line for whatever is wrong, for ball joints, and for elements that
    make bodies (replicate, attach, composite, flexcomp).
    """
    from cspace.model.mjcf.reader import mjcf_description  # a dozen files that most users never need
    from cspace.model.xml import parse_source

    return mjcf_description(parse_source(source), package_paths)
