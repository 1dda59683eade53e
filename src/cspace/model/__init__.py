"""Robots as data: the description and its readers and writers."""

from cspace.model.description import Description, Provenance, Source
from cspace.model.joint import Joint, Limits, Loop, Mimic
from cspace.model.link import Geometry, Inertial, Link, Mesh

__all__ = [
    "Description",
    "Geometry",
    "Inertial",
    "Joint",
    "Limits",
    "Link",
    "Loop",
    "Mesh",
    "Mimic",
    "Provenance",
    "Source",
]
