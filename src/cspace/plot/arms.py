"""A robot in one configuration, and all configurations that reach a pose."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Final

import numpy as np

from cspace.arrays import Array, as_floats
from cspace.errors import InputError
from cspace.kinematics import KinematicModel
from cspace.plot import colors, planar
from cspace.plot.arm_bodies import solids_of
from cspace.plot.arm_stage import set_stage
from cspace.plot.axes import space_axes
from cspace.plot.legends import list_entries, mark_bold, tints_of
from cspace.plot.raytrace import stage
from cspace.plot.raytrace.scene import Group, draw_groups
from cspace.plot.skeleton import make_skeleton, planar_basis

GHOST: Final = 0.40
FAINT: Final = 0.16
"""Opacity of ghosts, and of those out of limits."""


def robot(
    arm: KinematicModel, q: Any, *, ax: Any | None = None, color: Any = None, title: str = ""
) -> list[Any]:
    """Draw a robot in one configuration, its base and tip frames and its shadow.

    arm: a Robot that is a chain. q: (dof,) [rad, m]. ax: 3-D axes, or 2-D ones for a planar arm; None makes a
    figure. color: of the links (RGB), light grey by default. A planar arm is drawn in its plane.
    Returns the artists.
    Raises InputError on a wrong shape, MissingExtraError without matplotlib.
    """
    q = as_floats(q, "q", last=(arm.dof,))
    if q.ndim != 1:
        raise InputError(f"q has shape {q.shape}; one picture shows one configuration, expected ({arm.dof},)")
    basis = planar_basis(arm.chain)
    if basis is not None and not hasattr(ax, "get_proj"):
        return planar.draw_configurations(
            arm, q[None], basis, ax=ax, solid=0, tints=[colors.JOINT if color is None else color], title=title
        )
    axes = space_axes(ax)
    drawn = make_skeleton(arm, q)
    set_stage(axes, [drawn], [drawn.T_tip])
    link = np.array(colors.LINK if color is None else color, dtype=np.float64)[:3]
    frames = Group(
        stage.make_triads(np.stack([drawn.T_base, drawn.T_tip]), 0.14 * drawn.length), shadow=False
    )
    artists = draw_groups(axes, [Group(solids_of(drawn, link, np.array(colors.JOINT))), frames])
    return artists + stage.write_title(axes, title)


def solutions(
    arm: KinematicModel,
    answer: Any,
    goal: Any | None = None,
    *,
    near: Any | None = None,
    labels: Sequence[str] | None = None,
    within: Sequence[bool] | None = None,
    ax: Any | None = None,
    title: str = "",
) -> list[Any]:
    """Draw every solution transparently, and the one nearest to `near` (or the first) opaquely.

    Configurations out of limits are grey.

    arm: a Robot that is a chain. answer: a result of `arm.ik`, or configurations (k, dof). goal: the pose
    (4, 4) or point they reach; by default where the tip of the first one is. near: (dof,) [rad, m].
    labels: k texts for the legend; by default the branches of the solutions. within: which configurations are
    within limits; by default according to the limits of the arm, modulo 2π. Returns the artists.
    Raises InputError if there is nothing to draw, MissingExtraError without matplotlib.
    """
    q = as_floats(getattr(answer, "q", answer), "configurations", last=(arm.dof,))
    if q.ndim != 2 or not len(q):
        raise InputError(f"nothing to draw: the configurations have shape {q.shape}, expected (k, {arm.dof})")
    inside = np.array(within_limits(arm, q) if within is None else within, dtype=bool)
    if len(inside) != len(q):
        raise InputError(f"within has {len(inside)} entries for {len(q)} configurations; give one each")
    names = list(labels) if labels is not None else branch_names(answer, inside)
    solid = 0 if near is None else nearest_row(q, as_floats(near, "near", last=(arm.dof,)), arm)
    tints = tints_of(names, inside, solid)
    basis = planar_basis(arm.chain)
    if basis is not None and not hasattr(ax, "get_proj"):
        return planar.draw_configurations(
            arm, q, basis, ax=ax, solid=solid, tints=tints, names=names, goal=goal, title=title
        )
    axes = space_axes(ax, aside=0.7 + 0.063 * max(len(text) for _, text in list_entries(names, solid)))
    drawn = [make_skeleton(arm, each) for each in q]
    T_goal = drawn[solid].T_tip if goal is None else stage.goal_pose(goal, drawn[solid].T_tip)
    set_stage(axes, drawn, [T_goal])
    white = (1.0, 1.0, 1.0)
    groups = [
        Group(
            solids_of(drawn[k], colors.mix_colors(tints[k], white, 0.25), tints[k]),
            GHOST if inside[k] else FAINT,
        )
        for k in range(len(q))
        if k != solid
    ]
    groups.append(Group(solids_of(drawn[solid], np.array(colors.LINK), tints[solid])))
    size = 0.20 * drawn[solid].length
    groups.append(Group(stage.make_triads(T_goal[None], size, thickness=0.045), shadow=False))
    artists = draw_groups(axes, groups)
    artists += write_legend(axes, names, tints, solid)
    return artists + stage.write_title(axes, title)


def within_limits(arm: KinematicModel, q: Array) -> Any:
    """Which of the configurations q (k, dof) are within the limits of the arm, modulo 2π."""
    from cspace.ik.wrapping import into_limits

    return into_limits(q, arm.chain.joint_types, arm.limits.lower, arm.limits.upper)[1]


def branch_names(answer: Any, inside: Any) -> list[str]:
    """The branches of the solutions as texts, or numbers, with a note for those out of limits."""
    branch = getattr(answer, "branch", None)
    count = len(inside)
    texts = [""] * count if branch is None or len(branch) != count else [str(each) for each in branch]
    names = [text or f"solution {k + 1}" for k, text in enumerate(texts)]
    return [name if fits else f"{name} (out of limits)" for name, fits in zip(names, inside, strict=True)]


def nearest_row(q: Array, near: Array, arm: KinematicModel) -> int:
    """The row of q nearest to `near`; revolute joints are compared modulo 2π."""
    from cspace.ik.wrapping import short_way

    return int(np.argmin((short_way(q - near, arm.chain.joint_types) ** 2).sum(axis=1)))


def write_legend(ax: Any, names: list[str], tints: Sequence[Any], solid: int) -> list[Any]:
    """The branches and their colours; the solid one is marked."""
    from matplotlib.lines import Line2D

    entries = list_entries(names, solid)
    handles = [
        Line2D(
            [], [], linestyle="none", marker="o" if k >= 0 else "", markersize=8 if k == solid else 7,
            markerfacecolor=(*tints[k], 1.0 if k == solid else 0.45), markeredgecolor=tints[k], label=text,
        )
        for k, text in entries
    ]  # fmt: skip
    own_figure = len(ax.figure.axes) == 1
    legend = ax.legend(
        handles=handles, loc="upper left", frameon=False, fontsize=9, labelcolor=colors.INK,
        handletextpad=0.3, borderaxespad=0.0, labelspacing=0.55,
        bbox_to_anchor=(0.02, 0.90) if own_figure else (0.0, 1.0),
        bbox_transform=ax.figure.transFigure if own_figure else ax.transAxes,
    )  # fmt: skip
    mark_bold(legend, entries, solid)
    return [legend]
