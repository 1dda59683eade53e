"""Trajectories as CSV tables: columns are found by their names in the heading, in any order."""

from __future__ import annotations

import csv
import re
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final

import numpy as np

from cspace import tolerances
from cspace.arrays import Array
from cspace.errors import shorten
from cspace.localization.log import Log
from cspace.localization.logs.lines import Lines, is_number
from cspace.localization.logs.tum import plan_of_space
from cspace.mobile import Odometry, TimedPoses
from cspace.spatial import embed_pose_2d, pose, pose_2d

NAMES: Final = {
    "time": ("time", "t", "timestamp", "stamp"),
    "x": ("x", "px", "tx", "pos_x", "position_x"),
    "y": ("y", "py", "ty", "pos_y", "position_y"),
    "z": ("z", "pz", "tz", "pos_z", "position_z"),
    "theta": ("theta", "θ", "yaw", "heading"),
    "qx": ("qx", "q_x", "orientation_x"),
    "qy": ("qy", "q_y", "orientation_y"),
    "qz": ("qz", "q_z", "orientation_z"),
    "qw": ("qw", "q_w", "orientation_w"),
}
"""What a column holds, and the names by which it is known, in lower case."""
COLUMN_OF: Final = {name: column for column, names in NAMES.items() for name in names}
QUATERNION: Final = ("qx", "qy", "qz", "qw")
UNITS: Final = {
    "time": {"s": 1.0, "sec": 1.0, "ms": 1 / 10**3, "us": 1 / 10**6, "µs": 1 / 10**6, "ns": 1 / 10**9},
    "x": {"m": 1.0, "mm": 1 / 1000, "cm": 1 / 100},
    "theta": {"rad": 1.0, "deg": np.pi / 180, "°": np.pi / 180},
    "qx": {},
}
"""Units that may follow a name, as in "x [m]", and what they are in s, m and rad."""
UNITS_OF: Final = {"y": "x", "z": "x", "qy": "qx", "qz": "qx", "qw": "qx"}
"""Columns with the units of another one."""
TITLE: Final = re.compile(r"\s*([^\[\]()]*?)\s*(?:[\[(]\s*([^\[\]()]*?)\s*[\])])?\s*")
WANTED: Final = "time, x, y and theta, or time, x, y, z, qx, qy, qz and qw"


@dataclass(frozen=True)
class Heading:
    """The line that names the columns, what separates them (None: blanks), and their names."""

    line: int
    separator: str | None
    titles: tuple[str, ...]


def find_heading(lines: Lines) -> Heading | None:
    """The first line with words, if it names a column of a trajectory and none of its words is a number.

    It may begin with "#", which is a comment where the line after it is separated otherwise.
    """
    filled = ((number, line) for number, line in enumerate(lines.lines, 1) if line.strip())
    number, first = next(filled, (0, ""))
    is_comment = first.lstrip().startswith("#")
    text = first.lstrip().removeprefix("#") if is_comment else first
    separator = next((mark for mark in ",;\t" if mark in text), None)
    if is_comment and (separator is None or separator not in next(filled, (0, ""))[1]):
        return None
    titles = tuple(split_line(text, separator) or ())
    known = [COLUMN_OF.get(name_and_unit(title)[0]) for title in titles]
    if not {"time", "x"} & set(known) or any(map(is_number, titles)):
        return None
    return Heading(number, separator, titles)


def split_line(line: str, separator: str | None) -> list[str] | None:
    """The cells of a line; None where its quotes do not match."""
    if separator is None:
        return line.split()
    try:
        return next(csv.reader([line], delimiter=separator, skipinitialspace=True, strict=True), [])
    except csv.Error:
        return None


def name_and_unit(title: str) -> tuple[str, str | None]:
    """The name of a column in lower case, and the unit in brackets behind it, or None."""
    found = TITLE.fullmatch(title)
    return (found[1].lower(), found[2]) if found else (title.strip().lower(), None)


def read_csv_poses(lines: Lines, heading: Heading) -> tuple[Array, Array, list[str]]:
    """The times of the file (n,), the poses (n, 4, 4), and the titles of columns that are left out.

    LogError for columns that are missing, named twice or in unknown units, for cells that are no finite
    numbers, lines of another length, quaternions of zero, and times that run backwards.
    """
    places = place_columns(lines, heading)
    is_planar = "theta" in places
    wanted = ["time", "x", "y", *(("theta",) if is_planar else ("z", *QUATERNION))]
    factors = [read_factor(lines, heading, places[name], name) if name in places else 1.0 for name in wanted]
    used = [places.get(name) for name in wanted]
    numbers, rows = [], []
    for number, cells in split_rows(lines, heading):
        words = [cells[place] if place is not None else "0" for place in used]
        rows.append(lines.numbers(number, words, f"the columns {', '.join(wanted)}", factors))
        numbers.append(number)
    table = np.array(rows, dtype=np.float64).reshape(-1, len(wanted))
    if not len(table):
        raise lines.error(heading.line, "the table has no rows under its heading")
    backwards = np.flatnonzero(np.diff(table[:, 0]) < 0)
    if len(backwards):
        raise lines.error(numbers[int(backwards[0]) + 1], "the time runs backwards; sort the lines by time")
    left_out = [title for place, title in enumerate(heading.titles) if place not in used]
    return table[:, 0], place_in_space(lines, numbers, table, is_planar), left_out


def place_columns(lines: Lines, heading: Heading) -> dict[str, int]:
    """Where each column is; LogError where one is missing, or named twice."""
    places: dict[str, int] = {}
    for place, title in enumerate(heading.titles):
        column = COLUMN_OF.get(name_and_unit(title)[0])
        if column is not None and column in places:
            first = heading.titles[places[column]]
            raise lines.error(heading.line, f"{first!r} and {shorten(title, 40)!r} both name {column}")
        if column is not None:
            places[column] = place
    turned = [name for name in QUATERNION if name in places]
    if turned:
        places.pop("theta", None)  # the heading of the quaternion
    needed = ["time", "x", "y", *(QUATERNION if turned else ("theta",))]
    missing = [name for name in needed if name not in places]
    if missing:
        text = f"the heading has no {' and no '.join(missing)}; the columns must be {WANTED}, by name"
        raise lines.error(heading.line, text)
    return places


def read_factor(lines: Lines, heading: Heading, place: int, column: str) -> float:
    """What one of the unit of a column is in s, m or rad; LogError for an unknown unit."""
    unit = name_and_unit(heading.titles[place])[1]
    known = UNITS[UNITS_OF.get(column, column)]
    if not unit:
        return 1.0
    if unit not in known:
        allowed = f"units: {', '.join(known)}" if known else "it has no unit"
        raise lines.error(heading.line, f"{column} is in {shorten(unit, 20)!r}; {allowed}")
    return known[unit]


def split_rows(lines: Lines, heading: Heading) -> Iterator[tuple[int, list[str]]]:
    """The lines under the heading with their cells; LogError for a line of another length."""
    count = len(heading.titles)
    for number, line in enumerate(lines.lines[heading.line :], heading.line + 1):
        if not line.strip() or line.lstrip().startswith("#"):
            continue
        cells = split_line(line, heading.separator)
        if cells is None:
            most = csv.field_size_limit()
            is_long = len(line) > most
            text = f"a cell has more than {most} characters" if is_long else "the quotes do not match"
            raise lines.error(number, f"the line cannot be split: {text}")
        if len(cells) != count:
            raise lines.error(number, f"the line has {len(cells)} columns; the heading names {count}")
        yield number, cells


def place_in_space(lines: Lines, numbers: list[int], table: Array, is_planar: bool) -> Array:
    """Poses (n, 4, 4) of rows time, x, y, θ, or time, x, y, z, qx, qy, qz, qw."""
    if is_planar:
        return np.asarray(embed_pose_2d(pose_2d(xytheta=table[:, 1:])))
    lengths = np.linalg.norm(table[:, 4:], axis=1)
    zero = np.flatnonzero(lengths == 0)
    if len(zero):
        raise lines.error(numbers[int(zero[0])], "the quaternion is zero; it has no rotation")
    return np.asarray(pose(xyz=table[:, 1:4], xyzw=table[:, 4:] / lengths[:, None]))


def read_csv(lines: Lines, heading: Heading) -> Log:
    """A trajectory as truth, with the odometry that a perfect robot would have measured.

    Of poses of space x, y and the heading are read; heights and tilts are left out and noted.
    """
    stamps, T, left_out = read_csv_poses(lines, heading)
    times, poses = stamps - stamps[0], plan_of_space(T)
    notes = [f"columns left out: {shorten(', '.join(left_out), 80)}"] if left_out else []
    tilt, height = float(np.arccos(np.clip(T[:, 2, 2], -1, 1)).max()), float(np.ptp(T[:, 2, 3]))
    if tilt > tolerances.LEVEL_TILT or height > 0:
        notes.append(f"tilts up to {tilt:.3g} rad and heights over {height:.3g} m are left out")
    return Log(Odometry.from_poses(times, poses), truth=TimedPoses(times, poses), notes=tuple(notes))
