"""Mutated logs are read whole or refused with a LogError that names the file: nothing else happens."""

from __future__ import annotations

import gzip
import re
import warnings

import numpy as np
import pytest

from cspace.errors import LogError
from cspace.localization import Log, read_log
from cspace.localization.logs.mrclam import ROBOTS
from localization.mutations import mutate

WORDS = ["nan", "inf", "-inf", "1e400", "1e308", "-1e308", "-1", "0", "99999999999999999999", "1e-320", ""]
WORDS += ["x", "3.5", "#", "\x00", "ODOM", "FLASER", "٣", "1_0", "0x10", "1e9", "-"]


def carmen(name: str) -> str:
    """Odometry and scans of five beams."""
    head = {"FLASER": "FLASER 5", "ROBOTLASER1": "ROBOTLASER1 0 -1.5 3.1 0.7 80 0.01 0 5"}[name]
    poses = "{x} 0 0.1 {x} 0 0.1"
    tail = {"FLASER": poses, "ROBOTLASER1": f"1 7 {poses} 0 0 0 0 0"}[name] + " {t} host {t}"
    lines = ["# log", "PARAM robot_front_laser_max 81.9 0 h 0"]
    for k in range(6):
        lines.append(f"ODOM {0.1 * k} 0 0.1 0.5 0 0 {k} host {k}")
        lines.append(f"{head} 1.0 2.0 3.5 81.9 4 " + tail.format(x=0.1 * k, t=k + 0.5))
    return "\n".join(lines) + "\n"


def corrected() -> str:
    """ODOM lines of time 0 repeat the corrected pose of the scan before."""
    lines = []
    for k in range(6):
        lines.append(f"ODOM {1.3 * k + 1} 0 0 0 0 0 {k} host {k}")
        lines.append(f"FLASER 3 1 2 3 {1.3 * (k + 1)} 0 0 {1.3 * (k + 1)} 0 0 {k} host {k}")
        lines.append(f"ODOM {1.3 * (k + 1)} 0 0 0 0 0 0 host 0")
    return "\n".join(lines) + "\n"


VICTORIA = "".join(
    f"ODOMETRY {k} {k + 1} 1 0 0.1 0.1 0 0 0.1 0 0.1\nLANDMARK {k + 1} {50 + k % 3} 3 -1 0.1 0 0.1\n"
    for k in range(5)
)
TUM = "# t x y z q\n" + "".join(f"{10 + k} {k} 0 0 0 0 0.1 0.99\n" for k in range(6))
KITTI = "".join(f"1 0 0 {k} 0 1 0 0 0 0 1 {2 * k}\n" for k in range(6))
FILES = {
    "flaser": carmen("FLASER"),
    "robotlaser": carmen("ROBOTLASER1"),
    "corrected": corrected(),
    "victoria": VICTORIA,
    "tum": TUM,
    "kitti": KITTI,
}


def read_quietly(path) -> Log | str:
    """The log, or the message with which it was refused; warnings are errors."""
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        try:
            return read_log(path)
        except LogError as error:
            return str(error)


def read_or_refuse(path, folder="") -> Log | None:
    """The log, checked; or None where it was refused by its name."""
    log = read_quietly(path)
    if isinstance(log, str):
        assert (folder or path.name) in log
        assert len(log) < 400
        return None
    for part in (log.odometry, log.scans, log.readings, log.truth):
        if part is not None:
            assert np.isfinite(part.times).all()
            assert (np.diff(part.times) >= 0).all()
    assert np.isfinite(log.odometry.steps).all()
    assert log.truth is None or np.isfinite(log.truth.poses).all()
    return log


@pytest.mark.parametrize("name", FILES)
@pytest.mark.parametrize("seed", range(6))
def test_mutated_files_are_read_whole_or_refused(tmp_path, name, seed):
    rng = np.random.default_rng([seed, len(name)])
    path = tmp_path / "mutated.log"
    path.write_text(FILES[name], encoding="utf-8")
    assert read_or_refuse(path) is not None
    for _ in range(100):
        path.write_text(mutate(FILES[name], WORDS, rng), encoding="utf-8")
        read_or_refuse(path)


@pytest.mark.parametrize("name", FILES)
def test_files_cut_anywhere_hold_the_beginning_or_name_the_cut_line(tmp_path, name):
    """Of a text cut between two lines the rest is a log, which begins as the whole does; of one cut inside of
    a line, that line is named, or its numbers are others."""
    text = FILES[name]
    path = tmp_path / "cut.log"
    path.write_text(text)
    whole, counts = list_rows(read_or_refuse(path)), []
    for size in range(len(text)):
        path.write_text(text[:size])
        log = read_quietly(path)
        line = text.count("\n", 0, size) + 1
        if isinstance(log, str):
            assert path.name in log
            named = re.search(r"cut\.log:(\d+)", log)
            assert text[:size].strip() == "" or name == "corrected" or named is None or int(named[1]) == line
            continue
        rows = list_rows(log)
        cut = int(not text[:size].endswith("\n"))
        for part, found in rows.items():
            clean = max(0, len(found) - cut)
            assert np.array_equal(found[:clean], whole[part][:clean], equal_nan=True)
            assert len(found) <= len(whole[part])
        counts.append(sum(map(len, rows.values())))
    assert len(counts) > text.count("\n") // 2
    assert counts[-1] == sum(map(len, whole.values()))


def list_rows(log: Log | None) -> dict[str, np.ndarray]:
    """The rows of numbers of each part of a log."""
    assert log is not None
    rows = {"steps": log.odometry.steps}
    if log.scans is not None:
        rows["ranges"] = log.scans.ranges
    if log.readings is not None:
        rows["readings"] = np.stack([log.readings.landmark, log.readings.range], axis=1)
    if log.truth is not None:
        rows["truth"] = log.truth.poses
    return rows


@pytest.mark.parametrize("name", FILES)
def test_damaged_gzip_files(tmp_path, name):
    rng = np.random.default_rng(1)
    whole = gzip.compress(FILES[name].encode() * 3, mtime=0)
    path = tmp_path / "log.gz"
    for size in range(1, len(whole) - 1, 5):
        path.write_bytes(whole[:size])
        assert read_or_refuse(path) is None
    for _ in range(200):
        damaged = bytearray(whole)
        damaged[int(rng.integers(10, len(damaged)))] ^= int(rng.integers(1, 256))
        path.write_bytes(bytes(damaged))
        read_or_refuse(path)


MRCLAM = {
    "Barcodes.dat": "".join(f"{subject} {10 * subject}\n" for subject in range(1, 10)),
    "Landmark_Groundtruth.dat": "".join(f"{ROBOTS + k} {k} 1 0.001 0.001\n" for k in range(1, 5)),
    "Robot1_Odometry.dat": "# t v w\n" + "".join(f"{100 + k / 2} 0.1 0.2\n" for k in range(8)),
    "Robot1_Measurement.dat": "".join(f"{100 + k} {10 * (6 + k % 4)} 2.0 0.3\n" for k in range(4)),
    "Robot1_Groundtruth.dat": "".join(f"{100 + k / 4} {k} 0 {0.1 * k}\n" for k in range(20)),
}


@pytest.mark.parametrize(
    ("missing", "part", "is_empty"),
    [
        ("Robot1_Groundtruth.dat", "truth", False),
        ("Robot1_Groundtruth.dat", "truth", True),
        ("Landmark_Groundtruth.dat", "landmarks", False),
    ],
)
def test_folders_without_a_truth_are_read(tmp_path, missing, part, is_empty):
    for each, text in MRCLAM.items():
        (tmp_path / each).write_text(text)
    whole = read_log(tmp_path)
    if is_empty:
        (tmp_path / missing).write_text("# t x y w\n")
    else:
        (tmp_path / missing).unlink()
    log = read_log(tmp_path)
    assert getattr(log, part) is None
    assert any(missing in note for note in log.notes)
    assert not any(missing in note for note in whole.notes)
    assert np.array_equal(log.odometry.steps, whole.odometry.steps)
    assert np.array_equal(log.readings.range, whole.readings.range)
    assert np.array_equal(log.readings.landmark, whole.readings.landmark)


@pytest.mark.parametrize("name", ["Barcodes.dat", "Robot1_Odometry.dat", "Robot1_Measurement.dat"])
def test_folders_without_what_a_log_needs_are_refused(tmp_path, name):
    for each, text in MRCLAM.items():
        if each != name:
            (tmp_path / each).write_text(text)
    with pytest.raises(LogError, match=name):
        read_log(tmp_path)


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("name", MRCLAM)
def test_mutated_folders_are_read_whole_or_refused(tmp_path, name, seed):
    rng = np.random.default_rng(seed)
    for each, text in MRCLAM.items():
        (tmp_path / each).write_text(text)
    path = tmp_path / "Robot1_Odometry.dat"
    assert len(read_log(path).readings) == 4
    for _ in range(100):
        (tmp_path / name).write_text(mutate(MRCLAM[name], WORDS, rng), encoding="utf-8")
        read_or_refuse(path, str(tmp_path))
