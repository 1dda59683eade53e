"""The configurations of a goal of `cs.plan`: IK solutions of poses, partial goals and regions."""

from cspace.plan_goals.find import explain_goals, find_goals
from cspace.plan_goals.goals import Goals

__all__ = ["Goals", "explain_goals", "find_goals"]
