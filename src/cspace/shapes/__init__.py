"""Shapes: solids at a place, with the signed distance of points and covers by spheres."""

from cspace.shapes.cover import Cover, cover_shape
from cspace.shapes.height_field import HeightField
from cspace.shapes.hull import Hull
from cspace.shapes.mesh import Mesh
from cspace.shapes.mesh_cover import Bounds, CoverMeasure, SphereCover, cover_mesh, measure_cover
from cspace.shapes.point_cloud import PointCloud
from cspace.shapes.shape import Shape
from cspace.shapes.solids import Box, Capsule, Cylinder, HalfSpace, Sphere

__all__ = [
    "Bounds",
    "Box",
    "Capsule",
    "Cover",
    "CoverMeasure",
    "Cylinder",
    "HalfSpace",
    "HeightField",
    "Hull",
    "Mesh",
    "PointCloud",
    "Shape",
    "Sphere",
    "SphereCover",
    "cover_mesh",
    "cover_shape",
    "measure_cover",
]
