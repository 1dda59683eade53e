"""Inverse kinematics: every configuration that reaches a goal, or why there is none."""

from cspace.ik import subproblems
from cspace.ik.conditions import Condition, NoClosedFormError
from cspace.ik.families import Family
from cspace.ik.geometry import Geometry, geometry
from cspace.ik.numeric import NumericSolution, SampledSolutions, ik_many_starts, ik_numeric
from cspace.ik.solutions import Solutions
from cspace.ik.solutions_batch import SolutionsBatch
from cspace.ik.solve import inverse_kinematics

__all__ = [
    "Condition",
    "Family",
    "Geometry",
    "NoClosedFormError",
    "NumericSolution",
    "SampledSolutions",
    "Solutions",
    "SolutionsBatch",
    "geometry",
    "ik_many_starts",
    "ik_numeric",
    "inverse_kinematics",
    "subproblems",
]
