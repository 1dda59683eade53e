"""Exported Python files need numpy alone and find what the library finds; they hold closed forms only."""

from __future__ import annotations

import ast
import subprocess
import sys
from types import ModuleType

import numpy as np
import pytest

import cspace as cs
from cspace.ik import NoClosedFormError
from export import agree, arms

ALLOWED = {"__future__", "collections", "dataclasses", "typing", "numpy"}
FAMILIES = [
    *("ur5e", "irb120", "yam", "kr6_r900", "romeo_left_leg", "al5d", "so101"),
    *("planar_1r", "planar_2r", "simplified_puma", "rpr", "PPP", "PRP", "RPP"),
    *("wrist_12_meet", "wrist_23_meet", "wrist_12_parallel", "wrist_skew", "parallel_234", "parallel_123"),
]
WITHOUT_FORM = ["gen3_lite", "scara", "stanford", "calibrated", "RRPRRR", "PPPRRR", "neighbours", "gen3"]


def module_of(text):
    """The text as a module that has been imported."""
    module = ModuleType("exported")
    sys.modules["exported"] = module  # where dataclasses look for the names of types
    exec(compile(text, "exported.py", "exec"), module.__dict__)
    return module


def check(name, count, seed):
    robot = arms.arm(name)
    module = module_of(robot.export("python").text)
    goals, regular = agree.goals(robot, count, seed)
    for k, goal in enumerate(goals):
        answer, found = module.ik(goal), robot.ik(goal)
        assert bool(answer) == bool(found), goal
        for q in answer.q:
            np.testing.assert_allclose(robot.fk(q), goal, atol=1e-8 * max(1.0, np.abs(goal[:3, 3]).max()))
            np.testing.assert_allclose(module.fk(q), robot.fk(q), atol=1e-12 * max(1.0, np.abs(q).max()))
            np.testing.assert_allclose(
                module.jacobian(q), robot.jacobian(q), atol=1e-11 * (1 + np.abs(q).max())
            )
        if k >= regular:
            continue
        assert answer.status == found.status
        assert len(answer) == len(found)
        assert answer.complete
        for q in found.q:
            assert agree.apart(q, answer.q, robot.joint_types) < 1e-6


@pytest.mark.slow
@pytest.mark.parametrize("name", FAMILIES)
def test_it_finds_what_the_library_finds(name):
    check(name, 8, seed=1)


@pytest.mark.parametrize("name", WITHOUT_FORM)
def test_an_arm_without_a_closed_form_is_refused(name, tmp_path):
    robot = arms.arm(name)
    with pytest.raises(NoClosedFormError, match=r"has no closed form, .* lang='cpp' or lang='c'") as caught:
        robot.export("python", tmp_path / "arm.py")
    assert str(caught.value).startswith(robot.name)
    assert list(tmp_path.iterdir()) == []
    assert robot.export("cpp").text


@pytest.mark.slow
@pytest.mark.parametrize("name", cs.robots.names())
def test_every_arm_of_the_catalogue_is_a_module_on_its_own(name):
    robot = cs.load_robot(name)
    try:
        made = robot.export("python")
    except NoClosedFormError:
        assert "elimination" in robot.export("cpp").method
        return
    tree = ast.parse(made.text)
    for node in ast.walk(tree):
        names = [a.name for a in node.names] if isinstance(node, ast.Import) else []
        names += [node.module] if isinstance(node, ast.ImportFrom) else []
        assert {name.split(".")[0] for name in names} <= ALLOWED
    assert "0BSD" in ast.get_docstring(tree)
    assert max(map(len, made.text.splitlines()), default=0) < 2000
    q = robot.random_configuration(rng=1, reach=0.3)
    locked = [q[robot.joint_names.index(joint)] for joint in made.locked]
    found = module_of(made.text).ik(robot.fk(q), *([locked] if locked else []))
    assert agree.apart(q, found.q, robot.joint_types) < 1e-5


def test_what_is_no_pose_is_refused():
    robot = cs.load_robot("ur5e")
    module = module_of(robot.export("python").text)
    for bad in (*agree.nonsense(robot), np.eye(3)):
        with pytest.raises(ValueError, match="T"):
            module.ik(bad)
    with pytest.raises(ValueError, match="expected 6 joints"):
        module.fk([0.0])


def test_limits():
    robot = cs.load_robot("irb120")
    module = module_of(robot.export("python").text)
    middle = (robot.limits.lower + robot.limits.upper) / 2
    q, inside = module.into_limits(middle + 2 * np.pi * np.array([1, -1, 0, 2, 0, 0]))
    assert inside
    np.testing.assert_allclose(q, middle, atol=1e-12)
    assert not module.into_limits(robot.limits.upper + 0.1)[1]


@pytest.mark.parametrize("name", ["irb120", "rpr", "ur5e"])
def test_rounding_beyond_a_limit_is_set_to_it(name):
    robot = cs.load_robot(name)
    module, limits = module_of(robot.export("python").text), robot.limits
    middle = robot.random_configuration(rng=0, reach=0.5)
    for side, way in ((limits.lower, -1), (limits.upper, 1)):
        turns = [2 * np.pi if kind == "R" else 0.0 for kind in robot.joint_types]
        on = np.where(np.isfinite(side), side, middle)
        for turn in (0, 1, -2):
            for off in (0.0, 1e-15, 5e-10):
                q, inside = module.into_limits(on + way * off + turn * np.array(turns))
                assert inside
                assert ((limits.lower <= q) & (q <= limits.upper)).all()
                assert np.abs(np.sin((q - on) / 2)).max() < 1e-9
        narrow = np.isfinite(side) & ((limits.upper - limits.lower < 6) | (np.array(turns) == 0))
        for joint in np.flatnonzero(narrow):
            q = middle.copy()
            q[joint] = side[joint] + way * 1e-6
            assert not module.into_limits(q)[1]


def test_the_file_and_its_example_run_alone(tmp_path):
    made = cs.load_robot("ur5e").export("python", tmp_path / "arm.py")
    made.write_example(tmp_path / "main.py")
    for script in ("arm.py", "main.py"):
        words = [sys.executable, "-W", "error", script]
        done = subprocess.run(words, cwd=tmp_path, capture_output=True, text=True)
        assert done.returncode == 0, done.stderr
        assert "configurations reach" in done.stdout
