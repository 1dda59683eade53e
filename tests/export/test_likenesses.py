"""The exported code of an arm made from another one finds the other's solutions, mapped.

Both headers are compiled: of an arm, and of the same arm scaled, mirrored, read from the tip, with another
zero, on another base with another tool, or drawn with other points and directions.
"""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
import pytest

from export import arms, compiled
from ik.likenesses import LIKENESSES, arm_of, gap, random_configurations, size_of, weakest

EVERY = bool(os.environ.get("CSPACE_EVERY_EXPORT"))
NAMES = ["rpr", "irb120", "ur5e", "stanford", "PRRR", "gantry", "rail"] if EVERY else ["rail"]
ASKED = list(LIKENESSES) if EVERY else ["a thousandfold", "mirrored", "reversed"]
"""As in export/arms.py: to compile them all takes an hour."""
GOALS = 200
CLEAR = 1e-3
"""Smallest singular value of solutions next to which rounding makes and unmakes none."""


def program(robot, folder: Path) -> Path:
    folder.mkdir()
    return compiled.cpp_program(robot.export("cpp"), folder, compiled.cxx(), "-O0")


@pytest.fixture(scope="module", params=NAMES)
def arm(request, tmp_path_factory):
    """An arm without limits, and its program."""
    chain = arms.arm(request.param).chain
    robot = arm_of(chain.joint_types, chain.axes, chain.points, chain.T_zero)
    return robot, program(robot, tmp_path_factory.mktemp(request.param) / "arm")


@pytest.mark.slow
@pytest.mark.parametrize("name", ASKED)
def test_the_code_of_a_likeness_finds_the_same_solutions(arm, name, tmp_path):
    robot, own = arm
    rng = np.random.default_rng(3)
    like = LIKENESSES[name](robot, rng)
    T = robot.fk(random_configurations(robot, rng, GOALS))
    T_like = np.array([like.to_goal(goal) for goal in T])
    found = compiled.ask(own, T, robot.dof)
    others = compiled.ask(program(like.robot, tmp_path / "like"), T_like, robot.dof)
    clear = 0
    for one, other in zip(found, others, strict=True):
        assert len(one.q) > 0 < len(other.q)
        if min(weakest(robot, one.q).min(), weakest(like.robot, other.q).min()) < CLEAR:
            continue
        clear += 1
        assert one.status == other.status
        assert len(one.q) == len(other.q)
        for q in like.to_q(one.q):
            assert gap(like.robot, other.q, q, size_of(like.robot)).min() < 1e-6
    assert clear > GOALS / 2
