"""Plans and motions of a robot to configurations, poses, partial goals and regions: to all IK solutions."""

from cspace.plan_motion.motions import Motion, move, time_plan
from cspace.plan_motion.plans import plan, plan_many

__all__ = ["Motion", "move", "plan", "plan_many", "time_plan"]
