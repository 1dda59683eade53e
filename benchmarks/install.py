"""Build time, wheel size and installed size in a fresh environment: benchmarks/results/install.json.

Usage: python benchmarks/install.py
"""

from __future__ import annotations

import json
import os
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


def main() -> None:
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(temporary)
        venv.create(folder / "venv", with_pip=True)
        programs = folder / "venv" / ("Scripts" if os.name == "nt" else "bin")
        python = programs / ("python.exe" if os.name == "nt" else "python")
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
            "python": ".".join(map(str, sys.version_info[:3])),
        }
    (HERE / "results/install.json").write_text(json.dumps(result, indent=1) + "\n")


if __name__ == "__main__":
    main()
