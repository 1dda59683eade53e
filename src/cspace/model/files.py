"""Files of robots: their bytes and paths, and where the packages and meshes are that they name."""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any
from urllib.parse import unquote

from cspace import files
from cspace.errors import CspaceError, DescriptionError, InputTypeError
from cspace.tolerances import DESCRIPTION_BYTES


def path_of(source: Any) -> str:
    """`source` as a path. Raises InputTypeError for other objects."""
    return files.path_of(source, "a file is given by its path, a robot also by its text")


def read_bytes(path: str | os.PathLike[str]) -> bytes:
    """The bytes of a robot file; DescriptionError names the path of one missing, too large or unreadable."""
    return files.read_regular(path, "robot", DESCRIPTION_BYTES, DescriptionError)


PACKAGE_SCHEMES = ("package://", "model://")


def check_folders(package_paths: Any) -> tuple[str, ...]:
    """The folders of a `package_paths` argument; one folder alone would be read as a list of its letters."""
    if isinstance(package_paths, (str, bytes, os.PathLike)):
        raise InputTypeError(
            f"package_paths is a list of folders, got {os.fsdecode(package_paths)!r}; write it in brackets"
        )
    try:
        return tuple(map(os.fsdecode, package_paths))
    except TypeError as error:
        raise InputTypeError(f"package_paths is a list of folders: {error}") from None


def locate_file(uri: str, beside: str | None, package_paths: Sequence[str]) -> str:
    """The file of the mesh that `uri` names; DescriptionError with every place tried if there is none.

    uri: package://NAME/rest, model://NAME/rest, file://path, or a plain path. beside: the folder of the
    robot file. package_paths: folders given by the caller, each either holding packages or being one.
    A package is looked for in package_paths, beside the file and in each folder above it, in
    ROS_PACKAGE_PATH, and in the share folders of AMENT_PREFIX_PATH and CMAKE_PREFIX_PATH. A folder is a
    package by its name or by the name that its package.xml gives.
    """
    return _first(_candidates(uri, beside, package_paths), os.path.isfile, f"mesh {uri!r}")


def locate_package(name: str, beside: str | None, package_paths: Sequence[str]) -> str:
    """The folder of a package; rules and error as in `locate_file`."""
    return _first(_packages(name, beside, package_paths), os.path.isdir, f"package {name!r}")


def _first(places: Iterator[str], fits: Callable[[str], bool], subject: str) -> str:
    """The first place that fits."""
    tried: dict[str, None] = {}
    for place in places:
        if place not in tried:
            tried[place] = None
            if fits(place):
                return place
    searched = "".join(f"\n  {place}" for place in tried) or " nowhere"
    raise DescriptionError(
        f"{subject} not found; searched:{searched}\n"
        "Pass package_paths=[folder that contains the package], or set ROS_PACKAGE_PATH."
    )


def _candidates(uri: str, beside: str | None, package_paths: Sequence[str]) -> Iterator[str]:
    scheme = next((s for s in PACKAGE_SCHEMES if uri.startswith(s)), None)
    if scheme is None:
        plain = unquote(uri[len("file://") :]) if uri.startswith("file://") else uri
        yield os.path.normpath(os.path.join(beside or "", plain))
        return
    package, _, rest = uri[len(scheme) :].lstrip("/").partition("/")
    for folder in _packages(package, beside, package_paths):
        yield os.path.normpath(os.path.join(folder, rest))


def _packages(name: str, beside: str | None, package_paths: Sequence[str]) -> Iterator[str]:
    """The folders that may be the package of that name, in the order in which they are tried."""
    given = [*package_paths, *_listed("ROS_PACKAGE_PATH")]
    for folder in _folders(beside, package_paths):
        yield os.path.normpath(os.path.join(folder, name))
        if os.path.basename(os.path.normpath(folder)) == name or _declared(folder) == name:
            yield os.path.normpath(folder)
    for folder in given:  # a clone may have another name than its package
        yield from (part for part in _subfolders(folder) if _declared(part) == name)


def _folders(beside: str | None, package_paths: Sequence[str]) -> Iterator[str]:
    """The folders that may hold packages, in the order in which they are tried."""
    yield from package_paths
    if beside is not None:
        here = Path(os.path.abspath(beside))
        yield str(here)
        yield from (str(parent) for parent in here.parents)
    yield from _listed("ROS_PACKAGE_PATH")
    for variable in ("AMENT_PREFIX_PATH", "CMAKE_PREFIX_PATH"):
        yield from (os.path.join(prefix, "share") for prefix in _listed(variable))


def _subfolders(folder: str) -> list[str]:
    """The folders in a folder, by name; none where it cannot be read."""
    try:
        return sorted(entry.path for entry in os.scandir(folder) if entry.is_dir())
    except OSError:
        return []


def _declared(folder: str) -> str | None:
    """The name that the package.xml of a folder gives, if there is one that can be read."""
    path = os.path.join(folder, "package.xml")
    if not os.path.isfile(path):
        return None
    try:
        name = re.search(rb"<name>\s*([^<\s]+)\s*</name>", read_bytes(path))
    except CspaceError:
        return None
    return None if name is None else name.group(1).decode("utf-8", "replace")


def _listed(variable: str) -> list[str]:
    value = os.environ.get(variable, "").replace(";", os.pathsep)
    return [folder for folder in value.split(os.pathsep) if folder]
