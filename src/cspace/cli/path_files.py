"""Paths of arms as files: YAML, JSON or CSV by the ending."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from cspace.cli.exits import UsageError
from cspace.cli.output import check_writable
from cspace.files import write_text

if TYPE_CHECKING:
    from cspace.planning import Plan
    from cspace.robot import Robot


SCHEMA: Final = "cspace.path/1"
"""The keys of a path in YAML and JSON."""
UNITS: Final = {"R": "rad", "P": "m"}
"""The unit of a joint, by its type."""
ENDINGS: Final = (".yaml", ".yml", ".json", ".csv")
"""The endings of files of paths."""


def check_path_file(path: Path) -> None:
    """Refuse a file that cannot be written, or whose ending names no format, before any computation."""
    if path.suffix.lower() not in ENDINGS:
        raise UsageError(
            f"unknown format of a path {str(path)!r}; its name must end with one of {', '.join(ENDINGS)}"
        )
    check_writable(path)


def write_path(path: Path, robot: Robot, plan: Plan) -> None:
    """Write the corners of a plan, with all digits; the file is complete or untouched."""
    values = {
        "schema": SCHEMA,
        "robot": robot.name,
        "joints": list(robot.joint_names),
        "units": [UNITS[kind] for kind in robot.joint_types],
        "certified": plan.certified,
        "path": plan.path.tolist(),
    }
    ending = path.suffix.lower()
    text = {".json": path_json, ".csv": path_csv}.get(ending, path_yaml)(values)
    write_text(path, text)


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
