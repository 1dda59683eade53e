"""The dynamic window among obstacles: within limits, without contact, honest where it comes no farther."""

import numpy as np
import pytest

import cspace as cs
from cspace.errors import InputError, InputTypeError
from navigation.following.test_following import check_limits

nav = cs.navigation
ROBOT = nav.Unicycle(max_speed=1.0, acceleration=0.8, max_turn_rate=1.5, turn_acceleration=3.0, radius=0.25)


def clearance(path, blocked, resolution):
    """The least distance of a path (m, 2) from the blocked cells and the outside."""
    walls = np.argwhere(np.pad(blocked, 1, constant_values=True))[:, ::-1] - 0.5
    gap = np.maximum(np.abs(path[:, None] / resolution - walls[None]) - 0.5, 0) * resolution
    return np.hypot(gap[..., 0], gap[..., 1]).min()


def finely(run):
    """The path with nine points between every two of the simulator."""
    steps = np.arange(10)[:, None] / 10
    return np.concatenate([a + steps * (b - a) for a, b in zip(run.path[:-1], run.path[1:], strict=True)])


@pytest.mark.parametrize("seed", range(12))
def test_obstacles_that_the_path_does_not_know_are_passed_or_the_robot_is_stuck(seed):
    rng = np.random.default_rng(seed)
    resolution, blocked = 0.1, np.zeros((60, 120), bool)
    for _ in range(10):
        r, c = rng.integers(2, 55), rng.integers(20, 95)
        blocked[r : r + rng.integers(1, 7), c : c + rng.integers(1, 7)] = True
    run = nav.follow(
        [[0.8, 3.0], [11.0, 3.0]],
        "dynamic_window",
        vehicle=ROBOT,
        world=cs.OccupancyGrid(blocked, resolution=resolution),
        tolerance=0.2,
    )
    check_limits(run)
    assert run.status in ("arrived", "stuck", "missed"), run.reason
    assert clearance(finely(run), blocked, resolution) >= ROBOT.radius - 2e-3


def test_most_fields_are_crossed():
    arrived = 0
    for seed in range(12):
        rng = np.random.default_rng(100 + seed)
        blocked = np.zeros((60, 120), bool)
        for _ in range(8):
            r, c = rng.integers(2, 55), rng.integers(20, 95)
            blocked[r : r + 3, c : c + 3] = True
        world = cs.OccupancyGrid(blocked, resolution=0.1)
        arrived += bool(
            nav.follow([[0.8, 3], [11, 3]], "dynamic_window", vehicle=ROBOT, world=world, tolerance=0.2)
        )
    assert arrived >= 10


def test_without_a_world_it_follows_the_path():
    run = nav.follow([[0, 0], [5, 0], [8, 3]], "dynamic_window", vehicle=ROBOT, tolerance=0.2)
    assert run, run.reason
    check_limits(run)


def test_a_trap_is_told():
    """A pocket that opens towards the robot: the path goes through its floor."""
    blocked = np.zeros((60, 100), bool)
    blocked[20:41, 60] = blocked[20, 40:61] = blocked[40, 40:61] = True
    world = cs.OccupancyGrid(blocked, resolution=0.1)
    run = nav.follow(
        [[1, 3], [9, 3]], "dynamic_window", vehicle=ROBOT, world=world, tolerance=0.2, patience=5.0
    )
    assert not run
    assert run.status == "stuck"
    assert "no farther" in run.reason
    assert clearance(finely(run), blocked, 0.1) >= ROBOT.radius - 2e-3


@pytest.mark.parametrize("controller", ["pure_pursuit", "stanley"])
def test_controllers_that_see_nothing_run_into_walls_and_say_so(controller):
    blocked = np.zeros((30, 60), bool)
    blocked[:, 40] = True
    vehicle = nav.Car(wheelbase=0.5, length=0.8, width=0.4, rear=0.1, max_speed=1.0)
    world = cs.OccupancyGrid(blocked, resolution=0.1)
    run = nav.follow([[0.5, 1.5], [5.5, 1.5]], controller, vehicle=vehicle, world=world)
    assert run.status == "collision"
    assert "touched" in run.reason
    front = run.poses[:, 0] + 0.7
    assert front[-2] <= 4.0 + 1e-9 < front[-1]


def test_a_path_of_a_planner_is_followed_without_contact():
    blocked = np.zeros((60, 60), bool)
    blocked[:40, 20] = blocked[20:, 40] = True
    world = cs.OccupancyGrid(blocked, resolution=0.1)
    route = cs.navigate(world, (0.5, 0.5), (5.5, 5.5), "a_star", radius=0.4)
    run = nav.follow(route, vehicle=ROBOT, world=world, speed=0.4, lookahead=0.2, tolerance=0.1)
    assert run, run.reason
    again = nav.follow(route, "dynamic_window", vehicle=ROBOT, world=world, lookahead=0.5, tolerance=0.2)
    assert again, again.reason
    assert clearance(finely(again), blocked, 0.1) >= ROBOT.radius - 2e-3


def test_what_is_no_question_is_refused():
    line = [[0, 0], [1, 0]]
    with pytest.raises(InputTypeError, match="OccupancyGrid"):
        nav.follow(line, world=np.zeros((3, 3)))
    with pytest.raises(InputTypeError, match="Unicycle"):
        nav.follow(line, "dynamic_window", vehicle=nav.Car())
    with pytest.raises(InputTypeError, match="lookahead"):
        nav.follow(line, look_ahead=1.0)
    with pytest.raises(InputError, match="weights"):
        nav.follow(line, "dynamic_window", weights=(1, 2))
    with pytest.raises(InputError, match="margin"):
        nav.follow(line, "dynamic_window", margin=-1)


@pytest.mark.parametrize("controller", ["pure_pursuit", "dynamic_window"])
@pytest.mark.parametrize("planner", ["dijkstra", "fast_marching"])
def test_who_stays_within_the_tolerance_has_arrived(planner, controller):
    """A vehicle that comes no farther is stuck where the end is out of reach, not where it is at the end."""
    arrived = 0
    for seed in range(12):
        rng = np.random.default_rng(seed)
        blocked = np.zeros((60, 60), dtype=bool)
        row, column = rng.integers(10, 44, 2)
        blocked[row : row + 5, column : column + 5] = True
        world, ends = cs.OccupancyGrid(blocked, 0.1), rng.uniform(0.4, 5.6, (2, 2))
        if not world.is_free(ends).all() or not (route := cs.navigate(world, *ends, planner=planner)):
            continue
        for patience in (0.25, 10.0):
            run = nav.follow(route, controller, world=world, patience=patience)
            missing = np.hypot(*(run.path[-1] - route.path[-1]))
            assert run.status != "stuck" or missing > 0.05
            arrived += run.status == "arrived"
    assert arrived > 4
