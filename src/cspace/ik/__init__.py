"""Inverse kinematics: every configuration that reaches a goal, or why there is none."""

from typing import TYPE_CHECKING

from cspace.ik import subproblems
from cspace.ik.conditions import Condition, NoClosedFormError
from cspace.ik.explain import IkPlan, InvariantDirection, InvariantPoint, Relation, Step, ik_plan
from cspace.ik.geometry import Geometry, geometry
from cspace.ik.numeric.descent import ik_many_starts, ik_numeric
from cspace.ik.numeric.multi_task import TaskSolution, ik_tasks, task_velocity
from cspace.ik.numeric.resolved_rate import resolved_rate
from cspace.ik.numeric.solution import NumericSolution, SampledSolutions
from cspace.ik.numeric.tasks import CenterOfMassTask, DirectionTask, PoseTask, PositionTask, PostureTask
from cspace.ik.redundancy.arm_angle import swivel
from cspace.ik.redundancy.feasible_intervals import redundancy
from cspace.ik.redundancy.result import Interval, Redundancy
from cspace.ik.self_motion.self_motion import SelfMotion
from cspace.ik.solutions import Solutions
from cspace.ik.solutions_batch import SolutionsBatch
from cspace.ik.solver import HasSolver, Solver, solver_of_robot
from cspace.ik.tracking.result import Branch, Track
from cspace.ik.tracking.track import track

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

if not TYPE_CHECKING:  # type checkers report such names themselves

    def __getattr__(name: str) -> object:
        import sys

        from cspace.errors import module_error

        raise module_error(sys.modules[__name__], name)
