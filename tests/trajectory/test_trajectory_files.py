"""Files of trajectories."""

import numpy as np
import pytest

from cspace.errors import DescriptionError, InputError
from cspace.trajectory import (
    JoinedTrajectory,
    from_csv,
    from_json,
    state_to_state,
    to_csv,
    to_json,
    to_ros,
)

NAMES = ("shoulder", 'the "elbow", bent')


def motion(names=NAMES):
    return state_to_state(
        [0.0, 1.0],
        [1.0, -0.4],
        start_velocity=[0.3, 0.0],
        velocity=1.0,
        acceleration=3.0,
        jerk=20.0,
        joint_names=names,
    )


def test_json_is_the_same_in_every_bit(tmp_path):
    path, one = tmp_path / "a.json", motion()
    to_json(one, path)
    other = from_json(path)
    t = np.linspace(0.0, one.duration, 100)
    for order in range(4):
        assert (other(t, order) == one(t, order)).all()
    assert other.joint_names == NAMES
    assert other.duration == one.duration
    with pytest.raises(InputError, match="use to_csv"):
        to_json(JoinedTrajectory([one]), path)


def test_csv_attains_its_samples(tmp_path):
    path, one = tmp_path / "a.csv", motion()
    to_csv(one, path, rate=200.0)
    other, samples = from_csv(path), one.sample(200.0)
    assert other.joint_names == NAMES
    assert other.duration == one.duration
    assert np.allclose(other(samples.times), samples.q, atol=1e-13)
    assert np.allclose(other(samples.times, 1), samples.qd, atol=1e-11)
    t = np.linspace(0.0, one.duration, 999)
    assert np.allclose(other(t), one(t), atol=1e-6)


def test_ros_points_are_samples(tmp_path):
    yaml = pytest.importorskip("yaml")
    path, one = tmp_path / "a.yaml", motion()
    to_ros(one, path, rate=100.0)
    message, samples = yaml.safe_load(path.read_text("utf-8")), one.sample(100.0)
    assert message["joint_names"] == list(NAMES)
    points = message["points"]
    assert np.array_equal([p["positions"] for p in points], samples.q)
    assert np.array_equal([p["velocities"] for p in points], samples.qd)
    assert np.array_equal([p["accelerations"] for p in points], samples.qdd)
    ticks = [p["time_from_start"]["sec"] * 10**9 + p["time_from_start"]["nanosec"] for p in points]
    assert (np.diff(ticks) > 0).all()
    assert ticks[-1] == round(one.duration * 1e9)
    with pytest.raises(InputError, match="no names of joints"):
        to_ros(motion(None), path, rate=10.0)


def test_bad_files_are_named_with_their_fault(tmp_path):
    path = tmp_path / "bad"
    for text, fault in (
        ("time,q:a\n0,1\n", "columns must be"),
        ("time,q:a,qd:a\n", "no rows"),
        ("time,q:a,qd:a\n0,1,2\n0,1,2\n", "times must increase"),
        ("time,q:a,qd:a\n0,1,x\n", "not 3 numbers"),
        ("time,q:a,qd:a\n0,1,nan\n", "must be finite"),
    ):
        path.write_text(text)
        with pytest.raises(DescriptionError, match=fault):
            from_csv(path)
    for text, fault in (
        ("{", "no JSON"),
        ("[]", "schema is None"),
        ('{"schema": "cspace.trajectory/1"}', "knots"),
    ):
        path.write_text(text)
        with pytest.raises(DescriptionError, match=fault):
            from_json(path)
