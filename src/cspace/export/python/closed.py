"""Arms of six joints in closed form, arms of four and five completed to six by joints that stay at zero."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from cspace.export.python.base import Array, Solutions, accept_candidate, inverse, make_answer, pose_gap
from cspace.export.python.trig_steps import Care

Branch = list[complex]  # the turns t1 … t6 of the Denavit–Hartenberg form


def goal_in_form(plan: dict[str, Any], T: Array) -> Array:
    """The goal as the closed form sees it."""
    goal = inverse(T) if plan["reversed"] else T
    return np.asarray(plan["to_form_left"] @ goal @ plan["to_form_right"])


def candidates(arm: dict[str, Any], T: Array, care: Care, stray: float) -> list[Array]:
    """The branches as configurations of the arm; those whose virtual joints are not at zero are left out."""
    plan, found = arm["plan"], []
    for branch in arm["branches"](plan, goal_in_form(plan, T), care):
        q, real = np.zeros(len(arm["axes"])), True
        for i, turn in enumerate(branch):
            angle = plan["sign"][i] * (np.angle(turn) - plan["form"]["offset"][i])
            if plan["joint"][i] >= 0:
                q[plan["joint"][i]] = angle
            else:
                real = real and abs(np.angle(np.exp(1j * angle))) <= stray
        if real:
            found.append(q)
    return found


def unconstrained_turns(plan: dict[str, Any], unconstrained: Array) -> list[complex]:
    """What the turns of the form are where the joints have the values that they take when free."""
    t = [plan["form"]["offset"][i] + plan["sign"][i] * (unconstrained[j] if j >= 0 else 0.0)
         for i, j in enumerate(plan["joint"])]  # fmt: skip
    if plan["family"] == 2:
        t[3] += t[1] + t[2]  # three parallel axes leave their sum free
    return [complex(np.exp(1j * angle)) for angle in t]


def sweep(arm: dict[str, Any], T: Array, care: Care, found: list[Array]) -> None:
    """Starts with each joint of the form turned around: where it is free, solutions lie along a family."""
    plain = candidates(arm, T, care, np.pi)
    for i in range(6):
        turned = replace(care, unconstrained=list(care.unconstrained))
        turned.unconstrained[i] *= complex(np.exp(2.4j))
        moved = candidates(arm, T, turned, np.pi)
        if len(moved) == len(plain) and np.allclose(moved, plain, atol=1e-3):
            continue
        for k in range(1, 16):
            turned.unconstrained[i] = care.unconstrained[i] * complex(np.exp(2j * np.pi * k / 16))
            for q in candidates(arm, T, turned, np.pi):
                accept_candidate(arm, T, found, q, 20)


def turn_free_wrist(arm: dict[str, Any], T: Array, care: Care, found: list[Array]) -> None:
    """Behind a shoulder without a solution: a free wrist turned to where the elbow reaches the goal."""
    care = replace(care, free=max(care.free, 1e-6))
    for shoulder in (0, 1):
        here = replace(care, shoulder=shoulder)
        known = len(found)
        for q in candidates(arm, T, here, 1e-3):
            if any(pose_gap(arm, q, other) < 1e-6 for other in found):
                known = -1
        for turn in arm["free_turns"](arm["plan"], goal_in_form(arm["plan"], T), here) if known >= 0 else []:
            here.unconstrained = [*care.unconstrained[:3], turn, *care.unconstrained[4:]]
            if any([accept_candidate(arm, T, found, q) for q in candidates(arm, T, here, 1e-3)]):
                break


def solve_closed(arm: dict[str, Any], T: Array, unconstrained: Array) -> Solutions:
    """Every branch, refined on the true arm; joints that the pose leaves free at their idle values."""
    plan = arm["plan"]
    slack = 4 * plan["form"]["deviation"]
    care = Care(max(1e-10, slack), 0.0, max(1e-12, slack), unconstrained_turns(plan, unconstrained))
    stray = 0.1 if plan["idealised"] else 1e-3
    found: list[Array] = []
    for spread in (0.0, slack) if plan["idealised"] else (0.0,):
        care.spread = spread
        for q in candidates(arm, T, care, stray):
            accept_candidate(arm, T, found, q)
    if plan["idealised"] and plan["virtual_joints"] and not found:
        for q in candidates(arm, T, replace(care, band=float(np.sqrt(care.band))), np.pi):
            accept_candidate(arm, T, found, q)
    if plan["idealised"] or plan["virtual_joints"]:
        sweep(arm, T, care, found)
    if "free_turns" in arm:
        turn_free_wrist(arm, T, care, found)
    return make_answer(arm, T, found)
