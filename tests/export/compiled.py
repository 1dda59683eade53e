"""Exported arms compiled and asked, and what the library answers, in one shape."""

from __future__ import annotations

import ctypes
import os
import shutil
import subprocess
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest

HERE = Path(__file__).parent
STRICT = ["-Wall", "-Wextra", "-Wconversion", "-Werror", "-pedantic"]
COMPILERS = [name for name in ("g++", "clang++") if shutil.which(name)]
STATUS = ("unreachable", "exact", "singular", "not_a_pose")


@dataclass
class Answer:
    status: str
    complete: bool
    q: np.ndarray
    self_motion: np.ndarray
    T: np.ndarray
    J: np.ndarray


def compiler(*names: str) -> str:
    """The first compiler that is there, or the test is skipped."""
    for name in names:
        if name and shutil.which(name):
            return name
    return pytest.skip(f"no compiler: {', '.join(names)}")


def run(command: list[str | Path], cwd: Path) -> None:
    done = subprocess.run([str(word) for word in command], cwd=cwd, capture_output=True, text=True)
    assert done.returncode == 0, f"{' '.join(map(str, command))}\n{done.stderr[:4000]}"


def cpp_program(made, folder: Path, cxx: str, *flags: str) -> Path:
    """driver.cpp with the header of an export, compiled strictly."""
    made.write(folder)
    (header,) = made.files
    program = folder / "program"
    words = [f'-DHEADER="{header}"', f"-DARM={made.name}", f"-DLOCKED={len(made.locked)}", "-I", folder]
    run([cxx, "-std=c++17", *STRICT, *flags, *words, HERE / "driver.cpp", "-o", program], folder)
    return program


def c_program(made, folder: Path, cxx: str, cc: str) -> Path:
    """driver.c and the source of an export, each with its own compiler, linked by the one of C."""
    made.write(folder)
    header, source = made.files
    program = folder / "program"
    words = [f'-DHEADER="{header}"', f"-DARM={made.name}", f"-DLOCKED={len(made.locked)}", "-I", folder]
    run([cxx, "-std=c++17", "-O1", "-fno-exceptions", *STRICT, "-c", source, "-o", "arm.o"], folder)
    run([cc, "-std=c99", *STRICT, *words, HERE / "driver.c", "arm.o", "-lm", "-o", program], folder)
    return program


def shared_library(made, folder: Path, cxx: str) -> ctypes.CDLL:
    """The C interface of an export, written to the folder, as a library that Python loads."""
    made.write(folder)
    _, source = made.files
    flags = ["-std=c++17", "-O0", "-fPIC", "-shared", *STRICT]
    run([cxx, *flags, source, "-o", "arm.so"], folder)
    return ctypes.CDLL(str(folder / "arm.so"))


def ask(program: Path, goals: np.ndarray, dof: int) -> list[Answer]:
    data = np.int32(len(goals)).tobytes() + np.ascontiguousarray(goals).tobytes()
    done = subprocess.run([program], input=data, capture_output=True, timeout=300)
    assert done.returncode == 0, done.returncode
    row = np.dtype([("q", "f8", dof), ("self_motion", "i4"), ("T", "f8", (4, 4)), ("J", "f8", (6, dof))])
    answers, at = [], 0
    for _ in goals:
        count, status, complete = np.frombuffer(done.stdout, "i4", 3, at)
        rows = np.frombuffer(done.stdout, row, count, at + 12)
        at += 12 + count * row.itemsize
        answers.append(
            Answer(STATUS[status], bool(complete), rows["q"], rows["self_motion"] != 0, rows["T"], rows["J"])
        )
    assert at == len(done.stdout)
    return answers


def cxx() -> str:
    return compiler(os.environ.get("CXX", ""), "g++", "clang++", "c++")


def cc() -> str:
    return compiler(os.environ.get("CC", ""), "gcc", "clang", "cc")
