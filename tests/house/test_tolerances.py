"""Every threshold of the Python package is in `tolerances`: with a name, a unit and a reason."""

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
    assert not [name for name in reasons if not re.search(rf"\b{name}\b", others)], "used nowhere"
