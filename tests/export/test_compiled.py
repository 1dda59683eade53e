"""Exported headers compile alone and answer every kind of goal as the library does."""

from __future__ import annotations

import ctypes
import subprocess

import numpy as np
import pytest

import cspace as cs
from cspace import _core
from cspace.ik.wrapping import into_limits
from export import agree, arms, compiled


def check(robot, program, count=200):
    goals, regular = agree.goals(robot, count, seed=20)
    answers = compiled.ask(program, goals, robot.dof)
    pairs = list(zip(answers, goals, strict=True))
    certificates = [agree.check_regular(robot, answer, goal) for answer, goal in pairs[:regular]]
    assert np.mean(certificates) > 0.98  # rounding, and so the instruction set, may withhold one
    for answer, goal in pairs[regular:]:
        agree.check_special(robot, answer, goal)
    for answer in compiled.ask(program, agree.nonsense(robot), robot.dof):
        assert answer.status == "not_a_pose"
        assert len(answer.q) == 0


@pytest.mark.slow
@pytest.mark.parametrize("name", ["gen3_lite"])
def test_a_header_answers_as_the_library(name, tmp_path):
    robot = arms.arm(name)
    check(robot, compiled.cpp_program(robot.export("cpp"), tmp_path, compiled.cxx(), "-O1"))


@pytest.mark.slow
def test_the_c_interface_links_as_c_and_answers_as_the_library(tmp_path):
    robot = arms.arm("ur5e")
    check(robot, compiled.c_program(robot.export("c"), tmp_path, compiled.cxx(), compiled.cc()))


@pytest.mark.slow
@pytest.mark.parametrize("name", arms.ASKED)
def test_kinds_of_arms(name, tmp_path):
    robot = arms.arm(name)
    check(robot, compiled.cpp_program(robot.export("cpp"), tmp_path, compiled.cxx(), "-O1"))


@pytest.mark.slow
@pytest.mark.parametrize("name", ["ur5e"])
@pytest.mark.parametrize("cxx", compiled.COMPILERS)
def test_every_compiler_that_is_here(name, cxx, tmp_path):
    robot = arms.arm(name)
    check(robot, compiled.cpp_program(robot.export("cpp"), tmp_path, cxx, "-O1"))


@pytest.mark.slow
@pytest.mark.parametrize("name", ["rpr"])
def test_every_kind_in_c(name, tmp_path):
    robot = arms.arm(name)
    check(robot, compiled.c_program(robot.export("c"), tmp_path, compiled.cxx(), compiled.cc()))


@pytest.mark.slow
@pytest.mark.parametrize("name", ["rpr", "cobra600"])
def test_joints_are_moved_into_their_limits_as_the_library_moves_them(name, tmp_path):
    robot, rng = cs.load_robot(name), np.random.default_rng(0)
    made = robot.export("c")
    library = compiled.shared_library(made, tmp_path, compiled.cxx())
    moves = getattr(library, f"{made.name}_into_limits")
    lower, upper = robot.limits.lower, robot.limits.upper
    side = np.where(np.isfinite(lower), lower, -1.0), np.where(np.isfinite(upper), upper, 1.0)
    turns = np.array([2 * np.pi if kind == "R" else 0.0 for kind in robot.joint_types])
    inside = 0
    for off in (0.0, 1e-15, 5e-10, 1e-6, 0.1) * 40:
        q = np.where(rng.random(robot.dof) < 0.5, side[0] - off, side[1] + off)
        q = np.where(rng.random(robot.dof) < 0.3, rng.uniform(*side), q) + turns * rng.integers(-2, 3)
        moved, fits = into_limits(q, robot.joint_types, lower, upper)
        assert moves(q.ctypes.data_as(ctypes.POINTER(ctypes.c_double))) == fits
        if fits:
            assert ((lower <= q) & (q <= upper)).all()
            np.testing.assert_allclose(np.sin((q - moved) / 2), 0, atol=1e-15)
        inside += int(fits)
    assert 20 < inside < 190


@pytest.mark.slow
@pytest.mark.parametrize("name", ["irb120"])
@pytest.mark.parametrize("lanes", ["arrays", *["avx2"] * (_core.isa in ("avx2", "avx512"))])
def test_other_lanes(name, lanes, tmp_path):
    """Compilers without vector extensions keep lanes in arrays; newer processors have wider registers."""
    robot = arms.arm(name)
    made = robot.export("cpp")
    flags = ["-O3", "-mavx2", "-mfma"]
    if lanes == "arrays":
        flags = [f"-D{made.name.upper()}_IK_FORCE_ARRAY_LANES"]
    check(robot, compiled.cpp_program(made, tmp_path, compiled.cxx(), *flags))


@pytest.mark.slow
def test_arms_share_a_program(tmp_path):
    """Two headers and the library's own in one file: no macro, name or include guard meets its like."""
    for name in ("ur5e", "irb120"):
        cs.load_robot(name).export("cpp", tmp_path / f"{name}.hpp")
    (tmp_path / "main.cpp").write_text(
        '#include "ur5e.hpp"\n#include "irb120.hpp"\n#include "ur5e.hpp"\n'
        "int main() { double q[6] = {0.1, -1, 1, 0.3, 0.4, 0.5}, T[16]; ur5e::fk(q, T);\n"
        "const int a = ur5e::ik(T).count; irb120::fk(q, T); return a + irb120::ik(T).count != 16; }\n"
    )
    words = [compiled.cxx(), "-std=c++17", "-O1", *compiled.STRICT, "main.cpp", "-o", "main"]
    compiled.run(words, tmp_path)
    assert subprocess.run([tmp_path / "main"]).returncode == 0


def test_fast_math_is_refused(tmp_path):
    made = cs.load_robot("ur5e").export("cpp", tmp_path / "ur5e.hpp")
    (tmp_path / "main.cpp").write_text('#include "ur5e.hpp"\nint main() {}\n')
    words = [compiled.cxx(), "-std=c++17", "-ffast-math", "-fsyntax-only", "main.cpp"]
    done = subprocess.run(words, cwd=tmp_path, capture_output=True, text=True)
    assert done.returncode != 0
    assert f"{made.name}: compile without -ffast-math" in done.stderr


@pytest.mark.slow
@pytest.mark.parametrize("lang", ["cpp", "c"])
def test_the_example_runs(lang, tmp_path):
    made = cs.load_robot("gen3_lite").export(lang, tmp_path / ("arm.hpp" if lang == "cpp" else "arm.h"))
    made.write_example(tmp_path / ("main." + lang))
    if lang == "cpp":
        compiled.run([compiled.cxx(), "-std=c++17", *compiled.STRICT, "main.cpp", "-o", "main"], tmp_path)
    else:
        compiled.run([compiled.cxx(), "-std=c++17", "-fno-exceptions", "-c", "arm.cpp"], tmp_path)
        compiled.run(
            [compiled.cc(), "-std=c99", *compiled.STRICT, "main.c", "arm.o", "-lm", "-o", "main"], tmp_path
        )
    done = subprocess.run([tmp_path / "main"], capture_output=True, text=True)
    assert done.returncode == 0
    rows = np.array([line.split() for line in done.stdout.splitlines()[1:]], dtype=float)
    robot = cs.load_robot("gen3_lite")
    poses = robot.fk(rows)
    np.testing.assert_allclose(poses, np.broadcast_to(poses[0], poses.shape), atol=5e-5)
    assert len(rows) == len(robot.ik(poses[0]).q)
