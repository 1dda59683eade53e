"""The contenders: one small adapter each.

An adapter module has NAME (as printed), PACKAGE (the distribution, for its version), MODULE (what a user
imports) and any of the factories `ik(arm)`, `fk(arm)`, `jacobian(arm)`. A factory returns a Task, or raises
Refused with the contender's own reason. What a Task prepares from the problems is not timed: each contender
gets its own favourite input.
"""

from __future__ import annotations

import importlib
from collections.abc import Callable
from dataclasses import dataclass
from types import ModuleType
from typing import Any

from chains import Arm, Array

NAMES = ["cspace_", "eaik_", "ik_geo_", "ssik_", "ur_analytic", "pinocchio_", "toolbox"]


class Refused(Exception):
    """The contender does not do this arm or this task; the message is its reason."""


def need_turns(arm: Arm) -> None:
    """For contenders whose input has no word for a slide."""
    if not arm.turns.all():
        raise Refused("takes joints that turn only")


@dataclass
class Task:
    """One thing a contender does.

    prepare: a problem (pose (4, 4) or configuration (n,)) in the contender's favourite form (not timed).
    call: the timed call. read: from what the call returned to an array a user can index: (k, n)
    configurations, a pose (4, 4) or a Jacobian (6, n); timed as well, in a column of its own.
    exact: as read, for the judge and not timed: only what the contender itself calls a solution.
    batch: the same for all problems at once on one core, from what prepare_batch made of the stacked
    problems.
    """

    prepare: Callable[[Array], Any]
    call: Callable[[Any], Any]
    read: Callable[[Any], Array]
    exact: Callable[[Any], Array] | None = None
    batch: Callable[[Any], Any] | None = None
    prepare_batch: Callable[[Array], Any] = lambda problems: problems


def load(name: str) -> ModuleType:
    return importlib.import_module(f"peers.{name}")
