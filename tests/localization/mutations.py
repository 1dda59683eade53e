"""Faults put into the text of a file."""

from __future__ import annotations

import numpy as np


def mutate(text: str, faults: list[str], rng: np.random.Generator) -> str:
    """A text with one to three faults: words replaced, removed or doubled, lines moved, the end cut off."""
    for _ in range(int(rng.integers(1, 4))):
        lines = text.split("\n")
        row = int(rng.integers(len(lines)))
        words = lines[row].split(" ")
        at = int(rng.integers(len(words)))
        match int(rng.integers(8)):
            case 0 | 1 | 2:
                words[at] = faults[int(rng.integers(len(faults)))]
            case 3:
                words = words[:at] + words[at + 1 :]
            case 4:
                words.insert(at, words[at])
            case 5:
                lines.insert(int(rng.integers(len(lines))), lines[row])
            case 6:
                other = int(rng.integers(len(lines)))
                lines[other], words = lines[row], lines[other].split(" ")
            case _:
                return text[: int(rng.integers(len(text) + 1))]
        lines[row] = " ".join(words)
        text = "\n".join(lines)
    return text
