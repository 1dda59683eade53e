"""The parts of the page on localisation, one module per topic, and their lines of what must hold.

A topic is a file <topic>_tables.py beside this one, with MEASURED (the names of its results),
section(results) and ROWS; topics without a file are left out.
"""

from __future__ import annotations

from importlib import import_module
from pathlib import Path
from types import ModuleType
from typing import Any

TOPICS = ("pose_graph", "filters", "monte_carlo", "laser_slam", "landmark_slam", "consistency")


def modules() -> list[ModuleType]:
    """The topics that have a file."""
    here = Path(__file__).resolve().parent
    return [import_module(f"{name}_tables") for name in TOPICS if (here / f"{name}_tables.py").exists()]


MEASURED: list[str] = [name for module in modules() for name in module.MEASURED]
ROWS: list[Any] = [build for module in modules() for build in module.ROWS]


def section(results: dict[str, Any]) -> str:
    return "\n\n".join(module.section(results) for module in modules())
