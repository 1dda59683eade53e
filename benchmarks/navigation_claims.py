"""The table of claims: asks all planners; writes benchmarks/results/claims.json, docs/claims.md and figures.

Usage: python benchmarks/navigation_claims.py [--rows NAME …] [--missing] [--page] [--check]
--rows: these rows alone; --missing: rows that have no results yet; --page: nothing is asked, only the page
and the figures are made again; --check: fails if the page is not what the results say. Results are written
after every row, so that a run that was stopped goes on with --missing.
"""

from __future__ import annotations

import argparse
import json
import sys
import time
from pathlib import Path

import claims_page
from run import machine

ROOT = Path(__file__).resolve().parents[1]
sys.path[:0] = [str(ROOT / "docs/figures")]

from claims import suite  # noqa: E402
from claims.rows import ROWS  # noqa: E402


def measure(names: list[str]) -> None:
    results = claims_page.load() if claims_page.RESULT.exists() else {"rows": {}}
    results["about"] = machine()
    began = time.perf_counter()
    asked, seen = suite.questions(), suite.questions_of_sight()
    for name in names:
        results["rows"][name] = suite.result(ROWS[name], asked, seen)
        write(results)
        words = [finding["word"] for finding in results["rows"][name]["found"].values()]
        print(f"{time.perf_counter() - began:6.1f} s", name, *words, sep="  ", flush=True)


def write(results: dict) -> None:
    results["rows"] = {name: results["rows"][name] for name in ROWS if name in results["rows"]}
    text = json.dumps(results, ensure_ascii=False)
    text = text.replace('}, "', '},\n "').replace('"rows": {', '"rows": {\n ')
    claims_page.RESULT.write_text(text + "\n", encoding="utf-8")


def main() -> int:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--rows", nargs="+", choices=list(ROWS), metavar="NAME")
    for flag in ("--missing", "--page", "--check"):
        parser.add_argument(flag, action="store_true")
    told = parser.parse_args()
    if told.check:
        text = claims_page.page(claims_page.load())
        return int(claims_page.PAGE.read_text(encoding="utf-8") != text)
    names = told.rows or list(ROWS)
    if told.missing and claims_page.RESULT.exists():
        names = [name for name in names if name not in claims_page.load()["rows"]]
    if not told.page:
        measure(names)
    results = claims_page.load()
    claims_page.PAGE.write_text(claims_page.page(results), encoding="utf-8")
    import claims_figures

    claims_figures.draw(results)
    return 0


if __name__ == "__main__":
    sys.exit(main())
