"""Mobile robots of the plane: vehicles on wheels, their odometry and its errors."""

from cspace.mobile.vehicles import Car, Unicycle

__all__ = ["Car", "Unicycle"]
