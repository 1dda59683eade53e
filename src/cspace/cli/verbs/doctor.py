"""`cspace doctor`: whether this installation is whole."""

from __future__ import annotations

import argparse
import platform
import sys
from collections.abc import Mapping
from types import MappingProxyType
from typing import Any, Final

import numpy as np

from cspace.cli.exits import Exit
from cspace.cli.output import Cell, Output, Table
from cspace.tolerances import SELF_CHECK

EXAMPLES: Final = """
cspace doctor
cspace doctor --json
"""

EXTRAS: Final[Mapping[str, str]] = MappingProxyType(
    {"rich": "cli", "matplotlib": "plot", "pyyaml": "ros", "xacro": "xacro"}
)
"""Optional packages and the extra that brings each."""

ARMS: Final = ("ur5e", "puma560", "kr6_r900")
"""The arms of the self-check."""
POSES: Final = 50
"""Poses per arm."""


def arguments(parser: argparse.ArgumentParser) -> None:
    """There are none."""


def run(args: argparse.Namespace, out: Output) -> int:
    """Print versions and optional parts and run the self-check; a failed check is a negative answer."""
    checks = [check_arm(name) for name in ARMS]
    extras = {name: version_of(name) for name in EXTRAS}
    healthy = all(each["passed"] for each in checks)
    if out.as_json:
        out.document(
            {
                "schema": "cspace.doctor/1",
                "versions": read_versions(),
                "extras": extras,
                "checks": checks,
                "healthy": healthy,
            }
        )
        return Exit.DONE if healthy else Exit.NEGATIVE
    absent = {name: f"not installed; pip install 'cspace[{extra}]'" for name, extra in EXTRAS.items()}
    out.facts({**read_versions(), **{name: version or absent[name] for name, version in extras.items()}})
    out.line()
    table = Table(["self-check", "poses", "solutions", "worst |fk(ik(T)) - T|", ""], left=frozenset({0, 4}))
    for each in checks:
        verdict = Cell("ok", "green") if each["passed"] else Cell("FAILED", "bold red")
        table.add(each["robot"], f"{each['poses']}", f"{each['solutions']}", f"{each['worst']:.1e}", verdict)
    out.table(table)
    return Exit.DONE if healthy else Exit.NEGATIVE


def read_versions() -> dict[str, str]:
    """What is running."""
    from cspace import __version__, _core

    return {
        "cspace": __version__,
        "instruction set": _core.isa,
        "python": sys.version.split()[0],
        "numpy": np.__version__,
        "platform": platform.platform(),
    }


def version_of(package: str) -> str | None:
    """The version of an installed package, or None."""
    from importlib import metadata

    try:
        return metadata.version(package)
    except metadata.PackageNotFoundError:
        return None


def check_arm(name: str) -> dict[str, Any]:
    """Solve poses of random configurations: every solution must reach its pose, and one must be the start."""
    from cspace.robots import load_robot

    robot = load_robot(name)
    q = np.random.default_rng(7).uniform(-2.8, 2.8, size=(POSES, robot.dof))
    worst, count = 0.0, 0
    for start in q:
        T = robot.fk(start)
        found = robot.ik(T).q
        away = np.abs(robot.fk(found) - T).max() if len(found) else np.inf
        back = np.abs(np.sin(0.5 * (found - start))).max(axis=1).min() if len(found) else np.inf
        worst, count = max(worst, float(away), float(back)), count + len(found)
    return {"robot": name, "poses": POSES, "solutions": count, "worst": worst, "passed": worst <= SELF_CHECK}
