"""Inverse kinematics: every configuration that reaches a goal, or why there is none."""

from cspace.ik import subproblems
from cspace.ik.conditions import Condition, NoClosedFormError
from cspace.ik.explain import IkPlan, Relation, Step, StillDirection, StillPoint, ik_plan
from cspace.ik.families import Family
from cspace.ik.feasible import redundancy
from cspace.ik.geometry import Geometry, geometry
from cspace.ik.numeric import (
    CenterOfMassTask,
    DirectionTask,
    NumericSolution,
    PoseTask,
    PositionTask,
    PostureTask,
    SampledSolutions,
    TaskSolution,
    ik_many_starts,
    ik_numeric,
    ik_tasks,
    resolved_rate,
    task_velocity,
)
from cspace.ik.redundancy import Interval, Redundancy
from cspace.ik.solutions import Solutions
from cspace.ik.solutions_batch import SolutionsBatch
from cspace.ik.solve import inverse_kinematics
from cspace.ik.swivel import swivel
from cspace.ik.tracking import Branch, Track, track

__all__ = [
    "Branch",
    "CenterOfMassTask",
    "Condition",
    "DirectionTask",
    "Family",
    "Geometry",
    "IkPlan",
    "Interval",
    "NoClosedFormError",
    "NumericSolution",
    "PoseTask",
    "PositionTask",
    "PostureTask",
    "Redundancy",
    "Relation",
    "SampledSolutions",
    "Solutions",
    "SolutionsBatch",
    "Step",
    "StillDirection",
    "StillPoint",
    "TaskSolution",
    "Track",
    "geometry",
    "ik_many_starts",
    "ik_numeric",
    "ik_plan",
    "ik_tasks",
    "inverse_kinematics",
    "redundancy",
    "resolved_rate",
    "subproblems",
    "swivel",
    "task_velocity",
    "track",
]
