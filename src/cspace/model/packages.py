"""Where mesh files are: package:// names and relative paths, with every place that was tried."""

from __future__ import annotations

import os
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any
from urllib.parse import unquote

from cspace.errors import InputTypeError

__all__ = ["folders", "locate"]

PACKAGE_SCHEMES = ("package://", "model://")


def folders(package_paths: Any) -> tuple[str, ...]:
    """The folders of a `package_paths` argument; one folder alone would be read as a list of its letters."""
    if isinstance(package_paths, (str, bytes, os.PathLike)):
        raise InputTypeError(
            f"package_paths is a list of folders, got {os.fsdecode(package_paths)!r}; put it in brackets"
        )
    try:
        return tuple(map(os.fsdecode, package_paths))
    except TypeError as error:
        raise InputTypeError(f"package_paths is a list of folders: {error}") from None


def locate(uri: str, beside: str | None, package_paths: Sequence[str]) -> tuple[str | None, tuple[str, ...]]:
    """The file that `uri` names, or None, and the places tried in order.

    uri: package://NAME/rest, model://NAME/rest, file://path, or a plain path. beside: the folder of the
    robot file. package_paths: folders given by the caller, each either holding packages or being one.
    A package is looked for in package_paths, beside the file and in each folder above it, in
    ROS_PACKAGE_PATH, and in the share folders of AMENT_PREFIX_PATH and CMAKE_PREFIX_PATH.
    """
    tried: dict[str, None] = {}
    for place in _candidates(uri, beside, package_paths):
        if place in tried:
            continue
        tried[place] = None
        if os.path.isfile(place):
            return place, tuple(tried)
    return None, tuple(tried)


def _candidates(uri: str, beside: str | None, package_paths: Sequence[str]) -> Iterator[str]:
    scheme = next((s for s in PACKAGE_SCHEMES if uri.startswith(s)), None)
    if scheme is None:
        plain = unquote(uri[len("file://") :]) if uri.startswith("file://") else uri
        yield os.path.normpath(os.path.join(beside or "", plain))
        return
    package, _, rest = uri[len(scheme) :].partition("/")
    for folder in _folders(beside, package_paths):
        yield os.path.normpath(os.path.join(folder, package, rest))
        if os.path.basename(os.path.normpath(folder)) == package:
            yield os.path.normpath(os.path.join(folder, rest))


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


def _listed(variable: str) -> list[str]:
    value = os.environ.get(variable, "").replace(";", os.pathsep)
    return [folder for folder in value.split(os.pathsep) if folder]
