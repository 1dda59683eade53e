"""Plans of a robot to configurations, poses, partial goals and regions: to all their IK solutions."""

from cspace.plan_motion.plans import Plans, plan, plan_many

__all__ = ["Plans", "plan", "plan_many"]
