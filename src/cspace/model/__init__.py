"""Robots as data: the description and its readers and writers."""

from cspace.model.chain import Chain, chain, default_tip
from cspace.model.description import Description, Provenance, Source
from cspace.model.joint import Joint, Limits, Loop, Mimic
from cspace.model.link import Geometry, Inertial, Link, Mesh
from cspace.model.screws import from_screws, twists
from cspace.model.tree import Tree, tree
from cspace.model.urdf import from_urdf
from cspace.model.urdf_writer import to_urdf

__all__ = [
    "Chain",
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
    "Tree",
    "chain",
    "default_tip",
    "from_screws",
    "from_urdf",
    "to_urdf",
    "tree",
    "twists",
]
