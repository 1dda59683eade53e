"""The solids of links: what a description gives as their collision geometry, or capsules along the arm."""

from __future__ import annotations

from collections.abc import Container, Mapping
from typing import Final

import numpy as np

from cspace.arrays import Array
from cspace.errors import CspaceError, DescriptionError
from cspace.kinematics import Assembly
from cspace.model import Description, Geometry
from cspace.shapes import Box, Capsule, Cylinder, Mesh, Shape, Sphere
from cspace.spatial.poses import invert_pose
from cspace.spatial.vectors import frame_along
from cspace.tolerances import DRAWN_LENGTH

SKELETON_SHARE: Final = 0.06
"""Radius of the skeleton's capsules, as a share of the arm's length: that of slender industrial arms."""

Solids = Mapping[str, tuple[Shape, ...]]


def described_solids(description: Description, frames: Container[str]) -> dict[str, tuple[Shape, ...]]:
    """The collision shapes of the links that are in `frames`, by link, each in the frame of its link.

    Meshes are read from their files. Raises DescriptionError, with the link, for a mesh that is not found or
    cannot be read, and for a shape whose sizes are not positive.
    """
    solids = {}
    for link in description.links:
        if link.name in frames and link.collision:
            try:
                solids[link.name] = tuple(solid_of(geometry) for geometry in link.collision)
            except CspaceError as error:
                raise DescriptionError(f"collision geometry of link {link.name!r}: {error}") from error
    return solids


def solid_of(geometry: Geometry) -> Shape:
    """The solid of an element of a description, in the frame of its link."""
    size, pose, name = geometry.size, geometry.origin, geometry.name
    if geometry.mesh is not None:
        return Mesh.from_file(geometry.mesh.file(), scale=geometry.mesh.scale, pose=pose, name=name)
    if geometry.shape == "box":
        return Box(size, pose, name)
    if geometry.shape == "sphere":
        return Sphere(size[0], pose, name)
    radius, length = size
    kind = Cylinder if geometry.shape == "cylinder" else Capsule
    return kind(radius, length, pose, name)


def skeleton_solids(assembly: Assembly) -> dict[str, tuple[Shape, ...]]:
    """Capsules from each joint to the next one and to the tips, by the link that the joint carries.

    A picture of the arm, not its real shape: every capsule has the radius SKELETON_SHARE of the arm's length.
    """
    ends: dict[int, list[Array]] = {}
    for joint, parent in enumerate(assembly.parent.tolist()):
        ends.setdefault(parent, []).append(assembly.T_parent_joint[joint][:3, 3])
    for leaf in assembly.leaves:
        frame = assembly.frame_index[leaf]
        ends.setdefault(int(assembly.frame_joint[frame]), []).append(assembly.T_joint_frame[frame][:3, 3])
    whole = sum(float(np.linalg.norm(p)) for joint, points in ends.items() if joint >= 0 for p in points)
    links: dict[int, tuple[str, Array]] = {}
    for name, frame in assembly.frame_index.items():  # the first link that each joint carries
        links.setdefault(int(assembly.frame_joint[frame]), (name, assembly.T_joint_frame[frame]))
    solids: dict[str, tuple[Shape, ...]] = {}
    for joint, points in ends.items():
        if joint < 0 or joint not in links:
            continue
        name, T_joint_link = links[joint]
        solids[name] = tuple(
            capsule_to(p, SKELETON_SHARE * whole).moved(invert_pose(T_joint_link)) for p in points
        )
    return solids


def capsule_to(end: Array, radius: float) -> Shape:
    """The capsule from the origin to a point (3,); a sphere where they coincide."""
    length = float(np.linalg.norm(end))
    if length < DRAWN_LENGTH:
        return Sphere(radius)
    T = np.eye(4)
    T[:3, :3], T[:3, 3] = frame_along(end / length), end / 2.0
    return Capsule(radius, length, T)
