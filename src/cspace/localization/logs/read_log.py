"""The reader of logs: tells the formats apart by their content."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

from cspace.arrays import whole_number
from cspace.errors import InputError, LogError, shorten
from cspace.files import path_of
from cspace.localization.log import Log
from cspace.localization.logs import kitti
from cspace.localization.logs.carmen import RECORDS, read_carmen
from cspace.localization.logs.csv_poses import find_heading, read_csv
from cspace.localization.logs.lines import Lines, is_number, read_lines
from cspace.localization.logs.mrclam import FILE, is_mrclam, read_mrclam
from cspace.localization.logs.tum import COLUMNS, read_tum
from cspace.localization.logs.victoria import read_victoria

GRAPHS = ("VERTEX", "EDGE", "FIX")


def read_log(path: str | os.PathLike[str], *, robot: int | None = None) -> Log:
    """The log of a robot: CARMEN, MRCLAM, Victoria Park, TUM, KITTI or CSV, by its content; gzips too.

    path: a file, or for MRCLAM the folder, or a file of one robot in it. robot: which robot of an MRCLAM
    folder, the first unless given. A log is read whole or not at all; `log.notes` says what was dropped or
    mended. Raises LogError with file and line for anything else.
    """
    name = path_of(path, "a log is given by its path")
    place = Path(name)
    if robot is not None:
        whole_number(robot, "robot", 1, MOST_ROBOTS)
    if place.is_dir():
        if not is_mrclam(place):
            raise LogError(
                "this is a folder without Barcodes.dat of MRCLAM; give the file of a log",
                path=name,
            )
        return read_mrclam(place, robot)
    found = FILE.fullmatch(place.name)
    if found and place.is_file() and is_mrclam(place.parent):
        return read_mrclam(place.parent, int(found[1]) if robot is None else robot)
    if robot is not None:
        raise InputError(f"robot is {robot}; only folders of MRCLAM have several robots; leave robot= out")
    return read_by_content(read_lines(name))


MOST_ROBOTS = 1000
"""The largest number of a robot."""


def read_by_content(lines: Lines) -> Log:
    """The log of a file by its first line that is no comment, or by the heading of a table."""
    heading = find_heading(lines)
    if heading is not None:
        return read_csv(lines, heading)
    number, words = next(lines.rows(), (0, [""]))
    if words[0] in ("ODOMETRY", "LANDMARK"):
        return read_victoria(lines)
    if words[0] in RECORDS:
        return read_carmen(lines)
    if words[0].startswith(GRAPHS):
        raise lines.error(number, f"{words[0]} belongs to a pose graph, not to a log of a robot")
    if len(words) == COLUMNS and all(map(is_number, words)):
        return read_tum(lines)
    if len(words) == kitti.COLUMNS and all(map(is_number, words)):
        return kitti.read_kitti(lines)
    if not words[0]:
        raise LogError("the file has no lines", path=lines.path)
    shown: Any = shorten(" ".join(words), 40)
    remedy = (
        "; a table needs a heading that names time, x, y and theta"
        if "," in words[0] or ";" in words[0]
        else ""
    )
    raise lines.error(
        number, f"{shown!r} begins no log of CARMEN, MRCLAM, Victoria Park, TUM, KITTI or CSV{remedy}"
    )
