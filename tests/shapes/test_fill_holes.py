"""Meshes with holes become solids: closed, of the right volume, with the given triangles among theirs."""

from __future__ import annotations

import numpy as np
import pytest

import cspace as cs
from cspace import shapes
from cspace.shapes.triangles import count_open_edges, find_open_edges
from shapes.solids import box_mesh


def slow_open_edges(faces):
    """The sides without an opposite one, by a list of all of them."""
    sides = [(int(f[k]), int(f[(k + 1) % 3])) for f in faces for k in range(3)]
    for side in list(sides):
        if side in sides and side[::-1] in sides:
            sides.remove(side)
            sides.remove(side[::-1])
    return sorted(sides)


@pytest.mark.parametrize("seed", range(20))
def test_open_edges_are_those_of_a_slow_list(seed):
    rng = np.random.default_rng(seed)
    faces = np.array([rng.permutation(6)[:3] for _ in range(int(rng.integers(1, 12)))])
    assert sorted(map(tuple, find_open_edges(faces).tolist())) == slow_open_edges(faces)
    assert count_open_edges(faces) == len(slow_open_edges(faces))


@pytest.mark.parametrize("seed", range(10))
def test_a_hull_without_some_triangles_becomes_a_solid(seed):
    rng = np.random.default_rng(seed)
    hull = shapes.Hull(rng.normal(size=(40, 3)))
    kept = rng.random(len(hull.facets)) < 0.9
    kept[rng.integers(len(kept))] = False
    surface = shapes.Mesh(hull.vertices, hull.facets[kept], cs.random_pose(rng=rng), "link", solid=False)
    solid = surface.fill_holes()
    assert solid.closed
    assert solid.solid
    assert (solid.name, solid.pose.tolist()) == ("link", surface.pose.tolist())
    assert 0.0 < solid.volume <= hull.volume + 1e-12
    assert np.array_equal(solid.faces[: kept.sum()], surface.faces)
    corners = surface.pose[:3, 3] + surface.vertices @ surface.pose[:3, :3].T
    assert np.abs(solid.distance(corners)).max() < 1e-12


def test_flat_holes_are_filled_flat():
    vertices, faces = box_mesh([1, 2, 3])
    for open_faces in (faces[2:], faces[4:], faces[1:], np.delete(faces, [0, 1, 2, 3], axis=0)):
        solid = shapes.Mesh(vertices, open_faces, solid=False).fill_holes()
        assert np.isclose(solid.volume, 6.0)


def test_a_closed_mesh_stays_as_it_is():
    mesh = shapes.Mesh(*box_mesh([1, 2, 3]))
    assert np.array_equal(mesh.fill_holes().vertices, mesh.vertices)
    assert np.array_equal(mesh.fill_holes().faces, mesh.faces)


def test_inward_surfaces_are_turned_and_two_holes_filled_apart():
    vertices, faces = box_mesh([1, 1, 1])
    tube = np.delete(faces, [0, 1, 2, 3], axis=0)[:, ::-1]  # without its two ends along x
    solid = shapes.Mesh(vertices, tube, solid=False).fill_holes()
    assert np.isclose(solid.volume, 1.0)
    assert len(solid.faces) == len(tube) + 8
    assert solid.contains([0.0, 0.0, 0.0])


def test_the_cover_of_a_filled_mesh_needs_fewer_spheres():
    vertices, faces = box_mesh([0.2, 0.2, 0.2])
    surface = shapes.Mesh(vertices, faces[2:], solid=False)
    filled = surface.fill_holes().cover(0.02)
    assert filled.solid
    assert len(filled) < len(surface.cover(0.02)) / 2
