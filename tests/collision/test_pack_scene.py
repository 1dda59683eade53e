"""The arrays of a scene describe its shapes: distances computed from them are those of the shapes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pytest

import cspace as cs
from cspace.collision import pack_scene
from cspace.errors import InputTypeError
from shapes.solids import every_shape


def distances(packed, p):
    """The least distance of one point (3,) from each object, by the rows of the arrays."""
    found = np.full(len(packed.names), np.inf)

    def note(owner, value):
        found[owner] = min(found[owner], value)

    for row, owner in zip(packed.boxes, packed.box_object, strict=True):
        s = np.abs(row[3:12].reshape(3, 3).T @ (p - row[:3])) - row[12:]
        note(owner, np.linalg.norm(np.maximum(s, 0)) + min(s.max(), 0))
    for row, owner in zip(packed.capsules, packed.capsule_object, strict=True):
        v = row[3:6] - row[:3]
        t = np.clip((p - row[:3]) @ v / max(v @ v, 1e-300), 0, 1)
        note(owner, np.linalg.norm(p - row[:3] - t * v) - row[6])
    for row, owner in zip(packed.cylinders, packed.cylinder_object, strict=True):
        z = (p - row[:3]) @ row[3:6]
        s = np.array([np.linalg.norm(p - row[:3] - z * row[3:6]) - row[7], abs(z) - row[6]])
        note(owner, np.linalg.norm(np.maximum(s, 0)) + min(s.max(), 0))
    for row, owner in zip(packed.half_spaces, packed.half_space_object, strict=True):
        note(owner, row[:3] @ p - row[3])
    for (points, radius), owner in zip(packed.clouds, packed.cloud_object, strict=True):
        note(owner, np.linalg.norm(p - points, axis=1).min() - radius)
    return found


def test_distances_from_the_arrays_are_those_of_the_shapes():
    rng = np.random.default_rng(0)
    scene = cs.Scene(every_shape(rng))
    T_world_base = cs.random_pose(rng=rng)
    packed = pack_scene(scene, T_world_base)
    assert packed.names == scene.names
    assert packed.version == scene.version
    named = dict(zip(packed.names, range(len(packed.names)), strict=True))
    for p in rng.normal(size=(100, 3)):
        found, p_world = distances(packed, p), cs.transform_points(T_world_base, p)
        for name in ("box_1", "sphere_1", "capsule_1", "cylinder_1", "half_space_1", "point_cloud_1"):
            assert found[named[name]] == pytest.approx(scene[name].distance(p_world), abs=1e-12)
    assert [packed.names[k] for k in packed.mesh_object] == ["hull_1", "mesh_1", "height_field_1"]
    for owner, (triangles, solid) in zip(packed.mesh_object, packed.meshes, strict=True):
        corners = cs.transform_points(T_world_base, triangles.reshape(-1, 3))
        most = 1e-11 if packed.names[owner] == "hull_1" else 1e-12
        assert np.abs(scene[packed.names[owner]].distance(corners)).max() < most
        assert solid
        first = triangles.reshape(-1, 3)
        assert len(np.unique(first, axis=0)) == len(np.unique(first.round(9), axis=0))


def test_attached_objects_are_no_obstacles_and_an_empty_scene_has_empty_arrays():
    scene = cs.Scene(every_shape(np.random.default_rng(0))).remove("half_space_1")
    for name in scene.names:
        scene = scene.attach(name, "hand", np.eye(4))
    packed = pack_scene(scene)
    assert packed.names == ()
    assert (packed.boxes.shape, packed.capsules.shape, packed.cylinders.shape) == ((0, 15), (0, 7), (0, 8))
    assert (packed.half_spaces.shape, packed.meshes, packed.clouds) == ((0, 4), (), ())


def test_a_shape_of_another_class_is_refused_by_name():
    @dataclass(frozen=True, eq=False, repr=False)
    class Blob(cs.shapes.Shape):
        kind = "blob"
        pose: object = (0.0, 0.0, 0.0)
        name: str = "cloud"

        def __post_init__(self):
            self._place()

        def _sizes(self):
            return ""

    with pytest.raises(InputTypeError, match="'cloud' is a Blob"):
        pack_scene(cs.Scene([Blob()]))
