"""Robots from URDF, with the file and the line in every complaint."""

from __future__ import annotations

import math
import os
import warnings
from collections.abc import Sequence
from pathlib import Path
from typing import Any, Final

from cspace.arrays import Array
from cspace.errors import suggest
from cspace.math.wrapping import TURN
from cspace.model.attributes import complain_at, fault_at, read_floats, read_number, slip_in, text_of
from cspace.model.description import Description
from cspace.model.files import check_folders
from cspace.model.joint import JOINT_TYPES, RESISTANCES, Joint, Mimic
from cspace.model.link import SHAPES, Geometry, Inertial, Link, Mesh
from cspace.model.structure import ElementError
from cspace.model.transmissions import read_armatures
from cspace.model.values import IDENTITY, X_AXIS, freeze_array, from_rpy
from cspace.model.xml import Element, parse_source
from cspace.tolerances import DEGREE_LIMITS, UNLIMITED

Color = tuple[float, float, float, float]

CHILDREN: Final[dict[str, frozenset[str]]] = {
    "robot": frozenset({"link", "joint", "material", "transmission", "gazebo"}),
    "link": frozenset({"inertial", "visual", "collision"}),
    "joint": frozenset({"origin", "parent", "child", "axis", "limit", "mimic", "dynamics", "calibration"}),
    "inertial": frozenset({"origin", "mass", "inertia"}),
    "visual": frozenset({"origin", "geometry", "material"}),
    "collision": frozenset({"origin", "geometry", "material"}),
}
ATTRIBUTES: Final[dict[str, frozenset[str]]] = {
    "origin": frozenset({"xyz", "rpy"}),
    "axis": frozenset({"xyz"}),
    "limit": frozenset({"lower", "upper", "velocity", "effort", "acceleration", "jerk"}),
    "mimic": frozenset({"joint", "multiplier", "offset"}),
    "dynamics": frozenset(RESISTANCES),
    "inertia": frozenset({"ixx", "ixy", "ixz", "iyy", "iyz", "izz"}),
    "mesh": frozenset({"filename", "scale"}),
}
"""The elements and attributes of URDF, to tell a slip of the pen from an extension."""
DRAKE_ACCELERATION: Final = "drake:acceleration"
"""Drake's name for the limit that URDF does not have."""
OTHER_ROOTS = {
    "mujoco": "this is MJCF (MuJoCo), which load_robot and model.from_mjcf read",
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
    Armature: armature= of <dynamics>, or <drake:rotor_inertia> and <drake:gear_ratio> of transmissions.
    Raises DescriptionError with file and line for whatever is wrong in the file.
    """
    return urdf_description(parse_source(source), package_paths)


def urdf_description(root: Element, package_paths: Sequence[Any] = ()) -> Description:
    """The robot of the root element of a URDF document; errors as in from_urdf."""
    return _Reader(root.path, package_paths).read(root)


class _Reader:
    """Reads one document; knows the folders for meshes."""

    def __init__(self, path: str | None, package_paths: Sequence[Any]) -> None:
        self.path = path
        self.beside = None if path is None else os.path.dirname(os.path.abspath(path))
        self.package_paths = check_folders(package_paths)
        self.colors: dict[str, Color] = {}
        self.armatures: dict[str, float] = {}

    def read(self, root: Element) -> Description:
        self.check_root(root)
        self.check_words(root)
        for material in root.all("material"):
            self.color(material)
        links = [(element, self.link(element)) for element in root.all("link")]
        names = {element.attributes.get("name", "").strip() for element in root.all("joint")}
        self.armatures = read_armatures(root, names)
        joints = [(element, self.joint(element)) for element in root.all("joint")]
        self.warn_of_degrees(joints)
        unnamed = "robot" if root.path is None else Path(root.path).stem
        robot = root.attributes.get("name", "").strip() or unnamed
        try:
            return Description(robot, tuple(link for _, link in links), tuple(joint for _, joint in joints))
        except ElementError as error:
            named: list[tuple[Element, Link | Joint]] = [*links, *joints]
            culprit = next((element for element, part in named if part is error.part), root)
            raise fault_at(culprit, str(error)) from None

    def check_root(self, root: Element) -> None:
        """Complain unless the document is a URDF robot, saying what it is instead."""
        xacro = next((child for child in root.children if child.tag.startswith("xacro:")), None)
        if xacro is not None:
            raise fault_at(xacro, "this is a xacro file, which load_robot and model.from_xacro expand")
        if root.tag != "robot":
            hint = OTHER_ROOTS.get(root.tag, "a URDF file holds one <robot> element")
            raise fault_at(root, f"this is no robot: the root element is <{root.tag}>; {hint}")

    def check_words(self, element: Element) -> None:
        """Complain about what looks like a slip of the pen: an element left out in silence is worse."""
        known = CHILDREN.get(element.tag, frozenset())
        missing = known - {child.tag for child in element.children}
        slip = slip_in(element, known, missing, ATTRIBUTES)
        if slip is not None:
            name = element.attributes.get("name", "")
            where = f" ({element.tag} {name!r})" if name else ""
            raise fault_at(slip[1], slip[0] + where)
        for child in element.children:
            if child.tag in ("link", "joint", "inertial", "visual", "collision"):
                self.check_words(child)

    def origin(self, parent: Element) -> Array:
        """The <origin> of an element; the identity without one."""
        element = parent.first("origin")
        if element is None:
            return IDENTITY
        x, y, z = read_floats(element, "xyz", (0.0, 0.0, 0.0), 3)
        roll, pitch, yaw = read_floats(element, "rpy", (0.0, 0.0, 0.0), 3)
        return freeze_array(from_rpy((x, y, z), (roll, pitch, yaw)))

    def color(self, material: Element) -> Color | None:
        """The colour of a material, by its own <color> or by the name of an earlier one."""
        name = material.attributes.get("name", "")
        element = material.first("color")
        if element is None:
            return self.colors.get(name)
        r, g, b, a = read_floats(element, "rgba", None, 4)
        self.colors[name] = (r, g, b, a)
        return self.colors[name]

    def link(self, element: Element) -> Link:
        name = text_of(element, "name")
        inertial = element.first("inertial")
        return complain_at(
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
            raise fault_at(element, f"<inertial> of link {link!r} needs <mass value=…>")
        T = self.origin(element)
        value = read_number(mass, "value")
        entries = [0.0] * 6
        if inertia is not None:
            entries = [read_number(inertia, name, 0.0) for name in ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")]
        xx, xy, xz, yy, yz, zz = entries
        R = T[:3, :3]
        local = [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]
        return complain_at(element, lambda: Inertial(value, T[:3, 3], R @ local @ R.T))

    def geometry(self, element: Element) -> Geometry:
        """One <visual> or <collision>."""
        holder = element.first("geometry")
        if holder is None or not holder.children:
            raise fault_at(element, f"<{element.tag}> needs a <geometry> with a shape")
        shape = holder.children[0]
        if shape.tag not in SHAPES:
            raise fault_at(shape, str(suggest("shape", shape.tag, SHAPES)))
        size: list[float] = []
        mesh = None
        if shape.tag == "mesh":
            mesh = self.mesh(shape)
        elif shape.tag == "box":
            size = read_floats(shape, "size", None, 3)
        else:
            size = [read_number(shape, name) for name in SHAPES[shape.tag]]
        material = element.first("material")
        color = None if material is None else self.color(material)
        name = element.attributes.get("name", "")
        origin = self.origin(element)
        return complain_at(shape, lambda: Geometry(shape.tag, tuple(size), origin, name, mesh, color))

    def mesh(self, element: Element) -> Mesh:
        uri = text_of(element, "filename")
        x, y, z = read_floats(element, "scale", (1.0, 1.0, 1.0), 3)
        return complain_at(element, lambda: Mesh(uri, (x, y, z), self.beside, self.package_paths))

    def joint(self, element: Element) -> Joint:
        name = text_of(element, "name")
        kind = text_of(element, "type")
        if kind not in JOINT_TYPES:
            known = suggest("joint type", kind, JOINT_TYPES, owner=f"joint {name!r}")
            raise fault_at(element, str(known))
        parent, child = (self.end(element, name, which) for which in ("parent", "child"))
        axis = element.first("axis")
        direction: Any = X_AXIS if axis is None else read_floats(axis, "xyz", (1.0, 0.0, 0.0), 3)
        origin = self.origin(element)
        numbers = self.limits(element, kind) | self.dynamics(element, name)
        mimic = self.mimic(element) if kind != "fixed" else None
        return complain_at(
            axis if axis is not None and not any(direction) else element,
            lambda: Joint(name, kind, parent, child, origin, direction, mimic=mimic, **numbers),
        )

    def end(self, joint: Element, name: str, which: str) -> str:
        """The link at one end of a joint."""
        tag = joint.first(which)
        if tag is None:
            raise fault_at(joint, f"joint {name!r} needs <{which} link=…>")
        return text_of(tag, "link")

    def limits(self, joint: Element, kind: str) -> dict[str, Any]:
        """What <limit> says; lower and upper count for revolute and prismatic joints only."""
        limit = joint.first("limit")
        if limit is None or kind == "fixed":
            return {}
        found = {}
        if kind in ("revolute", "prismatic"):
            found = {name: read_number(limit, name, 0.0) for name in ("lower", "upper")}
        for name in ("velocity", "effort", "acceleration", "jerk"):
            if name in limit.attributes:
                found[name] = read_number(limit, name)
        if "acceleration" not in found and DRAKE_ACCELERATION in limit.attributes:
            found["acceleration"] = read_number(limit, DRAKE_ACCELERATION)
        return {name: math.copysign(math.inf, x) if abs(x) >= UNLIMITED else x for name, x in found.items()}

    def warn_of_degrees(self, joints: Sequence[tuple[Element, Joint]]) -> None:
        """Warn of the first revolute joint whose limits are many turns, as are those of degrees."""
        least, most = DEGREE_LIMITS
        for element, joint in joints:
            largest = max(map(abs, (joint.lower, joint.upper)))
            if joint.type != "revolute" or not least < largest <= most:
                continue
            place = "" if self.path is None else f"{self.path}:{element.line}: "
            span = f"{joint.lower:g} … {joint.upper:g} rad, up to {largest / TURN:.0f} turns"
            text = f"joint {joint.name!r} has the limits {span}: URDF takes radians, are these degrees?"
            warnings.warn(place + text, stacklevel=2)
            return

    def dynamics(self, joint: Element, name: str) -> dict[str, Any]:
        """What <dynamics> says; an armature that it names counts before those of transmissions."""
        found = {"armature": self.armatures[name]} if name in self.armatures else {}
        element = joint.first("dynamics")
        if element is not None:
            found |= {key: read_number(element, key) for key in RESISTANCES if key in element.attributes}
        return found

    def mimic(self, joint: Element) -> Mimic | None:
        element = joint.first("mimic")
        if element is None:
            return None
        leader = text_of(element, "joint")
        factor, shift = read_number(element, "multiplier", 1.0), read_number(element, "offset", 0.0)
        return complain_at(element, lambda: Mimic(leader, factor, shift))
