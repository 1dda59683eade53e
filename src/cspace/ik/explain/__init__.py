"""What the solver of an arm does, step by step, in words and in equations that hold."""

from cspace.ik.explain.findings import Step
from cspace.ik.explain.make_plan import ik_plan
from cspace.ik.explain.plan import IkPlan
from cspace.ik.explain.survey import InvariantDirection, InvariantPoint, Relation

__all__ = ["IkPlan", "InvariantDirection", "InvariantPoint", "Relation", "Step", "ik_plan"]
