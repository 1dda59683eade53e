"""Planning: free ways of arms among obstacles, and configuration spaces, exact for arms with two joints."""

from cspace.planning.aorrtc import AORRTC
from cspace.planning.arm_planner import ArmPlanner
from cspace.planning.configuration_spaces import configuration_space
from cspace.planning.grid_search import GridSearch
from cspace.planning.joint_space.projections import Projection
from cspace.planning.joint_space.slices import Slice
from cspace.planning.joint_space.space import JointSpace
from cspace.planning.joint_space.volumes import Volume
from cspace.planning.plan_result import STATUSES, Plan
from cspace.planning.planners import PLANNERS, find_planner
from cspace.planning.plans import Plans
from cspace.planning.potential_field import Potential, PotentialField, PotentialRest, Push, potential
from cspace.planning.prm import PRM, LazyPRM, PRMStar
from cspace.planning.region import Region
from cspace.planning.roadmap import Roadmap
from cspace.planning.rrt import RRT, InformedRRTStar, RRTStar
from cspace.planning.rrt_connect import RRTConnect
from cspace.planning.space import ArmSpace
from cspace.planning.two_joints.answers import BoundaryCurve, Connection, FreeComponent
from cspace.planning.two_joints.configuration_space import ConfigurationSpace

__all__ = [
    "AORRTC",
    "PLANNERS",
    "PRM",
    "RRT",
    "STATUSES",
    "ArmPlanner",
    "ArmSpace",
    "BoundaryCurve",
    "ConfigurationSpace",
    "Connection",
    "FreeComponent",
    "GridSearch",
    "InformedRRTStar",
    "JointSpace",
    "LazyPRM",
    "PRMStar",
    "Plan",
    "Plans",
    "Potential",
    "PotentialField",
    "PotentialRest",
    "Projection",
    "Push",
    "RRTConnect",
    "RRTStar",
    "Region",
    "Roadmap",
    "Slice",
    "Volume",
    "configuration_space",
    "find_planner",
    "potential",
]
