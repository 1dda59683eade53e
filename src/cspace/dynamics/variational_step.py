"""The variational midpoint step, of order two: without friction it is symplectic and conserves momenta.

With the mean velocity w of a step from q_k to q_{k+1}, its middle q_m and L = T − V, the momenta at the ends
are

    p_k     = M(q_m) w − (h/2) ∂L/∂q(q_m, w) − (h/2) τ,
    p_{k+1} = M(q_m) w + (h/2) ∂L/∂q(q_m, w) + (h/2) τ.

The first equation is solved for w, the second continues. Friction is part of τ; a joint that it stops within
a step takes more of its forces at the beginning than at the end. The orientation of a floating base moves by
exp(h ω) R, its middle is exp(h ω/2) R, and its rows are carried to the ends by the Jacobians of the
exponential. Source: Marsden and West 2001, sections 1.6 and 2.3; Bou-Rabee and Marsden 2009 for groups.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from cspace.arrays import Array
from cspace.dynamics.coriolis import coriolis_matrix
from cspace.dynamics.inverse import gravity_torques
from cspace.dynamics.mass_matrix import mass_matrix
from cspace.dynamics.mechanics import Drive, Flags, Mechanics, State, advance_state
from cspace.dynamics.rows import torques_of_wrenches
from cspace.spatial import left_jacobian_inv_so3, left_jacobian_so3
from cspace.tolerances import STEP_CONVERGED, STEP_ROUNDED

MOST_ITERATIONS: Final = 80
"""Of Newton's method: each gains a digit or more at steps that resolve the motion; joints that change from
sliding to sticking need some more."""

MOST_DECAY: Final = 700.0
"""Decay whose exponential still is a double."""

SMALL_DECAY: Final = 1e-2
"""Decay h b / m below which the split of damping is that of its series, then exact to rounding."""


@dataclass(frozen=True, eq=False)
class Middle:
    """What acts in the middle of a step, (..., dof): the momentum M w, the forces ∂L/∂q + τ; and M."""

    M: Array
    momentum: Array
    push: Array


def step_variational(mechanics: Mechanics, state: State, drive: Drive, h: float) -> State:
    """The state after one variational midpoint step; rows whose equation is not solved become NaN."""
    M = mass_matrix(mechanics.robot, state.q, T_world_base=state.T_world_base, threads=mechanics.threads)
    p = np.einsum("...ij,...j", M, state.qd)
    late = split_forces(mechanics, state.qd, M, h)
    w, middle, failed = solve_step(mechanics, state, drive, h, p, late)
    ahead = carry_momentum(mechanics, middle, w, h * late)
    zero = np.zeros_like(w)
    end = advance_state(state, h * w, zero, mechanics.robot.floating)
    if failed.any():
        end = end.with_rows(failed, mechanics.rest(end))
    M_end = mass_matrix(mechanics.robot, end.q, T_world_base=end.T_world_base, threads=mechanics.threads)
    qd = np.linalg.solve(M_end, ahead[..., None])[..., 0]
    return State(end.q, np.where(failed[..., None], np.nan, qd), end.T_world_base)


def split_forces(mechanics: Mechanics, qd: Array, M: Array, h: float) -> Array:
    """Which part of the forces of a step acts at its end, (..., dof), the rest acting at its beginning.

    One half without friction. In general 1/x − 1/(exp(x) − 1) with the decay x = h b/m, so that one joint
    alone decays by exp(−x) however stiff its damping is, and to the right velocity under a constant torque
    (exponential fitting; Liniger and Willoughby 1970). The order remains two.
    """
    sticking = mechanics.dry / np.maximum(np.abs(qd), mechanics.friction_speed)
    x = h * (mechanics.damping + sticking) / np.diagonal(M, axis1=-2, axis2=-1)
    safe = np.clip(x, SMALL_DECAY, MOST_DECAY)
    result: Array = np.where(
        x < SMALL_DECAY, 0.5 - x / 12.0 + x**3 / 720.0, 1.0 / safe - 1.0 / np.expm1(safe)
    )
    return np.where(x > safe, 1.0 / np.maximum(x, 1.0), result)


def solve_step(
    mechanics: Mechanics, state: State, drive: Drive, h: float, p: Array, late: Array
) -> tuple[Array, Middle, Flags]:
    """The mean velocity of a step (..., dof), what acts in its middle, and which rows (...) have no solution.

    Newton's method with M, and the slope of friction, in place of the exact slope. A joint with dry friction
    that would change its direction stops first: from rest the iteration is monotone.
    """
    w, early = state.qd.copy(), h * (1.0 - late)
    failed = state.wild()
    size = change = np.full(failed.shape, np.inf)
    for iteration in range(MOST_ITERATIONS):
        middle, wild = find_middle(mechanics, state, drive, h, np.where(failed[..., None], 0.0, w))
        failed = failed | wild
        r = carry_momentum(mechanics, middle, w, -early) - p
        r = np.where(failed[..., None], 0.0, r)
        after = w - np.linalg.solve(find_slope(mechanics, middle.M, w, early), r[..., None])[..., 0]
        after = np.where((mechanics.dry > 0.0) & (np.sign(w) * after < 0.0), 0.0, after)
        last, change = change, np.abs(after - w).max(axis=-1, initial=0.0)
        if iteration == 0:
            size = np.maximum(np.abs(w).max(axis=-1, initial=0.0), change)
        w = after
        settled = (change <= STEP_CONVERGED * size) | (
            (change <= STEP_ROUNDED * size) & (change > 0.5 * last)
        )
        if (settled | failed).all():
            break
    failed = failed | ~settled
    w = np.where(failed[..., None], 0.0, w)
    middle, wild = find_middle(mechanics, state, drive, h, w)
    return w, middle, failed | wild


def find_slope(mechanics: Mechanics, M: Array, w: Array, early: Array) -> Array:
    """M, and the slope of the friction that acts at the beginning of a step (..., dof, dof)."""
    stick = mechanics.dry / mechanics.friction_speed * (1.0 - np.tanh(w / mechanics.friction_speed) ** 2)
    diagonal = np.arange(mechanics.robot.dof)
    A = M.copy()
    A[..., diagonal, diagonal] += early * (mechanics.damping + stick)
    return A


def find_middle(mechanics: Mechanics, state: State, drive: Drive, h: float, w: Array) -> tuple[Middle, Flags]:
    """What acts in the middle of a step of mean velocity w, and which rows (...) cannot be computed.

    ∂L/∂q = Cᵀ q̇ − g, of the rotation of a base less ω × (M q̇): its velocity is kept in axes of the world.
    """
    robot, n = mechanics.robot, mechanics.threads
    half = advance_state(state, 0.5 * h * w, w - state.qd, robot.floating)
    wild = half.wild()
    if wild.any():
        half = half.with_rows(wild, mechanics.rest(half))
    q, T = half.q, half.T_world_base
    M = mass_matrix(robot, q, T_world_base=T, threads=n)
    C = coriolis_matrix(robot, q, half.qd, T_world_base=T, threads=n)
    momentum = np.einsum("...ij,...j", M, half.qd)
    push = np.einsum("...ji,...j", C, half.qd) + drive.tau - mechanics.resistance(half.qd)
    push -= gravity_torques(robot, q, **mechanics.shared(half))
    pull = torques_of_wrenches(robot, q, drive.wrenches, mechanics.expressed_in, T)
    if pull is not None:
        push = push + pull
    if robot.floating:
        push[..., 3:6] -= np.cross(half.qd[..., 3:6], momentum[..., 3:6])
    return Middle(M, momentum, push), wild


def carry_momentum(mechanics: Mechanics, middle: Middle, w: Array, times: Array) -> Array:
    """The momentum (..., dof) at the end of a step or, with negative times, at its beginning.

    times (..., dof) [s]: for how long the forces act from the middle on, one half of the step for a base.
    """
    result: Array = middle.momentum + times * middle.push
    if mechanics.robot.floating:
        u = 2.0 * times[..., 3:6] * w[..., 3:6]
        far = ~(np.einsum("...i,...i", u, u) < np.pi**2)
        u = np.where(far[..., None], 0.0, u)
        half = np.einsum("...ji,...j", left_jacobian_so3(0.5 * u), middle.push[..., 3:6])
        turning = middle.momentum[..., 3:6] + times[..., 3:6] * half
        result[..., 3:6] = np.einsum("...ji,...j", left_jacobian_inv_so3(u), turning)
    return result
