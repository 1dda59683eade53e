"""Type checkers accept README's code as it is printed, and know one goal of inverse kinematics from many."""

from __future__ import annotations

import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

import pytest

from data import ROOT
from docs.test_blocks import blocks

CHECKERS = {"mypy": ["mypy", "--strict", "--no-error-summary"], "pyright": ["pyright"]}
RESULTS = """
from typing import assert_type

import numpy as np

import cspace as cs
from cspace.ik import Solutions, SolutionsBatch, Solver

robot = cs.load_robot("ur5e")
many = np.zeros((3, 4, 4))
assert_type(robot.ik(np.eye(4)), Solutions)
assert_type(robot.ik(np.eye(4).tolist(), locked={"joint": 0.3}).solver, Solver)
assert_type(robot.ik(position=[0.4, None, 0.3], direction=[0, 0, -1]), Solutions)
assert_type(robot.ik(many), SolutionsBatch)
assert_type(robot.solver.solve(many).solver, Solver)
"""


def check_types(checker: str, folder: Path, code: str) -> None:
    if find_spec(checker) is None:
        pytest.skip(f"{checker} is a development dependency")
    file = folder / "page.py"
    file.write_text(code, encoding="utf-8")
    command = [sys.executable, "-m", *CHECKERS[checker], str(file)]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, timeout=600)
    assert done.returncode == 0, done.stdout + done.stderr


@pytest.mark.oracle
@pytest.mark.parametrize("checker", CHECKERS)
def test_the_code_of_the_readme_passes(checker, tmp_path):
    code = [block.text for block in blocks(ROOT / "README.md") if block.language == "python"]
    check_types(checker, tmp_path, "\n".join(code) + "\n")


@pytest.mark.oracle
@pytest.mark.parametrize("checker", CHECKERS)
def test_one_goal_is_known_from_many(checker, tmp_path):
    check_types(checker, tmp_path, RESULTS)
