"""Robots from URDF, with the file and the line in every complaint."""

from __future__ import annotations

import contextlib
import math
import os
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any, TypeVar

from cspace.arrays import Array
from cspace.errors import CspaceError, DescriptionError, suggest
from cspace.model.description import Description
from cspace.model.files import path_of, read_bytes
from cspace.model.joint import JOINT_TYPES, Joint, Mimic
from cspace.model.link import SHAPES, Geometry, Inertial, Link, Mesh
from cspace.model.packages import folders
from cspace.model.structure import ElementError
from cspace.model.transforms import from_rpy
from cspace.model.urdf_words import slip_in
from cspace.model.values import IDENTITY, X_AXIS, frozen
from cspace.model.xml import Element, parse
from cspace.tolerances import UNLIMITED

__all__ = ["from_urdf"]

T = TypeVar("T")
Color = tuple[float, float, float, float]
BLANKS = "\ufeff \t\r\n"

OTHER_ROOTS = {
    "mujoco": "this is MJCF (MuJoCo); only URDF and TOML can be read so far: convert it to URDF",
    "sdf": "this is SDF (Gazebo); convert it to URDF",
    "COLLADA": "this is a COLLADA mesh, not a robot",
    "launch": "this is a ROS launch file; give the URDF file that it loads",
}


def from_urdf(source: str | os.PathLike[str] | bytes, *, package_paths: Sequence[Any] = ()) -> Description:
    """A robot from URDF (Unified Robot Description Format, wiki.ros.org/urdf/XML).

    source: a path, or the text itself (a string that starts with "<", or bytes). package_paths: folders where
    package:// names are looked for first.
    Links, fixed joints and their frames are all kept. Joints: revolute, continuous, prismatic, fixed,
    floating, planar. A revolute or prismatic joint without <limit> is unlimited. Meshes are not opened.
    Raises DescriptionError with file and line for whatever is wrong in the file.
    """
    if isinstance(source, str) and source.lstrip(BLANKS).startswith("<"):
        blank = len(source) - len(source.lstrip(BLANKS))
        data = source[blank:].encode("utf-8", "replace")
        return _Reader(None, package_paths, source.count("\n", 0, blank)).read(data, "robot")
    if isinstance(source, bytes):
        return _Reader(None, package_paths, 0).read(source, "robot")
    path = path_of(source)
    return _Reader(path, package_paths, 0).read(read_bytes(path), Path(path).stem)


class _Reader:
    """Reads one document; knows the path for messages and the folders for meshes."""

    def __init__(self, path: str | None, package_paths: Sequence[Any], lines_before: int) -> None:
        self.path = path
        self.beside = None if path is None else os.path.dirname(os.path.abspath(path))
        self.package_paths = folders(package_paths)
        self.lines_before = lines_before
        self.colors: dict[str, Color] = {}

    def fault(self, message: str, element: Element) -> DescriptionError:
        return DescriptionError(message, path=self.path, line=element.line)

    def at(self, element: Element, make: Callable[[], T]) -> T:
        """What `make` returns; its complaint gets the file and the line of `element`."""
        try:
            return make()
        except DescriptionError as error:
            if error.line is not None:
                raise
            raise self.fault(str(error), element) from None
        except CspaceError as error:
            raise self.fault(str(error), element) from None

    def read(self, data: bytes, name: str) -> Description:
        root = parse(data, self.path, self.lines_before)
        self.check_root(root)
        self.check_words(root)
        for material in root.all("material"):
            self.color(material)
        links = [(element, self.link(element)) for element in root.all("link")]
        joints = [(element, self.joint(element)) for element in root.all("joint")]
        robot = root.attributes.get("name", "").strip() or name
        try:
            return Description(robot, tuple(link for _, link in links), tuple(joint for _, joint in joints))
        except ElementError as error:
            named: list[tuple[Element, Link | Joint]] = [*links] if error.kind == "link" else [*joints]
            culprits = [element for element, part in named if part.name == error.name]
            line = culprits[min(error.occurrence, len(culprits) - 1)].line if culprits else root.line
            raise DescriptionError(str(error), path=self.path, line=line) from None

    def check_root(self, root: Element) -> None:
        """Complain unless the document is a URDF robot, saying what it is instead."""
        xacro = next((child for child in root.children if child.tag.startswith("xacro:")), None)
        if xacro is not None:
            raise self.fault(
                "this is a xacro file; expand it first: xacro in.xacro > out.urdf (pip install xacro)", xacro
            )
        if root.tag != "robot":
            hint = OTHER_ROOTS.get(root.tag, "a URDF file holds one <robot> element")
            raise self.fault(f"this is no robot: the root element is <{root.tag}>; {hint}", root)

    def check_words(self, element: Element) -> None:
        """Complain about what looks like a slip of the pen: an element left out in silence is worse."""
        slip = slip_in(element)
        if slip is not None:
            name = element.attributes.get("name", "")
            where = f" ({element.tag} {name!r})" if name else ""
            raise self.fault(slip[0] + where, slip[1])
        for child in element.children:
            if child.tag in ("link", "joint", "inertial", "visual", "collision"):
                self.check_words(child)

    def floats(
        self, element: Element, attribute: str, default: Sequence[float] | None, n: int
    ) -> list[float]:
        """The n finite numbers of an attribute."""
        text = element.attributes.get(attribute)
        if text is None:
            if default is None:
                raise self.fault(f"<{element.tag}> needs the attribute {attribute!r}", element)
            return list(default)
        where = f"{attribute}={text[:60]!r} of <{element.tag}>"
        try:
            numbers = [float(word) for word in text.split()]
            if "_" in text:  # Python reads 1_000, no other reader does
                raise ValueError
        except ValueError:
            raise self.fault(f"{where}: expected {n} number{'s' if n > 1 else ''}", element) from None
        if len(numbers) != n:
            raise self.fault(f"{where} holds {len(numbers)} numbers, expected {n}", element)
        if not all(math.isfinite(number) for number in numbers):
            raise self.fault(f"{where}: every number must be finite", element)
        return numbers

    def number(self, element: Element, attribute: str, default: float | None = None) -> float:
        """One finite number; the plain case first, since a humanoid has a thousand of them."""
        text = element.attributes.get(attribute, "_")
        if "_" not in text:
            with contextlib.suppress(ValueError):
                value = float(text)
                if math.isfinite(value):
                    return value
        return self.floats(element, attribute, None if default is None else [default], 1)[0]

    def text(self, element: Element, attribute: str) -> str:
        value = element.attributes.get(attribute, "").strip()
        if not value:
            raise self.fault(f"<{element.tag}> needs the attribute {attribute!r}", element)
        return value

    def origin(self, parent: Element) -> Array:
        """The <origin> of an element; the identity without one."""
        element = parent.first("origin")
        if element is None:
            return IDENTITY
        x, y, z = self.floats(element, "xyz", (0.0, 0.0, 0.0), 3)
        roll, pitch, yaw = self.floats(element, "rpy", (0.0, 0.0, 0.0), 3)
        return frozen(from_rpy((x, y, z), (roll, pitch, yaw)))

    def color(self, material: Element) -> Color | None:
        """The colour of a material, by its own <color> or by the name of an earlier one."""
        name = material.attributes.get("name", "")
        element = material.first("color")
        if element is None:
            return self.colors.get(name)
        r, g, b, a = self.floats(element, "rgba", None, 4)
        self.colors[name] = (r, g, b, a)
        return self.colors[name]

    def link(self, element: Element) -> Link:
        name = self.text(element, "name")
        inertial = element.first("inertial")
        return self.at(
            element,
            lambda: Link(
                name,
                None if inertial is None else self.inertial(inertial, name),
                tuple(self.geometry(part) for part in element.all("visual")),
                tuple(self.geometry(part) for part in element.all("collision")),
            ),
        )

    def inertial(self, element: Element, link: str) -> Inertial:
        mass, inertia = element.first("mass"), element.first("inertia")
        if mass is None:
            raise self.fault(f"<inertial> of link {link!r} needs <mass value=…>", element)
        T = self.origin(element)
        value = self.number(mass, "value")
        entries = [0.0] * 6
        if inertia is not None:
            entries = [self.number(inertia, name, 0.0) for name in ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")]
        xx, xy, xz, yy, yz, zz = entries
        R = T[:3, :3]
        local = [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]
        return self.at(element, lambda: Inertial(value, T[:3, 3], R @ local @ R.T))

    def geometry(self, element: Element) -> Geometry:
        """One <visual> or <collision>."""
        holder = element.first("geometry")
        if holder is None or not holder.children:
            raise self.fault(f"<{element.tag}> needs a <geometry> with a shape", element)
        shape = holder.children[0]
        if shape.tag not in SHAPES:
            raise self.fault(str(suggest("shape", shape.tag, SHAPES)), shape)
        size: list[float] = []
        mesh = None
        if shape.tag == "mesh":
            mesh = self.mesh(shape)
        elif shape.tag == "box":
            size = self.floats(shape, "size", None, 3)
        else:
            size = [self.number(shape, name) for name in SHAPES[shape.tag]]
        material = element.first("material")
        color = None if material is None else self.color(material)
        name = element.attributes.get("name", "")
        origin = self.origin(element)
        return self.at(shape, lambda: Geometry(shape.tag, tuple(size), origin, name, mesh, color))

    def mesh(self, element: Element) -> Mesh:
        uri = self.text(element, "filename")
        x, y, z = self.floats(element, "scale", (1.0, 1.0, 1.0), 3)
        return self.at(element, lambda: Mesh(uri, (x, y, z), self.beside, self.package_paths))

    def joint(self, element: Element) -> Joint:
        name = self.text(element, "name")
        kind = self.text(element, "type")
        if kind not in JOINT_TYPES:
            known = suggest("joint type", kind, JOINT_TYPES, owner=f"joint {name!r}")
            raise self.fault(str(known), element)
        parent, child = (self.end(element, name, which) for which in ("parent", "child"))
        axis = element.first("axis")
        direction: Any = X_AXIS if axis is None else self.floats(axis, "xyz", (1.0, 0.0, 0.0), 3)
        origin = self.origin(element)
        numbers = self.limits(element, kind) | self.dynamics(element)
        mimic = self.mimic(element) if kind != "fixed" else None
        return self.at(
            axis if axis is not None and not any(direction) else element,
            lambda: Joint(name, kind, parent, child, origin, direction, mimic=mimic, **numbers),
        )

    def end(self, joint: Element, name: str, which: str) -> str:
        """The link at one end of a joint."""
        tag = joint.first(which)
        if tag is None:
            raise self.fault(f"joint {name!r} needs <{which} link=…>", joint)
        return self.text(tag, "link")

    def limits(self, joint: Element, kind: str) -> dict[str, Any]:
        """What <limit> says; lower and upper count for revolute and prismatic joints only."""
        limit = joint.first("limit")
        if limit is None or kind == "fixed":
            return {}
        found = {}
        if kind in ("revolute", "prismatic"):
            found = {name: self.number(limit, name, 0.0) for name in ("lower", "upper")}
        for name in ("velocity", "effort", "acceleration", "jerk"):
            if name in limit.attributes:
                found[name] = self.number(limit, name)
        return {name: math.copysign(math.inf, x) if abs(x) >= UNLIMITED else x for name, x in found.items()}

    def dynamics(self, joint: Element) -> dict[str, Any]:
        element = joint.first("dynamics")
        names = () if element is None else ("damping", "friction")
        return {name: self.number(element, name) for name in names if name in element.attributes}  # type: ignore

    def mimic(self, joint: Element) -> Mimic | None:
        element = joint.first("mimic")
        if element is None:
            return None
        leader = self.text(element, "joint")
        factor, shift = self.number(element, "multiplier", 1.0), self.number(element, "offset", 0.0)
        return self.at(element, lambda: Mimic(leader, factor, shift))
