"""The source tree as data: modules, rooms, imports and includes. Shared by the tests of this folder."""

from __future__ import annotations

import ast
import re
import subprocess
from contextlib import suppress
from dataclasses import dataclass
from functools import cache
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PACKAGE = ROOT / "src/cspace"

# The rooms from the ground up. A room uses the tiers below its own, never a neighbour in the same tier.
TIERS: list[set[str]] = [
    {"errors", "late_imports", "tolerances", "_core"},
    {"arrays", "files", "tables"},
    {"buffer_pool"},
    {"math"},
    {"spatial"},
    {"model", "shapes"},
    {"kinematics", "maps", "mobile"},
    {"dynamics", "collision", "search"},
    {"ik", "planning", "trajectory", "navigation", "localization"},
    {"export", "cartesian"},
    {"robot"},
    {"robots", "reach", "plan_motion", "mechanisms"},
    {"plot", "lab"},
    {"cli"},
    {"cspace", "__main__"},
]
RANK = {room: rank for rank, tier in enumerate(TIERS) for room in tier}

# What a room may import besides numpy and the standard library, and only inside its functions.
OPTIONAL_IMPORTS = {
    "collision": {"coal"},
    "model": {"tomli", "tomllib", "xacro"},  # the latter is in the standard library from Python 3.11 on
    "cli": {"rich"},
    "maps": {"PIL"},
    "plot": {"matplotlib", "PIL"},  # the latter comes with the former
    "trajectory": {"yaml"},
    "lab": {"viser", "websockets"},
}


@dataclass(frozen=True)
class Import:
    """One import: the module it names, where it stands, and whether it runs when its module is imported."""

    module: str
    where: str
    at_import: bool


def python_files() -> list[Path]:
    return sorted(PACKAGE.rglob("*.py"))


@cache
def syntax(path: Path) -> ast.Module:
    return ast.parse(path.read_text(encoding="utf-8"))


@cache
def nodes(path: Path) -> list[ast.AST]:
    """Of the syntax tree of a file."""
    return list(ast.walk(syntax(path)))


def room_of(path: Path) -> str:
    """The room a file of the package belongs to: its folder under the package, or its own name."""
    first = path.relative_to(PACKAGE).parts[0].removesuffix(".py")
    return "cspace" if first == "__init__" else first


def module_name(path: Path) -> str:
    parts = list(path.relative_to(PACKAGE.parent).with_suffix("").parts)
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


def is_type_checking(node: ast.AST) -> bool:
    return isinstance(node, ast.If) and "TYPE_CHECKING" in ast.unparse(node.test)


@cache
def imports(path: Path) -> list[Import]:
    """Every import of a file. Those under `if TYPE_CHECKING` count as downward imports but do not run."""
    found: list[Import] = []

    def visit(node: ast.AST, at_import: bool) -> None:
        where = f"{path.relative_to(ROOT)}:{getattr(node, 'lineno', 0)}"
        if isinstance(node, ast.Import):
            found.extend(Import(alias.name, where, at_import) for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            base = node.module or ""
            if node.level:
                package = module_name(path).split(".")
                keep = len(package) - node.level + (path.name == "__init__.py")
                base = ".".join([*package[:keep], *([base] if base else [])])
            names = [f"{base}.{alias.name}" for alias in node.names] if base == "cspace" else [base]
            found.extend(Import(name, where, at_import) for name in names)
        inside = isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef) or is_type_checking(node)
        for child in ast.iter_child_nodes(node):
            visit(child, at_import and not inside)

    visit(syntax(path), True)
    return found


def includes(path: Path) -> list[tuple[int, str]]:
    """The line number and target of every #include of a C++ file, quotes and brackets kept."""
    lines = path.read_text(encoding="utf-8").splitlines()
    matches = ((n, re.match(r'\s*#\s*include\s*([<"][^>"]+[>"])', line)) for n, line in enumerate(lines, 1))
    return [(n, match.group(1)) for n, match in matches if match]


@cache
def tracked_texts() -> list[tuple[str, str]]:
    """Name and text of every text file that belongs to the project (committed or about to be)."""
    command = ["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"]
    listing = subprocess.run(command, cwd=ROOT, capture_output=True)
    names = [n for n in listing.stdout.decode().split("\0") if n]
    texts = []
    for path in filter(Path.is_file, (ROOT / name for name in names)):
        with suppress(UnicodeDecodeError):
            texts.append((path.relative_to(ROOT).as_posix(), path.read_text(encoding="utf-8")))
    return texts
