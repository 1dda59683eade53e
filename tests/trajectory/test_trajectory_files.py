"""Files of trajectories."""

import json

import numpy as np
import pytest

import cspace as cs
from cspace.errors import DescriptionError
from cspace.trajectory import (
    from_csv,
    from_json,
    state_to_state,
    to_csv,
    to_json,
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


def timed_motions():
    """Motions of every kind, their ends and stops among them."""
    rng = np.random.default_rng(3)
    robot = cs.load_robot("ur5e")
    ways = [rng.normal(size=(5, 6)), np.linspace(0, 1, 4)[:, None] + rng.normal(size=(4, 6)) * 0.1]
    for way in ways:
        for path in (cs.spline(way), cs.blend(way, 0.05), cs.blend(way, 0.0)):
            options = {"velocity": 1.0, "acceleration": 5.0}
            yield cs.time_parametrize(path, **options)
            yield cs.time_parametrize(path, jerk=50.0, **options)
    yield cs.time_parametrize(cs.spline(ways[0]), acceleration=5.0, start_speed=0.1)
    q = np.array([0.3, -1.2, 1.5, -0.8, -1.3, 0.2])
    limits = {"velocity": 2.0, "acceleration": 8.0}
    line = robot.move_linear(robot.fk(q) @ cs.pose((0.1, 0.05, 0)), start=q, **limits)
    yield line
    yield robot.move_linear(robot.fk(q), start=q, **limits)  # of zero length
    yield robot.move_linear(cs.pose((3, 0, 0)), start=q, **limits)  # none
    yield line.then(line.reversed().scaled(2.0)).then(robot.move_to(q + 0.1, start=q, jerk=80.0, **limits))
    yield cs.time_parametrize(cs.spline(ways[0]), jerk=50.0, acceleration=5.0).scaled(3.0).reversed()


def test_motions_of_every_kind_are_the_same_in_every_bit(tmp_path):
    path, again = tmp_path / "a.json", tmp_path / "b.json"
    for one in timed_motions():
        to_json(one, path)
        other = from_json(path)
        t = np.linspace(0.0, one.duration, 200)
        for order in range(4):
            assert (other(t, order) == one(t, order)).all()
        assert (other.joint_names, other.duration) == (one.joint_names, one.duration)
        assert (other.reason, other.continuity) == (one.reason, one.continuity)
        assert (other.knots == one.knots).all()
        assert other.scaled(2.0).duration == one.scaled(2.0).duration
        to_json(other, again)
        assert again.read_text() == path.read_text()


def test_a_changed_file_is_refused_or_makes_a_motion_of_finite_numbers(tmp_path):
    """Any number, list or key of a file may be lost or changed: no other error, and no NaN."""
    rng, path = np.random.default_rng(0), tmp_path / "a.json"
    wrong = (None, -1, 0, 2, 1e300, "x", [], [1.0], {}, True, float("nan"), 10**400)
    texts = []
    for one in (
        cs.time_parametrize(cs.spline([[0.0, 1], [1, 0], [2, 1]]), acceleration=1.0, grid=6),
        cs.time_parametrize(cs.spline([[0.0, 1], [1, 0], [2, 1]]), acceleration=1.0, tolerance=0.1),
        cs.time_parametrize(cs.spline([[0.0, 1], [1, 0], [2, 1]]), acceleration=1.0, jerk=9.0, grid=20),
        motion().then(motion().reversed()),
    ):
        to_json(one, path)
        texts.append(path.read_text())
    refused = 0
    for _ in range(600):
        values = json.loads(texts[rng.integers(len(texts))])
        at = values
        while True:  # a random place of the tree
            keys = list(at) if isinstance(at, dict) else list(range(len(at)))
            key = keys[rng.integers(len(keys))]
            if not isinstance(at[key], dict | list) or not at[key] or rng.random() < 0.2:
                break
            at = at[key]
        if rng.random() < 0.3:
            del at[key]
        else:
            at[key] = wrong[rng.integers(len(wrong))]
        path.write_text(json.dumps(values))
        try:
            with np.errstate(all="ignore"):
                other = from_json(path)
                found = other(np.linspace(0.0, other.duration, 20), 1)
        except DescriptionError:
            refused += 1
            continue
        assert np.isfinite(other.duration)
        assert np.isfinite(found).all()
    assert refused > 200


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
        ('{"schema": "cspace.trajectory/1"}', "kind"),
        ('{"schema": "cspace.trajectory/1", "kind": "polynomials"}', "knots"),
    ):
        path.write_text(text)
        with pytest.raises(DescriptionError, match=fault):
            from_json(path)


def test_a_table_cut_anywhere_between_its_cells_is_refused_or_ends_earlier(tmp_path):
    path, one = tmp_path / "a.csv", motion()
    to_csv(one, path, rate=20.0)
    whole = path.read_text("utf-8")
    ends = [k for k, letter in enumerate(whole) if letter in ",\n"]
    for end in ends:
        path.write_text(whole[:end], "utf-8")
        try:
            found = from_csv(path)
        except DescriptionError:
            continue
        assert whole[end] == "\n"
        assert np.abs(found(found.duration) - one(found.duration)).max() < 1e-9


@pytest.mark.parametrize("text", ["time,q:a,qd:a\n0,0,0\n1,2\n", "x" * 200_000])
def test_tables_of_other_shapes_are_refused(tmp_path, text):
    path = tmp_path / "a.csv"
    path.write_bytes(text.encode())
    with pytest.raises(DescriptionError, match=r"a\.csv"):
        from_csv(path)


def test_samples_read_back_exceed_accelerations_by_a_share_of_the_jerk_as_documented(tmp_path):
    robot = cs.load_robot("panda")
    limits, rng, file = robot.limits, np.random.default_rng(0), tmp_path / "motion.csv"
    q = np.array([0.0, -0.7, 0.0, -2.0, 0.0, 1.5, 0.7])
    shares = []
    for rate in (100.0, 250.0, 1000.0):
        for _ in range(5):
            to_csv(robot.move_to(q + rng.uniform(-0.4, 0.4, 7), start=q), file, rate=rate)
            found = from_csv(file).extremes(2)
            excess = np.maximum(found.highest, -found.lowest) - limits.acceleration
            shares.append(float((excess / (limits.jerk / rate)).max()))
    assert 0.0 < max(shares) < 0.05
