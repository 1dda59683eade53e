"""Shapes: solids at a place, with the signed distance of points and covers by spheres."""

from cspace.shapes.cover import Cover, cover_shape
from cspace.shapes.height_field import HeightField
from cspace.shapes.hull import Hull
from cspace.shapes.mesh import Mesh
from cspace.shapes.point_cloud import PointCloud
from cspace.shapes.shape import Shape
from cspace.shapes.solids import Box, Capsule, Cylinder, HalfSpace, Sphere

__all__ = [
    "Box",
    "Capsule",
    "Cover",
    "Cylinder",
    "HalfSpace",
    "HeightField",
    "Hull",
    "Mesh",
    "PointCloud",
    "Shape",
    "Sphere",
    "cover_shape",
]
