"""Samples of trajectories as CSV files."""

from __future__ import annotations

import csv
import io
import os
from array import array
from collections.abc import Iterator
from math import isfinite
from typing import Final

import numpy as np

from cspace.arrays import Array
from cspace.errors import DescriptionError
from cspace.files import name_file, path_of, read_text, write_text
from cspace.model.values import read_joint_names
from cspace.trajectory.polynomials import PolynomialTrajectory
from cspace.trajectory.time_scaling import connect_samples
from cspace.trajectory.trajectory import Trajectory, check_trajectory

QUANTITIES: Final = ("q", "qd", "qdd")
"""What the columns of a CSV file begin with, before the name of a joint."""

LARGEST_FILE: Final = 2_000_000_000
"""Bytes of a file that is read."""


def to_csv(trajectory: Trajectory, path: str | os.PathLike[str], *, rate: float) -> None:
    """Write samples of a trajectory as a table: time [s], then positions, velocities and accelerations.

    Columns are named time, q:joint, qd:joint and qdd:joint; numbers have all digits and are in radians or
    metres. rate [Hz]: of the samples; the end is among them. The file is complete or untouched.
    Raises InputError for a trajectory with a reason (which is not what was asked for), and where the file
    cannot be written.
    """
    check_trajectory(trajectory)
    samples = trajectory.samples_to_write(rate)
    heading = ["time", *(f"{kind}:{name}" for kind in QUANTITIES for name in trajectory.labels)]
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(heading)
    table = np.column_stack([samples.times, samples.q, samples.qd, samples.qdd])
    writer.writerows([repr(x) for x in row] for row in table.tolist())
    write_text(path_of(path), text.getvalue())


def from_csv(path: str | os.PathLike[str]) -> PolynomialTrajectory:
    """The trajectory through the samples of a table, with columns as of to_csv.

    Between samples it is the quintic polynomial through positions, velocities and accelerations, or the cubic
    one where the table has no accelerations.

    Returns a PolynomialTrajectory. Raises DescriptionError, with the file and the line, for other columns,
    cells that are no numbers, and times that do not increase from zero.
    """
    text = read_text(path_of(path), "CSV", LARGEST_FILE, DescriptionError)
    rows = csv.reader(io.StringIO(text, newline=""))
    try:
        return _read_table(rows, str(path))
    except csv.Error as error:
        raise DescriptionError(f"the file is no table: {error}", path=str(path), line=rows.line_num) from None


def _read_table(rows: Iterator[list[str]], path: str) -> PolynomialTrajectory:
    """The trajectory of the rows of a table, the first of them the heading."""
    heading = next(rows, [])
    names = [title.partition(":")[2] for title in heading if title.startswith("q:")]
    kinds = [kind for kind in QUANTITIES if f"{kind}:{names[0] if names else ''}" in heading]
    wanted = ["time", *(f"{kind}:{name}" for kind in kinds for name in names)]
    if not names or len(kinds) < 2 or heading != wanted:
        raise DescriptionError(
            "the columns must be time, q:joint …, qd:joint … and perhaps qdd:joint …", path=path, line=1
        )
    with name_file(path, line=1):
        read_joint_names(names)
    table = _read_numbers(rows, len(heading), path)
    times, rest = table[:, 0], table[:, 1:].reshape(len(table), len(kinds), len(names))
    bad = np.flatnonzero(np.diff(times) <= 0.0)
    if bad.size or times[0] != 0.0:
        line = 2 if times[0] != 0.0 else int(bad[0]) + 3
        raise DescriptionError("times must increase, from 0 on", path=path, line=line)
    with name_file(path):
        return connect_samples(times, rest, names)


def _read_numbers(rows: Iterator[list[str]], columns: int, path: str) -> Array:
    """The numbers of a table with at least one row."""
    table = array("d")
    for line, row in enumerate(rows, 2):
        if len(row) != columns:
            raise DescriptionError(f"the row has {len(row)} cells, expected {columns}", path=path, line=line)
        try:
            numbers = [float(cell) for cell in row]
        except ValueError:
            raise DescriptionError(f"the row is not {columns} numbers", path=path, line=line) from None
        if not all(map(isfinite, numbers)):
            raise DescriptionError("the numbers must be finite", path=path, line=line)
        table.extend(numbers)
    if not table:
        raise DescriptionError("the table has no rows", path=path, line=1)
    return np.frombuffer(table).reshape(-1, columns)
