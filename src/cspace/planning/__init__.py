"""Planning: free ways of arms among obstacles."""

from cspace.planning.aorrtc import AORRTC
from cspace.planning.arm_planner import ArmPlanner
from cspace.planning.plan_result import STATUSES, Plan
from cspace.planning.planners import PLANNERS, find_planner
from cspace.planning.rrt_connect import RRTConnect
from cspace.planning.space import ArmSpace

__all__ = ["AORRTC", "PLANNERS", "STATUSES", "ArmPlanner", "ArmSpace", "Plan", "RRTConnect", "find_planner"]
