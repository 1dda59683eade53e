"""Numeric differential kinematics: descents to a pose, velocities, several tasks at once; for every robot."""

from cspace.ik.numeric.descend import METHODS, ik_many_starts, ik_numeric
from cspace.ik.numeric.multi_task import TaskSolution, ik_tasks, task_velocity
from cspace.ik.numeric.resolved_rate import resolved_rate
from cspace.ik.numeric.solution import NumericSolution, SampledSolutions
from cspace.ik.numeric.tasks import CenterOfMassTask, DirectionTask, PoseTask, PositionTask, PostureTask

__all__ = [
    "METHODS",
    "CenterOfMassTask",
    "DirectionTask",
    "NumericSolution",
    "PoseTask",
    "PositionTask",
    "PostureTask",
    "SampledSolutions",
    "TaskSolution",
    "ik_many_starts",
    "ik_numeric",
    "ik_tasks",
    "resolved_rate",
    "task_velocity",
]
