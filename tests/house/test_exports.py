"""What a room exports: named in `__all__`, importable, documented with the shapes of its arrays."""

from __future__ import annotations

import ast
import importlib
import inspect
import re
from pathlib import Path
from types import ModuleType

import pytest

from house import tree

ARRAYS = re.compile(r"\b(Array|ArrayLike|NDArray|ndarray)\b")
SHAPE = re.compile(r"\((\.\.\.|…|\d|n|m|k|dof|r|rows|links|frames)[^)]*\)")


def public_modules() -> list[Path]:
    """The modules that users import from: rooms that are a file, and the front of rooms that are a folder."""
    files = [path for path in tree.python_files() if not path.name.startswith("__main__")]
    return [
        path
        for path in files
        if len(path.relative_to(tree.PACKAGE).parts) == 1
        or (path.name == "__init__.py" and tree.room_of(path) != "cli")
    ]


def is_ours(node: ast.ImportFrom) -> bool:
    return bool(node.level) or (node.module or "").startswith("cspace")


def is_module(node: ast.ImportFrom, alias: ast.alias) -> bool:
    """Whether `from … import name` brings a whole module (or all its names) rather than one thing."""
    folder = tree.PACKAGE.parent / (node.module or "").replace(".", "/")
    return alias.name == "*" or (folder / alias.name).exists() or (folder / f"{alias.name}.py").exists()


def declared(path: Path) -> set[str]:
    """The public names that the file itself defines or gathers, read from its text."""
    names: set[str] = set()
    for node in tree.syntax(path).body:
        if isinstance(node, ast.FunctionDef | ast.ClassDef):
            names.add(node.name)
        elif isinstance(node, ast.ImportFrom) and path.name == "__init__.py" and is_ours(node):
            names.update(alias.asname or alias.name for alias in node.names if not is_module(node, alias))
    return {name for name in names if not name.startswith("_")}


def module_of(path: Path) -> ModuleType:
    return importlib.import_module(tree.module_name(path))


def exports(module: ModuleType) -> list[str]:
    """The names in `__all__`; a folder whose files are imported one by one exports none."""
    return getattr(module, "__all__", [])


@pytest.mark.parametrize("path", public_modules(), ids=tree.module_name)
def test_all_is_complete_and_importable(path):
    module = module_of(path)
    exported = exports(module)
    assert len(set(exported)) == len(exported), "a name twice"
    for name in exported:
        assert getattr(module, name) is not None
    assert declared(path) <= set(exported), "public, yet not in __all__"
    assert set(exported) <= set(dir(module)), "dir() shows what is exported"


def test_all_stands_in_no_internal_module():
    """Inside a room a name is public if it has no underscore; a second list of names would only age."""
    for path in set(tree.python_files()) - set(public_modules()) - {tree.PACKAGE / "cli/__init__.py"}:
        found = re.search(r"^__all__\b", path.read_text(encoding="utf-8"), re.M)
        assert not found, f"{path.relative_to(tree.ROOT)}: remove __all__"


ONE_WORD = {
    *("cross", "determinant", "perpendicular", "sinc", "skew", "unskew"),
    *("arguments", "main", "run"),  # what a verb of the command line, and a process, offer
    "solve",  # the core calls it by this name
}
"""Functions inside the rooms that one word names: operators of mathematics, and parts of a protocol."""
STANDALONE = {"export/python", "spatial/single.py"}
"""Files for users without cspace; the functions of single poses, called as single.inverse."""


def test_functions_inside_a_room_are_a_verb_and_an_object():
    exported = {name for path in public_modules() for name in exports(module_of(path))}
    for path in tree.python_files():
        where = path.relative_to(tree.PACKAGE)
        if str(where).startswith(tuple(STANDALONE)):
            continue
        for node in tree.syntax(path).body:
            if isinstance(node, ast.FunctionDef) and "_" not in node.name:
                known = node.name in exported | ONE_WORD
                assert known, f"{where}: {node.name} needs an object, such as read_{node.name}"


def exported_objects() -> list[tuple[str, object]]:
    found = {}
    for path in public_modules():
        module = module_of(path)
        for name in exports(module):
            thing = getattr(module, name)
            if inspect.isclass(thing) or inspect.isroutine(thing):
                found[f"{module.__name__}.{name}"] = thing
    return sorted(found.items())


def members(thing: object) -> list[tuple[str, object]]:
    """The public functions of a class of ours, or the function itself."""
    if not inspect.isclass(thing):
        return [("", thing)]
    bases = [base for base in reversed(thing.__mro__) if base.__module__.split(".")[0] == "cspace"]
    own = {name: value for base in bases for name, value in vars(base).items()}
    return [
        (name, getattr(value, "__func__", value))
        for name, value in own.items()
        if not name.startswith("_") and (inspect.isroutine(value) or isinstance(value, classmethod))
    ]


@pytest.mark.parametrize(("name", "thing"), exported_objects(), ids=lambda x: x if isinstance(x, str) else "")
def test_every_export_is_documented_with_the_shapes_of_its_arrays(name, thing):
    assert inspect.getdoc(thing), f"{name} has no docstring"
    for member, function in members(thing):
        label = f"{name}.{member}" if member else name
        text = inspect.getdoc(function)
        assert text, f"{label} has no docstring"
        try:
            signature = str(inspect.signature(function))
        except (ValueError, TypeError):
            continue
        if ARRAYS.search(signature):
            assert SHAPE.search(text) or SHAPE.search(inspect.getdoc(thing) or ""), f"{label}: say the shapes"
