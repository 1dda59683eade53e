"""Planning: free ways of arms among obstacles, and the exact configuration space of arms with two joints."""

from cspace.planning.aorrtc import AORRTC
from cspace.planning.arm_planner import ArmPlanner
from cspace.planning.grid_search import GridSearch
from cspace.planning.plan_result import STATUSES, Plan
from cspace.planning.planners import PLANNERS, find_planner
from cspace.planning.potential_field import Potential, PotentialField, PotentialRest, Push, potential
from cspace.planning.rrt_connect import RRTConnect
from cspace.planning.space import ArmSpace
from cspace.planning.two_joints.answers import BoundaryCurve, Connection, FreeComponent
from cspace.planning.two_joints.configuration_space import ConfigurationSpace, configuration_space

__all__ = [
    "AORRTC",
    "PLANNERS",
    "STATUSES",
    "ArmPlanner",
    "ArmSpace",
    "BoundaryCurve",
    "ConfigurationSpace",
    "Connection",
    "FreeComponent",
    "GridSearch",
    "Plan",
    "Potential",
    "PotentialField",
    "PotentialRest",
    "Push",
    "RRTConnect",
    "configuration_space",
    "find_planner",
    "potential",
]
