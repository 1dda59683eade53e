"""Explicit Runge–Kutta steps in the group of motions: the classical one, and that of Dormand and Prince.

A step is a displacement and a change of velocity. The orientation of a floating base is exp(u) R with a
rotation vector u, which obeys u' = J⁻¹(u) ω (Munthe-Kaas 1999); all else is added.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from cspace.arrays import Array
from cspace.dynamics.mechanics import Drive, Mechanics, State, advance_state, displacement_rate

Weights = tuple[float, ...]

RK4: Final[tuple[Weights, ...]] = ((), (1 / 2,), (0, 1 / 2), (0, 0, 1))
RK4_END: Final[Weights] = (1 / 6, 1 / 3, 1 / 3, 1 / 6)

DORMAND_PRINCE: Final[tuple[Weights, ...]] = (
    (),
    (1 / 5,),
    (3 / 40, 9 / 40),
    (44 / 45, -56 / 15, 32 / 9),
    (19372 / 6561, -25360 / 2187, 64448 / 6561, -212 / 729),
    (9017 / 3168, -355 / 33, 46732 / 5247, 49 / 176, -5103 / 18656),
    (35 / 384, 0, 500 / 1113, 125 / 192, -2187 / 6784, 11 / 84),
)
DORMAND_PRINCE_END: Final[Weights] = (*DORMAND_PRINCE[-1], 0)
DORMAND_PRINCE_ERROR: Final[Weights] = (
    *(-71 / 57600, 0, 71 / 16695, -71 / 1920, 17253 / 339200, -22 / 525),
    1 / 40,
)
"""The weights of the fifth order less those of the fourth."""

DORMAND_PRINCE_DENSE: Final[tuple[Weights, ...]] = (
    (1, 0, 0, 0, 0, 0, 0),
    (
        *(-8048581381 / 2820520608, 0, 131558114200 / 32700410799, -1754552775 / 470086768),
        *(127303824393 / 49829197408, -282668133 / 205662961, 40617522 / 29380423),
    ),
    (
        *(8663915743 / 2820520608, 0, -68118460800 / 10900136933, 14199869525 / 1410260304),
        *(-318862633887 / 49829197408, 2019193451 / 616988883, -110615467 / 29380423),
    ),
    (
        *(-12715105075 / 11282082432, 0, 87487479700 / 32700410799, -10690763975 / 1880347072),
        *(701980252875 / 199316789632, -1453857185 / 822651844, 69997945 / 29380423),
    ),
)
"""The weights of θ, θ², θ³ and θ⁴ between the ends of a step (Shampine 1986)."""


@dataclass(frozen=True, eq=False)
class Stages:
    """The rates of displacement and of velocity, (..., dof) each, at the stages of a step."""

    h: float
    xs: list[Array]
    vs: list[Array]

    def changes(self, weights: Sequence[float]) -> tuple[Array, Array]:
        """h times the weighted sums of the rates."""
        return self.h * weigh_rates(weights, self.xs), self.h * weigh_rates(weights, self.vs)


def weigh_rates(weights: Sequence[float], rates: Sequence[Array]) -> Array:
    """The weighted sum of rates (..., dof)."""
    total = np.zeros_like(rates[0])
    for weight, rate in zip(weights, rates, strict=False):
        if weight:
            total = total + weight * rate
    return total


def find_stages(
    mechanics: Mechanics, state: State, drive: Drive, h: float, table: tuple[Weights, ...]
) -> Stages:
    """The rates at the stages of a Runge–Kutta method."""
    floating = mechanics.robot.floating
    stages = Stages(h, [state.qd], [mechanics.accelerations(state, drive)])
    for weights in table[1:]:
        dx, dv = stages.changes(weights)
        inner = advance_state(state, dx, dv, floating)
        stages.xs.append(displacement_rate(inner, dx, floating))
        stages.vs.append(mechanics.accelerations(inner, drive))
    return stages


def step_rk4(mechanics: Mechanics, state: State, drive: Drive, h: float) -> State:
    """The state after one step of the classical Runge–Kutta method, of order four."""
    stages = find_stages(mechanics, state, drive, h, RK4)
    return advance_state(state, *stages.changes(RK4_END), mechanics.robot.floating)
