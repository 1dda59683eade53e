"""Links as data: mass and shape of each rigid part."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, Final

import numpy as np

from cspace.arrays import Array, one_array
from cspace.errors import InputError, suggest
from cspace.model.files import locate_file
from cspace.model.values import IDENTITY, check_placement, check_size, finite_number, freeze_array, name_of
from cspace.tables import show_fields
from cspace.tolerances import INERTIA_SYMMETRY

SHAPES: Final[dict[str, tuple[str, ...]]] = {
    "box": ("x", "y", "z"),
    "sphere": ("radius",),
    "cylinder": ("radius", "length"),
    "capsule": ("radius", "length"),
    "mesh": (),
}
"""The shapes and the sizes [m] that each needs; cylinder and capsule lie along z, centred."""


@show_fields
@dataclass(frozen=True, eq=False)
class Inertial:
    """Mass properties of one link.

    mass [kg] ≥ 0; com (3,): centre of mass in the link frame [m]; inertia (3, 3): about the centre of mass,
    in the axes of the link frame [kg·m²], symmetric.
    """

    mass: float
    com: Array
    inertia: Array

    def __post_init__(self) -> None:
        mass = finite_number(self.mass, "mass")
        if mass < 0.0:
            raise InputError(f"mass is {mass:g} kg; it must not be negative")
        com = _exactly(self.com, "centre of mass", (3,))
        inertia = _exactly(self.inertia, "inertia", (3, 3))
        skew = float(np.abs(inertia - inertia.T).max())
        if skew > INERTIA_SYMMETRY * max(1.0, float(np.abs(inertia).max())):
            raise InputError(f"inertia is not symmetric: opposite entries differ by {skew:.3g}")
        object.__setattr__(self, "mass", mass)
        object.__setattr__(self, "com", freeze_array(com.copy()))
        object.__setattr__(self, "inertia", freeze_array((inertia + inertia.T) / 2))

    def in_frame(self, T_frame_link: Array) -> Inertial:
        """The same body in another frame; T_frame_link (4, 4): the frame of this link in that one."""
        R = T_frame_link[:3, :3]
        return Inertial(self.mass, R @ self.com + T_frame_link[:3, 3], R @ self.inertia @ R.T)


@show_fields
@dataclass(frozen=True)
class Mesh:
    """A mesh file by reference; the file is not opened until the geometry is needed.

    uri: as written in the description. scale (3,): factors along the axes of the mesh. beside: the folder of
    the description. package_paths: folders where packages are looked for first.
    """

    uri: str
    scale: tuple[float, float, float] = (1.0, 1.0, 1.0)
    beside: str | None = None
    package_paths: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        name_of(self.uri, "mesh file")
        scale = _exactly(self.scale, f"scale of mesh {self.uri!r}", (3,))
        object.__setattr__(self, "scale", tuple(scale.tolist()))

    def file(self) -> str:
        """The path of the mesh file.

        Raises DescriptionError naming every place searched if there is no such file.
        """
        return locate_file(self.uri, self.beside, self.package_paths)


@show_fields
@dataclass(frozen=True, eq=False)
class Geometry:
    """One shape fixed to a link.

    shape: a key of SHAPES. size: its sizes [m] in the order of SHAPES. origin (4, 4): shape frame in the
    link. mesh: the file, for shape "mesh". color: RGBA in 0…1, or None.
    """

    shape: str
    size: tuple[float, ...] = ()
    origin: Array = field(default_factory=lambda: IDENTITY)
    name: str = ""
    mesh: Mesh | None = None
    color: tuple[float, float, float, float] | None = None

    def __post_init__(self) -> None:
        if self.shape not in SHAPES:
            raise suggest("shape", self.shape, SHAPES)
        wanted = SHAPES[self.shape]
        size = tuple(finite_number(s, f"size of a {self.shape}") for s in self.size)
        if len(size) != len(wanted):
            raise InputError(f"a {self.shape} needs the sizes ({', '.join(wanted)}), got {len(size)} numbers")
        if any(s < 0.0 for s in size):
            raise InputError(f"a {self.shape} has the size {size}; sizes must not be negative")
        if (self.mesh is not None) != (self.shape == "mesh"):
            raise InputError(f"shape {self.shape!r} {'without' if self.mesh is None else 'with'} a mesh file")
        object.__setattr__(self, "size", size)
        object.__setattr__(self, "origin", check_placement(self.origin, f"origin of a {self.shape}"))


@show_fields
@dataclass(frozen=True, eq=False)
class Link:
    """A rigid part: its name, mass properties (None if unknown) and shapes."""

    name: str
    inertial: Inertial | None = None
    visual: tuple[Geometry, ...] = ()
    collision: tuple[Geometry, ...] = ()

    def __post_init__(self) -> None:
        name_of(self.name, "link")
        object.__setattr__(self, "visual", tuple(self.visual))
        object.__setattr__(self, "collision", tuple(self.collision))


def _exactly(value: Any, subject: str, shape: tuple[int, ...]) -> Array:
    return check_size(one_array(value, subject, shape), subject)
