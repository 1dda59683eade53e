"""Planning: the configuration space of planar arms with two joints, exactly."""

from cspace.planning.two_joints.answers import BoundaryCurve, Connection, FreeComponent
from cspace.planning.two_joints.configuration_space import ConfigurationSpace, configuration_space

__all__ = [
    "BoundaryCurve",
    "ConfigurationSpace",
    "Connection",
    "FreeComponent",
    "configuration_space",
]
