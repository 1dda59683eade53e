"""Inputs that no motion can be made of: each is refused with an error that names it."""

from __future__ import annotations

import json
import warnings

import numpy as np
import pytest

import cspace as cs
from cspace.errors import DescriptionError, InputError, InputTypeError, UnknownNameError
from cspace.trajectory import (
    PolynomialTrajectory,
    arc_path,
    b_spline,
    from_csv,
    from_json,
    from_ros,
    line_path,
    pose_path,
    screw_path,
    state_to_state,
    time_parametrize,
    to_json,
)

PANDA = cs.load_robot("panda")
READY = PANDA.named_poses["ready"]
W = np.array([[0.0, 0.0], [1.0, 2.0], [3.0, 1.0], [4.0, 4.0]])
LIMITS = {"velocity": 1.0, "acceleration": 1.0}
ENDS = [[0.0, 0.0], [1.0, 1.0]]


@pytest.fixture(autouse=True)
def strict():
    """No warning of numpy instead of an error."""
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        yield


def masked(values):
    """An array with a masked entry."""
    array = np.ma.array(values, dtype=float)
    array[(0,) * array.ndim] = np.ma.masked
    return array


@pytest.mark.parametrize(
    "call",
    [
        lambda m: cs.spline(m(W)),
        lambda m: b_spline(m(W)),
        lambda m: cs.blend(W, m(np.ones(4))),
        lambda m: cs.blend(W, np.ma.masked),
        lambda m: cs.spline([m(row) for row in W]),
        lambda m: state_to_state(m(W[0]), W[1], jerk=1.0, **LIMITS),
        lambda m: state_to_state(W[0], W[1], velocity=m(np.ones(2)), acceleration=1.0, jerk=1.0),
        lambda m: time_parametrize(cs.spline(W), velocity=m(np.ones(2)), acceleration=1.0),
        lambda m: cs.spline(W)(m(np.ones(3))),
        lambda m: PANDA.move_to(m(READY), start=READY),
        lambda m: PANDA.move_to(READY, start=m(READY)),
        lambda m: PANDA.fk(m(READY)),
        lambda m: PANDA.ik(m(PANDA.fk(READY))),
        lambda m: line_path(m(np.eye(4)), np.eye(4)),
        lambda m: cs.move(PANDA, m(READY), READY),
        lambda m: cs.OccupancyGrid(m(np.zeros((3, 3)))),
    ],
)
def test_masked_entries_are_refused(call):
    with pytest.raises(InputError, match="masked entry"):
        call(masked)


def test_masked_arrays_without_masked_entries_are_read():
    assert np.array_equal(PANDA.fk(np.ma.array(READY)), PANDA.fk(READY))


@pytest.mark.parametrize(
    ("names", "fault"),
    [
        (["a", "a"], "'a' twice"),
        (["a", ""], "is empty"),
        (["a", "\ud800"], "half of a character"),
        (["a"], "has 1 names"),
        (["a", 2], "must be a string"),
        ("ab", "list of texts"),
    ],
)
def test_names_of_joints(names, fault, tmp_path):
    makers = [
        lambda: state_to_state(*ENDS, **LIMITS, joint_names=names),
        lambda: PolynomialTrajectory([0.0, 1.0], np.zeros((2, 1, 2)), joint_names=names),
        lambda: cs.Robot.from_dh(np.eye(2, 4), convention="standard", joint_names=names),
        lambda: cs.Robot.from_screws(np.eye(3)[:2], np.zeros((2, 3)), np.eye(4), joint_names=names),
    ]
    for make in makers:
        with pytest.raises((InputError, InputTypeError), match=fault):
            make()
    path = tmp_path / "motion.json"
    to_json(state_to_state(*ENDS, **LIMITS, joint_names=["a", "b"]), path)
    path.write_text(json.dumps({**json.loads(path.read_text()), "joint_names": names}))
    with pytest.raises(DescriptionError, match=fault):
        from_json(path)


@pytest.mark.parametrize(("names", "fault"), [(["a", "a"], "'a' twice"), (["", "b"], "is empty")])
def test_names_of_joints_in_files(names, fault, tmp_path):
    table, message = tmp_path / "motion.csv", tmp_path / "motion.yaml"
    heading = ["time", *(f"{kind}:{name}" for kind in ("q", "qd") for name in names)]
    table.write_text(",".join(heading) + "\n0,0,0,0,0\n1,1,1,0,0\n")
    with pytest.raises(DescriptionError, match=f"motion.csv:1: .*{fault}"):
        from_csv(table)
    pytest.importorskip("yaml")
    message.write_text(
        f"joint_names: {json.dumps(names)}\npoints:\n- {{positions: [0, 0], time_from_start: 0}}"
    )
    with pytest.raises(DescriptionError, match=fault):
        from_ros(message)


@pytest.mark.parametrize(
    "text",
    [
        "joint_names: [a]\njoint_names: [b]\npoints:\n- {positions: [0], time_from_start: 0}",
        "joint_names: [a]\npoints:\n- {positions: [0], time_from_start: 0, 'positions': [1]}",
        "joint_names: [a]\npoints:\n- {positions: [0], time_from_start: {sec: 0, sec: 1}}",
    ],
)
def test_doubled_keys_of_a_message(text, tmp_path):
    pytest.importorskip("yaml")
    path = tmp_path / "motion.yaml"
    path.write_text(text)
    with pytest.raises(DescriptionError, match=r":\d: .*is there twice"):
        from_ros(path)


def test_keys_that_are_merged_are_not_doubled(tmp_path):
    pytest.importorskip("yaml")
    path = tmp_path / "motion.yaml"
    first, second = "&p {positions: [0], time_from_start: 0}", "&q {<<: *p, time_from_start: 1}"
    path.write_text(f"joint_names: [a]\npoints:\n- {first}\n- {second}\n- {{<<: *q, time_from_start: 2}}")
    assert from_ros(path).duration == 2.0


@pytest.mark.parametrize("size", [1e-300, 1e-160, 1e-80, 1e-40, 1e20, 1e80, 1e160, 1e307])
def test_waypoints_of_any_size_give_paths_or_errors(size):
    for make in (
        lambda w: cs.spline(w, 3),
        lambda w: cs.spline(w, 5),
        lambda w: cs.spline(w, 5, ends="clamped"),
        lambda w: b_spline(w, 5 if len(w) > 5 else 3),
        lambda w: cs.blend(w, 0.1 * size),
        lambda w: cs.blend(w, 0.1 * size, kind="circular"),
    ):
        with pytest.raises(InputError, match=r"the largest allowed|all the same|too close|the least is"):
            make(W * size)


@pytest.mark.parametrize("deviation", [1e-300, 1e-17, 1e-13])
def test_a_blend_that_is_too_small_is_a_stop(deviation):
    path = cs.blend(W, deviation)
    assert len(path.stops) == 2
    assert "too small" in path.remarks[0]
    poses = np.array([np.eye(4)] * 3)
    poses[1:, :3, 3] = [1, 0, 0], [1, 1, 0]
    assert len(pose_path(poses, deviation=deviation).stops) == 1


@pytest.mark.parametrize("value", [5e-324, 1e-300, 1e-100, 1e-30, 1e110, 1e300])
def test_limits_beyond_the_range_of_numbers(value):
    path = cs.spline(W)
    for name in ("velocity", "acceleration", "jerk"):
        with pytest.raises(InputError, match=f"{name} contains"):
            time_parametrize(path, **{**LIMITS, "jerk": 1.0, name: value})
    panda = cs.spline([READY, 0.9 * READY])
    for name in ("speed", "turn_rate", "feed"):
        with pytest.raises(InputError, match=r"they must be|largest allowed"):
            time_parametrize(panda, PANDA, **{name: value})


@pytest.mark.parametrize("profile", ["double_s", "trapezoidal", "cubic", "quintic", "septic"])
@pytest.mark.parametrize("value", [5e-324, 1e-300, 1e-50])
def test_motions_beyond_the_range_of_numbers(profile, value):
    goal = 0.9 * READY
    for options in ({"velocity": value}, {"velocity": value, "start_velocity": np.full(7, 0.1)}):
        with pytest.raises(InputError, match=r"the motion would last|must be within"):
            PANDA.move_to(goal, start=READY, profile=profile, **options)
    if profile not in ("double_s", "trapezoidal"):
        with pytest.raises(InputError, match="duration is"):
            PANDA.move_to(goal, start=READY, profile=profile, duration=value)


MOTION = {"velocity": 1.0, "acceleration": 2.0, "jerk": 10.0}
KEYWORDS = (
    *MOTION, "start_velocity", "start_acceleration", "goal_velocity", "goal_acceleration", "duration",
    "cycle",
)  # fmt: skip
MAGNITUDES = (5e-324, 1e-310, 1e-200, 1e-100, 1e-30, 1e-18, 1e30, 1e150, 1e300)


def attains_goal_or_is_refused(make, goal):
    """Whether a motion that is made is finite and ends at its goal."""
    try:
        motion = make()
    except (InputError, InputTypeError):
        return True
    q = motion(np.linspace(0.0, motion.duration, 7))
    return bool(np.isfinite(q).all()) and (not motion or np.abs(q[-1] - goal).max() < 1e-9)


@pytest.mark.slow
@pytest.mark.parametrize("profile", ["double_s", "trapezoidal", "cubic", "quintic", "septic"])
@pytest.mark.parametrize("keyword", KEYWORDS)
def test_motions_with_numbers_of_any_size(profile, keyword):
    goal = 0.9 * READY
    given = {k: v for k, v in MOTION.items() if profile != "trapezoidal" or k != "jerk"}
    for value in (*MAGNITUDES, *(-m for m in MAGNITUDES)):
        for moving in ("start_velocity", "start_acceleration", "goal_velocity"):
            some = np.where(np.arange(7) < 3, value, MOTION.get(keyword, 0.0))
            asked = {moving: np.full(7, 0.1), keyword: value if keyword in ("duration", "cycle") else some}
            assert attains_goal_or_is_refused(
                lambda asked=asked: PANDA.move_to(goal, start=READY, profile=profile, **{**given, **asked}),
                goal,
            ), (value, moving)


@pytest.mark.parametrize("synchronize", ["time", "phase", "none"])
@pytest.mark.parametrize("keyword", [*KEYWORDS, "lowest_velocity", "lowest_acceleration"])
def test_motions_between_states_with_numbers_of_any_size(synchronize, keyword):
    goal = 0.9 * READY
    for value in (*MAGNITUDES, *(-m for m in MAGNITUDES)):
        for jerk in (None, 10.0):
            some = np.where(
                np.arange(7) < 3, value, MOTION.get(keyword, -1.0 if "lowest" in keyword else 0.0)
            )
            asked = {keyword: value if keyword in ("duration", "cycle") else some}
            if synchronize == "time":
                asked.setdefault("start_velocity", np.full(7, 0.1))
            given = {**MOTION, "jerk": jerk, "synchronize": synchronize, **asked}
            assert attains_goal_or_is_refused(
                lambda given=given: state_to_state(READY, goal, **given), goal
            ), (value, jerk)


@pytest.mark.parametrize("tiny", [0.0, 5e-324, 1e-310, 1e-200, 1e-100])
@pytest.mark.parametrize("profile", ["quintic", "septic"])
def test_tiny_states_move_as_zero_does(profile, tiny):
    goal = 0.9 * READY
    for moving in ("start_velocity", "goal_velocity"):
        given = {**MOTION, "start": READY, "profile": profile, moving: np.full(7, 0.1)}
        plain = PANDA.move_to(goal, **given)
        for name in ("start_acceleration", "goal_acceleration"):
            motion = PANDA.move_to(goal, **given, **{name: np.full(7, tiny)})
            assert motion.duration == pytest.approx(plain.duration, rel=1e-9)


@pytest.mark.parametrize("value", ["1e308", "1e200", "1e120"])
@pytest.mark.parametrize("column", range(1, 7))
def test_tables_beyond_the_range_of_numbers(value, column, tmp_path):
    path = tmp_path / "motion.csv"
    for row in range(3):
        cells = [[str(k), "1", "2", "3", "4", "5", "6"] for k in range(3)]
        cells[row][column] = value
        path.write_text("time,q:a,q:b,qd:a,qd:b,qdd:a,qdd:b\n" + "\n".join(map(",".join, cells)))
        with pytest.raises(DescriptionError, match=r"from sample \d at \d s .*range of numbers"):
            from_csv(path)


def test_files_of_motions_beyond_the_range_of_numbers(tmp_path):
    path = tmp_path / "motion.json"
    to_json(state_to_state(*ENDS, **LIMITS), path)
    values = json.loads(path.read_text())
    values["coefficients"][0][0][0] = 1e308
    path.write_text(json.dumps(values))
    with pytest.raises(DescriptionError, match="exceeds the range of numbers"):
        from_json(path)
    to_json(time_parametrize(cs.spline(W), **LIMITS), path)
    values = json.loads(path.read_text())
    values["path"]["control_points"][0][0][0] = 1e308
    path.write_text(json.dumps(values))
    with pytest.raises(DescriptionError, match="largest allowed"):
        from_json(path)


@pytest.mark.parametrize("far", [1e9, 1e20, 1e160, 1e300])
def test_points_that_are_too_far(far):
    near, goal, gone = np.eye(4), np.eye(4), np.eye(4)
    goal[:3, 3], gone[:3, 3] = (0.0, 0.2, 0.0), (far, 0.0, 0.0)
    with pytest.raises(InputError, match=r"via is 1e\+09 m from the start|via holds"):
        arc_path(near, goal, via=(far, 0.1, 0.0))
    if far > 1e15:
        for make in (line_path, screw_path, lambda a, b: pose_path([a, b, goal])):
            with pytest.raises(InputError, match=r"position of .* largest allowed"):
                make(near, gone)
        for name, value in {"center": (far, 0, 0), "angle": far}.items():
            options = {"center": (1, 0, 0), "axis": (0, 0, 1), "angle": 1.0, name: value}
            with pytest.raises(InputError, match=f"{name} holds"):
                arc_path(near, **options)


def test_grids_that_would_take_hours():
    with pytest.raises(InputError, match="grid is 3000000; it must be 1 to 100000"):
        time_parametrize(cs.spline(W), **LIMITS, jerk=1.0, grid=3_000_000)


@pytest.mark.parametrize(
    ("call", "fault"),
    [
        (lambda: time_parametrize(cs.spline(W), **LIMITS, gravity=(0, 0, -9.81)), "pass torque="),
        (lambda: time_parametrize(cs.spline([READY, 0.9 * READY]), PANDA, frame="panda_hand"), "pass speed="),
        (
            lambda: PANDA.move_to(
                0.9 * READY, start=READY, profile="trapezoidal", start_acceleration=np.ones(7)
            ),
            "'double_s'",
        ),
        (lambda: PANDA.move_linear(np.eye(4), start=READY, sped=1), "no option 'sped' in move_linear"),
        (lambda: PANDA.move_linear(PANDA.fk(READY), start=READY, sped=1), "no option 'sped' in move_linear"),
        (lambda: PANDA.move_arc(np.eye(4), start=READY, via=(0, 0, 0), sped=1), "in move_arc"),
        (lambda: PANDA.move_through([np.eye(4)], start=READY, sped=1), "in move_through"),
        (lambda: cs.move(PANDA, READY, READY, feed=1.0), "move has no feed="),
        (lambda: cs.move(PANDA, READY, READY, duration=1.0), "move has no duration="),
    ],
)
def test_options_without_effect(call, fault):
    with pytest.raises(InputTypeError, match=fault):
        call()


def test_wrong_values_are_named():
    with pytest.raises(InputError, match=r"deviation contains -0.1"):
        cs.blend(W, -0.1)
    for make in (cs.spline, b_spline, lambda w: cs.blend(w, 0.1)):
        with pytest.raises(InputError, match=r"shape \(3,\)(?!.*\(\.\.\.)"):
            make([1.0, 2.0, 3.0])


@pytest.mark.parametrize("start", [[READY, READY], READY[None], ["ready"], ["ready", "ready"]])
def test_move_takes_one_start(start):
    with pytest.raises(InputError, match=r"start has shape .* give one configuration"):
        cs.move(PANDA, start, READY)


def test_named_poses_are_starts():
    goal = 0.9 * READY
    T = PANDA.fk(goal)
    assert PANDA.move_to(goal, start="ready").duration == PANDA.move_to(goal, start=READY).duration
    assert PANDA.move_to("ready", start=goal)
    named, plain = (PANDA.move_linear(T, start=start) for start in ("ready", READY))
    assert named.duration == plain.duration
    assert bool(named) == bool(plain)
    for call in (PANDA.move_to, PANDA.move_linear):
        with pytest.raises(UnknownNameError, match="did you mean 'ready'"):
            call(T if call == PANDA.move_linear else goal, start="redy")


def test_no_motion_passes_no_check():
    T = PANDA.fk(READY)
    T[0, 3] += 3.0
    motion = PANDA.move_linear(T, start=READY)
    for each in (motion, motion.timed, motion.reversed()):
        check = each.check(PANDA)
        assert not motion
        assert not check
        assert check.reason == motion.reason
        assert not check.violations


def test_limits_of_another_number_of_joints_are_refused_whatever_else_is_given():
    path = cs.spline([[0.0, 0.0], [0.5, 2.0]])
    for count in (1, 3):
        limits = cs.Limits([-1.0] * count, [1.0] * count)
        with pytest.raises(InputError, match=f"limits is of {count} joints, the path of 2"):
            cs.time_parametrize(path, limits, velocity=1.0, acceleration=2.0)


NO_PLACES = (None, "x", np.zeros(0), np.zeros((2, 2)), 10**400, 1j)


@pytest.mark.parametrize("end", NO_PLACES)
def test_parts_end_at_one_number(end):
    path = cs.spline([[0.0, 0.0], [0.5, 2.0]])
    line = cs.trajectory.line_path(cs.pose((0, 0, 0)), cs.pose((1, 0, 0)))
    for each in (path, line):
        with pytest.raises((InputError, InputTypeError)):
            each.part(end)


@pytest.mark.parametrize("robot", [None, 3, "panda", np.eye(4)])
def test_moves_of_the_tip_need_a_robot(robot):
    T = cs.pose((0.1, 0.0, 0.0))
    with pytest.raises(InputTypeError):
        cs.cartesian.move_linear(robot, T, start=np.zeros(7))
    with pytest.raises(InputTypeError):
        cs.cartesian.move_through(robot, T[None], start=np.zeros(7))
    with pytest.raises(InputTypeError):
        cs.cartesian.move_arc(robot, start=np.zeros(7), center=(0, 0, 0), axis=(0, 0, 1), angle=1.0)


@pytest.mark.parametrize("thing", [None, 3, "motion.csv", np.eye(4)])
def test_only_trajectories_are_written(thing, tmp_path):
    for write in (
        lambda: cs.trajectory.to_csv(thing, tmp_path / "a.csv", rate=10.0),
        lambda: cs.trajectory.to_json(thing, tmp_path / "a.json"),
        lambda: cs.trajectory.to_ros(thing, tmp_path / "a.yaml", rate=10.0),
    ):
        with pytest.raises(InputTypeError, match="trajectory is a"):
            write()
    assert not list(tmp_path.iterdir())


def test_arrays_are_no_options():
    path = cs.spline([[0.0, 0.0], [0.5, 2.0]])
    robot = cs.load_robot("ur5e")
    q = np.array([0.3, -1.2, 1.5, -0.8, -1.3, 0.2])
    line = cs.trajectory.line_path(robot.fk(q), robot.fk(q) @ cs.pose((0.05, 0, 0)))
    for call in (
        lambda: cs.time_parametrize(path, velocity=1.0, acceleration=2.0, positions=np.zeros(0)),
        lambda: cs.cartesian.move_cartesian(robot, line, q, acceleration=2.0, as_far_as_possible=np.zeros(0)),
        lambda: cs.trajectory.Path([0, 1], np.zeros((1, 2, 6)), remarks=None),
        lambda: cs.trajectory.state_to_state(
            [0.0], [1.0], velocity=1, acceleration=2, joint_names=np.array(3)
        ),
        lambda: robot.move_to(
            q + 0.1, start=q, profile="quintic", velocity=1.0, acceleration=2.0, duration=np.zeros((2, 6))
        ),
    ):
        with pytest.raises((InputError, InputTypeError)):
            call()


def test_a_touch_has_a_place_and_arms_without_limits_no_warning():
    robot = cs.load_robot("ur5e")
    q = np.array([0.3, -1.2, 1.5, -0.8, -1.3, 0.2])
    T = robot.fk(q)
    ball = cs.Scene([cs.Sphere(0.2, T[:3, 3])])
    motion = robot.move_linear(T @ cs.pose((0.1, 0, 0)), start=q, acceleration=8.0, scene=ball)
    assert not motion
    assert motion.place == 0.0
    far = cs.trajectory.line_path(cs.pose((5, 0, 0)), cs.pose((5, 1, 0)))
    free = cs.load_robot("puma_style")
    assert not cs.cartesian.move_cartesian(free, far, acceleration=8.0, velocity=1.0)
