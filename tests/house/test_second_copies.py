"""A concept that is written once stays so: a pattern recognises it outside its one file."""

from __future__ import annotations

import re
from dataclasses import dataclass, field

import pytest

from house.tree import ROOT


@dataclass(frozen=True)
class Concept:
    """A concept, its file, and the pattern of its code; elsewhere the file's functions are called.

    apart: files that have it again, with the reason.
    """

    name: str
    home: str
    pattern: str
    apart: dict[str, str] = field(default_factory=dict)


WHOLE_TURN = r"\(?2(\.0)? \* (np|math|std::numbers::|M_)?\.?(pi|PI)\)?"

CONCEPTS = [
    Concept(
        "wrapping by 2π",
        "include/cspace/math/wrapping.hpp",
        rf"remainder\([^;]*({WHOLE_TURN}|two_pi|turn\b)"
        rf"|({WHOLE_TURN}|\bturn) \* (std::)?(round|floor|ceil|nearbyint)\("
        r"|\b(?P<period>\w+) \* (std::)?(round|nearbyint)\([^;()]* / (?P=period)\)"
        r"|> (half_turn|pi|std::numbers::pi) \? ",
    ),
    Concept(
        "multiples of 2π within limits",
        "include/cspace/math/wrapping.hpp",
        r"floor\(\(([\w.]+\.)?upper[^;]*\) / (turn|\(2 \* pi\))",
    ),
    Concept("digits of π and 2π", "include/cspace/math/trig.hpp", r"\b(3\.14159|6\.28318)"),
    Concept(
        "sines of several angles on lanes",
        "include/cspace/math/trig.hpp",
        r"\bsincos\(angles, |Pack<4> sines, cosines;",
    ),
    Concept(
        "frame turned about its z axis",
        "include/cspace/kinematics/forward.hpp",
        r"\bc \* x \+ s \* |\bs \* y \+ c \* x\b|\{\{\{c, -s, 0",
        {
            "include/cspace/collision/placement.hpp": "floats, not fused: docs/decisions/collision-lanes.md",
            "include/cspace/ik/general/elimination.hpp": "a constant: where an angle of a polynomial begins",
        },
    ),
    Concept(
        "frame tilted about its x axis",
        "include/cspace/kinematics/forward.hpp",
        r"\w+\.y = \w+\.z;\s+\w+\.z = -y;",
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
        r"(?i)(?<!sparse)(?<!sparse[ /])cholesky|A = L D Lᵀ|i == j \? (std::)?sqrt\("
        r"|\[((?P<a>\w+)( \* \w+ \+ |\]\[)(?P=a)|\w+ \* (?P<b>\w+) \+ (?P=b)|row)\] = [^;]*sqrt\("
        r"|(?P<M>\w)\[1\] / (?P=M)\[0\], \w+ = (?P=M)\[2\] / (?P=M)\[0\]",
        {
            "include/cspace/localization/landmarks/joint_compatibility.hpp": "a factor that gains rows as "
            "pairings are tried, and loses them again",
            "include/cspace/math/sparse/front.hpp": "a tile by columns in place, for kernels",
        },
    ),
    Concept(
        "elimination with pivoting",
        "include/cspace/math/linear.hpp",
        r"multiple = -A\[i\]\[k\] \* inverse|(\w)\[\w \* (\w+) \+ (\w)\] / \1\[\3 \* \2 \+ \3\]",
    ),
    Concept(
        "inverse of three rows",
        "include/cspace/math/linear.hpp",
        r"(\w)\[(4|3)\] \* \1\[(8|5)\] - \1\[(5|4)\] \* \1\[\4\]",
    ),
    Concept(
        "two linear equations",
        "include/cspace/math/plane.hpp",
        r"\([\w.]+ \* [\w.]+ - [\w.]+ \* [\w.]+\) / det",
    ),
    Concept(
        "inverse of two rows",
        "include/cspace/localization/landmarks/range_bearing.hpp",
        r"(\w)\[0\] \* \1\[3\] - \1\[1\] \* \1\[[12]\]",
    ),
    Concept(
        "Jacobian of the exponential",
        "include/cspace/spatial/left_jacobian.hpp",
        r"1\.0 / 24, 1\.0 / 720|square / (24|120|720)\b|\b1(\.0)? / 12(\.0)? \+"
        r"|\(1 - (c|(std::)?cos\(\w+\))\) / ",
        {"include/cspace/ik/numeric/error.hpp": "a series of two terms: its kernels are short"},
    ),
    Concept(
        "queue of a best-first search",
        "include/cspace/search/best_first.hpp",
        r"class Heap\b|std::priority_queue<",
        {
            "include/cspace/math/sparse/separator.hpp": "below the room search",
            "include/cspace/shapes/set_cover.hpp": "below the room search",
        },
    ),
    Concept(
        "Householder reflection",
        "include/cspace/math/linear.hpp",
        r"copysign\((std::)?(sqrt\(\w+\)|length), A\[",
    ),
    Concept(
        "damped least squares by reflections",
        "include/cspace/math/least_squares.hpp",
        r"-(std::)?sqrt\(damping \+ ",
    ),
    Concept(
        "rotation of Jacobi",
        "include/cspace/math/small_svd.hpp",
        r"/ \((d|(std::f)?abs\(\w+\)) \+ (std::)?(sqrt|hypot)\(",
        {
            "include/cspace/math/singular_values.hpp": "a matrix per lane, values alone",
            "include/cspace/math/symmetric_eigen.hpp": "two-sided, for symmetric matrices of any size",
        },
    ),
    Concept(
        "adaptive damping of a descent",
        "include/cspace/math/least_squares.hpp",
        r"\b(damping|mu) = [^;]*\b(lost|growth|grow)\b|damping \*= 0\.1|rule\.reject\(\)",
        {
            "include/cspace/localization/graph/optimizer.hpp": "sparse, scaled by the diagonal",
            "include/cspace/ik/refine.hpp": "damped by the square of the error and a singular value",
            "include/cspace/ik/numeric/descent.hpp": "a start per lane, which the next start replaces",
            "include/cspace/ik/numeric/multi_task.hpp": "each step is a quadratic program within limits",
        },
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
        rf"np\.(mod|remainder)\(.*(np\.pi|\bTURN\))|% ({WHOLE_TURN}|TURN\b)|TURN(: Final)? = {WHOLE_TURN}\n"
        r"|\bTURN \* (np\.)?(round|floor|ceil)\(|(round|floor|ceil)\(.* / TURN\)",
        {"src/cspace/maps/grow.py": "directions as integers, 2⁴⁰ per revolution"},
    ),
    Concept(
        "check of one positive number",
        "src/cspace/arrays.py",
        r"\.ndim or not \w+ > 0",
    ),
    Concept(
        "damped least squares in Python",
        "src/cspace/kinematics/loop_newton.py",
        r"damping(\[\w+\])? \*= |\bdamping\[\w+\] \* [A-Z]+|[A-Z]+ \* damping\b",
        {
            "src/cspace/cartesian/relax_chain.py": "a chain of blocks, whose damping follows the steps",
            "src/cspace/dynamics/possible_parameters.py": "one problem by QR, which its prior keeps regular",
        },
    ),
    Concept(
        "predictor and corrector in Python",  # closes loops by rows of numpy; in C++: math/continuation.hpp
        "src/cspace/kinematics/loop_closure.py",
        r"correction <= MOST_CORRECTION|tangent \* unit",
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
    assert concept.apart.keys() <= copies, (
        f"{concept.name} is no longer in {sorted(concept.apart.keys() - copies)}"
    )
    copies -= concept.apart.keys()
    assert concept.home in found, f"the pattern of {concept.name} no longer finds its own file"
    assert not copies, f"{concept.name} again in {sorted(copies)}; call {concept.home}"
