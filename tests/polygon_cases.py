"""The degenerate polygons of tests/cases/polygons: worlds, questions, and what is true."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import tomllib

import cspace as cs

FOLDER = Path(__file__).resolve().parent / "cases" / "polygons"


@dataclass(frozen=True)
class Case:
    """One world and one question; where the verdict is "error", making or asking it raises."""

    shows: str
    obstacles: list[list[list[list[float]]]]
    verdict: str
    bounds: list[float] | None = None
    start: list[float] | None = None
    goal: list[float] | None = None
    repair: bool = False
    says: tuple[str, ...] = ()
    """Words of the error, or of the repairs in their order."""
    length: float = float("inf")

    def world(self) -> cs.PolygonWorld:
        return cs.PolygonWorld(self.obstacles, self.bounds, repair=self.repair)


def polygon_cases(*verdicts: str) -> list[Case]:
    found: list[Case] = []
    for path in sorted(FOLDER.glob("*.toml")):
        rows: list[dict[str, Any]] = tomllib.loads(path.read_text(encoding="utf-8"))["case"]
        found += [Case(**{**row, "says": tuple(row.get("says", ()))}) for row in rows]
    return [case for case in found if not verdicts or case.verdict in verdicts]
