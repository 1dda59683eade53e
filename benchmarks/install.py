"""Build time, wheel size, installed size and the README's first command from the wheel, each in a fresh
environment: benchmarks/results/install.json.

Usage: python benchmarks/install.py
"""

from __future__ import annotations

import json
import os
import re
import shlex
import subprocess
import sys
import tempfile
import time
import venv
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent


def size_mb(folder: Path) -> float:
    return sum(path.stat().st_size for path in folder.rglob("*") if path.is_file()) / 1e6


def programs_of(folder: Path) -> Path:
    return folder / ("Scripts" if os.name == "nt" else "bin")


def first_command(wheel: Path, folder: Path) -> float:
    """Seconds to install the wheel with its pictures into an empty environment, and to run the README's first
    command there, without a compiler on the path.
    """
    line = re.search(r"```sh\n(.+?)\n```", (ROOT / "README.md").read_text(encoding="utf-8"))
    assert line is not None
    words = shlex.split(line[1].split(" && ")[-1])
    programs = programs_of(folder / "empty")
    environment = {**os.environ, "PATH": str(programs), "MPLBACKEND": "Agg"}
    environment.pop("PYTHONPATH", None)
    start = time.perf_counter()
    venv.create(folder / "empty", with_pip=True)
    pip = [programs / "python", "-m", "pip", "install", "-q", f"{wheel}[plot]"]
    subprocess.run(pip, check=True, env=environment, cwd=folder)
    subprocess.run([programs / words[0], *words[1:]], check=True, env=environment, cwd=folder)
    return time.perf_counter() - start


def main() -> None:
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(temporary)
        venv.create(folder / "venv", with_pip=True)
        python = programs_of(folder / "venv") / "python"
        site = Path(
            subprocess.check_output(
                [python, "-c", "import sysconfig; print(sysconfig.get_paths()['purelib'])"], text=True
            ).strip()
        )
        before = size_mb(site)
        source = folder / "source"
        subprocess.run(["git", "clone", "-q", str(ROOT), str(source)], check=True)
        environment = {**os.environ, "CMAKE_BUILD_PARALLEL_LEVEL": "2"}
        start = time.perf_counter()
        wheel_command = [python, "-m", "pip", "wheel", "-q", "--no-deps", "-w", str(folder), str(source)]
        subprocess.run(wheel_command, check=True, env=environment)
        spent = time.perf_counter() - start
        wheel = next(folder.glob("*.whl"))
        subprocess.run([python, "-m", "pip", "install", "-q", str(wheel)], check=True)
        result = {
            "build_seconds": round(spent, 1),
            "wheel_mb": round(wheel.stat().st_size / 1e6, 2),
            "installed_mb": round(size_mb(site) - before, 1),
            "first_command_seconds": round(first_command(wheel, folder), 1),
            "python": ".".join(map(str, sys.version_info[:3])),
        }
    (HERE / "results/install.json").write_text(json.dumps(result, indent=1) + "\n")


if __name__ == "__main__":
    main()
