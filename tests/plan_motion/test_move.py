"""From a configuration to a goal in time: free all along, within limits, at the goal."""

import numpy as np
import pytest

import cspace as cs
from cspace.errors import InputError
from cspace.plan_motion.motions import find_excess

START = np.array([0.0, -0.5, 0.0, -2.0, 0.0, 1.6, 0.8])


def without_jerk(limits):
    return cs.Limits(limits.lower, limits.upper, limits.velocity, limits.acceleration)


def shelf():
    return cs.Scene(
        [
            cs.Box((0.05, 0.8, 0.6), (0.45, 0.0, 0.3), name="wall"),
            cs.Sphere(0.08, (0.3, 0.4, 0.5), name="ball"),
        ]
    )


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("deviation", [0.0, 0.3])
def test_a_motion_is_free_within_limits_and_ends_at_its_goal(deviation, seed):
    robot, scene = cs.load_robot("panda"), shelf()
    rng = np.random.default_rng(seed)
    goals = robot.random_configuration(40, rng=rng, reach=0.8)
    goals = goals[~cs.collision.collides(robot, goals, scene)][:2]
    for goal in goals:
        motion = cs.move(robot, START, goal, scene, deviation=deviation)
        assert motion, motion.reason
        assert motion.check(without_jerk(robot.limits))
        np.testing.assert_allclose(motion(0.0), START, atol=1e-12)
        np.testing.assert_allclose(motion(motion.duration), goal, atol=1e-9)
        t = np.linspace(0, motion.duration, 4001)
        assert not cs.collision.collides(robot, motion(t), scene).any()
        assert motion.checked >= 1000 * motion.duration
        if deviation == 0.0:
            assert len(motion.path.stops) <= len(motion.plan.path) - 2
        gaps = np.linalg.norm(motion(t)[None] - motion.plan.path[:, None], axis=2).min(axis=1)
        assert (gaps <= motion.deviations + 1e-3).all()


@pytest.mark.parametrize("seed", range(2))
def test_jerks_are_kept_too(seed):
    robot, scene = cs.load_robot("panda"), shelf()
    rng = np.random.default_rng(seed)
    goals = robot.random_configuration(40, rng=rng, reach=0.8)
    goal = goals[~cs.collision.collides(robot, goals, scene)][0]
    motion = cs.move(robot, START, goal, scene, jerk=True)
    assert motion, motion.reason
    assert motion.check(robot.limits)
    np.testing.assert_allclose(motion(motion.duration), goal, atol=1e-9)
    np.testing.assert_allclose(motion([0.0, motion.duration], 2), 0.0, atol=1e-6)
    assert motion.duration > cs.move(robot, START, goal, scene).duration


def test_rounded_corners_are_faster():
    robot, scene = cs.load_robot("panda"), shelf()
    goal = robot.fk(np.array([1.2, 0.3, 0.2, -1.8, 0.1, 2.0, 0.5]))
    sharp, rounded = (cs.move(robot, START, goal, scene, deviation=d) for d in (0.0, 0.4))
    assert sharp
    assert rounded
    if len(rounded.plan.path) > 2:
        assert rounded.duration < sharp.duration


def test_torques_are_kept():
    robot = cs.load_robot("panda")
    goal = np.array([1.2, 0.3, 0.2, -1.2, 0.1, 2.0, 0.5])
    weak = 0.5 * robot.limits.effort
    free, bound = (cs.move(robot, START, goal, acceleration=60.0, torque=torque) for torque in (None, weak))
    assert bound
    t = np.linspace(0, bound.duration, 3001)
    tau = robot.inverse_dynamics(*(bound(t, order) for order in range(3)))
    assert (np.abs(tau) <= weak * (1 + 1e-6)).all()
    assert bound.duration > free.duration


def test_where_there_is_no_motion_it_says_why():
    robot = cs.load_robot("panda")
    far = cs.pose((3.0, 0, 0))
    none = cs.move(robot, START, far)
    assert not none
    assert "no IK solution" in none.reason
    assert cs.move(robot, START, START).duration == 0.0
    with pytest.raises(InputError, match="deviation"):
        cs.move(robot, START, START + 0.1, deviation=-1)
    with pytest.raises(InputError, match="pass acceleration="):
        cs.move(cs.load_robot("ur5e"), np.array([0, -1, 1, 0, 1, 0]), np.array([0.2, -1, 1, 0, 1, 0]))


@pytest.mark.parametrize("name", ["velocity", "acceleration", "jerk", "torque", "speed", "turn_rate"])
def test_the_last_check_finds_every_limit_that_is_exceeded(name):
    """It stands on its own: a motion that was timed with other limits is caught, wherever it exceeds one."""
    robot = cs.load_robot("panda")
    rng = np.random.default_rng(7)
    path = cs.spline(START + rng.uniform(-0.4, 0.4, (4, 7)))
    motion = cs.time_parametrize(path, robot, jerk=True)
    t = np.linspace(0.0, motion.duration, 2001)
    q, qd, qdd, jerk = (motion(t, order) for order in range(4))
    twist = np.einsum("kij,kj->ki", robot.jacobian(q), qd)
    values = {
        "velocity": np.abs(qd),
        "acceleration": np.abs(qdd),
        "jerk": np.abs(jerk),
        "torque": np.abs(robot.inverse_dynamics(q, qd, qdd)),
        "speed": np.linalg.norm(twist[:, :3], axis=1)[:, None],
        "turn_rate": np.linalg.norm(twist[:, 3:], axis=1)[:, None],
    }[name]
    most = values.max(axis=0)
    single = name in ("speed", "turn_rate")
    enough = {name: float(most[0]) if single else most}
    assert find_excess(robot, motion, t, q, {"jerk": True}) == ""
    assert find_excess(robot, motion, t, q, enough) == ""
    for j in range(values.shape[1]):
        less = np.array(most)
        less[j] *= 0.999
        fault = find_excess(robot, motion, t, q, {name: float(less[0]) if single else less})
        first = t[np.argmax(values[:, j] > less[j] * (1 + 1e-6))]
        assert f"{'the tip' if single else robot.joint_names[j]} exceeds its {name} limit" in fault
        assert f"at {first:.6g} s" in fault


@pytest.mark.parametrize("seed", range(3))
def test_limits_of_every_kind_pass_the_last_check(seed):
    robot, rng = cs.load_robot("panda"), np.random.default_rng(seed)
    goals = robot.random_configuration(40, rng=rng, reach=0.8)
    goal = goals[~cs.collision.collides(robot, goals, shelf())][0]
    for options in (
        {"jerk": True, "torque": True},
        {"velocity": 0.5, "speed": 0.3, "turn_rate": 1.0},
        {"acceleration": 60.0, "torque": 0.6 * robot.limits.effort},
    ):
        motion = cs.move(robot, START, goal, shelf(), **options)
        assert motion, motion.reason
