"""Arguments of wrong types and sizes, through the Python face: an error of cspace that says what is wrong."""

from __future__ import annotations

import pickle
from pathlib import Path
from xml.sax.saxutils import quoteattr

import numpy as np
import pytest

import cspace as cs
from cspace.errors import (
    CspaceError,
    DescriptionError,
    InputError,
    InputTypeError,
    MissingExtraError,
    UnknownNameError,
)
from cspace.model import Limits

ARM = cs.load_robot("ur5e")
GOAL = ARM.fk(np.full(6, 0.5))
FOUND = ARM.ik(GOAL)
MANY = ARM.ik(np.stack([GOAL, GOAL]))
REST = cs.PostureTask(np.zeros(6))
THREE = Limits(np.zeros(3), np.ones(3))
HUGE = [[10**400] * 4] * 4

CALLS = [
    (lambda: Limits([1.0, [1.0, 2.0]], [2.0, 3.0]), InputTypeError, "^lower limits"),
    (lambda: Limits(["a"], [1.0]), InputTypeError, "^lower limits"),
    (lambda: ARM.export("cpp", locked=np.array(0.1)), InputTypeError, "locked is an ndarray, expected joint"),
    (lambda: ARM.ik(HUGE), InputError, "beyond the range of float64"),
    (lambda: ARM.ik(GOAL, least_squares=GOAL), InputTypeError, "least_squares must be True or False"),
    (
        lambda: ARM.ik(np.stack([GOAL]), threads="2"),
        InputTypeError,
        "threads is a str; it must be a whole number",
    ),
    (
        lambda: ARM.ik(np.stack([GOAL]), threads=1.5),
        InputTypeError,
        "threads is a float; it must be a whole number",
    ),
    (lambda: ARM.ik(np.stack([GOAL]), threads=10**30), InputError, "must be 0 to 1024"),
    (lambda: ARM.ik(np.stack([GOAL]), threads=-1), InputError, "threads is -1"),
    (lambda: ARM.ik(GOAL, near=[True, *[0.0] * 5]), InputTypeError, "near must be numbers, got truth values"),
    (lambda: ARM.ik(GOAL, near=[True, False] * 3), InputTypeError, "near must be numbers, got truth values"),
    (lambda: ARM.fk([[0.0] * 6, [np.True_, *[0.0] * 5]]), InputTypeError, "q must be numbers, got truth val"),
    (lambda: ARM.fk(np.array([True, *[0.0] * 5], dtype=object)), InputTypeError, "^q must be numbers, got t"),
    (lambda: FOUND.within("upper"), InputTypeError, "limits is a str, expected cspace.model.Limits"),
    (lambda: MANY.within([0, 1]), InputTypeError, "limits is a list, expected cspace.model.Limits"),
    (lambda: FOUND.violations({}), InputTypeError, "limits is a dict, expected cspace.model.Limits"),
    (lambda: FOUND.within(THREE), InputError, "limits are for 3 joints"),
    (lambda: FOUND.nearest(np.zeros(6), GOAL), UnknownNameError, "no metric"),
    (lambda: MANY.nearest(np.zeros(6), "max_"), UnknownNameError, "did you mean 'max'"),
    (lambda: ARM.jacobian_dot(np.zeros(6), None), InputTypeError, "qd is None"),
    (lambda: ARM.to_dh(convention=np.eye(3)), UnknownNameError, "no Denavit–Hartenberg convention"),
    (lambda: ARM.random_configuration("3"), InputTypeError, "n is a str; it must be a whole number"),
    (lambda: ARM.random_configuration(-1), InputError, "n is -1"),
    (lambda: ARM.random_configuration(reach=[1, 2]), InputError, "reach is"),
    (lambda: ARM.random_configuration(reach="far"), InputTypeError, "reach must be numbers"),
    (lambda: ARM.random_configuration(reach=-1.0), InputError, "reach is -1"),
    (
        lambda: cs.kinematics.jacobian("ur5e", np.zeros(6)),
        InputTypeError,
        "first argument must be a Robot, got str",
    ),
    (lambda: cs.kinematics.center_of_mass(None, np.zeros(6)), InputTypeError, "got NoneType; cspace.load"),
    (lambda: cs.kinematics.workspace(ARM.description), InputTypeError, "got Description"),
    (lambda: cs.Robot("ur5e"), InputTypeError, "Robot needs a Description, got str; load_robot"),
    (lambda: cs.Robot.from_urdf(None), InputTypeError, "by its path, a robot also by its text, got NoneType"),
    (lambda: cs.Robot.from_toml([]), InputTypeError, "by its path, a robot also by its text, got list"),
    (lambda: cs.load_robot("ur5e", tip=["tool0"]), UnknownNameError, "no link"),
    (
        lambda: cs.load_robot("planar_2r").ik(position=(1e300, 1e300)),
        InputError,
        "position lies at .* the largest distance",
    ),
    (lambda: ARM.ik_many_starts(GOAL, starts=[[1, 2], [1, 2, 3]]), InputTypeError, "starts must be numbers"),
    (
        lambda: ARM.ik_many_starts(GOAL, starts="many"),
        InputTypeError,
        "starts is a str; it must be a whole",
    ),
    (
        lambda: ARM.ik_many_starts(GOAL, tolerance=True),
        InputTypeError,
        "tolerance must be a number, got the t",
    ),
    (lambda: ARM.ik_numeric(GOAL, tolerance=1e300), InputError, r"^tolerance holds 1e\+300; the largest"),
    (lambda: ARM.ik_numeric(GOAL, tolerance=None), InputError, "^tolerance holds nan; all must be finite"),
    (lambda: ARM.ik_tasks([]), InputError, "there are no tasks; give one, or several in a list: PoseTask"),
    (lambda: ARM.ik_tasks(REST, tolerance=np.True_), InputTypeError, "tolerance must be a number"),
    (
        lambda: ARM.task_velocity(np.zeros(6), REST, True),
        InputTypeError,
        "^dt must be a number, got the truth",
    ),
    (
        lambda: ARM.task_velocity(np.zeros(6), REST, 1, damping=True),
        InputTypeError,
        "^damping must be a number",
    ),
    (
        lambda: ARM.resolved_rate(np.zeros(6), np.ones(6), damping=True),
        InputTypeError,
        "^damping must be a nu",
    ),
    (
        lambda: ARM.track([GOAL], max_step=True),
        InputTypeError,
        "^max_step must be a number, got the truth va",
    ),
    (
        lambda: ARM.track([GOAL], cost=lambda q: q / "2"),
        InputError,
        r"cost= raised .*Error for q of shape \(1, 6\)",
    ),
    (
        lambda: ARM.track([GOAL], cost=lambda q: q),
        InputError,
        r"cost= has shape \(1, 6\), expected one number",
    ),
    (
        lambda: ARM.track([GOAL], cost=object()),
        UnknownNameError,
        "^no cost choice of type object; cost choices",
    ),
    (lambda: ARM.manipulability(np.zeros(6), rows=[GOAL]), UnknownNameError, "^no row of type ndarray in"),
    (lambda: ARM.export(name=object()), InputError, "^name is an object of type object, expected a letter"),
    (
        lambda: cs.random_pose(object(), rng=1),
        InputTypeError,
        "^size is an object of type object; it must be",
    ),
    (
        lambda: cs.OccupancyGrid([[1, 0], [1]]),
        InputError,
        "^blocked has rows of different lengths; all rows need",
    ),
    (lambda: cs.OccupancyGrid([[[1], [2]], [[1]]]), InputError, "^blocked has rows of different lengths"),
    (lambda: cs.OccupancyGrid("map.png"), InputTypeError, "^blocked is 'map.png', .*from_image, from_ros or"),
    (
        lambda: cs.OccupancyGrid(Path("map.png")),
        InputTypeError,
        "type PosixPath, expected an array .*from_im",
    ),
    (lambda: cs.OccupancyGrid(b"map.png"), InputTypeError, "from_image"),
    (
        lambda: cs.PolygonWorld([(2, 2), (5, 2), (5, 5)]),
        InputError,
        "^obstacles is a list of 3 points, expected a list of polygons .*: .polygon.$",
    ),
    (lambda: cs.PolygonWorld(np.eye(2)), InputError, "^obstacles is a list of 2 points"),
    (lambda: cs.PolygonWorld(iter([(2, 2), [5, 2]])), InputError, "^obstacles is a list of 2 points"),
    (lambda: cs.robots.find(5), InputTypeError, "must be a string, got int"),
    (lambda: cs.robots.search(None), InputTypeError, "must be a string, got NoneType"),
]


@pytest.mark.parametrize(("call", "error", "words"), CALLS)
def test_wrong_arguments_are_refused_in_words(call, error, words):
    with pytest.raises(error, match=words):
        call()


@pytest.mark.parametrize("open_axis", [[None] * 3, [None, None, 1.0], (None, 0, 1)])
@pytest.mark.parametrize(
    ("named", "goal"),
    [
        ("direction", lambda a: {"direction": a}),
        ("tool_axis", lambda a: {"direction": (0, 0, 1), "tool_axis": a}),
        ("tool_axis", lambda a: {"position": (0.3, 0.3, 0.3), "direction": (0, 0, 1), "tool_axis": a}),
        (r"ray\[0\]", lambda a: {"ray": (a, (0, 0, 1))}),
        (r"ray\[1\]", lambda a: {"ray": ((0.3, 0.3, 0.3), a)}),
        (r"angle_to\[0\]", lambda a: {"position": (0.3, 0.3, 0.3), "angle_to": (a, 0.3)}),
    ],
)
def test_only_points_have_open_coordinates(named, goal, open_axis):
    with pytest.raises(InputTypeError, match=f"^{named} contains None.*position= and look_at="):
        ARM.ik(**goal(open_axis))


@pytest.mark.parametrize("name", ["position", "look_at"])
def test_a_point_without_any_coordinate_is_named(name):
    with pytest.raises(InputError, match=f"^{name} has None for all three coordinates"):
        ARM.ik(**{name: [None] * 3})


ENDS = "<link name='a'/><link name='b'/>"
JOINT = "<joint name='j' type='fixed'><parent link='a'/><child link='b'/></joint>"


def urdf(name, text):
    return f"<robot name='r'>{text.format(quoteattr(name))}</robot>"


def mjcf(name, text):
    return f"<mujoco><worldbody><body name='a'>{text.format(quoteattr(name))}</body></worldbody></mujoco>"


@pytest.mark.parametrize("name", ["x" * 5000, "long " * 1000, '"quoted" ' * 600, "x'" * 2500])
@pytest.mark.parametrize(
    "call",
    [
        lambda n: cs.load_robot(n),
        lambda n: cs.load_robot("/tmp/" + n + ".urdf"),
        lambda n: cs.load_robot("ur5e", tip=n),
        lambda n: ARM.fk(np.zeros(6), n),
        lambda n: ARM.export(name="-" + n),
        lambda n: ARM.export("cpp", n + ".hpp"),
        lambda n: ARM.ik(GOAL, locked={n: 0.0}),
        lambda n: cs.Robot.from_urdf(urdf(n, "<link name={0}/><link name={0}/>")),
        lambda n: cs.Robot.from_urdf(urdf(n, "<link name={}/><link name='b'/>")),
        lambda n: cs.Robot.from_urdf(urdf(n, ENDS + JOINT.replace("'j'", "{}").replace("'a'", "'c'"))),
        lambda n: cs.Robot.from_urdf(urdf(n, ENDS + JOINT.replace("'a'", "{}"))),
        lambda n: cs.Robot.from_urdf(urdf(n, ENDS + JOINT.replace("'fixed'", "{}"))),
        lambda n: cs.Robot.from_mjcf(mjcf(n, "<joint name={} type='hinge' axis='0 0 0'/>")),
        lambda n: cs.Robot.from_mjcf(mjcf(n, "<joint name='j' class={}/>")),
        lambda n: cs.Robot.from_mjcf(mjcf(n, "<body name={0}/><body name={0}/>")),
        lambda n: cs.OccupancyGrid.from_image("/tmp/" + n),
        lambda n: cs.PolygonWorld.from_geojson({"type": n}),
        lambda n: cs.navigate(cs.OccupancyGrid([[0, 0]]), (0.5, 0.5), (1.5, 0.5), n),
    ],
)
def test_long_names_are_shortened(name, call):
    with pytest.raises(CspaceError) as caught:
        call(name)
    assert len(str(caught.value)) < 1000


@pytest.mark.parametrize("name", ["../x", "..", "ur5e/../kuka", "", "/dev/zero", "/", "x" * 10**5])
def test_names_with_tricks_are_refused_in_a_short_message(name):
    with pytest.raises(CspaceError) as caught:
        cs.load_robot(name)
    assert len(str(caught.value)) < 400


@pytest.mark.parametrize(
    "goal",
    [
        GOAL.astype(">f8"),
        GOAL.astype(object),
        GOAL.astype(np.longdouble),
        np.asfortranarray(GOAL),
        np.ma.masked_array(GOAL),
        np.stack([GOAL, GOAL], axis=-1)[..., 1],
        np.frombuffer(b"." + GOAL.tobytes(), dtype=np.float64, offset=1, count=16).reshape(4, 4),
        GOAL.tolist(),
    ],
)
def test_every_layout_of_the_same_numbers_has_the_same_answer(goal):
    assert np.array_equal(ARM.ik(goal).q, FOUND.q)
    assert np.array_equal(ARM.ik(np.asarray(goal)[None])[0].q, ARM.ik(GOAL[None])[0].q)


@pytest.mark.parametrize("n", [0, 17, 40])
def test_a_chain_of_no_joints_or_too_many_has_no_closed_form_and_says_so(n):
    links = "".join(f"<link name='l{i}'/>" for i in range(n + 1))
    joints = "".join(
        f"<joint name='j{i}' type='continuous'><parent link='l{i}'/><child link='l{i + 1}'/></joint>"
        for i in range(n)
    )
    robot = cs.Robot.from_urdf(f"<robot name='r'>{links}{joints}</robot>")
    with pytest.raises(CspaceError, match="no closed form for r"):
        robot.ik(np.eye(4))


@pytest.mark.parametrize(
    "error",
    [
        MissingExtraError("plot", "a picture"),
        DescriptionError("no links", path="arm.urdf", line=3),
        InputError("q is NaN"),
    ],
)
def test_errors_travel_between_processes(error):
    again = pickle.loads(pickle.dumps(error))
    assert type(again) is type(error)
    assert str(again) == str(error)
    assert vars(again) == vars(error)
