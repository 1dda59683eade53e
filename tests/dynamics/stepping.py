"""Steps of simulations from the functions of dynamics alone: what the compiled loop must agree with."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from cspace.dynamics.mechanics import State, advance_state, find_resistances
from cspace.dynamics.rows import torques_of_wrenches
from cspace.spatial import left_jacobian_inv_so3, left_jacobian_so3


@dataclass
class World:
    """A robot and what acts on it."""

    robot: Any
    gravity: Any = (0, 0, -9.81)
    wrenches: Any = None
    expressed_in: str = "base"
    friction_speed: float = 1e-2

    def __post_init__(self):
        self.damping, self.dry = find_resistances(self.robot)

    def resistance(self, qd):
        return self.damping * qd + self.dry * np.tanh(qd / self.friction_speed)

    def accelerations(self, state, tau):
        return self.robot.forward_dynamics(
            state.q,
            state.qd,
            tau - self.resistance(state.qd),
            gravity=self.gravity,
            wrenches=self.wrenches,
            expressed_in=self.expressed_in,
            friction=False,
            T_world_base=state.T_world_base,
        )

    def rate(self, state, dx):
        """The rate of the displacement that led to a state."""
        rate = state.qd.copy()
        if self.robot.floating:
            rate[3:6] = left_jacobian_inv_so3(dx[3:6]) @ rate[3:6]
        return rate


def step_rk4(world, state, tau, h):
    """One step of the classical Runge–Kutta method."""
    xs, vs = [state.qd], [world.accelerations(state, tau)]
    for part in (0.5, 0.5, 1.0):
        dx = h * part * xs[-1]
        inner = advance_state(state, dx, h * part * vs[-1], world.robot.floating)
        xs.append(world.rate(inner, dx))
        vs.append(world.accelerations(inner, tau))
    dx, dv = (h / 6 * (a + 2 * b + 2 * c + d) for a, b, c, d in (xs, vs))
    return advance_state(state, dx, dv, world.robot.floating)


def step_variational(world, state, tau, h):
    """One variational midpoint step, by Newton's method with the mass matrix in the middle."""
    robot = world.robot
    M = robot.mass_matrix(state.q, T_world_base=state.T_world_base)
    p, late = M @ state.qd, split_forces(world, state.qd, M, h)
    w, early = state.qd.copy(), h * (1 - late)
    for _ in range(80):
        M_middle, momentum, push = find_middle(world, state, tau, h, w)
        r = carry(robot, momentum, push, w, -early) - p
        slides = np.tanh(w / world.friction_speed)
        stick = world.dry / world.friction_speed * (1 - slides**2)
        change = np.linalg.solve(M_middle + np.diag(early * (world.damping + stick)), r)
        after = np.where((world.dry > 0) & (w * (w - change) < 0), 0.0, w - change)
        done = np.abs(after - w).max() <= 1e-14 * (1 + np.abs(w).max())
        w = after
        if done:
            break
    _, momentum, push = find_middle(world, state, tau, h, w)
    ahead = carry(robot, momentum, push, w, h * late)
    end = advance_state(state, h * w, np.zeros_like(w), robot.floating)
    qd = np.linalg.solve(robot.mass_matrix(end.q, T_world_base=end.T_world_base), ahead)
    return State(end.q, qd, end.T_world_base)


def split_forces(world, qd, M, h):
    x = h * (world.damping + world.dry / np.maximum(np.abs(qd), world.friction_speed)) / np.diagonal(M)
    safe = np.clip(x, 1e-2, 700.0)
    split = np.where(x < 1e-2, 0.5 - x / 12 + x**3 / 720, 1 / safe - 1 / np.expm1(safe))
    return np.where(x > safe, 1 / np.maximum(x, 1.0), split)


def find_middle(world, state, tau, h, w):
    """M, the momentum M w and the forces ∂L/∂q + τ in the middle of a step."""
    robot = world.robot
    half = advance_state(state, 0.5 * h * w, w - state.qd, robot.floating)
    q, T = half.q, half.T_world_base
    M = robot.mass_matrix(q, T_world_base=T)
    momentum = M @ w
    push = robot.coriolis_matrix(q, w, T_world_base=T).T @ w + tau - world.resistance(w)
    push -= robot.gravity_torques(q, gravity=world.gravity, T_world_base=T)
    pull = torques_of_wrenches(robot, q, world.wrenches, world.expressed_in, T)
    push = push if pull is None else push + pull
    if robot.floating:
        push[3:6] -= np.cross(w[3:6], momentum[3:6])
    return M, momentum, push


def carry(robot, momentum, push, w, times):
    result = momentum + times * push
    if robot.floating:
        u = 2 * times[3:6] * w[3:6]
        turning = momentum[3:6] + times[3:6] * (left_jacobian_so3(0.5 * u).T @ push[3:6])
        result[3:6] = left_jacobian_inv_so3(u).T @ turning
    return result


STEPS = {"rk4": step_rk4, "variational": step_variational}
