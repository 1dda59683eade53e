"""Signed distances: laws that fix them, and formulas of points on the surface."""

from __future__ import annotations

import pickle

import numpy as np
import pytest

import cspace as cs
from cspace import shapes
from shapes.solids import KINDS, box_mesh, every_shape


def shape_of(kind, seed=0):
    rng = np.random.default_rng(seed)
    return every_shape(rng)[KINDS.index(kind)], rng


def points_around(shape, rng, count=400):
    low, high = np.clip(shape.bounds, -3.0, 3.0)
    return rng.uniform(low - 0.5, high + 0.5, (count, 3))


@pytest.mark.parametrize("kind", KINDS)
def test_the_gradient_leads_to_a_point_of_the_surface(kind):
    shape, rng = shape_of(kind)
    points = points_around(shape, rng)
    distance, gradient = shape.distance(points), shape.gradient(points)
    assert np.abs(np.linalg.norm(gradient, axis=-1) - 1.0).max() < 1e-12
    assert np.abs(shape.distance(points - distance[:, None] * gradient)).max() < 1e-9


@pytest.mark.parametrize("kind", KINDS)
def test_the_distance_grows_no_faster_than_the_way(kind):
    shape, rng = shape_of(kind)
    a, b = points_around(shape, rng), points_around(shape, rng)
    difference = np.abs(shape.distance(a) - shape.distance(b))
    assert (difference <= np.linalg.norm(a - b, axis=-1) + 1e-12).all()


@pytest.mark.parametrize("kind", KINDS)
def test_the_gradient_is_that_of_differences(kind):
    shape, rng = shape_of(kind)
    points, step = points_around(shape, rng, 60), 1e-6
    shifts = step * np.eye(3)
    ahead, behind = (shape.distance(points[:, None] + s * shifts) for s in (1.0, -1.0))
    differences = (ahead - behind) / (2 * step)
    error = np.abs(differences - shape.gradient(points)).max(axis=-1)
    assert np.sort(error)[: int(0.9 * len(error))].max() < 1e-5  # the rest is near a ridge


@pytest.mark.parametrize("kind", KINDS)
def test_moving_shape_and_points_changes_nothing(kind):
    shape, rng = shape_of(kind)
    points, T = points_around(shape, rng), cs.random_pose(rng=rng)
    moved = shape.moved(T)
    np.testing.assert_array_equal(shape.moved(T[:3, 3]).pose, shape.moved(cs.pose(T[:3, 3])).pose)
    assert np.abs(moved.distance(cs.transform_points(T, points)) - shape.distance(points)).max() < 1e-11
    turned = moved.gradient(cs.transform_points(T, points))
    assert np.abs(turned - cs.transform_directions(T, shape.gradient(points))).max() < 1e-7


@pytest.mark.parametrize("kind", KINDS)
def test_the_bounds_hold_the_shape_and_are_tight(kind):
    shape, rng = shape_of(kind)
    points = points_around(shape, rng, 4000)
    low, high = shape.bounds
    inside = points[shape.contains(points)]
    assert (inside >= low).all()
    assert (inside <= high).all()
    if kind == "HalfSpace":
        assert np.isinf(shape.bounds).all()
        return
    for k in range(3):
        for corner, sign in ((low, -1.0), (high, 1.0)):
            sheet = rng.uniform(low, high, (4000, 3))
            sheet[:, k] = corner[k]
            assert -1e-12 <= shape.distance(sheet).min() < 0.1
            assert shape.distance(sheet + sign * 1e-3 * np.eye(3)[k]).min() > 0.0


@pytest.mark.parametrize("kind", KINDS)
def test_single_points_and_batches_agree_and_shapes_survive_pickling(kind):
    shape, rng = shape_of(kind)
    points = points_around(shape, rng, 12)
    batch = shape.distance(points.reshape(3, 4, 3))
    assert batch.shape == (3, 4)
    assert shape.gradient(points.reshape(3, 4, 3)).shape == (3, 4, 3)
    single = shape.distance(points[0])
    assert isinstance(single, float)
    assert single == pytest.approx(batch[0, 0], abs=1e-14)
    assert isinstance(shape.contains(points[0]), bool)
    again = pickle.loads(pickle.dumps(shape))
    assert np.array_equal(again.distance(points), shape.distance(points))
    assert repr(again) == repr(shape)


@pytest.mark.parametrize("size", [(0.4, 0.5, 0.6), (1.0, 0.01, 3.0)])
def test_box_hull_and_mesh_of_the_same_box_agree(size):
    rng = np.random.default_rng(3)
    vertices, faces = box_mesh(size)
    T = cs.random_pose(rng=rng)
    box = shapes.Box(size, T)
    points = points_around(box, rng, 2000)
    for other in (shapes.Hull(vertices, T), shapes.Mesh(vertices, faces, T)):
        assert np.abs(other.distance(points) - box.distance(points)).max() < 1e-12
        assert other.volume == pytest.approx(np.prod(size))
        assert np.allclose(other.bounds, box.bounds)


def test_capsules_of_no_length_are_spheres_and_cylinders_have_flat_ends():
    points = np.random.default_rng(1).normal(size=(100, 3))
    assert np.allclose(shapes.Capsule(0.3, 0.0).distance(points), shapes.Sphere(0.3).distance(points))
    assert np.allclose(shapes.Capsule(0.1, 1.0).ends, [[0, 0, -0.5], [0, 0, 0.5]])
    cylinder = shapes.Cylinder(0.5, 2.0)
    assert cylinder.distance([0.3, 0.0, 1.5]) == pytest.approx(0.5)
    assert cylinder.distance([0.5 + 0.3, 0.0, 1.4]) == pytest.approx(0.5)
    assert cylinder.distance([0.0, 0.0, 0.0]) == pytest.approx(-0.5)


def test_a_floor_is_the_half_space_below_its_height():
    floor = shapes.HalfSpace(offset=0.2)
    assert floor.distance([5.0, -3.0, 0.7]) == pytest.approx(0.5)
    assert floor.contains([1.0, 2.0, 0.2])
    assert np.array_equal(floor.bounds[1], [np.inf, np.inf, 0.2])
    assert np.allclose(floor.moved(cs.pose([0, 0, 1])).plane, [0, 0, 1, 1.2])


def test_a_height_field_is_solid_below_its_heights():
    rng = np.random.default_rng(2)
    field = shapes.HeightField(rng.uniform(size=(5, 4)), [3.0, 4.0], bottom=-0.5)
    x, y = np.linspace(-1.5, 1.5, 4), np.linspace(-2.0, 2.0, 5)
    nodes = np.stack([*np.meshgrid(x, y), field.heights], axis=-1)
    assert np.abs(field.distance(nodes)).max() < 1e-12
    inner = nodes[1:-1, 1:-1]
    assert field.contains(inner - [0, 0, 0.1]).all()
    assert not field.contains(np.add(inner, [0, 0, 0.1])).any()
    assert not field.contains([0.0, 0.0, -0.6])
    middle = (nodes[0, 0] + nodes[1, 1]) / 2  # on the line that divides a cell
    assert field.distance(middle) == pytest.approx(0.0, abs=1e-12)
    mesh, points = field.to_mesh(), points_around(field, rng)
    assert mesh.closed
    assert np.abs(mesh.distance(points) - field.distance(points)).max() < 1e-12


def test_an_open_mesh_is_a_surface():
    vertices, faces = box_mesh([1.0, 1.0, 1.0])
    with pytest.raises(cs.CspaceError, match="3 edges of 11 triangles"):
        shapes.Mesh(vertices, faces[1:])
    surface = shapes.Mesh(vertices, faces[1:], solid=False)
    assert not surface.closed
    assert surface.distance([0.0, 0.0, 0.0]) == pytest.approx(0.5)
    assert surface.hull().volume == pytest.approx(1.0)


def test_a_mesh_turned_inside_out_is_turned_back():
    vertices, faces = box_mesh([1.0, 1.0, 1.0])
    assert shapes.Mesh(vertices, faces[:, ::-1]).contains([0.0, 0.1, 0.2])


def test_points_are_nearest_by_brute_force():
    rng = np.random.default_rng(5)
    cloud = shapes.PointCloud(rng.normal(size=(2000, 3)), radius=0.05)
    points = rng.normal(size=(300, 3))
    apart = np.linalg.norm(points[:, None] - cloud.points, axis=-1).min(axis=1)
    assert np.abs(cloud.distance(points) - (apart - 0.05)).max() < 1e-14
