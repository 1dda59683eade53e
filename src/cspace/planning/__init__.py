"""Planning: free ways of arms among obstacles, and the exact configuration space of arms with two joints."""

from cspace.planning.aorrtc import AORRTC
from cspace.planning.arm_planner import ArmPlanner
from cspace.planning.plan_result import STATUSES, Plan
from cspace.planning.planners import PLANNERS, find_planner
from cspace.planning.prm import PRM, LazyPRM, PRMStar
from cspace.planning.roadmap import Roadmap
from cspace.planning.rrt_connect import RRTConnect
from cspace.planning.space import ArmSpace
from cspace.planning.two_joints.answers import BoundaryCurve, Connection, FreeComponent
from cspace.planning.two_joints.configuration_space import ConfigurationSpace, configuration_space

__all__ = [
    "AORRTC",
    "PLANNERS",
    "PRM",
    "STATUSES",
    "ArmPlanner",
    "ArmSpace",
    "BoundaryCurve",
    "ConfigurationSpace",
    "Connection",
    "FreeComponent",
    "LazyPRM",
    "PRMStar",
    "Plan",
    "RRTConnect",
    "Roadmap",
    "configuration_space",
    "find_planner",
]
