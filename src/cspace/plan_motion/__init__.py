"""Plans of a robot to configurations, poses, partial goals and regions: to all their IK solutions."""

from cspace.plan_motion.plans import plan, plan_many

__all__ = ["plan", "plan_many"]
