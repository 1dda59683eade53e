"""Goals that ask for less than a pose, on arms with as many joints as the goal asks for."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import cspace as cs
from cspace.errors import InputError, InputTypeError
from cspace.ik import NoClosedFormError
from cspace.ik.goals.parts import turn_to
from cspace.model import Description, Joint, Link, Mimic, from_screws
from cspace.robot import Robot
from ik.geometries import unit

AHEAD = 0.7

# How many joints a goal asks for, and the goal that a tip pose meets.
GOALS = {
    "position": (3, lambda T: {"position": T[:3, 3]}),
    "rotation": (3, lambda T: {"rotation": T[:3, :3]}),
    "direction": (2, lambda T: {"direction": 3 * T[:3, 2]}),
    "position and rotation": (6, lambda T: {"position": T[:3, 3], "rotation": T[:3, :3]}),
    "position and direction": (5, lambda T: {"position": T[:3, 3], "direction": T[:3, 2]}),
    "look_at": (2, lambda T: {"look_at": T[:3, 3] + AHEAD * T[:3, 2]}),
    "ray": (4, lambda T: {"ray": (T[:3, 3] - 0.3 * T[:3, 2], T[:3, 2])}),
    "x and y": (2, lambda T: {"position": (T[0, 3], T[1, 3], None)}),
    "height": (1, lambda T: {"position": (None, None, T[2, 3])}),
    "position and angle": (
        4,
        lambda T: {"position": T[:3, 3], "angle_to": ("x", float(np.arccos(T[0, 2])))},
    ),
    "tool axis -x": (5, lambda T: {"position": T[:3, 3], "direction": -T[:3, 0], "tool_axis": "-x"}),
}


def random_arm(word, rng):
    T_zero = np.eye(4)
    T_zero[:3, 3] = rng.uniform(-1, 1, 3)
    axes = [unit(v) for v in rng.normal(size=(len(word), 3))]
    return Robot(from_screws(axes, rng.uniform(-1, 1, (len(word), 3)), T_zero, joint_types=word))


def gaps(robot, rows, q):
    d = rows - q
    turns = np.array([kind == "R" for kind in robot.joint_types])
    return np.abs(np.where(turns, (d + np.pi) % (2 * np.pi) - np.pi, d)).max(axis=-1)


def met_by(name, T, tool_axis="z"):
    """The goal that T meets, measured plainly: the miss of a pose as a function."""
    value = GOALS[name][1](T)
    a = {"z": 2, "-x": 0}[tool_axis]
    sign = -1 if tool_axis == "-x" else 1

    def miss(S):
        p, d = S[:3, 3], sign * S[:3, a]
        out = []
        if "position" in value:
            out += [p[i] - v for i, v in enumerate(value["position"]) if v is not None]
        if "rotation" in value:
            out += list((S[:3, :3] - value["rotation"]).ravel())
        if "direction" in value:
            out += list(d - unit(np.asarray(value["direction"])))
        if "look_at" in value:
            away = value["look_at"] - p
            out += [*np.cross(away, d), min(0.0, away @ d)]
        if "ray" in value:
            out += list(np.cross(p - value["ray"][0], value["ray"][1])) + list(d - value["ray"][1])
        if "angle_to" in value:
            out.append(d[0] - np.cos(value["angle_to"][1]))
        return np.abs(out).max()

    return value, miss


@pytest.mark.parametrize("name", GOALS)
@pytest.mark.parametrize("seed", range(3))
def test_every_solution_meets_the_goal_and_the_generator_is_among_them(name, seed):
    joints = GOALS[name][0]
    rng = np.random.default_rng([1, seed, *map(ord, name)])
    robot = random_arm("R" * joints, rng)
    axis = "-x" if name.startswith("tool") else "z"
    for q in rng.uniform(-np.pi, np.pi, (6, joints)):
        value, miss = met_by(name, robot.fk(q), axis)
        found = robot.ik(**value)
        assert found.status == "exact"
        assert gaps(robot, found.q, q).min() < 1e-6
        assert max(miss(robot.fk(row)) for row in found.q) < 1e-8
        assert found.residual.max() < 1e-8
        assert found.complete
        assert "pose" in found.goal_parts or set(found.goal_parts) <= set(value)


@settings(max_examples=20, deadline=None)
@given(slides=st.integers(1, 3), seed=st.integers(0, 10**6))
def test_arms_that_slide_point_somewhere_from_somewhere(slides, seed):
    rng = np.random.default_rng(seed)
    robot = random_arm("".join(rng.permutation(list("P" * slides + "R" * (5 - slides)))), rng)
    q = rng.uniform(-1, 1, 5)
    T = robot.fk(q)
    found = robot.ik(position=T[:3, 3], direction=T[:3, 2])
    assert gaps(robot, found.q, q).min() < 1e-6


def test_the_numbers_of_solutions_are_those_of_a_search():
    """Newton's method from many starts finds no further configuration of a five-joint arm."""
    rng = np.random.default_rng(4)
    robot = random_arm("RRRRR", rng)
    q = rng.uniform(-np.pi, np.pi, 5)
    value, miss = met_by("position and direction", robot.fk(q))
    found = robot.ik(**value)
    seen = []
    for start in rng.uniform(-np.pi, np.pi, (300, 5)):
        x = start.copy()
        for _ in range(40):
            T, J = robot.fk(x), robot.jacobian(x)
            e = np.r_[value["position"] - T[:3, 3], np.cross(T[:3, 2], value["direction"])]
            across = np.eye(3) - np.outer(T[:3, 2], T[:3, 2])
            A = np.vstack([J[:3], across @ J[3:]])
            x = x + np.clip(np.linalg.lstsq(A, e, rcond=1e-9)[0], -0.3, 0.3)
        if miss(robot.fk(x)) < 1e-10:
            seen.append(x)
    assert len(seen) > 50
    assert max(gaps(robot, found.q, x).min() for x in seen) < 1e-6


def test_many_goals_in_one_call():
    rng = np.random.default_rng(5)
    robot = random_arm("RRRRR", rng)
    T = robot.fk(rng.uniform(-2, 2, (7, 5)))
    batch = robot.ik(position=T[:, :3, 3], direction=T[:, :3, 2])
    assert (batch.count > 0).all()
    assert np.nanmax(batch.residual) < 1e-8
    for i in range(7):
        one = robot.ik(position=T[i, :3, 3], direction=T[i, :3, 2])
        assert len(one) == batch.count[i] == len(batch[i])
        assert np.abs(np.sin((one.q - batch.q[i, : len(one)]) / 2)).max() < 1e-7
        assert batch[i].goal_parts["position"].shape == (3,)


def test_the_derivatives_of_many_goals_are_those_of_each():
    robot = random_arm("RRRRR", np.random.default_rng(4))
    T = robot.fk(np.random.default_rng(5).uniform(-1.5, 1.5, (4, 5)))
    b = robot.ik(position=T[:, :3, 3], direction=T[:, :3, 2])
    assert b.count.min() >= 1
    for i, k in enumerate(b.count):
        one = robot.ik(position=T[i, :3, 3], direction=T[i, :3, 2]).derivative
        np.testing.assert_allclose(b.derivative[i, :k], one, rtol=1e-6, atol=1e-9)
        assert np.isnan(b.derivative[i, k:]).all()


@pytest.mark.parametrize("joint", ["wrist_1_joint", 3, "goal_tool_turn_x"])
def test_a_drill_with_a_joint_held_leaves_nothing_open(joint):
    robot = cs.load_robot("ur5e")
    q = np.array([0.3, -1.2, 1.4, -0.8, 0.7, 0.1])
    T = robot.fk(q)
    keywords = {"position": T[:3, 3], "direction": T[:3, 0], "tool_axis": "x"}
    value = q[3]
    if joint == "goal_tool_turn_x":  # the one that takes T to the solver's own pose of the goal
        gap = T[:3, :3].T @ robot.ik(**keywords).goal[:3, :3]
        value = float(np.arctan2(gap[2, 1], gap[1, 1]))
    s = robot.ik(**keywords, locked={joint: value})
    assert s.freedom == ()
    assert gaps(robot, s.q, q).min() < 1e-9
    assert s.residual.max() < 1e-9
    near = robot.ik(**keywords, locked={joint: value}, near=q)
    assert gaps(robot, near.q, q).max() < 1e-9
    if joint != "goal_tool_turn_x":
        assert np.abs(s.q[:, 3] - value).max() == 0


def test_a_drill_is_sampled_at_as_many_turns_as_are_wanted():
    robot = cs.load_robot("ur5e")
    s = robot.ik(position=[0.4, 0.1, 0.3], direction=[0, 0, -1], samples=3)
    assert "at 3 values of goal_tool_turn_z" in s.reason
    x = robot.fk(s.q)[:, :3, 0]
    assert len({round(float(np.arctan2(*v[1::-1])), 6) for v in x}) == 3
    two = robot.ik(position=[[0.4, 0.1, 0.3], [0.3, 0.3, 0.3]], direction=[0, 0, -1], samples=3)
    np.testing.assert_allclose(two.q[0, : two.count[0]], s.q, atol=1e-12)
    with pytest.raises(InputTypeError, match="full pose"):
        robot.ik(position=[0.4, 0.1, 0.3], direction=[0, 0, -1], swivel=0.1)


def test_what_the_axes_rule_out_is_certified():
    scara = cs.load_robot("scara")
    p = scara.fk([0.3, 0.5, 0.1, 0.2])[:3, 3]
    for keywords in (
        {"rotation": np.eye(3)},
        {"position": p, "direction": [0, 1, 0]},
        {"position": [5, 5, 0]},
    ):
        s = scara.ik(**keywords)
        assert not s
        assert s.complete
        assert "cannot reach" in s.reason
        assert s.goal_parts.keys() == keywords.keys()


def test_a_direction_too_short_to_square_is_a_direction():
    robot = cs.load_robot("ur5e")
    p = [0.4, 0.1, 0.3]
    tiny = robot.ik(position=p, direction=[0, 0, -1e-200])
    np.testing.assert_array_equal(tiny.q, robot.ik(position=p, direction=[0, 0, -1]).q)


def test_angles_of_a_loop_do_not_pile_up():
    robot = cs.load_robot("ur5e")
    for angle in np.linspace(0.1, 1.0, 40):
        assert robot.ik(position=[0.4, 0.1, 0.3], angle_to=("z", angle), near=np.zeros(6))
    assert len(robot.solver._extended) <= 32


def test_the_reason_counts_the_rows_and_names_what_is_free():
    scara = cs.load_robot("scara")
    T = scara.fk([0.3, 0.5, 0.1, 0.2])
    s = scara.ik(position=T[:3, 3])
    assert s.reason.startswith(f"{len(s)} configurations reach the goal, at 16 values of {s.freedom[0]}")
    ur5e = cs.load_robot("ur5e")
    s = ur5e.ik(position=[0.4, 0.1, 0.3])
    assert s.reason.startswith(
        "1 of the configurations that reach the goal, which leaves 3 dimensions free: "
    )
    assert s.reason.endswith(", ".join(s.freedom))
    b = ur5e.ik(position=[[0.4, 0.1, 0.3], [0.4, 0.2, 0.3]])
    assert (b.freedom, b[0].freedom) == (s.freedom, s.freedom)


def test_an_arm_in_the_plane_takes_a_point_and_an_angle():
    T_zero = np.eye(4)
    T_zero[:3, 3] = [1.1, 0, 0.2]
    robot = cs.Robot.from_screws([[0, 0, 1]] * 3, [[0, 0, 0], [0.5, 0, 0], [0.9, 0, 0]], T_zero)
    q = np.array([0.4, -0.9, 0.3])
    T = robot.fk(q)
    found = robot.ik(position=T[:2, 3], angle=q.sum())
    assert len(found) == 2
    assert gaps(robot, found.q, q).min() < 1e-9
    many = robot.ik(position=np.stack([T[:2, 3]] * 3), angle=[q.sum()] * 3)
    assert (many.count == 2).all()


def test_what_no_configuration_meets_is_said():
    robot = random_arm("RRRRR", np.random.default_rng(6))
    found = robot.ik(position=[50.0, 0, 0], direction=[0, 0, 1])
    assert not found
    assert found.status == "unreachable"
    assert "the position and the direction of the tool axis" in found.reason
    assert found.out_of_reach > 40
    best = robot.ik(position=[50.0, 0, 0], direction=[0, 0, 1], least_squares=True)
    assert best.status == "least_squares"
    assert len(best.q) == 1
    assert best.residual[0] > 40


def test_a_five_joint_arm_asked_for_a_pose_says_why_not_and_comes_close():
    robot = cs.load_robot("so101")
    T = robot.fk(np.full(5, 0.3))
    T[:3, :3] = cs.spatial.exp_so3([0.0, 0.3, 0.4]) @ T[:3, :3]
    found = robot.ik(T)
    assert not found
    assert "5 joints" in found.reason
    assert found.out_of_reach > 0.01
    assert robot.ik(T, least_squares=True).status == "least_squares"


def test_filters_keep_what_was_asked():
    rng = np.random.default_rng(7)
    robot = random_arm("RRRRR", rng)
    T = robot.fk(rng.uniform(-2, 2, 5))
    found = robot.ik(position=T[:3, 3], direction=T[:3, 2])
    near = found.nearest(np.zeros(5))
    assert near.goal_parts.keys() == {"position", "direction"}
    assert near.residual.max() < 1e-8
    assert len(found.within()) == len(found)
    slope = found.derivative
    assert slope.shape == (len(found), 5, 6)


@pytest.mark.parametrize(
    ("keywords", "error", "words"),
    [
        ({"direction": [0, 0, 0]}, InputError, "direction is zero"),
        ({"direction": [0, 0, 1], "look_at": [1, 0, 0]}, InputTypeError, "cannot be combined"),
        ({"position": (None, None, None)}, InputError, "at least one of them"),
        ({"position": (0.1, None)}, InputError, "is not a planar arm"),
        ({"position": (0.1, None, 0), "rotation": np.eye(3)}, InputTypeError, "needs three coordinates"),
        ({"position": (0.1, None, 0), "direction": [0, 0, 1]}, InputTypeError, "needs three coordinates"),
        ({"position": [0.1, np.nan, 0.2], "direction": [0, 0, 1]}, InputError, "finite"),
        ({"ray": [1, 2, 3]}, InputTypeError, "pair"),
        ({"position": [0.1, 0, 0.2], "angle_to": ("w", 0.2)}, InputError, "axis 'w'"),
        ({"position": [0.1, 0, 0.2], "angle_to": ("x", 4.0)}, InputError, "0 to π"),
        ({"rotation": np.ones((3, 3))}, InputError, "rotation"),
        ({"direction": [0, 0, 1], "tool_axis": "up"}, InputError, "axis 'up'"),
        ({"direction": [0, 0, 1], "tool_axis": "--x"}, InputError, "axis '--x'"),
        ({"direction": [0, 0, 1], "tool_axis": np.eye(3)}, InputError, "tool_axis has shape"),
        ({"direction": [0, 0, 1], "tool_axis": np.empty((0, 3))}, InputError, "tool_axis has shape"),
        ({"position": [0.1, 0, 0.2], "tool_axis": "x"}, InputTypeError, "tool_axis= can only be combined"),
        ({"goal": np.eye(4), "tool_axis": "x"}, InputTypeError, "tool_axis= can only be combined"),
        ({"position": np.ones((2, 3)), "direction": np.ones((3, 3))}, InputError, r"position \(2,\) and dir"),
        ({"position": np.ones((2, 3)), "rotation": [np.eye(3)] * 3}, InputError, r"position \(2,\) and rot"),
        ({"ray": (np.ones((2, 3)), np.ones((3, 3)))}, InputError, r"ray\[0\] \(2,\) and ray\[1\] \(3,\)"),
        ({"position": [0.1, 0, 0.2], "angle_to": ("x", [0.1, 0.2])}, InputError, "one angle"),
        ({"position": [0.1, 0, 0.2], "angle_to": (np.eye(3), 0.1)}, InputError, r"angle_to\[0\] has shape"),
        ({"angle": 0.3}, InputTypeError, "angle= can only be combined"),
        ({}, InputTypeError, "one goal"),
    ],
)
def test_goals_that_make_no_sense(keywords, error, words):
    robot = random_arm("RRRRR", np.random.default_rng(8))
    with pytest.raises(error, match=words):
        robot.ik(**keywords)


def test_points_and_angles_that_do_not_fit_together():
    planar = cs.load_robot("planar_3r")
    with pytest.raises(InputError, match=r"position \(3,\) and angle \(2,\)"):
        planar.ik(position=np.ones((3, 2)), angle=[0.1, 0.2])


def test_points_beyond_all_numbers_are_refused_without_overflow():
    with np.errstate(all="raise"), pytest.raises(InputError, match="position lies at"):
        cs.load_robot("planar_2r").ik(position=[1e308, 1e308, 1e308])


@pytest.mark.parametrize("keywords", [{"position": [1, 0, 0]}, {"direction": [0, 0, 1]}])
def test_robots_whose_poses_have_no_answer_have_none_for_parts_of_them(keywords):
    floating = cs.Robot(cs.load_robot("ur5e").description, floating=True)
    links = tuple(Link(name) for name in "abc")
    lead = Joint("lead", "continuous", "a", "b", axis=(0, 0, 1))
    follow = Joint("follow", "continuous", "b", "c", cs.pose([1, 0, 0]), (0, 0, 1), mimic=Mimic("lead", 2.0))
    mimic = cs.Robot(Description("mimic", links, (lead, follow)))
    still = cs.Robot(Description("still", links[:1], ()))
    for robot, words in ((floating, "base is floating"), (mimic, "mimic"), (still, "no joint moves")):
        with pytest.raises(NoClosedFormError, match=words):
            robot.ik(**keywords)
        plan = robot.ik_plan(goal_parts=tuple(keywords))
        assert not plan
        assert words in plan.reason


def test_a_turn_from_one_direction_to_another():
    rng = np.random.default_rng(9)
    a = unit(np.array([1.0, 2, -0.5]))
    d = np.array([unit(v) for v in rng.normal(size=(100, 3))])
    d[:4] = a, -a, unit(-a + 1e-7), unit(a + 1e-9)
    R = turn_to(a, d)
    assert np.abs(R @ a - d).max() < 1e-14
    assert np.abs(R @ R.transpose(0, 2, 1) - np.eye(3)).max() < 1e-14
    assert (np.linalg.det(R) > 0).all()


@pytest.mark.parametrize("goal", GOALS)
@pytest.mark.parametrize("name", ["ur5e", "jaco2", "panda"])
def test_near_keeps_a_seed_that_meets_the_goal_and_goes_no_farther_than_one_that_does(name, goal):
    robot, rng = cs.load_robot(name), np.random.default_rng([4, *map(ord, name + goal)])
    for q in robot.random_configuration(6, rng=rng):
        asked = GOALS[goal][1](robot.fk(q))
        kept = robot.ik(**asked, near=q)
        assert gaps(robot, kept.q, q).max() < 1e-6
        seed = q + rng.uniform(-0.1, 0.1, robot.dof)
        near = robot.ik(**asked, near=seed)
        way = np.linalg.norm((near.q[0] - seed + np.pi) % (2 * np.pi) - np.pi)
        assert way <= np.linalg.norm(q - seed) + 1e-6


def test_a_joint_is_held_once_and_at_one_value():
    robot = cs.load_robot("ur5e")
    with pytest.raises(InputError, match="'shoulder_pan_joint' twice"):
        robot.ik(position=[0.4, 0.1, 0.3], locked={0: 0.1, "shoulder_pan_joint": 0.2})
    with pytest.raises(InputTypeError, match="one number"):
        robot.ik(position=[0.4, 0.1, 0.3], direction=[0, 0, -1], locked={0: [0.1, 0.2]})


def test_a_point_of_the_plane_may_leave_one_coordinate_open():
    robot = cs.load_robot("planar_3r")
    p = robot.fk([0.3, 0.5, -0.4])[:3, 3]
    for position in [(p[0], None), (None, p[1])]:
        found = robot.ik(position=position)
        asked = 0 if position[1] is None else 1
        assert found
        np.testing.assert_allclose(robot.fk(found.q)[:, asked, 3], p[asked], atol=1e-9)
    with pytest.raises(InputError, match="all three"):
        robot.ik(position=(None, None))


@pytest.mark.parametrize("name", ["ur5e", "jaco2", "panda"])
@pytest.mark.parametrize("far", [3.0, 30.0, 1000.0, 1e5])
def test_a_point_to_look_at_and_a_ray_may_be_far_away(name, far):
    robot, rng = cs.load_robot(name), np.random.default_rng(8)
    for _ in range(5):
        target = far * rng.normal(size=3)
        target *= far / np.linalg.norm(target)
        for options in ({}, {"near": rng.uniform(-1, 1, robot.dof)})[: 1 if far > 1e3 else 2]:
            found = robot.ik(look_at=target, **options)
            T = robot.fk(found.q[0])
            away = target - T[:3, 3]
            np.testing.assert_allclose(T[:3, 2], away / np.linalg.norm(away), atol=1e-9)
        T = robot.fk(rng.uniform(-1, 1, robot.dof))
        assert robot.ik(ray=(T[:3, 3] + far * T[:3, 2], T[:3, 2]))


def test_the_reason_of_a_ray_out_of_reach_says_how_far_away_it_is():
    robot = cs.load_robot("ur5e")
    for along in (0.0, 7.0):
        found = robot.ik(ray=([5, 0, along], [0, 0, 1]))
        best = robot.ik(ray=([5, 0, along], [0, 0, 1]), least_squares=True)
        assert not found
        np.testing.assert_allclose([found.out_of_reach, best.residual[0]], 4.0735, atol=1e-3)
        assert "misses it by 4.073 m" in found.reason
        assert "misses it by 4.073 m" in best.reason


@pytest.mark.parametrize("name", ["ur5e", "jaco2", "puma560"])
def test_the_freedom_of_a_partial_goal_has_feasible_intervals(name):
    robot, rng = cs.load_robot(name), np.random.default_rng(2)
    q = rng.uniform(-1, 1, robot.dof)
    T = robot.fk(q)
    goal = {"position": T[:3, 3], "direction": T[:3, 2]}
    for parameter in (None, robot.dof - 1, robot.joint_names[-1]):
        found = robot.redundancy(**goal, parameter=parameter)
        assert found
        for interval in found:
            at = robot.fk(interval.q)
            np.testing.assert_allclose(at[:3, 3], T[:3, 3], atol=1e-8)
            np.testing.assert_allclose(at[:3, 2], T[:3, 2], atol=1e-8)
    assert robot.redundancy(**goal, parameter=robot.dof - 1).feasible(q[-1])
    with pytest.raises(InputTypeError, match="one goal"):
        robot.redundancy()
    with pytest.raises(InputTypeError, match="no keyword 'postion'"):
        robot.redundancy(postion=T[:3, 3])


def test_a_ray_beyond_the_limits_of_a_slide_is_answered_as_other_goals_are():
    axes, points = [[0, 0, 1], [0, 1, 0], [1, 0, 0], [0, 0, 1], [0, 1, 0]], np.zeros((5, 3))
    tip = cs.pose([0.2, 0.1, 0.3])
    lower, upper = [-3, -3, -0.5, -3, -3], [3, 3, 0.5, 3, 3]
    robot = Robot(
        from_screws(axes, points, tip, joint_types="RRPRR", lower=lower, upper=upper, name="reacher")
    )
    T = robot.fk([0.3, -0.4, 6.0, 0.5, 0.7])
    found = robot.ik(ray=(T[:3, 3], T[:3, 2]))
    assert found or not found.complete


def test_rays_of_an_arm_whose_axes_are_parallel_to_six_digits():
    """The ray must lie in the plane of the links; rounding leaves a valley, whose floor alone reaches it."""
    robot = cs.load_robot("so101")
    for T in robot.fk(robot.random_configuration(12, rng=3)):
        found = robot.ik(ray=(T[:3, 3] + 0.05 * T[:3, 2], T[:3, 2]))
        assert found
        assert np.abs(np.cross(robot.fk(found.q[0])[:3, 2], T[:3, 2])).max() < 1e-9
        away = robot.fk(found.q[0])[:3, 3] - T[:3, 3]
        assert np.abs(np.cross(away, T[:3, 2])).max() < 1e-9
