"""Worlds of polygons: what is read, refused by name, mended, grown, and turned into cells and back."""

from __future__ import annotations

import copy
import json
import math
import pickle

import numpy as np
import pytest

import cspace as cs
from cspace.errors import InputError, InputTypeError, MapError
from cspace.maps import GeometryError
from cspace.navigation.navigate import MOST_DERIVED

BOX = [(4, 4), (6, 4), (6, 6), (4, 6)]
BOUNDS = (0, 0, 10, 10)


def test_a_world_says_what_it_is():
    world = cs.PolygonWorld([BOX], BOUNDS)
    assert world.bounds == BOUNDS
    assert world.components == 1
    assert world.repairs == ()
    assert "1 obstacles" in repr(world)
    np.testing.assert_array_equal(world.obstacles[0][0], BOX)
    assert sorted(len(ring) for ring in world.walls) == [4, 4]


def test_free_points_and_their_clearance():
    world = cs.PolygonWorld([BOX], BOUNDS)
    points = np.array([[[1, 5], [5, 5]], [[4, 5], [11, 5]]])
    np.testing.assert_array_equal(world.is_free(points), [[True, False], [True, False]])
    np.testing.assert_array_equal(world.clearance(points), [[1, 0], [0, 0]])
    assert world.is_free((2, 2))
    assert world.clearance((3, 5)) == 1


def test_without_bounds_there_is_room_around_the_obstacles():
    assert cs.PolygonWorld([BOX]).bounds == (3.5, 3.5, 6.5, 6.5)
    assert cs.PolygonWorld([]).bounds == (0, 0, 1, 1)


@pytest.mark.parametrize("turn", [1, -1])
def test_rings_in_either_direction_closed_or_not(turn):
    ring = BOX[::turn]
    for given in (ring, [*ring, ring[0]], np.array(ring, float), [*ring, ring[-1]]):
        assert cs.PolygonWorld([given], BOUNDS).clearance((1, 5)) == 1


def test_holes_are_free_and_cut_off():
    world = cs.PolygonWorld([[[(2, 2), (8, 2), (8, 8), (2, 8)], BOX]], BOUNDS)
    assert world.components == 2
    assert world.is_free((5, 5))
    assert not world.is_free((3, 3))
    assert not cs.navigate(world, (1, 1), (5, 5))


@pytest.mark.parametrize(
    ("obstacles", "words"),
    [
        ([[(0, 0), (2, 2), (2, 0), (0, 2)]], ["obstacle 0", "crosses itself", "(1, 1)", "repair=True"]),
        ([BOX, [(1, 1), (2, 2), (3, 3)]], ["obstacle 1", "no area", "3 corners", "repair=True"]),
    ],
)
def test_polygons_that_are_none_are_named_and_can_be_mended(obstacles, words):
    with pytest.raises(GeometryError) as error:
        cs.PolygonWorld(obstacles, BOUNDS)
    assert all(word in str(error.value) for word in words)
    mended = cs.PolygonWorld(obstacles, BOUNDS, repair=True)
    assert len(mended.repairs) == 1
    assert words[1] in mended.repairs[0]


def test_what_a_repair_leaves_is_read_by_the_even_odd_rule():
    world = cs.PolygonWorld([[(0, 0), (2, 2), (2, 0), (0, 2)]], (-1, -1, 3, 3), repair=True)
    assert world.is_free((1, 0.5))
    assert not world.is_free((0.5, 1))
    wall = cs.PolygonWorld([[(1, 0), (1, 3)]], (0, 0, 3, 3), repair=True)
    assert wall.components == 2


@pytest.mark.parametrize(
    ("make", "error", "words"),
    [
        (lambda: cs.PolygonWorld("abc"), InputTypeError, ["obstacles", "str"]),
        (lambda: cs.PolygonWorld([[(0, 0), (1, np.nan), (1, 1)]]), InputError, ["obstacle 0", "nan"]),
        (lambda: cs.PolygonWorld([[(0, 0, 0), (1, 1, 1)]]), InputError, ["obstacle 0", "(n, 2)"]),
        (lambda: cs.PolygonWorld([[(1, 1)]]), InputError, ["obstacle 0", "one corner"]),
        (lambda: cs.PolygonWorld([BOX], (0, 0, 0, 1)), InputError, ["bounds", "enclose no area"]),
        (lambda: cs.PolygonWorld([BOX], (0, 0, 1)), InputError, ["bounds", "(..., 4)"]),
        (lambda: cs.PolygonWorld([[(0, 0), (1e300, 0), (0, 1)]]), InputError, ["obstacle 0", "1e+15"]),
        (lambda: cs.PolygonWorld([BOX], BOUNDS).inflate(-1), InputError, ["radius", "-1"]),
        (lambda: cs.PolygonWorld([BOX], BOUNDS).inflate(6), InputError, ["radius", "no free space"]),
        (lambda: cs.PolygonWorld([BOX], BOUNDS).to_grid(0), InputError, ["resolution", "positive"]),
        (lambda: cs.PolygonWorld([BOX], BOUNDS).to_grid(1e-9), InputError, ["resolution", "cells"]),
    ],
)
def test_bad_worlds_are_refused_with_a_reason(make, error, words):
    with pytest.raises(error) as raised:
        make()
    assert all(word in str(raised.value) for word in words)


@pytest.mark.parametrize(
    ("point", "words"),
    [
        ((5, 5), ["start", "inside obstacle 0", "1 m deep", "nearest free point"]),
        ((11, 5), ["start", "outside the world", "x from 0 to 10"]),
        ((np.nan, 5), ["start", "finite"]),
        ((1, 2, 3), ["start", "(3,)", "(2,)"]),
        ([[1, 2]], ["start", "(1, 2)", "(2,)"]),
    ],
)
def test_a_start_that_is_not_free_is_named(point, words):
    with pytest.raises(InputError) as error:
        cs.navigate(cs.PolygonWorld([BOX], BOUNDS), point, (1, 1))
    assert all(word in str(error.value) for word in words)


def test_a_point_that_rounding_put_into_the_wall_is_on_it():
    world = cs.PolygonWorld([[(0, 0), (3, 1), (1, 3)]], (-5, -5, 5, 5))
    for t in np.linspace(0, 1, 101):
        on_wall = (1 - t) * np.array([3.0, 1]) + t * np.array([1.0, 3])
        route = cs.navigate(world, (4, 4), on_wall)
        assert route.length == pytest.approx(math.dist((4, 4), on_wall), abs=1e-9)
        np.testing.assert_array_equal(route.path[-1], on_wall)


def test_growing_keeps_the_radius_and_gives_little_away():
    rng = np.random.default_rng(3)
    world = cs.PolygonWorld([BOX, [(1, 1), (2, 1.2), (1.5, 3)]], BOUNDS)
    grown = world.inflate(0.5)
    points = rng.uniform(0.5, 9.5, (2000, 2))
    far, free = world.clearance(points), grown.is_free(points)
    assert np.all(far[free] >= 0.5 - 1e-12)
    assert np.all(free[far >= 0.5 / math.cos(math.pi / 32) + 1e-12])
    assert grown.bounds == (0.5, 0.5, 9.5, 9.5)
    assert world.inflate(0) is world
    assert world.inflate(1e-16) is world


def test_cells_are_blocked_where_an_obstacle_reaches_into_them():
    rng = np.random.default_rng(4)
    world = cs.PolygonWorld([BOX, [(1, 1), (2, 1.2), (1.5, 3)]], BOUNDS)
    grid = world.to_grid(0.25)
    assert grid.shape == (40, 40)
    assert grid.blocked[16:24, 16:24].all()
    assert grid.blocked.sum() < 64 + 40  # the box fills its cells and no others
    points = rng.uniform(0, 10, (2000, 2))
    assert all(world.is_free(p) for p in points if grid.is_free(p))


EMPTY = [(0, 0, 10, 10), (-3, 2, 7, 9), (0, 0, 3, 10), (1e6, 1e6, 1e6 + 1, 1e6 + 1)]


@pytest.mark.parametrize("bounds", EMPTY)
def test_an_empty_world_is_all_free_cells(bounds):
    world = cs.PolygonWorld([], bounds)
    assert not world.to_grid().blocked.any()
    assert np.allclose(world.to_grid().bounds, bounds, rtol=1e-12)
    for resolution in (0.1, 0.05, 1 / 3) if bounds[2] == 10 else ():
        assert not world.to_grid(resolution).blocked.any()


def test_by_default_cells_leave_little_of_the_bounds_over():
    rng = np.random.default_rng(8)
    left_over = []
    for _ in range(100):
        wide, high = rng.uniform(0.01, 100, 2)
        grid = cs.PolygonWorld([], (0, 0, wide, high)).to_grid()
        free = ~grid.blocked
        rows, columns = free.any(axis=1).sum(), free.any(axis=0).sum()
        assert free.sum() == rows * columns > 0
        assert 200 <= max(rows, columns) <= 300 or max(wide, high) > 200 * min(wide, high)
        over = max(wide - columns * grid.resolution, high - rows * grid.resolution)
        left_over.append(over / grid.resolution)
    assert max(left_over) < 0.5
    assert np.mean(left_over) < 0.05


def test_boxes_on_lines_between_cells_fill_their_cells_alone():
    world = cs.PolygonWorld([[(2, 2), (5, 2), (5, 5), (2, 5)]], BOUNDS)
    for parts in (40, 50, 100, 200):
        grid = world.to_grid(10 / parts)
        assert grid.blocked.sum() == (parts * 3 // 10) ** 2


def test_a_wall_without_thickness_between_cells_blocks_both():
    world = cs.PolygonWorld([[(5, 2), (5, 8), (5, 2)]], BOUNDS, repair=True)
    grid = world.to_grid(1.0)
    assert grid.blocked[2:8, 4:6].all()
    assert cs.navigate(grid, (4.5, 9.5), (5.5, 9.5), "a_star")
    assert not grid.blocked[:, [0, 1, 2, 3, 6, 7, 8, 9]].any()


def test_a_grid_becomes_polygons_with_its_own_walls():
    rng = np.random.default_rng(5)
    grid = cs.OccupancyGrid(rng.random((12, 9)) < 0.35, resolution=0.5, origin=(-1, 2))
    world = cs.PolygonWorld.from_grid(grid)
    assert world.bounds == grid.bounds
    points = rng.uniform((-1, 2), (3.5, 8), (500, 2))
    assert [world.is_free(p) for p in points] == [grid.is_free(p) for p in points]
    again = cs.PolygonWorld(world.obstacles, world.bounds)
    assert again.components == world.components
    assert [again.is_free(p) for p in points] == [world.is_free(p) for p in points]


@pytest.mark.parametrize("name", ["radius", "resolution"])
@pytest.mark.parametrize("value", [[1], np.array([3, 4]), {}, "a", np.nan])
def test_sizes_that_are_no_numbers_are_refused(name, value):
    for planner in ("any_angle", "a_star"):
        with pytest.raises((InputError, InputTypeError), match=name):
            cs.navigate(cs.PolygonWorld([BOX], BOUNDS), (1, 1), (9, 9), planner, **{name: value})


@pytest.mark.parametrize(
    ("planner", "options", "word"),
    [
        ("tangent_bug", {"range": range(3)}, "one value"),
        ("approximate_cells", {"uniform": "a"}, "True or False"),
        ("approximate_cells", {"refine": None}, "True or False"),
        ("a_star", {"resolution": 1e-320}, "resolution"),
    ],
)
def test_options_of_the_wrong_kind_are_refused(planner, options, word):
    with pytest.raises((InputError, InputTypeError), match=word):
        cs.navigate(cs.PolygonWorld([BOX], BOUNDS), (1, 1), (9, 9), planner, **options)


def test_worlds_can_be_copied_and_pickled():
    for world in (cs.PolygonWorld([BOX], BOUNDS), cs.PolygonWorld.from_grid(cs.OccupancyGrid(np.eye(4) > 0))):
        for again in (copy.deepcopy(world), pickle.loads(pickle.dumps(world))):
            assert again.bounds == world.bounds
            assert again.components == world.components
            start, goal = (0, 3), (3, 4)
            assert cs.navigate(again, start, goal).length == cs.navigate(world, start, goal).length


def test_what_is_made_from_a_world_is_kept_with_it():
    world = cs.PolygonWorld([BOX], BOUNDS)
    for more in ({"radius": 0.5}, {"planner": "a_star"}, {"planner": "a_star", "resolution": 0.5}):
        first, again = (cs.navigate(world, (1, 1), (9, 9), **more).world for _ in range(2))
        assert first is again
    grown = [cs.navigate(world, (1, 1), (9, 9), radius=r).world for r in np.linspace(0.1, 0.9, 20)]
    assert len({each.bounds for each in grown}) == 20
    assert len(vars(world)["_derived"]) <= MOST_DERIVED


def test_geojson_of_every_kind(tmp_path):
    polygon = {"type": "Polygon", "coordinates": [[[4, 4, 7], [6, 4, 7], [6, 6, 7], [4, 6, 7], [4, 4, 7]]]}
    many = {"type": "MultiPolygon", "coordinates": [polygon["coordinates"]]}
    collection = {
        "type": "FeatureCollection",
        "bbox": [0, 0, 10, 10],
        "features": [
            {"type": "Feature", "geometry": polygon, "properties": {}},
            {"type": "Feature", "geometry": None},
            {"type": "Feature", "geometry": {"type": "Point", "coordinates": [0, 0]}},
            {"type": "Feature", "geometry": {"type": "GeometryCollection", "geometries": [many]}},
        ],
    }
    world = cs.PolygonWorld.from_geojson(collection)
    assert len(world.obstacles) == 2
    assert world.bounds == BOUNDS
    path = tmp_path / "map.geojson"
    path.write_text(json.dumps(polygon))
    assert cs.PolygonWorld.from_geojson(path, bounds=BOUNDS).clearance((1, 5)) == 1


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("{", ["map.geojson:1", "JSON"]),
        ("[]", ["not a GeoJSON object"]),
        ('{"type": "Blob"}', ["'Blob'"]),
        ('{"type": ' + "1" * 5000 + "}", ["JSON cannot be read"]),
        ('{"type": "Polygon"}', ["coordinates"]),
        ('{"type": "Polygon", "coordinates": [[1, 2]]}', ["[x, y]"]),
        ('{"type": "FeatureCollection", "features": 3}', ["features"]),
    ],
)
def test_broken_geojson_is_named(tmp_path, text, words):
    path = tmp_path / "map.geojson"
    path.write_text(text)
    with pytest.raises(MapError) as error:
        cs.PolygonWorld.from_geojson(path)
    assert all(word in str(error.value) for word in words)


def test_polygons_from_text(tmp_path):
    path = tmp_path / "map.txt"
    path.write_text(
        "# a yard\nbounds 0 0 10 10\n2 2\n8 2\n8, 8\n2 8\n\n"
        "hole\n4 4\n6 4\n6 6\n4 6  # its corner\n\n0 0\n1 0\n0 1\n"
    )
    world = cs.PolygonWorld.from_text(path)
    assert [len(rings) for rings in world.obstacles] == [2, 1]
    assert world.components == 2
    path.write_text("1 2\n3 x\n")
    with pytest.raises(MapError, match=r"map.txt:2.*two numbers"):
        cs.PolygonWorld.from_text(path)
    path.write_text("hole\n1 2\n")
    with pytest.raises(MapError, match="before the first polygon"):
        cs.PolygonWorld.from_text(path)
    with pytest.raises(MapError, match="no such file"):
        cs.PolygonWorld.from_text(tmp_path / "none.txt")


def nested(levels, kind, inside):
    geometry = {"type": "Point", "coordinates": [0, 0]}
    for _ in range(levels):
        geometry = {"type": kind, inside: geometry if inside == "geometry" else [geometry]}
    return geometry


@pytest.mark.parametrize(
    ("kind", "inside"),
    [("GeometryCollection", "geometries"), ("FeatureCollection", "features"), ("Feature", "geometry")],
)
def test_geojson_is_nested_within_reason(kind, inside, tmp_path):
    assert cs.PolygonWorld.from_geojson(nested(50, kind, inside), bounds=(0, 0, 1, 1)).obstacles == []
    itself = {"type": kind}
    itself[inside] = itself if inside == "geometry" else [itself]
    for wrong in (nested(5000, kind, inside), nested(101, kind, inside), itself):
        with pytest.raises(MapError, match="nested more than 100 levels deep, or contains itself"):
            cs.PolygonWorld.from_geojson(wrong)
    path = tmp_path / "deep.json"
    path.write_text(json.dumps(nested(200, kind, inside)))
    with pytest.raises(MapError, match=r"deep.json: .*nested more than 100"):
        cs.PolygonWorld.from_geojson(path)


@pytest.mark.parametrize("kind", [{}, [], [["Point"]], 5, None, True, "point", 2.5])
def test_the_type_of_geojson_is_one_of_its_words(kind, tmp_path):
    path = tmp_path / "map.json"
    path.write_text(json.dumps({"type": kind}))
    for source in ({"type": kind}, {"type": "Feature", "geometry": {"type": kind}}, path):
        with pytest.raises(MapError, match='the "type" of the object is '):
            cs.PolygonWorld.from_geojson(source)


@pytest.mark.parametrize("form", ["text", "geojson"])
def test_a_written_world_is_the_same_to_the_last_bit(tmp_path, form):
    hole = [(4, 4), (6, 4), (6, 6), (4 + 1 / 3, 6)]
    world = cs.PolygonWorld([[BOX, hole], [(0.1, 0.2), (1e-17, 3), (1 / 7, 9)]], (0, -0.1, 10, 10 + 1 / 3))
    path = tmp_path / "yard"
    getattr(world, f"save_{form}")(path)
    again = getattr(cs.PolygonWorld, f"from_{form}")(path)
    assert again.bounds == world.bounds
    for one, other in zip(again.obstacles, world.obstacles, strict=True):
        assert all(map(np.array_equal, one, other))
    with pytest.raises(InputError, match="cannot be written"):
        getattr(world, f"save_{form}")(tmp_path / "none" / "yard")
    with pytest.raises(InputError, match="not a regular file"):
        getattr(world, f"save_{form}")(tmp_path)
    with pytest.raises(InputError, match="null character"):
        getattr(world, f"save_{form}")("a\0b")
    assert [entry.name for entry in tmp_path.iterdir()] == ["yard"]


@pytest.mark.parametrize("side", [[], [1], (1, 2), np.array([1.0, 2.0])])
def test_a_side_of_cells_is_one_number(side):
    world = cs.PolygonWorld([BOX], BOUNDS)
    for given in (world, world.to_grid(1.0)):
        with pytest.raises(InputError, match="one number"):
            given.to_grid(side)


def test_a_side_of_cells_is_positive_whoever_takes_it():
    world = cs.PolygonWorld([BOX], BOUNDS)
    for planner in ("any_angle", "a_star"):
        with pytest.raises(InputError, match="resolution is -1; it must be a positive length"):
            cs.navigate(world, (1, 1), (9, 9), planner, resolution=-1)
