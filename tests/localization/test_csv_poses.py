"""Tables of poses: columns by name in any order, read whole or refused with the line."""

from __future__ import annotations

import random

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import cspace as cs
from cspace.errors import InputError, LogError
from cspace.localization import TimedPoses, read_log, read_poses, write_poses
from localization.test_log_fuzz import read_or_refuse

NAMES = {
    "planar": ["time", "x", "y", "theta"],
    "spatial": ["time", "x", "y", "z", "qx", "qy", "qz", "qw"],
}
BAD = ["nan", "inf", "-inf", "1e400", "", "x", "1,5", "--1", '"', "1e19"]
FINE = st.floats(-1e6, 1e6).map(lambda value: value + 0.0)


def table_of(kind, rows):
    """Numbers (n, 4) time, x, y, θ as the columns of a kind."""
    if kind == "planar":
        return np.array(rows)
    t, x, y, theta = np.array(rows).T
    zero = 0 * t
    return np.column_stack([t, x, y, zero, zero, zero, np.sin(theta / 2), np.cos(theta / 2)])


def text_of(names, table, separator=",", order=None, extra=()):
    """A table as text, with its columns in an order, and further columns behind them."""
    order = range(len(names)) if order is None else order
    titles = [*(names[k] for k in order), *extra]
    lines = [[*(repr(float(row[k])) for k in order), *("0.5" for _ in extra)] for row in table]
    return "\n".join(separator.join(words) for words in [titles, *lines]) + "\n"


@st.composite
def tables(draw):
    """A kind, and rows time, x, y, θ with increasing times."""
    kind = draw(st.sampled_from(sorted(NAMES)))
    rows = draw(st.lists(st.tuples(FINE, FINE, FINE, st.floats(-3.1, 3.1)), min_size=1, max_size=8))
    return kind, np.sort(np.array(rows), axis=0)


@settings(deadline=None, derandomize=True)
@given(tables(), st.sampled_from([",", ";", "\t", " ", ", "]), st.randoms(use_true_random=False))
def test_the_order_of_columns_and_what_separates_them_change_nothing(
    tmp_path_factory, given_table, separator, rng
):
    kind, rows = given_table
    names, table = NAMES[kind], table_of(kind, rows)
    order = list(range(len(names)))
    rng.shuffle(order)
    path = tmp_path_factory.mktemp("csv") / "poses.csv"
    path.write_text(text_of(names, table, separator, order, ("speed",)))
    found = read_poses(path)
    assert np.array_equal(found.times, rows[:, 0])
    assert np.array_equal(found.poses[:, :2], rows[:, 1:3])
    assert np.allclose(found.poses[:, 2], rows[:, 3], atol=1e-12)


@settings(deadline=None, derandomize=True)
@given(tables(), st.data())
def test_a_table_with_one_fault_is_refused_with_its_line(tmp_path_factory, given_table, data):
    kind, rows = given_table
    lines = text_of(NAMES[kind], table_of(kind, rows)).splitlines()
    row = data.draw(st.integers(1, len(lines) - 1))
    words = lines[row].split(",")
    place = data.draw(st.integers(0, len(words) - 1))
    fault = data.draw(st.sampled_from([*BAD, None]))
    words = words[:place] + ([] if fault is None else [fault]) + words[place + 1 :]
    lines[row] = ",".join(words)
    path = tmp_path_factory.mktemp("csv") / "poses.csv"
    path.write_text("\n".join(lines))
    for reader in (read_poses, read_log, lambda file: cs.ate(file, file)):
        with pytest.raises(LogError, match=rf"poses\.csv.*{row + 1}") as caught:
            reader(path)
        assert len(str(caught.value)) < 400


@settings(max_examples=200, deadline=None, derandomize=True)
@given(tables(), st.integers(0, 10_000), st.integers(0, 3))
def test_cut_and_shuffled_tables_are_read_whole_or_refused(
    tmp_path_factory, given_table, seed, kind_of_fault
):
    kind, rows = given_table
    rng = random.Random(seed)
    text = text_of(NAMES[kind], table_of(kind, rows))
    lines = text.splitlines()
    if kind_of_fault == 0:
        text = text[: rng.randrange(len(text))]
    elif kind_of_fault == 1:
        rng.shuffle(lines)
        text = "\n".join(lines)
    elif kind_of_fault == 2:
        text = "\n".join([",".join(rng.choices(NAMES["spatial"] + ["v", "yaw [deg]"], k=5)), *lines[1:]])
    else:
        at = rng.randrange(len(text))
        text = text[:at] + rng.choice(',;"\t\n#\0é9') + text[at + 1 :]
    path = tmp_path_factory.mktemp("csv") / "poses.csv"
    path.write_text(text, encoding="utf-8")
    log = read_or_refuse(path)
    assert log is None or np.isfinite(log.truth.poses).all()


@settings(deadline=None, derandomize=True)
@given(tables())
def test_writing_and_reading_are_inverse(tmp_path_factory, given_table):
    _, rows = given_table
    path = tmp_path_factory.mktemp("csv") / "poses.csv"
    write_poses(path, TimedPoses(rows[:, 0], rows[:, 1:]), format="csv")
    found = read_poses(path)
    assert np.array_equal(found.times, rows[:, 0])
    assert np.allclose(found.poses, rows[:, 1:], atol=1e-12)
    rows[:, 0] = np.arange(len(rows))
    write_poses(path, TimedPoses(rows[:, 0], rows[:, 1:]), format="csv")
    assert cs.ate(path, TimedPoses(rows[:, 0], rows[:, 1:]), align=None).max == 0.0


def test_poses_of_space_are_written_and_read(tmp_path):
    T = cs.random_pose(5, rng=1)
    path = tmp_path / "space.csv"

    class Space:
        times, poses = np.arange(5.0), T

    write_poses(path, Space, format="csv")
    assert path.read_text().startswith("time,x,y,z,qx,qy,qz,qw\n")
    errors = cs.ate(path, Space, align=None)
    assert errors.max == 0.0
    assert errors.turn_max < 1e-7
    with pytest.raises(InputError, match="CSV needs"):
        write_poses(path, T, format="csv")


def test_units_and_other_names(tmp_path):
    path = tmp_path / "poses.csv"
    path.write_text(
        '"Stamp (ms)","yaw [deg]","position_x [mm]","ty","note"\n1500,90,2000,3,ok\n2000,-90,0,1,ok\n'
    )
    found = read_poses(path)
    assert found.times.tolist() == [1.5, 2.0]
    assert np.allclose(found.poses, [[2, 3, np.pi / 2], [0, 1, -np.pi / 2]], atol=1e-12)
    log = read_log(path)
    assert log.notes == ("columns left out: note",)
    assert np.allclose(log.odometry.dead_reckoning().poses[-1], [-2, 2, np.pi], atol=1e-9)
    path.write_text("#timestamp [ns],x [m],y [m],theta [rad]\n1403636579763555584,1,2,0\n# end\n")
    assert read_poses(path).times == pytest.approx([1403636579.763555584])


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("time,x,theta\n1,2,3\n", "no y; the columns must be time, x, y and theta"),
        ("x,y,theta\n1,2,3\n", "no time"),
        ("time,x,y,qx,qy,qz\n1,2,3,0,0,0\n", "no qw"),
        ("time,x,y,z,qx,qy,qz,qw\n1,2,3,0,0,0,0,0\n", "quaternion is zero"),
        ("time,x,y,theta\n", "no rows"),
        ("time,t,x,y,theta\n1,1,2,3,0\n", "'time' and 't' both name time"),
        ("time,x,y,theta [grad]\n1,2,3,0\n", "theta is in 'grad'; units: rad, deg"),
        ("time,x,y,theta\n2,0,0,0\n1,0,0,0\n", ":3: .*backwards"),
        ("time;x;y;theta\n1,5;0;0;0\n", ":2: '1,5' is no number"),
        ('time,x,y,theta\n1,2,"3,0\n', "quotes"),
        ("1,2,3,4\n", "a table needs a heading"),
        ("time,q:elbow,qd:elbow\n0,1,2\n", "no x and no y"),
    ],
)
def test_wrong_tables_are_named(tmp_path, text, words):
    path = tmp_path / "poses.csv"
    path.write_text(text)
    with pytest.raises(LogError, match=words):
        read_log(path)


def test_a_cell_that_is_too_long_is_named(tmp_path):
    path = tmp_path / "poses.csv"
    path.write_text(f"time,x,y,theta\n0,{'1' * 200_000},0,0\n")
    with pytest.raises(LogError, match="a cell has more than"):
        read_poses(path)


@pytest.mark.parametrize("format", ["tum", "kitti", "csv"])
def test_what_could_not_be_read_is_not_written(format, tmp_path):
    path = tmp_path / "poses.txt"
    for times, rows in ((np.zeros(0), np.zeros((0, 3))), (np.arange(2.0), [[0, 0, 0], [1e19, 0, 0]])):
        with pytest.raises(InputError, match=r"no poses to write|the largest allowed value"):
            write_poses(path, TimedPoses(times, rows), format=format)
    assert not path.exists()
