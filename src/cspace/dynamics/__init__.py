"""Dynamics: which torques make a motion, and what a robot does under given torques."""

from cspace.dynamics.forward import forward_dynamics
from cspace.dynamics.inverse import gravity_torques, inverse_dynamics
from cspace.dynamics.mass_matrix import mass_matrix

__all__ = ["forward_dynamics", "gravity_torques", "inverse_dynamics", "mass_matrix"]
