"""Several tasks at once: the velocities, or the configuration, with the least weighted error."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np

from cspace import _core
from cspace.arrays import Array, as_generator, one_array, positive_number, whole_number
from cspace.errors import InputError, InputTypeError, name_type
from cspace.ik.numeric.problem import bounds_of, further_starts, largest_speeds, middle_configuration
from cspace.ik.numeric.tasks import TASK_WIDTH, CenterOfMassTask, PostureTask, Task
from cspace.kinematics import KinematicModel
from cspace.kinematics.batch import check_robot, frame_number
from cspace.spatial.checks import one_pose
from cspace.tables import one_line, tabulate
from cspace.tolerances import FARTHEST, SETTLED, TASK_DONE

MOST_STARTS = 1_000_000


@tabulate()
@dataclass(frozen=True, eq=False, repr=False)
class TaskSolution:
    """The configuration with the least weighted error of several tasks, as far as steps find it.

    q (n,) [rad, m], inside the limits. T_world_base (4, 4): of a floating base where it ends, else as given.
    tasks: as given. position_error, rotation_error (k,) [m, rad]: of each task, zero for postures.
    settled: whether no step nearby reduces the error. iterations: how many steps it took from its start.
    Truthy if every task but postures is within the tolerance.
    """

    robot: KinematicModel
    q: Array
    T_world_base: Array
    tasks: tuple[Task, ...]
    position_error: Array
    rotation_error: Array
    settled: bool
    iterations: int
    success: bool

    def __bool__(self) -> bool:
        return self.success

    @property
    def reason(self) -> str:
        """What became of the tasks as one sentence."""
        if self.success:
            return f"all tasks are done after {self.iterations} steps"
        worst = int(np.argmax(np.maximum(self.position_error, self.rotation_error)))
        kind = type(self.tasks[worst]).__name__
        left = f"{self.position_error[worst]:.3g} m and {np.degrees(self.rotation_error[worst]):.3g}°"
        how = "no step nearby is better" if self.settled else "the steps ran out"
        return f"task {worst} ({kind}) misses its target by {left}; {how}, after {self.iterations} steps"

    def __repr__(self) -> str:
        return one_line("TaskSolution", f"of {self.robot.name}: {self.reason}")


def task_velocity(
    robot: KinematicModel,
    q: Any,
    tasks: Task | Iterable[Task],
    dt: float,
    *,
    limits: Any = True,
    velocity: Any = True,
    damping: float = 1e-6,
    T_world_base: Any = None,
) -> Array:
    """The joint velocities within the limits whose next step leaves the least weighted error of tasks.

    min ½ Σ |W (J q̇ dt − gain · e)|² + ½ damping |q̇ dt|² over q̇, with q + q̇ dt in the limits and |q̇| in
    those of the velocities: a small quadratic program, solved exactly.

    q (n,) [rad, m]. tasks: PoseTask, PositionTask, DirectionTask, CenterOfMassTask, PostureTask, on frames of
    any branch. dt [s]. limits: of the joints: True for the robot's own, False for none, or Limits; from
    outside them q̇ leads back. velocity: True for the robot's own limits, False for none, or (n,) [rad/s,
    m/s]. damping: how much motion costs. T_world_base (4, 4): where the base is.

    Returns q̇ (dof,) [rad/s, m/s]; of a floating base its twist [v; ω] in the world first.
    Raises InputError for wrong shapes, NaN, no task or a dt that is not positive; UnknownNameError for a
    frame that is not there.

    Kanoun, Lamiraux and Wieber 2011 (inequalities); Nocedal and Wright 2006, section 16.5.
    """
    check_robot(robot)
    rows, postures, _ = _packed(robot, tasks)
    at = _configuration(robot, q, "q")
    base = _base(T_world_base)
    qd, errors = np.empty(robot.dof), np.empty((len(rows), 2))
    step, cost = positive_number(dt, "dt"), positive_number(damping, "damping")
    speed = largest_speeds(robot, velocity)
    if not _core._task_velocity(
        robot, rows, postures, at, base, bounds_of(robot, limits), speed, step, cost, qd, errors
    ):
        raise InputError("the tasks and their weights exceed the range of float64; scale the weights")
    return qd


def ik_tasks(
    robot: KinematicModel,
    tasks: Task | Iterable[Task],
    start: Any = None,
    *,
    limits: Any = True,
    starts: int = 16,
    max_iterations: int = 500,
    tolerance: float = TASK_DONE,
    rng: int | np.random.Generator | None = None,
    T_world_base: Any = None,
) -> TaskSolution:
    """The configuration with the least error of weighted tasks: arms, trees, floating bases.

    min ½ Σ |W e(q)|² with q in the limits, by Levenberg–Marquardt steps that are quadratic programs.

    tasks, limits: as in task_velocity; the gains do not count. start (n,): the middle of the limits unless
    given. starts: how many to try at most until all tasks are done; the further ones are spread evenly over
    the limits, or drawn from rng. tolerance [m, rad]: up to which error a task is done. T_world_base (4, 4):
    where the base is, or, if it floats, where it starts.

    Returns TaskSolution: q (n,), T_world_base, the error of each task, reason; truthy if all but postures
    are done. Weights compromise: beside a PostureTask of weight w others miss by about w².
    Raises as task_velocity does.
    """
    check_robot(robot)
    rows, postures, listed = _packed(robot, tasks)
    rows[:, 2], postures[:, -1] = 1.0, 1.0
    bounds = bounds_of(robot, limits)
    first = middle_configuration(robot, bounds) if start is None else _configuration(robot, start, "start")
    base = _base(T_world_base)
    number = whole_number(starts, "starts", 1, MOST_STARTS)
    steps = whole_number(max_iterations, "max_iterations", 0, 1_000_000)
    done = positive_number(tolerance, "tolerance")
    rng = None if rng is None else as_generator(rng)
    kept = [not isinstance(task, PostureTask) for task in listed]

    def descend(begin: Array) -> tuple[float, TaskSolution]:
        q = np.clip(begin, bounds[0], bounds[1]) if bounds.size else begin.copy()
        T, errors, every = base.copy(), np.empty((len(rows), 2)), np.zeros((len(listed), 2))
        used, settled, cost = _core._task_solve(robot, rows, postures, q, T, bounds, steps, SETTLED, errors)
        every[kept] = errors
        reached = bool((every <= done).all())
        return cost, TaskSolution(robot, q, T, listed, every[:, 0], every[:, 1], settled, used, reached)

    best_cost, best = descend(first)
    if not best and number > 1:
        for begin in further_starts(robot, bounds, rows[:, 3:19].reshape(-1, 4, 4), number - 1, rng):
            cost, found = descend(begin)
            if found or cost < best_cost:
                best_cost, best = cost, found
            if found:
                break
    return best


def _packed(robot: KinematicModel, tasks: Task | Iterable[Task]) -> tuple[Array, Array, tuple[Task, ...]]:
    """The tasks as rows for the core: frames (k, TASK_WIDTH), and postures (k, 2 n + 1)."""
    listed = tuple(tasks) if isinstance(tasks, Iterable) else (tasks,)
    n = len(robot.joint_names)
    rows: list[Array] = []
    postures: list[Array] = []
    for task in listed:
        row = getattr(task, "_row", None)
        if row is None:
            raise InputTypeError(f"tasks contain {name_type(task)}, expected PoseTask, PostureTask …")
        if isinstance(task, PostureTask):
            if row.size != 2 * n + 1:
                raise InputError(f"a PostureTask has {(row.size - 1) // 2} joints, but {robot.name} has {n}")
            postures.append(row)
            continue
        if isinstance(task, CenterOfMassTask):
            if robot.mass == 0.0:
                raise InputError(f"no link of {robot.name} has a mass, which a CenterOfMassTask needs")
        else:
            row = row.copy()
            row[1] = frame_number(robot, task.frame)
        rows.append(row)
    if not listed:
        raise InputError("there are no tasks; give one, or several in a list: PoseTask, PostureTask …")
    return (
        np.array(rows).reshape(len(rows), TASK_WIDTH),
        np.array(postures).reshape(len(postures), 2 * n + 1),
        listed,
    )


def _configuration(robot: KinematicModel, value: Any, subject: str) -> Array:
    n = len(robot.joint_names)
    return one_array(value, subject, (n,), "one configuration", largest=FARTHEST)


def _base(T_world_base: Any) -> Array:
    return np.eye(4) if T_world_base is None else one_pose(T_world_base, "T_world_base")
