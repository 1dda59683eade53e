"""The configuration space of two joints against distances between segments, signed distances of shapes, and
a shortest path on a grid."""

from __future__ import annotations

import pickle

import numpy as np
import pytest
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import dijkstra

import cspace as cs
from planning.two_joints import arms

UNSURE = 1e-9  # of a distance [m]: nearer to contact either verdict is right


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(20))
def test_cells_are_those_of_a_brute_force_over_polygons(seed):
    rng = np.random.default_rng(seed)
    arm = arms.make_arm(rng, limits=bool(seed % 2))
    rings = [arms.star_polygon(rng, 1.8) for _ in range(3)]
    radius = rng.uniform(0, 0.1) if seed % 3 else 0.0
    space = cs.configuration_space(arm, rings, link_radius=radius)
    q = np.stack(np.meshgrid(*space.cells((24, 37)), indexing="ij"), axis=-1).reshape(-1, 2)
    apart = arms.clearance(arms.links_of(arm, q)[..., :2], rings) - radius
    sure = np.abs(apart) > UNSURE
    blocked = space.bitmap((24, 37)).ravel()
    assert blocked.dtype == bool
    np.testing.assert_array_equal(blocked[sure], apart[sure] < 0)
    np.testing.assert_array_equal(space.free(q), ~blocked)
    assert blocked.any() or seed == 3
    np.testing.assert_allclose(space.arm.points(q), arms.links_of(arm, q)[..., :2], atol=1e-12)


@pytest.mark.parametrize("seed", range(10))
def test_an_obstacle_map_names_an_obstacle_that_is_touched(seed):
    rng = np.random.default_rng(100 + seed)
    arm, rings = arms.make_arm(rng), [arms.star_polygon(rng, 1.8) for _ in range(4)]
    space = cs.configuration_space(arm, cs.PolygonWorld(rings))
    found = space.obstacle_map(30)
    np.testing.assert_array_equal(found >= 0, space.bitmap(30))
    q = np.stack(np.meshgrid(*space.cells(30), indexing="ij"), axis=-1)
    for number, ring in enumerate(rings):
        touching = q[found == number]
        if len(touching):
            assert arms.clearance(arms.links_of(arm, touching)[..., :2], [ring]).max() < UNSURE
            assert space.blocked_by(touching[0]) in space.obstacles


def scene_at_random(rng, T):
    """Shapes of every kind around an arm whose plane is z = 0 of a frame T (4, 4)."""

    def place():
        bearing, away = rng.uniform(0, 7), rng.uniform(0.7, 2.0)
        return T @ cs.pose([away * np.cos(bearing), away * np.sin(bearing), rng.uniform(-0.1, 0.1)])

    turned = cs.pose([0, 0, 0], rotvec=rng.uniform(-2, 2, 3))
    return cs.Scene(
        [
            cs.Box(rng.uniform(0.2, 0.7, 3), place() @ turned),
            cs.Sphere(rng.uniform(0.12, 0.3), place()),
            cs.Cylinder(rng.uniform(0.05, 0.3), 0.5, place()),
            cs.Cylinder(0.2, 0.5, place() @ cs.pose([0, 0, 0], rotvec=[np.pi / 2, 0, 0])),
            cs.Capsule(0.15, 0.4, place() @ cs.pose([0, 0, 0], rotvec=[0, np.pi / 2, 0])),
            cs.Capsule(0.15, 0.1, place()),
            cs.Hull(rng.uniform(-0.4, 0.4, (9, 3)), place()),
            cs.HalfSpace([0.3, -1.0, rng.uniform(-0.5, 0.5)], -1.6, T),
            cs.PointCloud(rng.uniform(-0.2, 0.2, (20, 3)), pose=place(), radius=0.06),
        ]
    )


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(12))
def test_a_scene_is_cut_where_the_arm_is_mounted(seed):
    """Links as samples of points against the signed distances of the shapes."""
    rng = np.random.default_rng(200 + seed)
    T = cs.pose(rng.uniform(-3, 3, 3), rotvec=rng.uniform(-3, 3, 3) if seed % 3 else [0, 0, 1.0])
    if seed == 3:
        T[:3, :3] = np.diag([1.0, -1.0, -1.0])  # upside down
    arm, scene = arms.make_arm(rng, place=T), scene_at_random(rng, T)
    space = cs.configuration_space(arm, scene)
    assert space.obstacles == scene.names
    q = rng.uniform(-np.pi, np.pi, (100, 2))
    links = arms.links_of(arm, q)
    np.testing.assert_allclose(space.arm.points(q), links @ space.arm.axes.T, atol=1e-12)
    part = np.linspace(0, 1, 200)[:, None]
    samples = np.concatenate(
        [links[:, None, k] + part * (links[:, None, k + 1] - links[:, None, k]) for k in (0, 1)], axis=1
    )
    nearest = np.min([shape.distance(samples).min(axis=1) for shape in scene], axis=0)
    spacing = space.arm.lengths.max() / 199
    free = space.free(q)
    assert free[nearest > spacing / 2].all()
    assert not free[nearest < -UNSURE].any()
    assert free.any()


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(8))
def test_curves_of_the_boundary_touch_what_they_name(seed):
    rng = np.random.default_rng(300 + seed)
    arm, rings = arms.make_arm(rng, limits=bool(seed % 2)), [arms.star_polygon(rng, 1.8) for _ in range(3)]
    space = cs.configuration_space(arm, rings, link_radius=0.03)
    assert space.boundaries
    for curve in space.boundaries:
        assert curve.points.shape[1] == 2
        assert len(curve.points) > 1
        links = arms.links_of(arm, curve.points)[..., :2]
        apart = arms.clearance(links, rings) - 0.03
        if curve.kind == "limit":
            assert curve.obstacle == ""
            on_limit = np.isclose(curve.points, space.lower) | np.isclose(curve.points, space.upper)
            assert on_limit.any(axis=1).all()
            assert (apart > -1e-7).all()
            continue
        np.testing.assert_allclose(apart, 0, atol=1e-7)
        ring = rings[space.obstacles.index(curve.obstacle)]
        part = links[:, :2] if curve.kind == "link 1" else links[:, 1:]
        touched = arms.distance_to_ring(part[:, 0], part[:, 1], ring)
        np.testing.assert_allclose(touched, 0.03, atol=1e-7)
        tips = arms.to_segments(links[:, 2], ring, np.roll(ring, -1, axis=0)).min(axis=1)
        if curve.kind.startswith("tip"):
            np.testing.assert_allclose(tips, 0.03, atol=1e-7)


def torus_graph(blocked, wraps):
    """The graph of the free cells (n, n) with their eight neighbours, lengths in cells."""
    n = len(blocked)
    cells = np.arange(n * n).reshape(n, n)
    rows, columns, lengths = [], [], []
    for step in ((0, 1), (1, 0), (1, 1), (1, -1)):
        there = np.roll(cells, (-step[0], -step[1]), axis=(0, 1))
        joined = ~blocked & ~blocked.ravel()[there]
        i, j = np.indices((n, n))
        for axis, index in ((0, i), (1, j)):
            if step[axis] and not wraps[axis]:
                beside = index + step[axis]
                joined &= (beside >= 0) & (beside < n)
        rows.append(cells[joined]), columns.append(there[joined])
        lengths.append(np.full(joined.sum(), np.hypot(*step)))
    data = (np.concatenate(lengths), (np.concatenate(rows), np.concatenate(columns)))
    return coo_matrix(data, shape=(n * n, n * n)).tocsr()


@pytest.mark.parametrize("seed", range(8))
def test_paths_are_free_and_hardly_longer_than_on_a_grid(seed):
    rng = np.random.default_rng(400 + seed)
    arm = arms.make_arm(rng)
    space = cs.configuration_space(arm, [arms.star_polygon(rng, 1.8) for _ in range(4)], link_radius=0.02)
    n = 120
    blocked = space.bitmap(n)
    graph = torus_graph(blocked, space.wraps)
    q1, q2 = space.cells(n)
    free = np.argwhere(~blocked)
    start = free[rng.integers(len(free))]
    costs = dijkstra(graph, directed=False, indices=start[0] * n + start[1]) * 2 * np.pi / n
    for goal in free[rng.integers(len(free), size=30)]:
        a, b = np.array([q1[start[0]], q2[start[1]]]), np.array([q1[goal[0]], q2[goal[1]]])
        answer = space.path(a, b)
        cost = costs[goal[0] * n + goal[1]]
        if np.isfinite(cost):
            assert answer, "a path on the grid"
        if not answer:
            assert answer.status == "separate"
            assert not len(answer.path)
            continue
        np.testing.assert_array_equal(answer.path[0], a)
        np.testing.assert_allclose(np.exp(1j * answer.path[-1]), np.exp(1j * b), atol=1e-9)
        assert answer.length < 1.15 * cost + 0.1
        for begin, end in zip(answer.path[:-1], answer.path[1:], strict=True):
            assert space.free(begin + np.linspace(0, 1, 60)[:, None] * (end - begin)).all()


def test_a_ring_of_obstacles_separates_two_halves():
    """The tip of a stretched arm cannot pass a wall that reaches over its whole reach."""
    arm = cs.load_robot("planar_2r")
    walls = [
        [(0.2, -0.05), (2.5, -0.05), (2.5, 0.05), (0.2, 0.05)],
        [(-2.5, -0.05), (-0.2, -0.05), (-0.2, 0.05), (-2.5, 0.05)],
    ]
    space = cs.configuration_space(arm, walls)
    above, below = [np.pi / 2, 0.3], [-np.pi / 2, 0.3]
    answer = space.connected(above, below)
    assert not answer
    assert answer.status == "separate"
    assert "component" in answer.reason
    assert space.connected(above, [np.pi / 2, -0.3])
    assert space.component(above) != space.component(below)
    assert space.component([0.0, 0.0]) is None
    assert all(component.proved for component in space.components)
    for k, component in enumerate(space.components):
        assert space.component(component.point) == k
        assert component.area_bounds[0] <= component.area <= component.area_bounds[1]


def test_areas_of_components_are_those_of_a_bitmap():
    rng = np.random.default_rng(7)
    for _ in range(5):
        space = cs.configuration_space(arms.make_arm(rng), [arms.star_polygon(rng, 1.8) for _ in range(3)])
        whole = (2 * np.pi) ** 2 * (1 - space.bitmap(1000).mean())
        assert sum(c.area for c in space.components) == pytest.approx(whole, rel=2e-3)


def test_every_solution_of_a_position_is_a_goal():
    arm = cs.load_robot("planar_2r")
    wall = [(0.6, 0.8), (1.0, 0.8), (1.0, 1.2), (0.6, 1.2)]
    space = cs.configuration_space(arm, [wall])
    goals = arm.ik(position=[0.2, 1.3, 0.0]).q
    assert len(goals) == 2
    free = space.free(goals)
    answer = space.path([-1.0, 0.2], goals)
    assert answer
    ends = np.exp(1j * goals[free])
    assert np.abs(ends - np.exp(1j * answer.path[-1])).max(axis=1).min() < 1e-9
    none = space.path([-1.0, 0.2], [[np.pi / 4, 0.0], [np.pi / 4, 0.1]])
    assert not none
    assert "obstacle 0" in none.reason


def test_limits_count_unless_they_are_left_out():
    T = np.eye(4)
    T[0, 3] = 2.0
    arm = cs.Robot.from_screws([[0, 0, 1]] * 2, [[0, 0, 0], [1, 0, 0]], T, lower=[-1, -7], upper=[1, 7])
    space = cs.configuration_space(arm, [])
    assert space.blocked_by([1.1, 0]) == "limit"
    assert space.free([0.9, 6.9])
    assert not space.wraps.any()
    assert space.components[0].area == pytest.approx(28.0)
    path = space.path([-0.9, -6.9], [0.9, 6.9])
    np.testing.assert_array_equal(path.path, [[-0.9, -6.9], [0.9, 6.9]])
    whole = cs.configuration_space(arm, [], limits=False)
    assert whole.wraps.all()
    assert whole.free([3.0, 0.0])


def test_nothing_is_free_with_the_base_in_an_obstacle():
    space = cs.configuration_space(cs.load_robot("planar_2r"), [[(-1, -1), (1, -1), (0, 1)]])
    assert space.bitmap(10).all()
    assert space.components == ()
    assert space.boundaries == ()
    with pytest.raises(cs.CspaceError, match=r"q_a \(0, 0\) touches 'obstacle 0'"):
        space.connected([0, 0], [1, 1])


def test_obstacles_out_of_reach_and_no_obstacles_change_nothing():
    arm = cs.load_robot("planar_2r")
    for obstacles in ([], [[(5, 5), (6, 5), (6, 6)]], cs.Scene(), cs.Scene([cs.Box([1, 1, 1], [0, 0, 9])])):
        space = cs.configuration_space(arm, obstacles)
        assert not space.bitmap(20).any()
        assert len(space.components) == 1
        assert space.components[0].area == pytest.approx((2 * np.pi) ** 2)
        assert space.path([3, 3], [-3, -3]).length == pytest.approx(np.hypot(*[2 * np.pi - 6] * 2))


def test_an_arm_whose_joints_coincide_and_one_that_ends_at_its_elbow():
    wall = [[(0.4, -0.1), (0.6, -0.1), (0.6, 0.1), (0.4, 0.1)]]
    for points, tip, angle in (([[0, 0, 0]] * 2, 1.0, "sum"), ([[0, 0, 0], [1, 0, 0]], 1.0, "first")):
        T = np.eye(4)
        T[0, 3] = tip
        space = cs.configuration_space(cs.Robot.from_screws([[0, 0, 1]] * 2, points, T), wall)
        q = np.random.default_rng(1).uniform(-np.pi, np.pi, (500, 2))
        heading = q.sum(axis=1) if angle == "sum" else q[:, 0]
        sweep = np.arctan2(0.1, 0.4)
        blocked = np.abs(np.angle(np.exp(1j * heading))) <= sweep
        np.testing.assert_array_equal(space.free(q), ~blocked)
        assert len(space.components) == 1
        area = 2 * np.pi * (2 * np.pi - 2 * sweep)
        low, high = space.components[0].area_bounds
        assert low - 1e-9 <= area <= high + 1e-9


def test_a_hole_in_a_polygon_is_free():
    outer, inner = (
        3.0 * np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]]),
        2.2 * np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]]),
    )
    space = cs.configuration_space(cs.load_robot("planar_2r"), [[outer, inner]])
    assert not space.bitmap(50).any()


def test_a_height_chooses_the_plane():
    arm = cs.load_robot("planar_2r")
    scene = cs.Scene([cs.Sphere(0.5, [1.2, 0, 0.4])])
    radii = [cs.configuration_space(arm, scene, height=h).sections["sphere_1"][0].radius for h in (0.0, 0.4)]
    np.testing.assert_allclose(radii, [0.3, 0.5])


def test_spaces_and_their_parts_read_well():
    space = cs.configuration_space(cs.load_robot("planar_2r"), [[(0.5, -1), (1, -1), (1, 1)]])
    assert repr(space) == "<ConfigurationSpace of planar_2r, 1 obstacle>"
    assert "Configuration space of planar_2r" in space._repr_html_()
    assert "FreeComponent" in repr(space.components[0])
    assert "BoundaryCurve" in repr(space.boundaries[0])
    again = pickle.loads(pickle.dumps(space.components[0]))
    assert again.area == space.components[0].area
