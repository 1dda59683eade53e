"""Kinematics: where every frame of a robot is, how it moves with the joints, and where it loses a freedom."""

from cspace.kinematics.assembly import Assembly, add_tool, assemble, assemble_chain, mount, screws
from cspace.kinematics.center_of_mass import center_of_mass, center_of_mass_jacobian
from cspace.kinematics.forward import forward_kinematics, forward_kinematics_all
from cspace.kinematics.jacobian import fk_jacobian, jacobian, jacobian_dot
from cspace.kinematics.kinematic_model import KinematicModel
from cspace.kinematics.limits import require_limits
from cspace.kinematics.loop_closure import (
    AssemblyModes,
    LoopClosure,
    LoopMotion,
    close_loops,
    find_assembly_modes,
    follow_loops,
)
from cspace.kinematics.loop_constraints import LoopConstraints
from cspace.kinematics.loop_freedom import LoopFreedom, loop_freedom
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
    "AssemblyModes",
    "Ellipsoid",
    "KinematicModel",
    "LoopClosure",
    "LoopConstraints",
    "LoopFreedom",
    "LoopMotion",
    "Singularity",
    "Workspace",
    "add_tool",
    "assemble",
    "assemble_chain",
    "center_of_mass",
    "center_of_mass_jacobian",
    "close_loops",
    "distance_to_singularity",
    "find_assembly_modes",
    "fk_jacobian",
    "follow_loops",
    "forward_kinematics",
    "forward_kinematics_all",
    "jacobian",
    "jacobian_dot",
    "loop_freedom",
    "manipulability",
    "manipulability_ellipsoid",
    "mount",
    "random_configurations",
    "require_limits",
    "screws",
    "singular_values",
    "singularity",
    "workspace",
]
