"""Every example runs, says its idea in its first line, stays short and makes the pictures it speaks of."""

from __future__ import annotations

import ast
import os
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import cspace
from data import ROOT

EXAMPLES = sorted((ROOT / "examples").glob("*.py"))
LONGEST = 60


def names(path: Path) -> str:
    return path.stem


def run(path: Path, folder: Path) -> subprocess.CompletedProcess[str]:
    package = str(Path(cspace.__file__).parents[1])
    search = os.pathsep.join(filter(None, [package, os.environ.get("PYTHONPATH", "")]))
    environment = {**os.environ, "PYTHONPATH": search, "MPLBACKEND": "Agg", "PYTHONIOENCODING": "utf-8"}
    return subprocess.run(
        [sys.executable, str(path), str(folder)],
        cwd=folder,
        capture_output=True,
        text=True,
        encoding="utf-8",
        timeout=120,
        env=environment,
        check=False,
    )


def test_the_numbers_are_without_gaps():
    assert [int(path.stem[:2]) for path in EXAMPLES] == list(range(1, len(EXAMPLES) + 1))


@pytest.mark.parametrize("path", EXAMPLES, ids=names)
def test_it_is_short_and_says_its_idea_first(path):
    text = path.read_text(encoding="utf-8")
    assert len(text.splitlines()) <= LONGEST
    idea = ast.get_docstring(ast.parse(text))
    assert idea
    assert "\n" not in idea
    assert idea.endswith(".")


@pytest.mark.slow
@pytest.mark.parametrize("path", EXAMPLES, ids=names)
def test_it_runs_and_makes_its_pictures(path, tmp_path):
    wanted = set(re.findall(r'folder / "([\w.]+)"', path.read_text(encoding="utf-8")))
    if any(name.endswith(".png") for name in wanted):
        pytest.importorskip("matplotlib")
    done = run(path, tmp_path)
    assert done.returncode == 0, done.stderr
    assert done.stderr == ""
    assert done.stdout.strip()
    assert {entry.name for entry in tmp_path.iterdir()} == wanted
    for name in wanted:
        assert (tmp_path / name).stat().st_size > 500


def test_the_arm_of_the_example_in_cpp_is_that_of_the_catalogue():
    text = (ROOT / "examples/cpp/reach.cpp").read_text(encoding="utf-8")
    axes, points, tip = (
        [float(x) for x in re.findall(r"-?\d+(?:\.\d+)?", re.search(pattern, text, re.S)[1])]
        for pattern in (r"axes\[\] = (.*?);", r"points\[\] = (.*?);", r"chain\.tip = (.*?);")
    )
    chain = cspace.load_robot("ur5e").chain
    np.testing.assert_allclose(axes, chain.axes.ravel(), atol=1e-9)
    T = np.eye(4)
    T[:3, :3], T[:3, 3] = np.reshape(tip[:9], (3, 3)), tip[9:]
    np.testing.assert_allclose(T, chain.T_zero, atol=1e-9)
    along = np.cross(np.reshape(points, (6, 3)) - chain.points, chain.axes)
    np.testing.assert_allclose(along, 0, atol=1e-9)
