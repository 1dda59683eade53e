"""JointTrajectory messages: written, read back, and read as ROS writes them."""

from __future__ import annotations

import json
import sys

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import cspace as cs
from cspace.errors import DescriptionError, InputError, MissingExtraError
from cspace.trajectory import from_ros, state_to_state, to_csv, to_ros
from cspace.trajectory.message_yaml import read_documents
from localization.mutations import mutate
from localization.test_log_fuzz import WORDS

NAMES = ("shoulder", 'the "elbow", bent')


def motion(seed=0, names=NAMES):
    rng = np.random.default_rng(seed)
    return state_to_state(
        rng.normal(size=2),
        rng.normal(size=2),
        start_velocity=rng.uniform(-0.9, 0.9, 2),
        velocity=1.0,
        acceleration=3.0,
        jerk=20.0,
        joint_names=names,
    )


def message_of(trajectory, times):
    """What ROS has of a trajectory at times in nanoseconds."""
    states = [trajectory(times / 1e9, order).tolist() for order in range(3)]
    stamps = [{"sec": int(t) // 10**9, "nanosec": int(t) % 10**9} for t in times]
    keys = ("positions", "velocities", "accelerations", "effort", "time_from_start")
    points = [
        dict(zip(keys, (*row, [], stamp), strict=True)) for *row, stamp in zip(*states, stamps, strict=True)
    ]
    header = {"stamp": {"sec": 0, "nanosec": 0}, "frame_id": ""}
    return {"header": header, "joint_names": list(trajectory.joint_names), "points": points}


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
        to_ros(motion(names=None), path, rate=10.0)


@pytest.mark.slow
@pytest.mark.parametrize("rate", [3.0, 100.0, 1000.0])
@pytest.mark.parametrize("seed", range(4))
def test_reading_is_the_inverse_of_writing(tmp_path, seed, rate):
    """The points are those written, to the nanosecond of their times; written again the file is the same."""
    path, again, one = tmp_path / "a.yaml", tmp_path / "b.yaml", motion(seed)
    to_ros(one, path, rate=rate)
    other, samples = from_ros(path), one.sample(rate)
    assert other.joint_names == NAMES
    assert other.duration == round(one.duration * 1e9) / 1e9
    knots = np.rint(samples.times * 1e9) / 1e9
    assert np.isin(knots, other.knots).all()
    for order, values in enumerate((samples.q, samples.qd, samples.qdd)):
        assert np.allclose(other(knots, order), values, rtol=0, atol=1e-15 * 20**order)
    to_ros(other, again, rate=rate)
    third = from_ros(again)
    assert np.allclose(third(knots[:-1]), samples.q[:-1], atol=1e-8)
    t = np.linspace(0.0, other.duration, 500)
    assert rate < 50 or np.allclose(other(t), one(np.minimum(t, one.duration)), atol=1e-6)


@pytest.mark.parametrize("style", [None, True, False])
@pytest.mark.parametrize("outer", [(), ("trajectory",), ("goal", "trajectory")])
def test_messages_as_ros_writes_them(tmp_path, style, outer):
    """In blocks, in brackets, folded at the margin; within goals; several forms of time are the same."""
    yaml = pytest.importorskip("yaml")
    one, path = motion(3), tmp_path / "echo.yaml"
    times = np.arange(0, round(one.duration * 1e9), 10**8)
    to_ros(one, path, rate=10.0)
    message = message_of(one, times)
    forms = [lambda t: t, lambda t: {"secs": t["sec"], "nsecs": t["nanosec"]}]
    forms.append(lambda t: t["sec"] + t["nanosec"] / 1e9)
    for form in forms:
        points = [point | {"time_from_start": form(point["time_from_start"])} for point in message["points"]]
        value = message | {"points": points}
        for field in reversed(outer):
            value = {field: value}
        path.write_text(yaml.safe_dump(value, default_flow_style=style) + "---\n")
        found = from_ros(path)
        assert np.abs(found.knots[:, None] - times / 1e9).min(axis=0).max() < 1e-15
        assert np.allclose(found(times / 1e9), one(times / 1e9), atol=1e-14)
    path.write_text(json.dumps(message))
    assert np.isin(times / 1e9, from_ros(path).knots).all()


@pytest.mark.parametrize(("kinds", "error"), [(3, 1e-6), (2, 1e-4), (1, 1e-2)])
def test_points_without_higher_derivatives(tmp_path, kinds, error):
    one, path = motion(5), tmp_path / "a.yaml"
    message = message_of(one, np.arange(0, round(one.duration * 1e9), 10**7))
    for point in message["points"]:
        for kind in ("velocities", "accelerations")[kinds - 1 :]:
            point[kind] = []
    path.write_text(json.dumps(message))
    found = from_ros(path)
    t = np.linspace(0, found.duration, 777)
    assert np.abs(found(t) - one(t)).max() < error


@pytest.mark.parametrize("text", ["1e-5", "1E5", "-2.e+3", "2.5e-300", "1.0e+2", "-0.0", "7"])
def test_numbers_of_any_spelling(text):
    assert read_documents(f"[{text}, a{text}]", "a.yaml") == [[float(text), f"a{text}"]]


@settings(deadline=None, derandomize=True)
@given(st.text("ab:,[]{}'\"-#|\n \t0.&e", max_size=60))
def test_any_text_is_read_or_refused(text):
    try:
        read_documents(text, "any.yaml")
    except DescriptionError as error:
        message = str(error)
    else:
        message = "any.yaml"
    assert "any.yaml" in message


def read_or_refuse(path):
    """Velocities, or the message with which the file was refused."""
    try:
        with np.errstate(all="ignore"):
            found = from_ros(path)
            return found(np.linspace(0, found.duration, 9), 1)
    except DescriptionError as error:
        return str(error)


@pytest.mark.parametrize("style", [None, True, False])
@pytest.mark.parametrize("seed", range(4))
def test_mutated_messages_are_read_whole_or_refused(tmp_path, seed, style):
    yaml = pytest.importorskip("yaml")
    rng, path = np.random.default_rng(seed), tmp_path / "a.yaml"
    whole = yaml.safe_dump(message_of(motion(seed), np.arange(0, 8 * 10**8, 10**8)), default_flow_style=style)
    refused = 0
    for _ in range(150):
        path.write_text(mutate(whole, WORDS, rng), encoding="utf-8")
        found = read_or_refuse(path)
        refused += isinstance(found, str)
        assert "a.yaml" in found if isinstance(found, str) else np.isfinite(found).all()
    assert refused > 50


POINT = "- {positions: [1], velocities: [0], time_from_start: {sec: 0}}\n"


@pytest.mark.parametrize(
    ("text", "fault"),
    [
        ("", "0 messages"),
        (f"joint_names: [a]\npoints:\n{POINT}---\njoint_names: [a]\npoints:\n{POINT}", "2 messages"),
        ("image: map.pgm\n", "no field points"),
        (f"joint_names: []\npoints:\n{POINT}", "joint_names must be"),
        (f"joint_names: [1]\npoints:\n{POINT}", "quote those that are numbers"),
        ("joint_names: [a]\npoints: []\n", "no points"),
        (f"joint_names: [a, b]\npoints:\n{POINT}", "positions of point 0: 1; expected 2"),
        (f"joint_names: [a]\npoints:\n{POINT}{POINT}", "point 1 does not increase"),
        (
            f"joint_names: [a]\npoints:\n{POINT.replace('sec: 0', 'sec: 1')}",
            "begin with the point of the time 0",
        ),
        (f"joint_names: [a]\npoints:\n{POINT.replace('sec: 0', 'hour: 0')}", "must be sec and nanosec"),
        (
            f"joint_names: [a]\npoints:\n{POINT.replace('[0]', '[.nan]')}",
            "velocities of point 0 must be finite",
        ),
        (
            f"joint_names: [a]\npoints:\n{POINT.replace('[0]', '[fast]')}",
            "velocities of point 0 must be finite",
        ),
        (f"joint_names: [a]\npoints:\n{POINT.replace('velocities', 'accelerations')}", "need velocities"),
        (f"joint_names: [a, a]\npoints:\n{POINT}", "joint_names contains .a. twice"),
        (f"joint_names: [a\npoints:\n{POINT}", r"yaml:\d: the file is no YAML"),
        (f"joint_names: [a]\n  points:\n{POINT}", r"yaml:2: the file is no YAML"),
        (f"joint_names: !!python/object:os.system [a]\npoints:\n{POINT}", r"yaml:1: the file is no YAML"),
        ("[" * 100_000, "the file is no YAML|depth"),
    ],
)
def test_bad_messages_are_named(tmp_path, text, fault):
    path = tmp_path / "bad.yaml"
    path.write_text(text)
    with pytest.raises(DescriptionError, match=fault):
        from_ros(path)


def test_without_the_extra_its_name_is_said(tmp_path, monkeypatch):
    path = tmp_path / "a.yaml"
    to_ros(motion(), path, rate=10.0)
    monkeypatch.setitem(sys.modules, "yaml", None)
    with pytest.raises(MissingExtraError, match=r"cspace\[ros\]"):
        from_ros(path)


HOSTILE = {
    "refers to itself": "&a {goal: *a}",
    "refers to itself twice": "&a {goal: {trajectory: *a}}",
    "large": "joint_names: [a]\npoints: [{positions: [1" + 400 * "0" + "], time_from_start: 0}]",
    "large time": "joint_names: [a]\npoints: [{positions: [1], time_from_start: {sec: 1" + 400 * "0" + "}}]",
    "misspelt time": "joint_names: [a]\npoints: [{positions: [1], time_from_start: {sec: 0, nanosecs: 5}}]",
    "nested": "\n".join(
        ["a0: &a0 [x, x, x, x, x, x, x, x, x]"]
        + [f"a{k}: &a{k} [{', '.join(9 * [f'*a{k - 1}'])}]" for k in range(1, 10)]
        + ["joint_names: [a]", "points: [{positions: {x: *a9}, time_from_start: 0}]"]
    ),
    **{
        tag: f"joint_names: [a]\npoints: [{{positions: [!!{tag} 'x'], time_from_start: 0}}]"
        for tag in ("int", "float", "bool", "timestamp", "binary")
    },
}


@pytest.mark.parametrize("kind", HOSTILE)
def test_hostile_messages_are_refused(kind, tmp_path):
    pytest.importorskip("yaml")
    path = tmp_path / "hostile.yaml"
    path.write_text(HOSTILE[kind], encoding="utf-8")
    with pytest.raises(DescriptionError, match=r"hostile\.yaml"):
        from_ros(path)


def test_a_motion_that_was_not_found_is_not_written(tmp_path):
    robot = cs.load_robot("panda")
    start = np.array(robot.named_poses["ready"])
    failed = robot.move_to(start + 9.0 * np.eye(7)[0], start=start)
    assert not failed
    for write in (to_ros, to_csv):
        with pytest.raises(InputError, match="not written"):
            write(failed, tmp_path / "motion", rate=100.0)
    assert not list(tmp_path.iterdir())


def test_joints_in_another_order_are_refused():
    one = motion()
    other = state_to_state(
        one(one.duration), [0.0, 0.0], velocity=1.0, acceleration=1.0, joint_names=NAMES[::-1]
    )
    with pytest.raises(InputError, match="one order"):
        one.then(other, order=0)
    robot = cs.load_robot("planar_2r")
    names = robot.joint_names[::-1]
    turned = state_to_state([0.0, 0.0], [0.1, 0.2], velocity=1.0, acceleration=1.0, joint_names=names)
    with pytest.raises(InputError, match="one order"):
        turned.check(robot)
