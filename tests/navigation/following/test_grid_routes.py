"""Following the routes of planners on grids: at the end, or with a reason."""

import numpy as np
import pytest

import cspace as cs

nav = cs.navigation
PLANNERS = ["a_star", "dijkstra", "theta_star", "jump_point_search", "wavefront", "d_star_lite"]
TURNING = [nav.Unicycle(), nav.Unicycle(max_speed=2.0), nav.Unicycle(max_speed=0.3, max_turn_rate=0.8)]
CARS = [
    nav.Car(),
    nav.Car(wheelbase=0.3, max_speed=1.0, length=0.5, width=0.3, rear=0.1),
    nav.Car(wheelbase=2.5, max_speed=4.0, max_steering=0.55, steering_rate=1.0),
]


def blocked_cells(rng, n):
    """Single cells, boxes, or walls with two gaps each."""
    blocked = np.zeros((n, n), dtype=bool)
    kind = rng.integers(3)
    if kind == 0:
        return rng.random((n, n)) < 0.2
    if kind == 1:
        for i, j in rng.integers(0, n, (n // 4, 2)):
            blocked[i : i + rng.integers(1, 6), j : j + rng.integers(1, 6)] = True
        return blocked
    for i in range(3, n - 1, 4):
        blocked[i] = True
        for j in rng.integers(0, n - 2, 2):
            blocked[i, j : j + 2] = False
    return blocked


def routes(seed, n):
    """Routes between places anywhere in free cells, of resolutions from 5 cm to 1 m."""
    rng, found = np.random.default_rng(seed), []
    while len(found) < n:
        cells = blocked_cells(rng, int(rng.integers(12, 40)))
        resolution = rng.choice([0.05, 0.1, 0.25, 0.5, 1.0])
        free = np.argwhere(~cells)[:, ::-1]
        ends = resolution * (free[rng.integers(len(free), size=2)] + rng.uniform(0.02, 0.98, (2, 2)))
        world = cs.OccupancyGrid(cells, resolution=resolution)
        route = nav.navigate(world, *ends, planner=str(rng.choice(PLANNERS)))
        if route and route.length > 0:
            found.append(route)
    return found


@pytest.mark.parametrize("controller", ["pure_pursuit", "dynamic_window"])
@pytest.mark.parametrize("vehicle", TURNING, ids=["usual", "fast", "slow"])
def test_who_turns_on_the_spot_always_arrives(controller, vehicle):
    for route in routes(0, 40):
        run = nav.follow(route, controller, vehicle=vehicle)
        assert run, (route.planner, run.reason)
        assert np.hypot(*(run.path[-1] - route.path[-1])) <= 0.05


@pytest.mark.parametrize("controller", ["pure_pursuit", "stanley"])
@pytest.mark.parametrize("vehicle", CARS, ids=["usual", "model", "large"])
def test_a_car_arrives_or_says_which_bend_is_too_tight(controller, vehicle):
    arrived = 0
    for route in routes(1, 60):
        run = nav.follow(route, controller, vehicle=vehicle)
        arrived += bool(run)
        if not run:
            named = "radius" in run.reason or (controller == "stanley" and "rear axle" in run.reason)
            assert named, run.reason
    assert arrived >= (45 if controller == "pure_pursuit" else 30)


@pytest.mark.parametrize("angle", np.linspace(-3, 3, 7))
def test_a_short_stub_at_the_end_is_no_detour(angle):
    """A centimetre in any direction behind a straight way."""
    path = np.array([[0.0, 0.0], [20.0, 0.0], [20.0 + 0.01 * np.cos(angle), 0.01 * np.sin(angle)]])
    cases = [("pure_pursuit", nav.Unicycle()), ("pure_pursuit", nav.Car()), ("stanley", nav.Car())]
    for controller, vehicle in [*cases, ("dynamic_window", nav.Unicycle())]:
        run = nav.follow(path, controller, vehicle=vehicle)
        assert run, run.reason
        assert run.times[-1] < 2 * (20 / vehicle.max_speed + vehicle.max_speed / vehicle.acceleration)
