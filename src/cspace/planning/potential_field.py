"""Potential field: descent of an attractive potential of the goal and repulsive potentials of obstacles.

Khatib 1986, "Real-time obstacle avoidance for manipulators and mobile robots". U(q) = U_goal(d) + Σ ½ k_r
(1/ρ − 1/ρ₀)² over the control points nearer than ρ₀ to something. d is the distance of the joints to the
nearest goal (L2 norm); joints that wrap take the short way. U_goal is ½ k d² within `cone` of the goal and
grows with the constant slope k · cone beyond it. Control points are all spheres of the links that move: each
obstacle repels a sphere at the distance ρ. Forces act on the joints by the transpose of the Jacobian. Links
that are checked against each other repel too, within a shorter distance: some links are always close.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Final, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from cspace._core import (
    ArmPlans,
    ArmProblems,
    FieldRest,
    FieldRule,
    evaluate_potential,
    plan_by_field,
    plan_each_by_field,
)
from cspace.arrays import Array, as_floats
from cspace.planning.arm_planner import Seed
from cspace.planning.edge_planner import ENDS, EdgePlanner
from cspace.planning.space import ArmSpace
from cspace.search import option
from cspace.tables import join_words, show_fields, shown
from cspace.tolerances import LARGEST_NUMBER, LEAST_GAIN

RESTS: Final = ("goal", "minimum", "saddle", "crease", "wall", "budget", "time")
"""How a descent ends, in the order of the core."""

SAID: Final = {
    "minimum": "the potential rises in every direction",
    "saddle": "the force vanishes, and the potential is too flat to find a descent; try another rho_0=",
    "crease": "an obstacle that is not convex pushes from two sides",
    "wall": "a motion further down is not free; a larger k_r= or rho_links= keeps links from contacts",
    "budget": "the budget of evaluations was used up; a larger looks= gets farther",
    "time": "the time limit was reached",
}

INFLUENCE: Final = 0.1
"""Share of the arm's reach within which obstacles repel, by default: some widths of a link."""

LINK_INFLUENCE: Final = 0.1
"""Share of rho_0 within which links repel each other by default: links of a wrist are a centimetre apart."""

CONE: Final = 0.5
"""Distance from the goal [rad or m] beyond which the attraction is constant by default: half a radian."""

MOST_NAMED: Final = 3
"""Pairs that a reason names: those that push most."""

LEAST_NAMED: Final = 0.01
"""Share of the strongest push that a pair must have to be named: others decide nothing."""


@show_fields
class Push(NamedTuple):
    """What repels a link at a configuration."""

    link: str
    """The link that is pushed."""
    other: str
    """The obstacle or link that pushes it."""
    force: float
    """The norm of the force on the joints, in units of k times rad; of several spheres their sum."""
    distance: float
    """The least distance of the two [m]."""


@show_fields
class PotentialRest(NamedTuple):
    """Where and how a descent ended."""

    kind: str
    """ "goal"; "minimum" or "crease", where the potential rises all around; otherwise "saddle", "wall",
    "budget" (of evaluations) or "time"."""
    q: Array
    """The configuration (dof,) [rad or m]."""
    distance: float
    """The distance from the nearest goal (L2 norm of the joints)."""
    force: float
    """The force that remains, in units of k times rad."""
    saddles: int
    """The number of equilibria that the descent left again."""
    pushes: tuple[Push, ...]
    """What repels there, the strongest first."""
    path: Array
    """The configurations (m, dof) of the descent."""
    values: Array
    """Their potentials (m,)."""
    gains: dict[str, float]
    """k, k_r, rho_0, cone, rho_links and step as they were used."""


@show_fields
class Potential(NamedTuple):
    """The potential at configurations q (..., dof)."""

    value: Array
    """(...) in units of k times rad²."""
    gradient: Array
    """(..., dof), by the joints."""


@dataclass(frozen=True, eq=False)
class PotentialField(EdgePlanner):
    """Gradient descent on the potential from a start until the arm reaches a goal or stops (Khatib 1986).

    In a step no sphere moves by more than half of its clearance from obstacles, so nothing is jumped, and
    each step is proved. Within `step` of the goal the arm goes there in a straight line if that is free.
    Joints stop at their limits. The status is "local_minimum" where the arm stops away from the goal and the
    potential rises all around: all eigenvalues of its second derivative are positive ("minimum"), or the
    slopes around cancel each other ("crease"). Elsewhere it is "undetermined". plan.stats["rest"], a
    PotentialRest, says where the descent ended, why, and what pushes; its path is the descent. With several
    starts each is tried, the one nearest to a goal first.
    """

    name = "potential_field"
    summary = "descent of an attractive and repulsive potential"

    simplify: bool = option(False, "shorten the path")
    k: float = option(1.0, "attraction", minimum=LEAST_GAIN, maximum=LARGEST_NUMBER)
    k_r: float | None = option(
        None,
        "repulsion; by default one sphere at the arm's reach balances the goal's attraction at half of rho_0",
        unit="rad² m²",
        minimum=LEAST_GAIN,
        maximum=LARGEST_NUMBER,
    )
    rho_0: float | None = option(
        None,
        "the distance of influence of obstacles; by default a tenth of the arm's reach",
        unit="m",
        minimum=LEAST_GAIN,
        maximum=LARGEST_NUMBER,
    )
    cone: float | None = option(
        None,
        "the distance from the goal beyond which the attractive force is constant; by default 0.5",
        unit="rad or m",
        minimum=LEAST_GAIN,
        maximum=LARGEST_NUMBER,
    )
    rho_links: float | None = option(
        None,
        "the distance of influence between links, 0 for none; by default a tenth of rho_0. Their k_r is less "
        "by the cube of rho_links / rho_0",
        unit="m",
        minimum=0,
        maximum=LARGEST_NUMBER,
    )
    step: float = option(0.1, "the longest step", unit="rad or m", minimum=LEAST_GAIN, maximum=LARGEST_NUMBER)
    looks: int = option(20000, "evaluations of the potential per start", minimum=1, maximum=1 << 40)

    def _fill_in(self, space: ArmSpace) -> PotentialField:
        """The options as they are used in a space."""
        rho_0 = INFLUENCE * space.reach if self.rho_0 is None else self.rho_0
        cone = CONE if self.cone is None else self.cone
        balanced = 0.25 * self.k * cone * rho_0**3 / space.reach
        return self._in_force(
            k_r=balanced if self.k_r is None else self.k_r,
            rho_0=rho_0,
            cone=cone,
            rho_links=LINK_INFLUENCE * rho_0 if self.rho_links is None else self.rho_links,
        )

    def _gains(self, space: ArmSpace) -> dict[str, float]:
        """k, k_r, rho_0, cone, rho_links and step as they are used."""
        given = self._fill_in(space).values
        return {name: given[name] for name in ("k", "k_r", "rho_0", "cone", "rho_links", "step")}

    def _make_rule(self, space: ArmSpace) -> FieldRule:
        """The options as the core takes them."""
        given = self._gains(space)
        return FieldRule(
            given["k"],
            given["k_r"],
            given["rho_0"],
            given["cone"],
            given["rho_links"],
            given["step"],
            self.looks,
        )

    def _plan_rows(self, space: ArmSpace, rows: tuple[Array, Array], rng: Seed) -> Any:
        """See EdgePlanner; with how the descent ended."""
        rule, options = self._make_rule(space), self._make_options(rng)
        return _Found(*plan_by_field(space.checker.core, space.bounds, space.wraps, *rows, options, rule))

    def _plan_each_rows(self, space: ArmSpace, problems: ArmProblems, rng: Seed, threads: int) -> Any:
        """See EdgePlanner."""
        rule, options = self._make_rule(space), self._make_options(rng)
        return _FoundEach(
            *plan_each_by_field(
                space.checker.core, space.bounds, space.wraps, problems, options, rule, threads
            )
        )

    def _list_statuses(self, found: Any) -> tuple[str, ...]:
        """See EdgePlanner."""
        statuses = super()._list_statuses(found)
        return tuple(
            "local_minimum" if status == "undetermined" and is_minimum(rest) else status
            for status, rest in zip(statuses, found.rests, strict=True)
        )

    def _list_stats(self, space: ArmSpace, found: Any) -> dict[str, Any]:
        """See EdgePlanner."""
        rest = self._name_rest(space, found.rest)
        return dict(found.stats) if rest is None else {**found.stats, "rest": rest}

    def _name_rest(self, space: ArmSpace, rest: Any) -> PotentialRest | None:
        """The rest of a descent by names; None if there was no descent."""
        if rest.kind < 0:
            return None
        pushes = tuple(
            Push(*space.checker.name_pair(contact), force, distance)
            for contact, force, distance in rest.pushes
        )
        rows = rest.rows
        return PotentialRest(
            RESTS[rest.kind],
            rows[-1],
            rest.distance,
            rest.force,
            rest.saddles,
            pushes,
            rows,
            rest.values,
            self._gains(space),
        )

    def _explain_end(self, space: ArmSpace, rows: tuple[Array, Array], found: Any) -> tuple[str, str]:
        """See EdgePlanner."""
        rest = self._name_rest(space, found.rest)
        if rest is None:
            return super()._explain_end(space, rows, found)
        saddles = f", over {rest.saddles} saddle{'s' * (rest.saddles != 1)}" if rest.saddles else ""
        if ENDS[found.status] == "found":
            return "found", f"descended the potential along a path of length {shown(found.cost)}{saddles}"
        status = "local_minimum" if is_minimum(found.rest) else "undetermined"
        ended = f"the descent ended {shown(rest.distance)} from the goal{saddles}"
        cause = SAID.get(rest.kind, "the path to the goal as given is not proved")
        pushes = [
            f"{each.other} pushes {each.link} from {1000 * each.distance:.3g} mm away"
            for each in rest.pushes[:MOST_NAMED]
            if each.force > LEAST_NAMED * rest.pushes[0].force
        ]
        return status, f"{ended}: {cause}" + (f"; {join_words(pushes)}" if pushes else "")


def is_minimum(rest: FieldRest) -> bool:
    """Whether the potential rises all around where a descent ended."""
    return rest.kind >= 0 and RESTS[rest.kind] in ("minimum", "crease")


class _FoundEach:
    """Plans of the core with how their descents ended."""

    def __init__(self, plans: ArmPlans, rests: list[FieldRest]) -> None:
        self.status, self.cost, self.corners = plans.status, plans.cost, plans.corners
        self.plans, self.rests = plans, rests

    def plan(self, k: int) -> _Found:
        """One of them."""
        return _Found(self.plans.plan(k), self.rests[k])


class _Found:
    """A plan of the core with how its descent ended."""

    def __init__(self, plan: Any, rest: Any) -> None:
        self.plan, self.rest = plan, rest

    def __getattr__(self, name: str) -> Any:
        return getattr(self.plan, name)


def potential(
    space: ArmSpace,
    goals: ArrayLike,
    q: ArrayLike,
    *,
    k: float = 1.0,
    k_r: float | None = None,
    rho_0: float | None = None,
    cone: float | None = None,
    rho_links: float | None = None,
) -> Potential:
    """The potential of goals (dof,) or (g, dof) at q (..., dof) [rad or m], and its gradient.

    k, k_r, rho_0, cone, rho_links: as for the planner "potential_field". Margins of the space count. In
    contact the value is that at a distance of 1e-9 rho_0.
    Raises InputError for configurations of another shape, or with NaN.
    """
    planner = PotentialField(k=k, k_r=k_r, rho_0=rho_0, cone=cone, rho_links=rho_links)
    at = as_floats(q, "q", last=(space.dof,), largest=LARGEST_NUMBER)
    rows = np.ascontiguousarray(at.reshape(-1, space.dof))
    targets = space.as_rows(goals, "goals")
    rule = planner._make_rule(space)
    values, gradients = evaluate_potential(space.checker.core, space.bounds, space.wraps, targets, rule, rows)
    return Potential(values.reshape(at.shape[:-1]), gradients.reshape(at.shape))
