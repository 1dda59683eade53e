"""Arguments of motions that are none: an error that names them, whatever is given."""

import dataclasses
import functools

import numpy as np
import pytest

import cspace as cs
from cspace import cartesian, trajectory
from cspace.errors import CspaceError, InputTypeError

START = np.array([0.3, -1.2, 1.5, -0.8, -1.3, 0.2])
WAYPOINTS = START + np.array([[0.0], [0.3], [-0.2]])
LIMITS = {"velocity": 2.0, "acceleration": 8.0}

STRANGE = (
    "no such", b"no such", 1j, object(), [], {}, [1, 2], [[1, 2], [3]], np.zeros((2, 6)), np.zeros((0, 6)),
    np.full((4, 4), np.nan), np.zeros((3, 4, 4)), np.array(["a"]), np.ones(6, dtype=object),
)  # fmt: skip


@pytest.fixture(scope="module")
def robot():
    return cs.load_robot("ur5e")


def line(robot):
    T = robot.fk(START)
    return trajectory.line_path(T, T @ cs.pose((0.1, 0, 0)))


CALLS = {
    "profile": lambda r, x: r.move_to(START + 0.1, start=START, jerk=50.0, profile=x, **LIMITS),
    "synchronize": lambda r, x: r.move_to(START + 0.1, start=START, jerk=50.0, synchronize=x, **LIMITS),
    "limits of move_to": lambda r, x: r.move_to(START + 0.1, start=START, jerk=50.0, limits=x, **LIMITS),
    "state_to_state": lambda r, x: trajectory.state_to_state([0], [1], synchronize=x, **LIMITS),
    "degree": lambda r, x: cs.spline(WAYPOINTS, x),
    "ends": lambda r, x: cs.spline(WAYPOINTS, ends=x),
    "spacing": lambda r, x: cs.spline(WAYPOINTS, spacing=x),
    "kind": lambda r, x: cs.blend(WAYPOINTS, 0.1, kind=x),
    "length": lambda r, x: trajectory.b_spline(WAYPOINTS, 2, length=x),
    "robot": lambda r, x: cs.time_parametrize(cs.spline(WAYPOINTS), robot=x, **LIMITS),
    "joint path": lambda r, x: cs.time_parametrize(x, **LIMITS),
    "poses": lambda r, x: r.move_through(x, start=START, **LIMITS),
    "rotation": lambda r, x: r.move_arc(
        start=START, center=(0, 0, 0), axis=(0, 0, 1), angle=0.1, rotation=x, **LIMITS
    ),
    "path": lambda r, x: cartesian.move_cartesian(r, x, **LIMITS),
    "followed path": lambda r, x: cartesian.follow_cartesian(r, x),
    "turned path": lambda r, x: cartesian.follow_free_turn(r, x),
    "limits of follow_free_turn": lambda r, x: cartesian.follow_free_turn(r, line(r), "z", START, limits=x),
    "CSV": lambda r, x: trajectory.from_csv(x),
    "JSON": lambda r, x: trajectory.from_json(x),
}


@pytest.mark.parametrize("value", STRANGE, ids=lambda value: type(value).__name__)
@pytest.mark.parametrize("argument", CALLS)
def test_strange_values_are_named(robot, argument, value):
    with pytest.raises(CspaceError):
        CALLS[argument](robot, value)


class Turning:
    """Curves that are methods, and one that can be called."""

    def without_order(self, s):
        return np.sin(s)[:, None]

    def with_three(self, s, order, length):
        return np.sin(s)[:, None] + order * length

    __call__ = without_order


@pytest.mark.parametrize(
    "curve",
    [
        lambda: 0.0,
        lambda s: np.sin(s)[:, None],
        lambda s, *, order: np.sin(s)[:, None],
        lambda s, order, length: np.sin(s)[:, None],
        Turning().without_order,
        Turning().with_three,
        Turning(),
        functools.partial(lambda s, order: np.sin(s)[:, None], order=0),
        *STRANGE,
    ],
)
def test_curves_without_order_are_named(curve):
    with pytest.raises(InputTypeError, match=r"must accept \(s, order\)"):
        trajectory.fit_path(curve, 1.0)


@pytest.mark.parametrize(
    "curve",
    [
        lambda s, order: np.array([np.sin(s), np.cos(s), -np.sin(s)][order])[:, None],
        lambda s, order=0: np.array([np.sin(s), np.cos(s), -np.sin(s)][order])[:, None],
        lambda *given: np.array([np.sin(given[0]), np.cos(given[0]), -np.sin(given[0])][given[1]])[:, None],
        functools.partial(lambda k, s, order: np.sin(k * s + order * np.pi / 2)[:, None], 1.0),
    ],
)
def test_curves_with_order_are_fitted(curve):
    np.testing.assert_allclose(trajectory.fit_path(curve, 1.0)(0.7), np.sin([0.7]), atol=1e-7)


PIECE = trajectory.CartesianPiece(
    1.0, np.zeros((6, 3)), np.zeros((6, 3)), np.eye(3), np.array([0.0, 0.0, 1.0]), 0.0, np.zeros(3)
)


@pytest.mark.parametrize(
    "value",
    [*STRANGE, None, 1.5, [PIECE, None], [PIECE, "x"], (each for each in (PIECE, 1.0)), PIECE],
    ids=lambda value: type(value).__name__,
)
def test_pieces_of_a_path_are_pieces(value):
    with pytest.raises(CspaceError, match=r"piece.*CartesianPiece"):
        trajectory.CartesianPath(value)


@pytest.mark.parametrize(
    "value",
    [
        *STRANGE[:4],
        *STRANGE[5:-1],
        None,
        "x",
        True,
        np.nan,
        0.5,
        [np.nan],
        [-0.1],
        [1.1],
        [np.inf],
        [None],
    ],
    ids=lambda value: type(value).__name__,
)
def test_stops_of_a_path_are_places_on_it(value):
    with pytest.raises(CspaceError, match="stops"):
        trajectory.CartesianPath([PIECE], value)


@pytest.mark.parametrize("value", [*STRANGE, None, True, -np.inf], ids=lambda value: type(value).__name__)
@pytest.mark.parametrize("field", [field.name for field in dataclasses.fields(PIECE)])
def test_fields_of_a_piece_are_named(field, value):
    with pytest.raises(CspaceError, match=rf"{field} of "):
        trajectory.CartesianPath([PIECE, dataclasses.replace(PIECE, **{field: value})])


def test_pieces_have_lengths_and_rotations():
    for field, value in (
        ("length", -1.0),
        ("R", np.zeros((3, 3))),
        ("R", -np.eye(3)),
        ("arm", [1e200, 0, 0]),
    ):
        with pytest.raises(CspaceError, match=f"{field} of "):
            trajectory.CartesianPath([dataclasses.replace(PIECE, **{field: value})])
    assert trajectory.CartesianPath(iter([PIECE, PIECE]), [1]).stops == [1.0]


POSES = {
    "line_path start": lambda x: trajectory.line_path(x, np.eye(4)),
    "line_path goal": lambda x: trajectory.line_path(np.eye(4), x),
    "screw_path start": lambda x: trajectory.screw_path(x, np.eye(4)),
    "screw_path goal": lambda x: trajectory.screw_path(np.eye(4), x),
    "arc_path start": lambda x: trajectory.arc_path(x, center=(1, 0, 0), axis=(0, 0, 1), angle=1.0),
    "arc_path goal": lambda x: trajectory.arc_path(np.eye(4), x, via=(1, 1, 0)),
    "arc_path via": lambda x: trajectory.arc_path(np.eye(4), cs.pose((2, 0, 0)), via=x),
    "arc_path center": lambda x: trajectory.arc_path(np.eye(4), center=x, axis=(0, 0, 1), angle=1.0),
    "arc_path axis": lambda x: trajectory.arc_path(np.eye(4), center=(1, 0, 0), axis=x, angle=1.0),
    "arc_path angle": lambda x: trajectory.arc_path(np.eye(4), center=(1, 0, 0), axis=(0, 0, 1), angle=x),
    "pose_path poses": lambda x: trajectory.pose_path(x),
    "pose_path pose": lambda x: trajectory.pose_path([np.eye(4), x]),
    "pose_path deviation": lambda x: trajectory.pose_path([np.eye(4), cs.pose((2, 0, 0))], deviation=x),
    "pose_path turn_deviation": lambda x: trajectory.pose_path(
        [np.eye(4), cs.pose((2, 0, 0))], turn_deviation=x
    ),
}


@pytest.mark.parametrize("value", STRANGE, ids=lambda value: type(value).__name__)
@pytest.mark.parametrize("argument", POSES)
def test_strange_ends_of_paths_are_named(argument, value):
    with pytest.raises(CspaceError):
        POSES[argument](value)


@pytest.mark.parametrize("size", [1e6, 1e8, 1e12, 1e100])
def test_a_path_of_too_many_metres_is_refused_at_once(robot, size):
    with pytest.raises(CspaceError, match=r"long|large|exceeds|must"):
        robot.move_linear(cs.pose((size, 0, 0.3)), start=START, **LIMITS)
    with pytest.raises(CspaceError, match=r"long|large|exceeds|must"):
        robot.move_arc(start=START, center=(0, 0, 0), axis=(0, 0, 1), angle=size, rotation="keep", **LIMITS)


@pytest.mark.parametrize("name", ["planar_2r", "stanford", "pr2_right_torso"])
def test_torques_without_efforts_are_asked_for(name):
    robot = cs.load_robot(name)
    q = robot.random_configuration(rng=0, reach=0.5)
    path = cs.spline(np.stack([q, q + 0.1]))
    with pytest.raises(CspaceError, match=r"no effort limits.*pass torque="):
        cs.time_parametrize(path, robot, torque=True, **LIMITS)
    assert cs.time_parametrize(path, robot, torque=np.inf, positions=False, **LIMITS)


def test_limits_of_position_may_be_given(robot):
    limits = cs.Limits(START - 0.05, START + 0.05)
    given = {"start": START, "jerk": 50.0, **LIMITS}
    assert robot.move_to(START + 0.04, limits=limits, **given)
    assert "upper limit" in robot.move_to(START + 0.1, limits=limits, **given).reason
    assert robot.move_to(START + 0.1, limits=False, **given)


@pytest.mark.parametrize("name", ["ur5e", "panda", "cobra600", "planar_3r"])
@pytest.mark.parametrize("side", [1.0, -1.0])
def test_a_start_beyond_its_limits_is_named(name, side):
    robot = cs.load_robot(name)
    inside = robot.random_configuration(rng=2, reach=0.5)
    limits = cs.Limits(np.full(robot.dof, -7.0), np.full(robot.dof, 7.0))
    for j, joint in enumerate(robot.joint_names):
        start = np.array(inside)
        start[j] = 7.5 * side
        goal = cs.pose((0.01, 0, 0)) @ robot.fk(start)
        motion = robot.move_linear(goal, start=start, limits=limits, **LIMITS)
        assert not motion
        assert motion.reason.startswith(
            f"at s = 0: {joint} of the start is {7.5 * side:g}, beyond its limits"
        )
        np.testing.assert_array_equal(motion(0.0), start)


@pytest.mark.parametrize("tolerance", [0.0, -1e-5, 1e-15, 1e-300, np.nan])
@pytest.mark.parametrize("name", ["ur5e", "panda"])
@pytest.mark.parametrize("free_axis", [None, "z"])
def test_a_tolerance_within_rounding_is_refused(name, free_axis, tolerance):
    robot = cs.load_robot(name)
    q = robot.random_configuration(rng=2, reach=0.5)
    goal = robot.fk(q) @ cs.pose((0.01, 0, 0))
    with pytest.raises(CspaceError, match="tolerance"):
        robot.move_linear(goal, start=q, tolerance=tolerance, free_axis=free_axis, **LIMITS)


@pytest.mark.parametrize("name", ["panda", "ur5e"])
def test_joints_of_a_floating_robot_are_timed(name):
    robot = cs.load_robot(name, floating=True)
    q = np.zeros(len(robot.joint_names))
    path = cs.spline(np.stack([q, q + 0.3, q - 0.1]))
    assert cs.time_parametrize(path, robot, positions=False, **LIMITS)
    for needs in ({"torque": True}, {"torque": 5.0}, {"speed": 0.1}, {"turn_rate": 0.1}):
        with pytest.raises(CspaceError, match=r"the base of .* is floating"):
            cs.time_parametrize(path, robot, **needs, **LIMITS)
