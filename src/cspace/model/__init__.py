"""Robots as data: the description and its readers and writers."""

from cspace.model.calibration import calibrated
from cspace.model.chain import Chain, chain, default_tip
from cspace.model.degrees_of_freedom import (
    body_freedoms,
    mobility,
    point_freedoms,
    task_word,
    tree_freedoms,
)
from cspace.model.description import Description, Provenance, Source, named_poses
from cspace.model.dh import DHTable, dh_matrix, from_dh
from cspace.model.dh_derivation import to_dh
from cspace.model.group_ends import group_ends
from cspace.model.joint import Joint, Limits, Loop, Mimic
from cspace.model.link import Geometry, Inertial, Link, Mesh
from cspace.model.link_matrices import LinkMatrices, link_matrices
from cspace.model.mjcf import from_mjcf
from cspace.model.mounting import mounted, with_body, with_frame
from cspace.model.right_angles import with_right_angles
from cspace.model.screws import from_screws, twists
from cspace.model.srdf import GroupState, JointGroup, Srdf, read_srdf, with_srdf
from cspace.model.toml import from_toml
from cspace.model.toml_writer import to_toml
from cspace.model.tree import Tree, tree
from cspace.model.urdf import from_urdf
from cspace.model.urdf_writer import to_urdf
from cspace.model.xacro import from_xacro

__all__ = [
    "Chain",
    "DHTable",
    "Description",
    "Geometry",
    "GroupState",
    "Inertial",
    "Joint",
    "JointGroup",
    "Limits",
    "Link",
    "LinkMatrices",
    "Loop",
    "Mesh",
    "Mimic",
    "Provenance",
    "Source",
    "Srdf",
    "Tree",
    "body_freedoms",
    "calibrated",
    "chain",
    "default_tip",
    "dh_matrix",
    "from_dh",
    "from_mjcf",
    "from_screws",
    "from_toml",
    "from_urdf",
    "from_xacro",
    "group_ends",
    "link_matrices",
    "mobility",
    "mounted",
    "named_poses",
    "point_freedoms",
    "read_srdf",
    "task_word",
    "to_dh",
    "to_toml",
    "to_urdf",
    "tree",
    "tree_freedoms",
    "twists",
    "with_body",
    "with_frame",
    "with_right_angles",
    "with_srdf",
]
