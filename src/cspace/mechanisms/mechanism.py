"""A mechanism: a robot whose links close loops, each function of it that of its room."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from cspace import dynamics, kinematics, model
from cspace.arrays import Array, as_floats
from cspace.dynamics import Simulation
from cspace.errors import InputError, InputTypeError
from cspace.kinematics import AssemblyModes, LoopClosure, LoopConstraints, LoopFreedom, LoopMotion
from cspace.model import Loop
from cspace.robot import Robot
from cspace.tables import count_things, tabulate

Seed = int | np.random.Generator | None
Driven = Mapping[str, ArrayLike]


@tabulate("name", "joint_names", "loops")
class Mechanism:
    """A robot whose links close loops.

    The robot is the tree that remains when each loop is cut at one joint; its coordinates are those of the
    mechanism, and the loops say which of their values go together.

    robot: the tree, whose fk, jacobian and other functions work as ever. loops: model.Loop objects in
    addition to those of the robot's description. constraints: their equations φ(q) = 0, a
    kinematics.LoopConstraints. joint_names: the n coordinates of a configuration, in order.

    Raises InputError where there are no loops, and for loops that cannot be (see LoopConstraints);
    UnknownNameError for an unknown link.
    """

    def __init__(self, robot: Robot, loops: Iterable[Loop] = ()) -> None:
        if not isinstance(robot, Robot):
            raise InputTypeError(
                f"Mechanism needs a Robot, got {type(robot).__name__}; cs.load_robot(path) returns one"
            )
        self.robot = robot
        self.constraints = LoopConstraints(robot, (*robot.description.loops, *loops))
        self.joint_names = robot.joint_names

    @property
    def name(self) -> str:
        """The name of the robot."""
        return self.robot.name

    @property
    def loops(self) -> tuple[Loop, ...]:
        """The loops, those of the description first."""
        return self.constraints.loops

    def mobility(self, dimension: int = 3) -> int:
        """The degrees of freedom by the formula of Grübler and Kutzbach; see model.mobility.

        The formula counts dependent constraints twice: take dimension=2 for planar linkages, or `dof`.
        """
        return model.mobility(replace(self.robot.description, loops=self.loops), dimension=dimension)

    def freedom(self, q: ArrayLike) -> LoopFreedom:
        """The freedom at a configuration q (n,), with the rows that depend on others; see
        kinematics.loop_freedom."""
        return kinematics.loop_freedom(self.constraints, q)

    def dof(self, q: ArrayLike) -> int:
        """The degrees of freedom at a configuration q (n,): n − rank K."""
        return self.freedom(q).dof

    def residual(self, q: ArrayLike) -> Array:
        """φ(q): how far the loops are open. q (..., n). Returns (..., rows) [m, and sines of angles]."""
        return self.constraints.residual(q)

    def close(
        self,
        driven: Driven | None = None,
        *,
        near: ArrayLike | None = None,
        starts: int = 30,
        rng: Seed = 0,
    ) -> LoopClosure:
        """Configurations with closed loops, with driven coordinates at given values; see
        kinematics.close_loops.

        driven: coordinate → values (...). near (..., n): seeds. Returns a LoopClosure with q (..., n).
        """
        return kinematics.close_loops(self.constraints, driven, near=near, starts=starts, rng=rng)

    def assembly_modes(self, driven: Driven, *, starts: int = 200, rng: Seed = 0) -> AssemblyModes:
        """All configurations that are found for given driven coordinates.

        driven: coordinate → value. starts, rng: of the search; a mechanism with a closed form needs none and
        says that its answer is complete. Returns AssemblyModes with q (k, n). Raises as
        kinematics.find_assembly_modes.
        """
        return kinematics.find_assembly_modes(self.constraints, driven, starts=starts, rng=rng)

    def follow(self, driven: Driven, start: ArrayLike, *, time_limit: float | None = None) -> LoopMotion:
        """The motion while driven coordinates go through values (k,), from start (n,), within
        time_limit [s]; see kinematics.follow_loops. Returns a LoopMotion with q (k, n)."""
        return kinematics.follow_loops(self.constraints, driven, start, time_limit=time_limit)

    def velocities(self, q: ArrayLike, driven: Driven, *, out: Array | None = None) -> Array:
        """The velocities (..., dof) of all joints at q (..., n) when the driven ones move at given rates
        (...); see dynamics.loop_velocities."""
        return dynamics.loop_velocities(self.constraints, q, driven, out=out)

    def accelerations(
        self, q: ArrayLike, qd: ArrayLike, driven: Driven, *, out: Array | None = None
    ) -> Array:
        """The accelerations (..., dof) of all joints at q (..., n) and qd (..., dof) when the driven ones
        accelerate at given rates (...); see dynamics.loop_accelerations."""
        return dynamics.loop_accelerations(self.constraints, q, qd, driven, out=out)

    def forward_dynamics(self, q: ArrayLike, qd: ArrayLike, tau: ArrayLike, **acts: Any) -> Array:
        """The accelerations (..., dof) under torques tau (..., dof), at q (..., n) and qd (..., dof).

        acts: gravity, wrenches, expressed_in, friction, T_world_base, out, threads. See
        dynamics.constrained_forward_dynamics, which also names the errors.
        """
        return dynamics.constrained_forward_dynamics(self.constraints, q, qd, tau, **acts)

    def inverse_dynamics(
        self, q: ArrayLike, qd: ArrayLike, qdd: ArrayLike, driven: Sequence[str], **acts: Any
    ) -> Array:
        """The torques (..., dof) of the driven joints behind a motion q (..., n), qd, qdd (..., dof).

        acts: as of forward_dynamics. See dynamics.constrained_inverse_dynamics, which also names the errors.
        """
        return dynamics.constrained_inverse_dynamics(self.constraints, q, qd, qdd, driven, **acts)

    def loop_wrenches(
        self, q: ArrayLike, qd: ArrayLike, qdd: ArrayLike, tau: ArrayLike, **acts: Any
    ) -> Array:
        """What each loop exerts on its child link, (..., loops, 6), during a motion q (..., n), qd, qdd (...,
        dof) under torques tau (..., dof); see dynamics.loop_wrenches."""
        return dynamics.loop_wrenches(self.constraints, q, qd, qdd, tau, **acts)

    def kinetic_energy(self, q: ArrayLike, qd: ArrayLike, **options: Any) -> Array:
        """½ q̇ᵀ M q̇ (...) [J] at q (..., n) and qd (..., dof); see Robot.kinetic_energy."""
        return self.robot.kinetic_energy(q, qd, **options)

    def potential_energy(self, q: ArrayLike, **options: Any) -> Array:
        """The energy of the weights (...) [J] at q (..., n); see Robot.potential_energy."""
        return self.robot.potential_energy(q, **options)

    def simulate(
        self,
        q: ArrayLike,
        qd: ArrayLike,
        *,
        control: Callable[..., ArrayLike] | ArrayLike | None = None,
        duration: float,
        dt: float,
        **options: Any,
    ) -> Simulation:
        """The motion from a state q (..., n), qd (..., dof) on, with loops that stay closed to rounding.

        control: torques (..., dof), or a function of t, q and qd that returns them, such as dynamics.PD.
        options: gravity, wrenches, expressed_in, friction, friction_speed, T_world_base, every,
        stop_at_limits, time_limit, threads. See dynamics.simulate_loops, which also names the errors.
        """
        return dynamics.simulate_loops(
            self.constraints, q, qd, control=control, duration=duration, dt=dt, **options
        )

    def _one_position(self, driven: Driven) -> Array:
        """The configuration (n,) of driven coordinates with one number each; raises as assembly_modes."""
        q = self.configuration(driven)
        if q.ndim > 1:
            raise InputError(
                f"driven values have shape {q.shape[:-1]}, expected one number each; assembly modes are of"
                " one position"
            )
        return q

    def configuration(self, values: Mapping[str, ArrayLike]) -> Array:
        """A configuration (..., n) from values of coordinates by name, zero where none is given.

        values: coordinate → (...) [rad or m]. Raises UnknownNameError for an unknown one.
        """
        numbers, rows, lead = kinematics.loop_closure.check_driven(self.constraints, values, None)
        q = np.zeros((len(rows), len(self.joint_names)))
        q[:, numbers] = rows
        return as_floats(q.reshape((*lead, len(self.joint_names))), "values")

    def __repr__(self) -> str:
        loops = count_things(len(self.loops), "loop")
        return f"<Mechanism {self.name}: {len(self.joint_names)} coordinates, {loops}>"
