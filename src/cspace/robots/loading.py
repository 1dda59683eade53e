"""A robot from a name of the catalogue or from a file."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from cspace.errors import DescriptionError, InputTypeError, UnknownNameError
from cspace.model import (
    Description,
    calibrated,
    from_toml,
    from_xacro,
    group_ends,
    read_srdf,
    with_right_angles,
    with_srdf,
)
from cspace.model.files import path_of, read_bytes
from cspace.model.urdf import urdf_description
from cspace.model.xacro import is_xacro
from cspace.model.xml import Element, parse_document
from cspace.robot import Robot
from cspace.robots.lookup import catalogue_description

ADVICE = {
    ".sdf": "SDF (Gazebo) cannot be read; convert it to URDF",
    ".usd": "USD cannot be read; convert it to URDF",
    ".usda": "USD cannot be read; convert it to URDF",
    ".srdf": "an SRDF file only adds to a robot; give the URDF file of the robot, and this one as srdf=",
}

SUFFIXES = (".urdf", ".xml", ".mjcf", ".xacro", ".toml")
"""Of the files that can be read; XML files may have any other."""


def load_robot(
    name_or_path: str | os.PathLike[str],
    base: str | None = None,
    tip: str | None = None,
    *,
    floating: bool | None = None,
    locked: Mapping[str, float] | None = None,
    geometry: str = "collision",
    cover: float = 0.01,
    package_paths: Sequence[Any] = (),
    xacro_args: Mapping[str, Any] | None = None,
    calibration: str | os.PathLike[str] | None = None,
    right_angles: float | None = None,
    srdf: str | os.PathLike[str] | None = None,
    group: str | None = None,
) -> Robot:
    """Load a robot of the catalogue or of a file.

    name_or_path: a name ("ur5e", see cspace.robots.names()) or the path of a URDF, xacro, MJCF or TOML file;
    XML files are distinguished by their content. base, tip: links between which it moves, if the file allows
    several. floating: whether the base moves freely, its six velocities before those of the joints; None:
    if the file says so. locked: joint name → value [rad or m] of joints off the chain from base to tip, such
    as fingers; zero unless given. geometry: what collision checks use, "collision" (the elements of the file,
    covered by spheres within `cover` [m]) or "skeleton" (capsules along the arm). package_paths: folders
    where packages (of package:// and $(find …)) are looked for first. xacro_args: values of the arguments of
    a xacro file, by name. calibration: the file of one UR arm's joint frames, see model.calibrated.
    right_angles: how far [rad] the file rounds right angles, which then are exact, such as 1e-5 for 1.5708
    and 3.1416, see model.with_right_angles; None: the numbers of the file.
    srdf: the path of an SRDF file of MoveIt, whose named poses and allowed pairs of links are added, see
    model.with_srdf. group: one of its groups, whose ends are base and tip, see model.group_ends.

    Raises UnknownNameError for a name that is not in the catalogue and for a group that does not exist,
    DescriptionError for a file that cannot be read, InputError where the tip is a choice that must be made
    and for a group that is not a chain, MissingExtraError for xacro without the extra [xacro].
    """
    description = load_description(
        name_or_path,
        package_paths=package_paths,
        xacro_args=xacro_args,
        calibration=calibration,
        right_angles=right_angles,
    )
    if group is not None and (srdf is None or base is not None or tip is not None):
        raise InputTypeError("group= names a group of an SRDF file: give srdf=, and neither base= nor tip=")
    if srdf is not None:
        content = read_srdf(path_of(srdf))
        description = with_srdf(description, content)
        base, tip = (base, tip) if group is None else group_ends(description, content, group)
    return Robot(description, base, tip, floating=floating, locked=locked, geometry=geometry, cover=cover)


def load_description(
    name_or_path: str | os.PathLike[str],
    *,
    package_paths: Sequence[Any] = (),
    xacro_args: Mapping[str, Any] | None = None,
    calibration: str | os.PathLike[str] | None = None,
    right_angles: float | None = None,
) -> Description:
    """The description of a robot, as load_robot finds it: a name of the catalogue or a path.

    A string is a path if it has a suffix of a robot file or a separator, or if it names a file and no robot.
    """
    if not isinstance(name_or_path, (str, os.PathLike)):
        raise InputTypeError(
            f"expected the name or the path of a robot, got {type(name_or_path).__name__};"
            " Robot(description), Robot.from_dh and Robot.from_screws make robots without a file"
        )
    description = _nominal(name_or_path, package_paths, xacro_args)
    if calibration is not None:
        description = calibrated(description, calibration)
    return description if right_angles is None else with_right_angles(description, right_angles)


def _nominal(
    name_or_path: str | os.PathLike[str], package_paths: Sequence[Any], xacro_args: Mapping[str, Any] | None
) -> Description:
    """The robot of a name or a path, before any calibration."""
    if isinstance(name_or_path, str) and not _looks_like_a_path(name_or_path):
        try:
            description = catalogue_description(name_or_path)
        except UnknownNameError:
            if not os.path.exists(name_or_path):
                raise
        else:
            _refuse_arguments(xacro_args, name_or_path)
            return description
    path = os.fspath(name_or_path)
    suffix = Path(path).suffix.lower()
    if suffix in ADVICE:
        raise DescriptionError(ADVICE[suffix], path=path)
    root = None if suffix in (".toml", ".xacro") else _parsed(path, suffix)
    if suffix == ".xacro" or (root is not None and is_xacro(root)):
        return from_xacro(path, xacro_args=xacro_args, package_paths=package_paths)
    _refuse_arguments(xacro_args, path)
    if root is None:
        return from_toml(path, package_paths=package_paths)
    if root.tag == "mujoco":
        from cspace.model.mjcf.reader import mjcf_description  # most users never need it

        return mjcf_description(root, package_paths)
    return urdf_description(root, package_paths)


def _refuse_arguments(xacro_args: Mapping[str, Any] | None, name: object) -> None:
    """Complain about arguments that nothing would read."""
    if xacro_args:
        raise InputTypeError(f"xacro_args can only be used with a xacro file, and {str(name)!r} is not one")


def _looks_like_a_path(text: str) -> bool:
    suffix = Path(text).suffix.lower()
    return "/" in text or os.sep in text or suffix in (*SUFFIXES, *ADVICE)


def _parsed(path: str, suffix: str) -> Element:
    """The root element of an XML file; of a file of unknown suffix only if it starts as XML does."""
    data = read_bytes(path)
    start = data[:64].lstrip(b"\xef\xbb\xbf \t\r\n")
    if suffix not in SUFFIXES and not start.startswith(b"<"):
        raise DescriptionError(
            f"this is not a robot file: it starts with {start[:12]!r};"
            " a robot is URDF (.urdf, .xml), xacro (.xacro), MJCF (.xml) or TOML (.toml)",
            path=path,
        )
    return parse_document(data, path)
