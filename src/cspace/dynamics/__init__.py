"""Dynamics: the masses of a robot, which torques make a motion, and how it moves under given torques."""

from cspace.dynamics.base_parameters import BaseParameters, base_parameters
from cspace.dynamics.controllers import PD, ComputedTorque
from cspace.dynamics.coriolis import coriolis_matrix
from cspace.dynamics.derivatives import forward_dynamics_derivatives, inverse_dynamics_derivatives
from cspace.dynamics.exciting_trajectory import ExcitingTrajectory, exciting_trajectory
from cspace.dynamics.forward import forward_dynamics
from cspace.dynamics.identify import Identification, identify
from cspace.dynamics.inertia_checks import InertiaFault
from cspace.dynamics.inertia_report import InertiaReport, inertia_report
from cspace.dynamics.inverse import gravity_torques, inverse_dynamics
from cspace.dynamics.loop_dynamics import (
    constrained_forward_dynamics,
    constrained_inverse_dynamics,
    loop_accelerations,
    loop_velocities,
    loop_wrenches,
)
from cspace.dynamics.loop_simulation import simulate_loops
from cspace.dynamics.mass_matrix import mass_matrix
from cspace.dynamics.momentum import (
    centroidal_momentum,
    centroidal_momentum_matrix,
    kinetic_energy,
    potential_energy,
)
from cspace.dynamics.operational_space import OperationalSpace, operational_space
from cspace.dynamics.regressor import parameter_names, parameters, regressor
from cspace.dynamics.simulate import simulate
from cspace.dynamics.simulation import Simulation
from cspace.dynamics.with_parameters import with_parameters

__all__ = [
    "PD",
    "BaseParameters",
    "ComputedTorque",
    "ExcitingTrajectory",
    "Identification",
    "InertiaFault",
    "InertiaReport",
    "OperationalSpace",
    "Simulation",
    "base_parameters",
    "centroidal_momentum",
    "centroidal_momentum_matrix",
    "constrained_forward_dynamics",
    "constrained_inverse_dynamics",
    "coriolis_matrix",
    "exciting_trajectory",
    "forward_dynamics",
    "forward_dynamics_derivatives",
    "gravity_torques",
    "identify",
    "inertia_report",
    "inverse_dynamics",
    "inverse_dynamics_derivatives",
    "kinetic_energy",
    "loop_accelerations",
    "loop_velocities",
    "loop_wrenches",
    "mass_matrix",
    "operational_space",
    "parameter_names",
    "parameters",
    "potential_energy",
    "regressor",
    "simulate",
    "simulate_loops",
    "with_parameters",
]
