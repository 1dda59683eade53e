"""Prints the longest files and functions of the library: information, not a verdict.

Usage: python tools/sizes.py
"""

from __future__ import annotations

import ast
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent


def files() -> list[tuple[int, str]]:
    """Lines and name of every source file."""
    found = [p for folder in ("src", "include") for p in (ROOT / folder).rglob("*")]
    sources = [p for p in found if p.suffix in {".py", ".hpp", ".cpp"}]
    return [(p.read_text(encoding="utf-8").count("\n"), str(p.relative_to(ROOT))) for p in sources]


def functions() -> list[tuple[int, str]]:
    """Lines and name of every Python function."""
    found = []
    for path in (ROOT / "src/cspace").rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.FunctionDef):
                lines = (node.end_lineno or node.lineno) - node.lineno + 1
                found.append((lines, f"{path.relative_to(ROOT)}:{node.name}"))
    return found


def main() -> None:
    for title, sizes in (("files", files()), ("functions", functions())):
        lines = sorted(size for size, _ in sizes)
        print(f"{len(sizes)} {title}, {sum(lines)} lines, median {lines[len(lines) // 2]}; the longest:")
        for size, name in sorted(sizes, reverse=True)[:8]:
            print(f"{size:6d}  {name}")


if __name__ == "__main__":
    main()
