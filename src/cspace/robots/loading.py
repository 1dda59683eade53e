"""A robot from a name of the catalogue or from a file."""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from cspace.errors import DescriptionError, InputTypeError, UnknownNameError
from cspace.model import Description, from_mjcf, from_toml, from_urdf
from cspace.model.files import read_bytes
from cspace.model.xml import root_tag
from cspace.robot import Robot
from cspace.robots.lookup import catalogue_description

__all__ = ["load_description", "load_robot"]

ADVICE = {
    ".xacro": "xacro cannot be read yet; expand it first: xacro in.xacro > out.urdf (pip install xacro)",
    ".sdf": "SDF (Gazebo) cannot be read; convert it to URDF",
    ".usd": "USD cannot be read; convert it to URDF",
    ".usda": "USD cannot be read; convert it to URDF",
    ".srdf": "an SRDF file only adds groups to a robot; give the URDF file that it belongs to",
}


XML_SUFFIXES = (".urdf", ".xml", ".mjcf")


def load_robot(
    name_or_path: str | os.PathLike[str],
    base: str | None = None,
    tip: str | None = None,
    *,
    floating: bool | None = None,
    package_paths: Sequence[Any] = (),
) -> Robot:
    """A robot of the catalogue or of a file, ready to be asked.

    name_or_path: a name ("ur5e", see cspace.robots.names()) or the path of a URDF, MJCF or TOML file; URDF
    and MJCF are told apart by their root element.
    base, tip: links between which it moves, where the file leaves the choice. floating: whether the base
    moves freely, its six velocities before those of the joints; None: if the file says so. package_paths:
    folders where package:// names of meshes are looked for first.
    Raises UnknownNameError for a name that is not in the catalogue, DescriptionError for a file that cannot
    be read, InputError where the tip is a choice that must be made.
    """
    return Robot(load_description(name_or_path, package_paths=package_paths), base, tip, floating=floating)


def load_description(
    name_or_path: str | os.PathLike[str], *, package_paths: Sequence[Any] = ()
) -> Description:
    """The description of a robot, as load_robot finds it: a name of the catalogue or a path.

    A string is a path if it has a suffix of a robot file or a separator, or if it names a file and no robot.
    """
    if not isinstance(name_or_path, (str, os.PathLike)):
        raise InputTypeError(
            f"a robot is given by a name or a path, got {type(name_or_path).__name__}; Robot(description),"
            " Robot.from_dh and Robot.from_screws take what is no file"
        )
    if isinstance(name_or_path, str) and not _looks_like_a_path(name_or_path):
        try:
            return catalogue_description(name_or_path)
        except UnknownNameError:
            if not _exists(name_or_path):
                raise
    path = os.fspath(name_or_path)
    suffix = Path(path).suffix.lower()
    if suffix in ADVICE:
        raise DescriptionError(ADVICE[suffix], path=path)
    if suffix == ".toml":
        return from_toml(path, package_paths=package_paths)
    data = read_bytes(path)
    if suffix not in XML_SUFFIXES:
        _check_xml(path, data)
    read = from_mjcf if root_tag(data) == "mujoco" else from_urdf
    return read(path, package_paths=package_paths)


def _looks_like_a_path(text: str) -> bool:
    suffix = Path(text).suffix.lower()
    return "/" in text or os.sep in text or suffix in (*XML_SUFFIXES, ".toml", *ADVICE)


def _exists(text: str) -> bool:
    try:
        return os.path.exists(text)
    except ValueError:  # a zero byte
        return False


def _check_xml(path: str, data: bytes) -> None:
    """Complain about a file of unknown suffix unless it starts as XML does."""
    start = data[:64].lstrip(b"\xef\xbb\xbf \t\r\n")
    if not start.startswith(b"<"):
        raise DescriptionError(
            f"this is no robot file: it starts with {start[:12]!r};"
            " a robot is URDF (.urdf, .xml), MJCF (.xml) or TOML (.toml)",
            path=path,
        )
