"""Formats the Python and C++ of the tree, or says with --check what is not formatted."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
CPP_FOLDERS = ["include", "src", "tests/cpp", "benchmarks", "examples"]


def cpp_files() -> list[str]:
    return sorted(
        str(path)
        for folder in CPP_FOLDERS
        for ending in ("*.hpp", "*.cpp")
        for path in (ROOT / folder).rglob(ending)
    )


def main() -> int:
    check = "--check" in sys.argv[1:]
    ruff = ["ruff", "format", *(["--check"] if check else []), "."]
    clang = ["clang-format", "--style=file", *(["--dry-run", "-Werror"] if check else ["-i"]), *cpp_files()]
    return max(subprocess.run(command, cwd=ROOT).returncode for command in (ruff, clang))


if __name__ == "__main__":
    sys.exit(main())
