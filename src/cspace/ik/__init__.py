"""Inverse kinematics: every configuration that reaches a goal, or why there is none."""

from cspace.ik import subproblems
from cspace.ik.conditions import Condition, NoClosedFormError
from cspace.ik.explain import IkPlan, InvariantDirection, InvariantPoint, Relation, Step, ik_plan
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
from cspace.ik.redundancy.arm_angle import swivel
from cspace.ik.redundancy.parameters import redundancy
from cspace.ik.redundancy.result import Interval, Redundancy
from cspace.ik.self_motion.self_motion import SelfMotion
from cspace.ik.solutions import Solutions
from cspace.ik.solutions_batch import SolutionsBatch
from cspace.ik.solver import HasSolver, Solver, solver_of_robot
from cspace.ik.tracking import Branch, Track, track

__all__ = [
    "Branch",
    "CenterOfMassTask",
    "Condition",
    "DirectionTask",
    "Geometry",
    "HasSolver",
    "IkPlan",
    "Interval",
    "InvariantDirection",
    "InvariantPoint",
    "NoClosedFormError",
    "NumericSolution",
    "PoseTask",
    "PositionTask",
    "PostureTask",
    "Redundancy",
    "Relation",
    "SampledSolutions",
    "SelfMotion",
    "Solutions",
    "SolutionsBatch",
    "Solver",
    "Step",
    "TaskSolution",
    "Track",
    "geometry",
    "ik_many_starts",
    "ik_numeric",
    "ik_plan",
    "ik_tasks",
    "redundancy",
    "resolved_rate",
    "solver_of_robot",
    "subproblems",
    "swivel",
    "task_velocity",
    "track",
]
