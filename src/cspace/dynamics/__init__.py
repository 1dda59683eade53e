"""Dynamics: the masses of robots, and how forces move them."""

from cspace.dynamics.inertia_checks import InertiaFault
from cspace.dynamics.inertia_report import InertiaReport, inertia_report

__all__ = ["InertiaFault", "InertiaReport", "inertia_report"]
