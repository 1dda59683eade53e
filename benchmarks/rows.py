"""A line of the table of what must hold."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Row:
    """A line of the table. holds and aimed are None where nothing was measured or no aim is set."""

    what: str
    must: str
    aim: str
    measured: str
    holds: bool | None
    aimed: bool | None


def row(what: str, must: str, aim: str, measured: str, holds: bool | None, aimed: bool | None = None) -> Row:
    return Row(what, must, aim, measured or "not measured", holds if measured else None, aimed)
