"""Numeric differential kinematics: descents to a pose, for every robot."""

from cspace.ik.numeric.descend import METHODS, ik_many_starts, ik_numeric
from cspace.ik.numeric.solution import NumericSolution, SampledSolutions

__all__ = ["METHODS", "NumericSolution", "SampledSolutions", "ik_many_starts", "ik_numeric"]
