"""A concept that is written once stays so: a pattern recognises it outside its one file."""

from __future__ import annotations

import re
from dataclasses import dataclass

import pytest

from house.tree import ROOT


@dataclass(frozen=True)
class Concept:
    """A concept, its file, and the pattern of its code; elsewhere the file's functions are called."""

    name: str
    home: str
    pattern: str


WHOLE_TURN = r"\(?2(\.0)? \* (np|math|std::numbers::|M_)?\.?(pi|PI)\)?"

CONCEPTS = [
    Concept(
        "wrapping by 2π",
        "include/cspace/math/wrapping.hpp",
        rf"remainder\([^;]*{WHOLE_TURN}|{WHOLE_TURN} \* (std::)?(round|floor|ceil)\(",
    ),
    Concept(
        "Rodrigues' formula",
        "include/cspace/spatial/rotation.hpp",
        r"\bxy [-+] \w+\.z\b|\.x \* \w+\.y \* \w+ [-+] \w+\.z \* \w+",
    ),
    Concept(
        "logarithm of a rotation",
        "include/cspace/spatial/rotation.hpp",
        r"m\[2\]\[1\] - \w+\.m\[1\]\[2\]",
    ),
    Concept(
        "Cholesky and L D Lᵀ factorisation",
        "include/cspace/math/linear.hpp",
        r"(?i)(?<!sparse)(?<!sparse[ /])cholesky|A = L D Lᵀ|i == j \? (std::)?sqrt\(",
    ),
    Concept(
        "Householder reflection",
        "include/cspace/math/linear.hpp",
        r"copysign\((std::)?(sqrt\(\w+\)|length), A\[",
    ),
    Concept(
        "damped normal equations",
        "include/cspace/math/least_squares.hpp",
        r"\[(\w)\]\[\1\] (\+=|= \w+\[\1\]\[\1\] \+) ([\w.]+\.)?damping;",
    ),
    Concept(
        "step shortened to a stride",
        "include/cspace/math/least_squares.hpp",
        r"> ([\w:.]*stride|0\.\d+)(,| \?) \1 / ",
    ),
    Concept(
        "predictor along a curve",
        "include/cspace/math/continuation.hpp",
        r"0\.5 \* ([\w.]+) \* (\1 \* )?([\w.]+\.)?bend\[",
    ),
    Concept(
        "twist of a joint",
        "include/cspace/kinematics/jacobian.hpp",
        r"\? ([\w.]+(\[\w\])?) : cross\(\1, |, cross\(d, p - o\)",
    ),
    Concept(
        "error of the tip to first order",
        "include/cspace/ik/chain.hpp",
        r"sine_between\(\w+\.R, goal\.R\)",
    ),
    Concept(
        "product of exponentials",
        "include/cspace/ik/chain.hpp",
        r"T = T \* joint_motion\(|R = (\w+\.)?R \* (spatial::)?rotation_about\(\w+, c, s\)",
    ),
    Concept(
        "wrapping by 2π in Python",
        "src/cspace/math/wrapping.py",
        rf"np\.(mod|remainder)\(.*np\.pi|% {WHOLE_TURN} - np\.pi|TURN(: Final)? = {WHOLE_TURN}\n",
    ),
    Concept(
        "check of one positive number",
        "src/cspace/arrays.py",
        r"\.ndim or not \w+ > 0",
    ),
    Concept("lines of YAML", "src/cspace/files.py", r'"---", "\.\.\."'),
]

# Python files for users without cspace; they import numpy alone.
STANDALONE = "src/cspace/export/python/"


@pytest.mark.parametrize("concept", CONCEPTS, ids=lambda c: c.name)
def test_a_concept_stands_in_one_file(concept: Concept) -> None:
    endings = {".py"} if concept.home.endswith(".py") else {".hpp", ".cpp"}
    files = [p for folder in ("include", "src") for p in (ROOT / folder).rglob("*") if p.suffix in endings]
    found = {
        str(path.relative_to(ROOT))
        for path in files
        if re.search(concept.pattern, path.read_text(encoding="utf-8"))
    }
    copies = {name for name in found if not name.startswith(STANDALONE)} - {concept.home}
    assert concept.home in found, f"the pattern of {concept.name} no longer finds its own file"
    assert not copies, f"{concept.name} again in {sorted(copies)}; call {concept.home}"
