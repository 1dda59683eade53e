"""Dynamics: the masses of a robot, which torques make a motion, and how it moves under given torques."""

from cspace.dynamics.forward import forward_dynamics
from cspace.dynamics.inertia_checks import InertiaFault
from cspace.dynamics.inertia_report import InertiaReport, inertia_report
from cspace.dynamics.inverse import gravity_torques, inverse_dynamics
from cspace.dynamics.mass_matrix import mass_matrix

__all__ = [
    "InertiaFault",
    "InertiaReport",
    "forward_dynamics",
    "gravity_torques",
    "inertia_report",
    "inverse_dynamics",
    "mass_matrix",
]
