"""The data sets of UTIAS, Multi-Robot Cooperative Localization and Mapping (MRCLAM): a folder of tables."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

from cspace.arrays import Array
from cspace.errors import LogError
from cspace.localization.log import Landmarks, Log, Readings
from cspace.localization.logs.lines import Lines, mend_clock, read_lines
from cspace.mobile import Odometry, TimedPoses

ROBOTS = 5
"""Subjects from 1 to this are robots, the others landmarks."""
MAP = "Landmark_Groundtruth"
ENDINGS = (".dat", ".dat.gz")
FILE = re.compile(r"Robot(\d+)_(Odometry|Measurement|Groundtruth)\.dat(\.gz)?")


def is_mrclam(folder: Path) -> bool:
    """Whether the folder has the barcodes or the map of landmarks of such a data set."""
    return any(has_file(folder, name) for name in ("Barcodes", MAP))


def list_robots(folder: Path) -> list[int]:
    """The numbers of the robots whose files are in a folder."""
    return sorted({int(found[1]) for path in folder.iterdir() if (found := FILE.fullmatch(path.name))})


def read_mrclam(folder: Path, robot: int | None) -> Log:
    """The log of one robot, the first unless given, with landmarks and truth.

    Readings name the barcode that was seen; Barcodes.dat says whose it is. Readings of other robots and of
    unknown barcodes are left out. The odometry is the commanded velocity. Without the file of its truth, or
    that of the map, the log has none, and a note says so. Source: Leung et al. 2011.
    """
    numbers = list_robots(folder)
    if not numbers:
        raise LogError("no Robot1_Odometry.dat, Robot2_… in the folder", path=str(folder))
    if robot is not None and robot not in numbers:
        raise LogError(
            f"no robot {robot} in the folder; robots: {', '.join(map(str, numbers))}", path=str(folder)
        )
    chosen = numbers[0] if robot is None else robot
    notes = [f"robot {chosen} of {', '.join(map(str, numbers))}"] if len(numbers) > 1 else []
    speeds = read_table(folder, f"Robot{chosen}_Odometry", 3, "time, forward velocity, angular velocity")
    seen = read_seen(folder, f"Robot{chosen}_Measurement")
    if not len(speeds):
        raise LogError(f"Robot{chosen}_Odometry.dat has no rows", path=str(folder))
    zero = speeds[0, 0]
    times, clock = mend_clock(speeds[:, 0] - zero)
    twists = np.stack([speeds[:, 1], np.zeros(len(speeds)), speeds[:, 2]], axis=-1)
    notes += [f"odometry: {note}" for note in clock]
    repeated = int(np.count_nonzero(np.diff(times) == 0))
    if repeated:
        notes.append(f"odometry: {repeated} stamps are repeated; the last velocity of each holds")
    readings, more = name_landmarks(folder, seen, zero)
    truth, of_truth = read_truth(folder, f"Robot{chosen}_Groundtruth", zero)
    landmarks = read_landmarks(folder) if has_file(folder, MAP) else None
    of_map = [f"map: the folder has no {MAP}.dat"] if landmarks is None else []
    return Log(
        Odometry.from_twists(times, twists),
        readings=readings,
        landmarks=landmarks,
        truth=truth,
        notes=tuple(notes + more + of_truth + of_map),
    )


def read_truth(folder: Path, name: str, zero: float) -> tuple[TimedPoses | None, list[str]]:
    """The true poses and notes; None where the folder has no file of them, or one without rows."""
    if not has_file(folder, name):
        return None, [f"truth: the folder has no {name}.dat"]
    rows = read_table(folder, name, 4, "time, x, y, orientation")
    if not len(rows):
        return None, [f"truth: {name}.dat has no rows"]
    times, clock = mend_clock(rows[:, 0] - zero)
    return TimedPoses(times, rows[:, 1:]), [f"truth: {note}" for note in clock]


def name_landmarks(folder: Path, seen: Array, zero: float) -> tuple[Readings, list[str]]:
    """Readings with the subjects of their barcodes, of landmarks alone, and notes of those left out."""
    codes = read_names(folder, "Barcodes", 2, "subject, barcode")
    subject_of = {int(code): int(subject) for subject, code in codes}
    subjects = np.array([subject_of.get(int(code), 0) for code in seen[:, 1]], dtype=np.int64)
    times, clock = mend_clock(seen[:, 0] - zero)
    notes = [f"readings: {note}" for note in clock]
    unknown, robots = int((subjects == 0).sum()), int(((subjects > 0) & (subjects <= ROBOTS)).sum())
    if unknown:
        notes.append(f"readings: {unknown} of unknown barcodes are left out")
    if robots:
        notes.append(f"readings: {robots} of other robots are left out")
    keep = subjects > ROBOTS
    return Readings(times[keep], subjects[keep], seen[keep, 2], seen[keep, 3]), notes


def read_landmarks(folder: Path) -> Landmarks:
    """The map with the standard deviations of its points."""
    what = "subject, x, y and their standard deviations"
    rows = read_names(folder, MAP, 5, what)
    covariances = np.zeros((len(rows), 2, 2))
    covariances[:, 0, 0], covariances[:, 1, 1] = rows[:, 3] ** 2, rows[:, 4] ** 2
    return Landmarks(rows[:, 0].astype(np.int64), rows[:, 1:3], covariances)


def read_seen(folder: Path, name: str) -> Array:
    """Times, barcodes, ranges and bearings; LogError for a range below zero."""
    lines = find_lines(folder, name)
    seen = lines.table(4, "time, barcode, range, bearing")
    lines.refuse(seen[:, 2] < 0, "the range is below zero")
    return seen


def read_names(folder: Path, name: str, columns: int, what: str) -> Array:
    """A table whose first column names each row once, by a whole number; LogError otherwise."""
    lines = find_lines(folder, name)
    rows = lines.table(columns, what)
    named = rows[:, 0]
    lines.refuse((named < 0) | (named != np.round(named)), "the subject must be a whole number from 0 on")
    is_second = np.ones(len(rows), dtype=np.bool_)
    is_second[np.unique(named, return_index=True)[1]] = False
    lines.refuse(is_second, "the subject was named by a line before; give each once")
    return rows


def read_table(folder: Path, name: str, columns: int, what: str) -> Array:
    """The rows of a file of the folder."""
    return find_lines(folder, name).table(columns, what)


def has_file(folder: Path, name: str) -> bool:
    """Whether the folder has a file of a name, plain or compressed."""
    return any((folder / (name + ending)).is_file() for ending in ENDINGS)


def find_lines(folder: Path, name: str) -> Lines:
    """The lines of a file of the folder, plain or compressed."""
    for ending in ENDINGS:
        if (folder / (name + ending)).is_file():
            return read_lines(str(folder / (name + ending)))
    raise LogError(f"there is no {name}.dat in the folder; it belongs to the data set", path=str(folder))
