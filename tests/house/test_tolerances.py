"""Thresholds have names: in Python small ones are in `tolerances`, in C++ each is a `constexpr`."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path

import pytest

from cspace import tolerances
from house import tree

SMALL = 1e-3
"""A number from here down is a threshold, or a number that keeps a quotient finite."""
STANDALONE = tree.PACKAGE / "export/python"
"""Files for users without cspace, which import numpy alone."""
FILES = [
    path
    for path in tree.python_files()
    if path != tree.PACKAGE / "tolerances.py" and path.parent != STANDALONE
]

CORE = tree.ROOT / "include/cspace"
CPP_FILES = sorted(
    path
    for folder in (CORE, tree.ROOT / "src")
    for path in folder.rglob("*")
    if path.suffix in {".hpp", ".cpp"}
)
CPP_COMMENTS_AND_STRINGS = re.compile(r'//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\\n])*"', re.S)
CPP_CONSTANTS = re.compile(r"constexpr[^;(){}=]*[={][^;]*;")
CPP_NUMBERS = re.compile(r"(?<![\w.])(?:0x[\da-f.']+p[-+]?\d+|(?:\d[\d']*\.?\d*|\.\d+)(?:e[-+]?\d+)?)", re.I)


def defaults(node: ast.AST) -> set[ast.AST]:
    """The default values of parameters and fields, which their docstrings give the reason for."""
    if isinstance(node, ast.arguments):
        return {*node.defaults, *node.kw_defaults} - {None}
    if isinstance(node, ast.ClassDef):
        return {each.value for each in node.body if isinstance(each, ast.AnnAssign) and each.value}
    return set()


def small_numbers(text: str) -> Iterator[ast.Constant]:
    nodes = list(ast.walk(ast.parse(text)))
    allowed = set().union(*map(defaults, nodes))
    for node in nodes:
        is_float = isinstance(node, ast.Constant) and isinstance(node.value, float)
        if is_float and 0 < abs(node.value) <= SMALL and node not in allowed:
            yield node


def small_cpp_numbers(text: str) -> Iterator[tuple[int, str]]:
    """Line and text of small numbers, and of those with a negative exponent, outside of constants."""
    for hidden in (CPP_COMMENTS_AND_STRINGS, CPP_CONSTANTS):
        text = hidden.sub(lambda match: re.sub(r"[^\n]", " ", match[0]), text)
    for match in CPP_NUMBERS.finditer(text):
        digits = match[0].lower().replace("'", "")
        value = float.fromhex(digits) if digits.startswith("0x") else float(digits)
        if 0 < value <= SMALL or re.search("[ep]-", digits):
            yield text.count("\n", 0, match.start()) + 1, match[0]


@pytest.mark.parametrize("path", FILES, ids=tree.module_name)
def test_no_threshold_stands_outside_tolerances(path: Path) -> None:
    for node in small_numbers(path.read_text(encoding="utf-8")):
        raise AssertionError(f"{path.relative_to(tree.ROOT)}:{node.lineno}: move {node.value} to tolerances")


def test_a_threshold_is_found() -> None:
    assert [node.value for node in small_numbers("def f(x, eps=1e-6):\n    return x < 1e-9")] == [1e-9]


def test_every_tolerance_has_a_reason_and_a_use() -> None:
    text = (tree.PACKAGE / "tolerances.py").read_text(encoding="utf-8")
    reasons = re.findall(r'^(\w+): Final = [^\n]+\n"""[^"]{20,}"""', text, re.M)
    assert reasons == tolerances.__all__
    others = "".join(path.read_text(encoding="utf-8") for path in FILES)
    assert not set(reasons) - set(re.findall(r"\w+", others)), "used nowhere"


@pytest.mark.parametrize("path", CPP_FILES, ids=lambda path: str(path.relative_to(tree.ROOT)))
def test_no_threshold_of_the_core_is_without_a_name(path: Path) -> None:
    for line, number in small_cpp_numbers(path.read_text(encoding="utf-8")):
        raise AssertionError(
            f"{path.relative_to(tree.ROOT)}:{line}: give {number} a constexpr name and a reason"
        )


@pytest.mark.parametrize(
    ("text", "numbers"),
    [
        ("if (x < 1e-9) y = 0.5 * x;  // 1e-12", ["1e-9"]),
        ("constexpr double a = 1e-9, b[] = {1e-3, 2e-2};\nreturn x < a ? 0x1p-53 : 1e300;", ["0x1p-53"]),
        ("if constexpr (n > 2) return x + 0.0005;", ["0.0005"]),
        ('throw Error("below 1e-9");', []),
        ("int x1e = 3; return v.e - 2 + 0x1f;", []),
    ],
)
def test_a_threshold_of_the_core_is_found(text: str, numbers: list[str]) -> None:
    assert [number for _, number in small_cpp_numbers(text)] == numbers


def test_every_tolerance_of_the_core_has_a_reason_and_a_use() -> None:
    home = CORE / "tolerances.hpp"
    blocks = home.read_text(encoding="utf-8").split("\n\n")
    blocks = [block for block in blocks if "constexpr" in block]
    assert not [block for block in blocks if not re.match("// .{20}", block)], "without a reason"
    names = re.findall(r"(\w+) = ", "".join(re.sub("//.*", "", block) for block in blocks))
    others = "".join(path.read_text(encoding="utf-8") for path in CPP_FILES if path != home)
    assert not set(names) - set(re.findall(r"tolerance::(\w+)", others)), "used nowhere"
