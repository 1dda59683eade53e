"""What a bad shape gets: a message that names the subject, the value and the rule."""

from __future__ import annotations

import numpy as np
import pytest

import cspace as cs
from cspace import shapes
from shapes.solids import box_mesh

NAN_POSE = np.diag([1.0, 1.0, 1.0, np.nan])
CALLS = {
    "flat box": (lambda: shapes.Box([1, 0, 1]), "size of a box is [1.0, 0.0, 1.0]; each side"),
    "box at two numbers": (lambda: shapes.Box([1, 1, 1], [0, 0]), "one pose (4, 4) or position (3,)"),
    "box at ragged rows": (lambda: shapes.Box([1, 1, 1], [[0], [1, 2]]), "pose of a box must be numbers"),
    "box of two sides": (lambda: shapes.Box([1, 1]), "size of a box has shape (2,), expected (3,)"),
    "sphere of radius zero": (lambda: shapes.Sphere(0.0), "radius of a sphere is 0.0; it must be"),
    "NaN radius": (lambda: shapes.Sphere(np.nan), "radius of a sphere holds nan"),
    "negative capsule": (lambda: shapes.Capsule(0.1, -1.0), "length of a capsule is -1 m"),
    "flat cylinder": (lambda: shapes.Cylinder(0.1, 0.0), "length of a cylinder is 0.0"),
    "zero normal": (lambda: shapes.HalfSpace([0, 0, 0]), "normal of a half space is [0.0, 0.0, 0.0]"),
    "NaN pose": (lambda: shapes.Box([1, 1, 1], NAN_POSE), "pose of a box"),
    "NaN position": (
        lambda: shapes.Box([1, 1, 1], [0, np.nan, 0]),
        "position of a box holds nan at index (1,)",
    ),
    "sheared pose": (lambda: shapes.Box([1, 1, 1], np.diag([1, 2, 1, 1])), "rotation part of pose of a box"),
    "two poses": (lambda: shapes.Sphere(1.0, np.tile(np.eye(4), (2, 1, 1))), "(2, 4, 4)"),
    "name": (lambda: shapes.Sphere(1.0, name=3), "the name of a sphere is an int"),
    "empty cloud": (lambda: shapes.PointCloud(np.empty((0, 3))), "holds 0 points"),
    "NaN in a cloud": (
        lambda: shapes.PointCloud([[0, 0, 0], [0, np.nan, 0]]),
        "points of a point cloud holds nan at index (1, 1)",
    ),
    "negative cloud": (lambda: shapes.PointCloud([[0, 0, 0]], radius=-1), "radius of a point cloud is -1"),
    "open mesh": (lambda: shapes.Mesh(box_mesh([1, 1, 1])[0], box_mesh([1, 1, 1])[1][2:]), "is not closed"),
    "vertex out of range": (lambda: shapes.Mesh(np.eye(3), [[0, 1, 3]]), "name vertex 3; there are"),
    "half a vertex": (lambda: shapes.Mesh(np.eye(3), [[0, 1, 1.5]]), "integers"),
    "mesh without triangles": (lambda: shapes.Mesh(np.eye(3), [[0, 1, 1]]), "no triangle"),
    "one row": (lambda: shapes.HeightField([[1, 2]], [1, 1]), "at least two rows"),
    "bottom above": (lambda: shapes.HeightField(np.ones((2, 2)), [1, 1], bottom=2), "bottom of a height"),
    "points of the plane": (lambda: shapes.Box([1, 1, 1]).distance([[0, 0]]), "expected (..., 3)"),
}


@pytest.mark.parametrize("name", CALLS)
def test_a_bad_shape_is_named(name):
    call, text = CALLS[name]
    with pytest.raises(cs.CspaceError) as caught:
        call()
    assert text in str(caught.value)


def test_shapes_cannot_be_changed():
    box = shapes.Box([1, 1, 1], name="a")
    with pytest.raises(AttributeError):
        box.size = (2, 2, 2)
    with pytest.raises(ValueError, match="read-only"):
        box.size[0] = 2
    assert box.renamed("b").name == "b"
    assert repr(box) == "<Box 'a', 1 × 1 × 1 m, at (0, 0, 0)>"
    assert "1 point," in repr(shapes.PointCloud([[0, 0, 0]]))
