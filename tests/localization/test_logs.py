"""Readers of logs: what they read, what they mend, and how they name what is wrong."""

from __future__ import annotations

import gzip

import numpy as np
import pytest

import cspace as cs
from cspace.errors import InputError, LogError
from cspace.localization import Landmarks, Log, Odometry, Readings, read_log
from cspace.localization.logs.lines import mend_clock
from data import shared_data


def write(folder, text, name="log.txt"):
    path = folder / name
    path.write_text(text, encoding="utf-8")
    return path


FLASER = "FLASER 3 1.0 2.0 81.9 {x} 0 0 {x} 0 0 {t} host {t}\n"
ODOM = "ODOM {x} 0 0 0 0 0 {t} host {t}\n"


def test_a_raw_log_of_carmen(tmp_path):
    text = "".join(ODOM.format(x=k, t=10 + k) + FLASER.format(x=k, t=10 + k + 0.5) for k in range(4))
    log = read_log(write(tmp_path, "# comment\nPARAM a 1 0 nohost 0\n" + text))
    assert log.truth is None
    np.testing.assert_allclose(log.odometry.increments, [[1.0, 0.0, 0.0]] * 3)
    np.testing.assert_allclose(log.scans.times, [0.5, 1.5, 2.5, 3.5])
    np.testing.assert_allclose(log.scans.angles, np.radians([-90.0, -30.0, 30.0]))
    assert log.scans.returns.tolist() == [[True, True, False]] * 4
    kinds = [kind for _, kind, _ in log.events()]
    assert kinds == ["odometry", "scans"] * 4


def test_raw_increments_of_a_corrected_log_are_chained(tmp_path):
    """The frame jumps by 0.3 m with each correction; the raw odometry goes 1 m per step."""
    lines, x = [], 0.0
    for k in range(5):
        lines.append(ODOM.format(x=x + 1.0, t=k + 1))
        x += 1.3
        lines += [FLASER.format(x=x, t=k + 1), ODOM.format(x=x, t=0)]
    log = read_log(write(tmp_path, "".join(lines)))
    np.testing.assert_allclose(log.odometry.increments[:, 0], 1.0)
    np.testing.assert_allclose(log.truth.poses[:, 0], 1.3 * np.arange(1, 6))
    assert any("corrected" in note for note in log.notes)


@pytest.mark.parametrize("stamp", ["0", "1.13486e+09"])
def test_logs_without_times_keep_their_order(tmp_path, stamp):
    """The same log with times and with times that were lost or printed with six digits: all but the clock is
    the same, and each scan belongs to the odometry before it."""
    texts = []
    for timed in (True, False):
        lines, x, t = [], 0.0, 0.0
        for k in range(7):
            for _ in range(1 + k % 3):
                x, t = x + 1.0, t + 0.1
                lines.append(ODOM.format(x=x, t=round(t, 6) if timed else stamp))
            x += 0.3
            time = round(t, 6) if timed else stamp
            lines += [FLASER.format(x=x, t=time), ODOM.format(x=x, t="0 "), "NEFF 50.0\n"]
        texts.append("".join(lines))
    timed, counted = (read_log(write(tmp_path, text)) for text in texts)
    np.testing.assert_allclose(counted.odometry.increments, timed.odometry.increments, atol=1e-12)
    np.testing.assert_allclose(counted.truth.poses, timed.truth.poses)
    np.testing.assert_allclose(counted.odometry.times, timed.odometry.times, atol=1e-9)
    np.testing.assert_allclose(counted.scans.times, timed.scans.times, atol=1e-9)
    assert any("counted" in note for note in counted.notes)
    assert not any("counted" in note for note in timed.notes)


def test_scans_without_odometry_move_as_corrected(tmp_path):
    """Two scans in a row: what lies between them is known from the corrected poses alone."""
    lines = []
    for x in (1.0, 2.5, 4.5):
        lines += [FLASER.format(x=x, t=0), ODOM.format(x=x, t=x * 7), "NEFF 50.0\n"]
    log = read_log(write(tmp_path, ODOM.format(x=0.8, t=0) + "".join(lines)))
    np.testing.assert_allclose(log.odometry.increments[:, 0], [1.5, 2.0])
    assert (np.diff(log.scans.times) > 0).all()
    assert any("2 corrected poses" in note for note in log.notes)


def test_robotlaser_has_its_angles(tmp_path):
    head = "ROBOTLASER1 0 -1.5 3.0 0.5 40.0 0.01 0 3 1.0 2.0 3.0 1 7.0"
    log = read_log(write(tmp_path, head + " 1.1 0 0 1.0 0 0 0 0 0 0 0 5.0 host 5.0\n"))
    np.testing.assert_allclose(log.scans.angles, [-1.5, -1.0, -0.5])
    assert log.scans.most == 40.0
    np.testing.assert_allclose(log.scans.T_base_laser[:2, 2], [0.1, 0.0])


@pytest.mark.parametrize(("count", "step", "half"), [(180, 1.0, 90), (181, 1.0, 90), (360, 0.5, 90),
                                                     (361, 0.5, 90), (401, 0.25, 50)])  # fmt: skip
def test_the_modes_of_a_sick_laser(tmp_path, count, step, half):
    """Steps of a degree, a half and a quarter, whether the scan has its last beam or not."""
    ranges = " ".join(["1.5"] * count)
    log = read_log(write(tmp_path, f"FLASER {count} {ranges} 0 0 0 0 0 0 1 host 1\n" * 2))
    np.testing.assert_allclose(np.degrees(log.scans.angles), -half + step * np.arange(count), atol=1e-9)


def test_ranges_below_zero_are_no_returns(tmp_path):
    """Drivers print −1 or 0 for nothing; what exceeds a float is beyond every range."""
    log = read_log(write(tmp_path, "FLASER 5 -1 0 nan 1e60 2.0 0 0 0 0 0 0 1 host 1\n"))
    assert log.scans.returns.tolist() == [[False, False, False, False, True]]
    assert any("2 ranges are not above zero" in note for note in log.notes)


def test_a_clock_is_mended_with_the_fewest_changes():
    times = np.array([0.0, 1.0, 9.0, 2.0, 3.0, 2.5, 4.0])
    mended, notes = mend_clock(times)
    assert (np.diff(mended) >= 0).all()
    assert len(notes) == 1
    assert (mended != times).sum() == 2
    same, none = mend_clock(np.arange(5.0))
    assert none == []
    assert (same == np.arange(5.0)).all()


def test_mrclam_names_landmarks_by_their_barcodes():
    log = cs.read_log(shared_data() / "localization/mrclam6", robot=3)
    assert set(np.unique(log.readings.landmark)) <= set(log.landmarks.names.tolist())
    assert log.readings.landmark.min() > 5
    assert any("other robots" in note for note in log.notes)
    same = cs.read_log(shared_data() / "localization/mrclam6/Robot3_Odometry.dat.gz")
    np.testing.assert_array_equal(same.odometry.steps, log.odometry.steps)


def test_victoria_park_is_read_whole():
    log = read_log(shared_data() / "localization/victoria/victoria_park.txt")
    assert len(log.odometry) == 6968
    assert len(log.readings) == 3640
    assert log.readings.range[0] == pytest.approx(np.hypot(11.5387, -3.2007))


@pytest.mark.parametrize(("name", "scans"), [("intel", 910), ("freiburg-079", 4791)])
def test_real_logs_of_carmen(name, scans):
    log = read_log(shared_data() / f"localization/carmen/{name}-corrected.log.gz")
    assert len(log.scans) == len(log.truth) == scans
    assert (np.diff(log.odometry.times) >= 0).all()
    missing = 1.0 - log.scans.returns.mean()
    assert 0.005 < missing < 0.05


def test_a_trajectory_of_tum(tmp_path):
    half = np.sqrt(0.5)
    log = read_log(write(tmp_path, f"# t\n5 1 2 0 0 0 0 1\n6 1 3 0 0 0 {half} {half}\n"))
    np.testing.assert_allclose(log.truth.poses, [[1, 2, 0], [1, 3, np.pi / 2]], atol=1e-12)
    assert log.truth.times.tolist() == [0.0, 1.0]
    assert log.notes == ()


@pytest.mark.parametrize(
    ("text", "part"),
    [
        ("", "no lines"),
        ("hello world\n", "begins no log"),
        ("VERTEX_SE2 0 0 0 0\n", "pose graph"),
        ("ODOM 0 0 0 0 0 0 1 h 1\nWHAT 1 2\n", ":2: no message 'WHAT'"),
        ("ODOM 0 0 0\n", ":1: ODOM has 3 values"),
        ("ODOM 0 nan 0 0 0 0 1 h 1\n", "must be finite"),
        ("ODOM 0 x 0 0 0 0 1 h 1\n", "'x' is no number"),
        ("FLASER 3 1 2 3 0 0 0\n", "the line is cut"),
        ("FLASER 3.5 1 2 3 0 0 0 0 0 0 1 h 1\n", "must be a whole number"),
        ("PARAM robot_front_laser_max 0 0 h 0\n", "must be above zero"),
        (ODOM.format(x=0, t=1) + "ODOM 0 0 0 0 0 0 2\n", ":2: ODOM has 7 values"),
        (ODOM.format(x=0, t="1e300"), "must not exceed 1e+18"),
        ("ODOMETRY 0 1.5 1 0 0 1 0 0 1 0 1\n", "an id must be a whole number"),
        (FLASER.format(x=0, t=1) + "FLASER 2 1 2 0 0 0 0 0 0 2 h 2\n", ":2: the scan has 2 beams"),
        ("ODOMETRY 0 1 1 0 0\n", "5 values; 11 expected"),
        ("ODOMETRY 0 1 1 0 0 1 0 0 1 0 1\nODOMETRY 7 8 1 0 0 1 0 0 1 0 1\n", ":2: pose 7"),
        ("1 0 0 0 0 0 0 0\n", "quaternion is zero"),
        ("2 0 0 0 0 0 0 1\n1 0 0 0 0 0 0 1\n", ":2: the time runs backwards"),
        ("2 0 0 0 0 0 0 1\n1 0 0 0\n", ":2: the line has 4 columns"),
    ],
)
def test_a_bad_file_is_named_with_its_line(tmp_path, text, part):
    with pytest.raises(LogError) as error:
        read_log(write(tmp_path, text))
    assert part in str(error.value)
    assert "log.txt" in str(error.value)


def test_a_file_that_is_cut_in_the_middle_is_named(tmp_path):
    whole = gzip.compress(ODOM.format(x=0, t=1).encode() * 1000)
    (tmp_path / "log.gz").write_bytes(whole[: len(whole) // 2])
    with pytest.raises(LogError, match="damaged or cut"):
        read_log(tmp_path / "log.gz")


@pytest.mark.parametrize(
    ("call", "part"),
    [
        (lambda: Readings([0.0], [1], [np.nan], [np.nan]), "neither range nor bearing"),
        (lambda: Readings([0.0], [1], [-1.0], [0.0]), "range is -1"),
        (lambda: Readings([0.0, 1.0], [1, 1], [1.0, 1.0], [45.0, 90.0]), "np.radians"),
        (lambda: Readings([1.0, 0.0], [1, 1], [1.0, 1.0], [0.0, 0.0]), "runs backwards"),
        (lambda: Landmarks([1, 1], [[0.0, 0.0], [1.0, 1.0]]), "landmark 1 is there twice"),
        (lambda: Landmarks([-1], [[0.0, 0.0]]), "whole numbers from 0"),
        (lambda: Landmarks([2], [[0.0, 0.0]]).rows_of([3]), "landmark 3 is read but not on the map"),
    ],
)
def test_bad_arrays_are_named(call, part):
    with pytest.raises(InputError) as error:
        call()
    assert part in str(error.value)


def test_a_log_shows_what_it_holds():
    assert "1 step" in repr(Log(Odometry([0.0, 1.0], [[1.0, 0.0, 0.0]])))


def test_one_scan_of_many_and_where_its_beams_ended():
    """Points of a scan in base: the laser turned by a quarter and moved, one beam without return."""
    scans = cs.localization.Scans(
        times=[0.0, 1.0],
        ranges=[[1.0, 2.0, 3.0], [np.nan, 2.0, 90.0]],
        angles=[0.0, np.pi / 2, np.pi],
        T_base_laser=cs.pose_2d(xytheta=[0.5, 0.0, np.pi / 2]),
    )
    one = scans[-1]
    assert len(one) == 1
    assert one.times[0] == 1.0
    np.testing.assert_allclose(one.points(), [[-1.5, 0.0]], atol=1e-12)
    np.testing.assert_allclose(scans.points(0), [[0.5, 1.0], [-1.5, 0.0], [0.5, -3.0]], atol=1e-12)
    with pytest.raises(IndexError):
        scans[2]
