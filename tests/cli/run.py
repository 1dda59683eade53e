"""Running the command line, in this process for speed and in a fresh one where the process matters."""

from __future__ import annotations

import io
import json
import os
import subprocess
import sys
from contextlib import redirect_stderr, redirect_stdout
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from cspace.cli import main

ROOT = Path(__file__).resolve().parents[2]


@dataclass(frozen=True)
class Result:
    """How a command line ended."""

    code: int
    out: str
    err: str

    @property
    def json(self) -> Any:
        return json.loads(self.out, parse_constant=refuse)


def refuse(word: str) -> None:
    raise AssertionError(f"{word} is no JSON")


def cspace(line: str, *more: str) -> Result:
    """Run `cspace LINE`, words split at blanks, then `more` words as they are, in this process."""
    out, err = io.StringIO(), io.StringIO()
    with redirect_stdout(out), redirect_stderr(err):
        code = main([*line.split(), *map(str, more)])
    return Result(int(code), out.getvalue(), err.getvalue())


def command(*words: str, **kwargs: Any) -> subprocess.CompletedProcess[str]:
    """Run `python -m cspace WORDS` in a fresh process."""
    return subprocess.run(
        [sys.executable, "-m", "cspace", *words],
        capture_output=True,
        text=True,
        encoding="utf-8",
        timeout=120,
        env=environment(),
        check=False,
        **kwargs,
    )


def environment(**more: str) -> dict[str, str]:
    """This process's environment with the package importable."""
    import cspace as package

    folder = str(Path(package.__file__).parents[1])
    path = os.pathsep.join(filter(None, [folder, os.environ.get("PYTHONPATH", "")]))
    return {**os.environ, "PYTHONPATH": path, "PYTHONIOENCODING": "utf-8", **more}
