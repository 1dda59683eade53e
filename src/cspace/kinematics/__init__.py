"""Kinematics: where every frame of a robot is, how it moves with the joints, and where it loses a freedom."""

from cspace.kinematics.assembly import (
    Assembly,
    add_tool,
    assemble,
    assemble_chain,
    mount,
    screws,
    tip_choices,
)
from cspace.kinematics.center_of_mass import center_of_mass, center_of_mass_jacobian
from cspace.kinematics.forward import forward_kinematics, forward_kinematics_all
from cspace.kinematics.jacobian import fk_jacobian, jacobian, jacobian_dot
from cspace.kinematics.kinematic_model import KinematicModel
from cspace.kinematics.limits import require_limits
from cspace.kinematics.manipulability import (
    Ellipsoid,
    distance_to_singularity,
    manipulability,
    manipulability_ellipsoid,
    singular_values,
)
from cspace.kinematics.singularity import Singularity, singularity
from cspace.kinematics.workspace import Workspace, random_configurations, workspace

__all__ = [
    "Assembly",
    "Ellipsoid",
    "KinematicModel",
    "Singularity",
    "Workspace",
    "add_tool",
    "assemble",
    "assemble_chain",
    "center_of_mass",
    "center_of_mass_jacobian",
    "distance_to_singularity",
    "fk_jacobian",
    "forward_kinematics",
    "forward_kinematics_all",
    "jacobian",
    "jacobian_dot",
    "manipulability",
    "manipulability_ellipsoid",
    "mount",
    "random_configurations",
    "require_limits",
    "screws",
    "singular_values",
    "singularity",
    "tip_choices",
    "workspace",
]
