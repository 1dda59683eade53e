"""Arms of six joints in closed form, arms of four and five completed to six by joints that stay at zero."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from cspace.export.python.base import Array, Solutions, accept_candidate, inverse, make_answer
from cspace.export.python.steps import Known, Settings, follow_steps

STARTS = 16  # values of an angle that nothing fixes


def goal_in_form(form: dict[str, Any], T: Array) -> Known:
    """The goal from the frame of axis 1 to that of axis 6: position p, rotation r."""
    P = inverse(form["base"]) @ (inverse(T) if form["reversed"] else T) @ inverse(form["tool"])
    turned = {f"r_{i + 1}{j + 1}": float(P[i, j]) for i in range(3) for j in range(3)}
    return Known(p_x=float(P[0, 3]), p_y=float(P[1, 3]), p_z=float(P[2, 3]), **turned)


def candidates(
    arm: dict[str, Any], T: Array, settings: Settings, stray: float
) -> list[tuple[Array, tuple[str, ...]]]:
    """The ways through the steps as configurations, each with the angles that nothing fixes.

    Ways whose virtual joints stray from zero are left out.
    """
    form, found = arm["form"], []
    for way in follow_steps(arm["steps"], goal_in_form(form, T), settings):
        q, real = np.zeros(len(arm["axes"])), True
        for i, angle in enumerate(arm["angles"](way)):
            value = form["sign"][i] * (angle - form["offset"][i])
            if form["joint"][i] >= 0:
                q[form["joint"][i]] = value
            else:
                real = real and abs(np.angle(np.exp(1j * value))) <= stray
        if real:
            found.append((q, way.free))
    return found


def unconstrained_angles(arm: dict[str, Any], q: Array) -> dict[str, float]:
    """The angles of the steps where the joints have the values that they take when free."""
    form = arm["form"]
    rows = zip(form["joint"], form["sign"], form["offset"], strict=True)
    t = [offset + sign * (q[joint] if joint >= 0 else 0.0) for joint, sign, offset in rows]
    names = [name for _, names in arm["steps"] for name in names]
    return {name: float(sum(t[int(number) - 1] for number in name[1:])) for name in names}


def sweep(arm: dict[str, Any], T: Array, settings: Settings, found: list[Array]) -> None:
    """Starts with each free angle turned around: solutions lie along a self-motion where an angle is free."""
    for name in {name for _, free in candidates(arm, T, settings, np.pi) for name in free}:
        for turn in 2 * np.pi * np.arange(1, STARTS) / STARTS:
            turned = {**settings.unconstrained, name: settings.unconstrained[name] + turn}
            for q, _ in candidates(arm, T, replace(settings, unconstrained=turned), np.pi):
                accept_candidate(arm, T, found, q, 20)


def solve_closed(arm: dict[str, Any], T: Array, unconstrained: Array) -> Solutions:
    """Every way through the steps, refined on the true arm."""
    form = arm["form"]
    slack = 4 * form["deviation"]
    settings = Settings(max(1e-10, slack), 0.0, max(1e-12, slack), unconstrained_angles(arm, unconstrained))
    tries = [(settings, 0.1 if form["idealised"] else 1e-3)]
    if form["idealised"]:
        tries.append((replace(settings, spread=slack), 0.1))
    found: list[Array] = []
    for each, stray in tries:
        for q, _ in candidates(arm, T, each, stray):
            accept_candidate(arm, T, found, q)
    if form["idealised"] and form["virtual_joints"] and not found:
        for q, _ in candidates(arm, T, replace(settings, band=float(np.sqrt(settings.band))), np.pi):
            accept_candidate(arm, T, found, q)
    if form["idealised"] or form["virtual_joints"]:
        sweep(arm, T, settings, found)
    return make_answer(arm, T, found)
