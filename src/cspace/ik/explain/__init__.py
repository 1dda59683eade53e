"""Explanations: the steps of the solver of an arm, as text and as equations that can be evaluated."""

from cspace.ik.explain.findings import Step
from cspace.ik.explain.make_plan import ik_plan
from cspace.ik.explain.plan import IkPlan
from cspace.ik.explain.survey import InvariantDirection, InvariantPoint, Relation

__all__ = ["IkPlan", "InvariantDirection", "InvariantPoint", "Relation", "Step", "ik_plan"]
