"""Robots from xacro, the macro language of ROS: expanded by the package xacro in a separate process.

Why a process: a xacro file is a program. It may count to 10^10^10 or call itself endlessly, which nothing in
this process could stop, and the package keeps its state in global variables.
"""

from __future__ import annotations

import json
import os
import sys
from collections.abc import Mapping, Sequence
from typing import Any, Final

from cspace.errors import DescriptionError, InputError, InputTypeError, MissingExtraError
from cspace.model.attributes import fault_at
from cspace.model.description import Description
from cspace.model.files import check_folders, path_of, read_bytes
from cspace.model.urdf import urdf_description
from cspace.model.xml import Element
from cspace.tolerances import XACRO_SECONDS

CHILD: Final = (
    "import sys; sys.path[:] = [path for path in sys.path if path]; import json;"
    " request = json.load(sys.stdin); sys.path[:] = request['path'];"
    " from cspace.model.xacro_child import main; main(request)"
)
"""What the other process runs: with our own module path, whatever lies in the working folder."""


def from_xacro(
    path: str | os.PathLike[str],
    *,
    xacro_args: Mapping[str, Any] | None = None,
    package_paths: Sequence[Any] = (),
) -> Description:
    """A robot from a xacro file (github.com/ros/xacro) that makes URDF or MJCF.

    xacro_args: values of its arguments (<xacro:arg>) by name; numbers, texts, True and False.
    package_paths: folders where $(find …) and package:// look first; then beside the file and in each folder
    above it, in ROS_PACKAGE_PATH, and in the share folders of AMENT_PREFIX_PATH and CMAKE_PREFIX_PATH.
    A xacro file is a program: it can read files and environment variables, so take those that you trust.
    Raises MissingExtraError without the package xacro (the extra [xacro]); DescriptionError with file and
    line, as in from_urdf, and for a file that takes longer than tolerances.XACRO_SECONDS or makes more than
    XACRO_ELEMENTS; InputError for an argument that the file does not have.
    """
    name = path_of(path)
    read_bytes(name)  # raises the usual error for a missing file
    root = expand_file(name, texts_of(xacro_args), check_folders(package_paths))
    stem = os.path.basename(name).partition(".")[0]
    if root.tag == "mujoco":
        from cspace.model.mjcf.reader import mjcf_description

        root.attributes.setdefault("model", stem)
        return mjcf_description(root, package_paths)
    if root.tag == "robot" and root.first("link") is None:
        raise fault_at(
            root, "this xacro file makes no links; if it holds macros, give the file that calls them"
        )
    root.attributes.setdefault("name", stem)
    return urdf_description(root, package_paths)


def is_xacro(root: Element) -> bool:
    """Whether an XML document has elements of xacro; a comment that shows some does not count."""
    return any(element.tag.startswith("xacro:") for element in root.walk())


def texts_of(arguments: Mapping[str, Any] | None) -> dict[str, str]:
    """The arguments of a xacro file as the texts that it takes."""
    if not isinstance(arguments or {}, Mapping):
        raise InputTypeError(f"xacro_args is a mapping of names to values, got {type(arguments).__name__}")
    found = {}
    for name, value in (arguments or {}).items():
        if not isinstance(name, str) or not isinstance(value, (str, int, float, os.PathLike)):
            raise InputTypeError(
                f"xacro_args maps names to texts or numbers, got {name!r}: {type(value).__name__}"
            )
        found[name] = str(value).lower() if isinstance(value, bool) else str(value)
    return found


def expand_file(path: str, arguments: Mapping[str, str], package_paths: Sequence[str]) -> Element:
    """The root element of what a xacro file makes; each element knows its file and line there."""
    import subprocess  # these two cost a tenth of `import cspace`
    from importlib.util import find_spec

    if find_spec("xacro") is None:
        raise MissingExtraError("xacro", f"reading {path!r}, a xacro file,")
    if not sys.executable:
        raise InputError(f"{path!r} is xacro, which a second Python expands, but sys.executable is not set")
    places = [place for place in sys.path if place not in ("", os.curdir)]  # not the working folder
    request = {"path": places, "file": path, "arguments": arguments, "package_paths": package_paths}
    command = [sys.executable, "-c", CHILD]
    try:
        done = subprocess.run(
            command, input=json.dumps(request).encode(), capture_output=True, timeout=XACRO_SECONDS
        )
    except subprocess.TimeoutExpired:
        text = f"its expansion took longer than {XACRO_SECONDS:g} s; do its macros call each other endlessly?"
        raise DescriptionError(text, path=path, line=1) from None
    try:
        answer = json.loads(done.stdout)
    except ValueError:
        last = done.stderr.decode("utf-8", "replace").strip().splitlines()[-1:]
        text = f"expanding it ended with exit code {done.returncode}: {''.join(last)[:200] or 'no message'}"
        raise DescriptionError(text, path=path, line=1) from None
    if "unknown" in answer:
        raise InputError(f"{path}: {answer['unknown']}")
    if "fault" in answer:
        raise DescriptionError(answer["fault"], path=answer["file"], line=answer["line"])
    return tree_of(answer["files"], answer["elements"])


def tree_of(files: Sequence[str], rows: Sequence[Any]) -> Element:
    """The elements of an answer, each (depth, tag, attributes, number of its file, line), in their places."""
    line: list[Element] = []
    for depth, tag, attributes, file, number in rows:
        element = Element(tag, attributes, number, files[file])
        del line[depth:]
        if line:
            line[-1].children.append(element)
        line.append(element)
    return line[0]
