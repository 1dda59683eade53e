"""Plans as files: the corners of a path as YAML, JSON or CSV, by the ending."""

from __future__ import annotations

import json
import os
from pathlib import Path
from typing import Any, Final

from cspace.arrays import Array
from cspace.collision import RobotGeometry
from cspace.errors import InputError
from cspace.files import path_of, write_text

SCHEMA: Final = "cspace.path/1"
"""The keys of a path in YAML and JSON."""
ENDINGS: Final = (".yaml", ".yml", ".json", ".csv")
"""The endings of files of paths."""


def check_ending(path: str | os.PathLike[str]) -> str:
    """The ending of a file of a path; InputError for one that names no format."""
    name = path_of(path, "a path is written to the path of a file")
    ending = Path(name).suffix.lower()
    if ending not in ENDINGS:
        raise InputError(
            f"unknown format of a path {name!r}; its name must end with one of {', '.join(ENDINGS)}"
        )
    return ending


def write_path(
    path: str | os.PathLike[str], geometry: RobotGeometry, corners: Array, *, certified: bool
) -> None:
    """Write the corners (m, dof) of a path, with all digits; the file is complete or untouched."""
    ending = check_ending(path)
    values = {
        "schema": SCHEMA,
        "robot": geometry.robot,
        "joints": list(geometry.joint_names),
        "units": ["m" if k in geometry.prismatic else "rad" for k in range(geometry.dof)],
        "certified": certified,
        "path": corners.tolist(),
    }
    write_text(path, {".json": path_json, ".csv": path_csv}.get(ending, path_yaml)(values))


def path_json(values: dict[str, Any]) -> str:
    """A path as a JSON document, a corner a line."""
    head = "".join(f'  "{key}": {json_text(value)},\n' for key, value in values.items() if key != "path")
    rows = ",\n".join(f"    {json_text(row)}" for row in values["path"])
    return f'{{\n{head}  "path": [\n{rows}\n  ]\n}}\n'


def path_yaml(values: dict[str, Any]) -> str:
    """A path as a YAML document, a corner a line."""
    head = "".join(f"{key}: {json_text(value)}\n" for key, value in values.items() if key != "path")
    rows = "".join(f"  - [{', '.join(map(yaml_number, row))}]\n" for row in values["path"])
    return f"{head}path:\n{rows}"


def path_csv(values: dict[str, Any]) -> str:
    """A path as a table: the names of the joints, then a corner a line."""
    heading = ",".join(quote_cell(name) for name in values["joints"])
    rows = "".join(",".join(map(repr, row)) + "\n" for row in values["path"])
    return f"{heading}\n{rows}"


def json_text(value: Any) -> str:
    """A value as JSON, which is YAML too, in its own characters."""
    return json.dumps(value, ensure_ascii=False)


def yaml_number(value: float) -> str:
    """A number as every reader of YAML takes it: readers of version 1.1 want a point before an exponent."""
    digits, sign, exponent = repr(value).partition("e")
    return digits + (".0" if sign and "." not in digits else "") + sign + exponent


def quote_cell(text: str) -> str:
    """A cell of a CSV table, in quotes where it needs them."""
    doubled = text.replace('"', '""')
    return f'"{doubled}"' if any(sign in text for sign in ',"\r\n') else text
