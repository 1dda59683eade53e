"""The entries of a legend of configurations: those of one name share one entry, and one colour."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Final

import numpy as np

from cspace.arrays import Array
from cspace.plot import colors

MOST_ENTRIES: Final = 24
"""The longest legend that fits beside a picture."""

Entries = list[tuple[int, str]]
"""For each entry the configuration whose mark it shows, -1 for none, and its text."""


def list_entries(names: Sequence[str], solid: int) -> Entries:
    """The entries for configurations of these names; the solid one stands for its name."""
    rows: dict[str, list[int]] = {}
    for k, name in enumerate(names):
        rows.setdefault(name, []).append(k)
    entries = [
        (solid if solid in alike else alike[0], name if len(alike) == 1 else f"{name} ({len(alike)}×)")
        for name, alike in rows.items()
    ]
    if len(entries) <= MOST_ENTRIES:
        return entries
    shown = entries[: MOST_ENTRIES - 1]
    return [*shown, (-1, f"… and {len(entries) - len(shown)} more")]


def tints_of(names: Sequence[str], inside: Any, solid: int) -> list[Array]:
    """One colour per configuration: hues, one per name, for those within limits, grey for others."""
    coloured = inside.copy()
    coloured[solid] = True
    hues = list(dict.fromkeys(name for name, fits in zip(names, coloured, strict=True) if fits))
    palette = np.roll(colors.make_palette(len(hues)), hues.index(names[solid]), axis=0)
    grey = np.array(colors.BARRED)
    return [palette[hues.index(name)] if fits else grey for name, fits in zip(names, coloured, strict=True)]


def mark_bold(legend: Any, entries: Entries, solid: int) -> None:
    """The text of the solid configuration in bold."""
    for (row, _), text in zip(entries, legend.get_texts(), strict=True):
        text.set_fontweight("bold" if row == solid else "normal")
