"""What the solver of an arm does, step by step, in words and in equations that hold."""

from cspace.ik.explain.ask import ik_plan
from cspace.ik.explain.findings import Step
from cspace.ik.explain.plan import IkPlan
from cspace.ik.explain.survey import Relation, StillDirection, StillPoint

__all__ = ["IkPlan", "Relation", "Step", "StillDirection", "StillPoint", "ik_plan"]
