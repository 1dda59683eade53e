"""Robots written as URDF, every number with all its digits."""

from __future__ import annotations

import math
import os
import re
from collections.abc import Iterable, Iterator

from cspace.arrays import Array
from cspace.errors import InputError
from cspace.files import write_text
from cspace.model.description import Description
from cspace.model.joint import Joint
from cspace.model.link import SHAPES, Geometry, Inertial, Link
from cspace.model.transmissions import NAMESPACE, transmission_lines
from cspace.model.values import IDENTITY
from cspace.spatial import to_rpy
from cspace.tolerances import UNLIMITED

FORBIDDEN = "[^\t\n\r -\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]"
"""The characters that XML 1.0 does not allow; a text, because the pattern takes milliseconds to compile."""

ESCAPES = {ord(c): f"&{name};" for c, name in {"&": "amp", "<": "lt", ">": "gt", '"': "quot"}.items()}
ESCAPES |= {ord(c): f"&#{ord(c)};" for c in "\t\n\r"}
"""How characters are written inside the quotation marks of an attribute; readers would blank bare breaks."""


def to_urdf(description: Description, path: str | os.PathLike[str] | None = None) -> str:
    """The robot as the text of a URDF file, written to `path` as well if there is one.

    Reading it back gives the same tree, with poses equal to rounding. URDF demands numbers where a limit is
    unknown: tolerances.UNLIMITED stands for infinity. Armature is written as the rotors of transmissions, as
    Drake reads it. Named poses and sources have no place in URDF.
    A file is written whole or not at all. Raises InputError for a robot with closed loops, for names that XML
    cannot hold and for a path that cannot be written.
    """
    if description.loops:
        raise InputError(
            f"robot {description.name!r} has {len(description.loops)} closed loops, but URDF supports trees"
            " only; write it as TOML"
        )
    geared = [joint for joint in description.joints if joint.armature is not None]
    extension = f' xmlns:drake="{NAMESPACE}"' if geared else ""
    lines = ['<?xml version="1.0" encoding="utf-8"?>', f"<robot name={_quoted(description.name)}{extension}>"]
    for link in description.links:
        lines.extend(_link(link))
    for joint in description.joints:
        lines.extend(_joint(joint))
    for joint in geared:
        lines.extend(transmission_lines(_quoted(joint.name), joint.armature or 0.0))
    lines.append("</robot>")
    text = "\n".join(lines) + "\n"
    if path is not None:
        write_text(path, text)
    return text


def _quoted(text: str) -> str:
    if bad := re.search(FORBIDDEN, text):
        raise InputError(
            f"the name {text!r} contains the character {bad.group()!r}, which XML does not allow; rename it"
        )
    return f'"{text.translate(ESCAPES)}"'


def _numbers(values: Iterable[float]) -> str:
    return " ".join(repr(float(value) + 0.0) for value in values)


def _tag(tag: str, /, **attributes: str | float | Iterable[float] | None) -> str:
    """An element without content; attributes that are None are left out."""
    words = [f"<{tag}"]
    for key, value in attributes.items():
        if isinstance(value, str):
            words.append(f"{key}={_quoted(value)}")
        elif value is not None:
            words.append(f'{key}="{_numbers(value if isinstance(value, Iterable) else [value])}"')
    return " ".join(words) + "/>"


def _origin(T: Array, indent: str) -> Iterator[str]:
    if T is not IDENTITY:
        yield indent + _tag("origin", xyz=T[:3, 3], rpy=to_rpy(T[:3, :3]))


def _link(link: Link) -> Iterator[str]:
    if link.inertial is None and not link.visual and not link.collision:
        yield "  " + _tag("link", name=link.name)
        return
    yield f"  <link name={_quoted(link.name)}>"
    if link.inertial is not None:
        yield from _inertial(link.inertial)
    for tag, shapes in (("visual", link.visual), ("collision", link.collision)):
        for geometry in shapes:
            yield from _geometry(tag, geometry)
    yield "  </link>"


def _inertial(inertial: Inertial) -> Iterator[str]:
    (xx, xy, xz), (_, yy, yz), (_, _, zz) = inertial.inertia.tolist()
    yield "    <inertial>"
    yield "      " + _tag("origin", xyz=inertial.com, rpy="0 0 0")
    yield "      " + _tag("mass", value=inertial.mass)
    yield "      " + _tag("inertia", ixx=xx, ixy=xy, ixz=xz, iyy=yy, iyz=yz, izz=zz)
    yield "    </inertial>"


def _geometry(tag: str, geometry: Geometry) -> Iterator[str]:
    name = f" name={_quoted(geometry.name)}" if geometry.name else ""
    yield f"    <{tag}{name}>"
    yield from _origin(geometry.origin, "      ")
    yield f"      <geometry>{_shape(geometry)}</geometry>"
    if geometry.color is not None:
        yield f'      <material name="">{_tag("color", rgba=geometry.color)}</material>'
    yield f"    </{tag}>"


def _shape(geometry: Geometry) -> str:
    if geometry.mesh is not None:
        scale = geometry.mesh.scale
        return _tag("mesh", filename=geometry.mesh.uri, scale=None if scale == (1.0, 1.0, 1.0) else scale)
    if geometry.shape == "box":
        return _tag("box", size=geometry.size)
    return _tag(geometry.shape, **dict(zip(SHAPES[geometry.shape], geometry.size, strict=True)))


def _joint(joint: Joint) -> Iterator[str]:
    yield f"  <joint name={_quoted(joint.name)} type={_quoted(joint.type)}>"
    yield from _origin(joint.origin, "    ")
    yield "    " + _tag("parent", link=joint.parent)
    yield "    " + _tag("child", link=joint.child)
    if joint.type not in ("fixed", "floating"):
        yield "    " + _tag("axis", xyz=joint.axis)
    yield from _limit(joint)
    if joint.damping is not None or joint.friction is not None:
        yield "    " + _tag("dynamics", damping=joint.damping, friction=joint.friction)
    if joint.mimic is not None:
        yield "    " + _tag("mimic", **vars(joint.mimic))
    yield "  </joint>"


def _limit(joint: Joint) -> Iterator[str]:
    if joint.type == "fixed":
        return
    known = {"effort": joint.effort, "velocity": joint.velocity}
    if joint.type in ("revolute", "prismatic"):
        known = {"lower": joint.lower, "upper": joint.upper, **known}
    extra = {"acceleration": joint.acceleration, "jerk": joint.jerk}
    known |= {key: value for key, value in extra.items() if math.isfinite(value)}
    if joint.type in ("revolute", "prismatic") or any(math.isfinite(value) for value in known.values()):
        finite = {key: min(max(value, -UNLIMITED), UNLIMITED) for key, value in known.items()}
        yield "    " + _tag("limit", **finite)
