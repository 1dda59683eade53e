"""The code on the pages runs: README and docs, top to bottom, one namespace per page.

```python blocks are executed in order, and a ```text block shows what the one above it prints. ```console
blocks run their `$ cspace …` lines and compare the output, blank space apart, where the page prints any (a
line or a part of a line may be … for any text).
A block with `no-run` after its language is shown only; one with `needs=PACKAGE` runs where that is installed.
"""

from __future__ import annotations

import fnmatch
import re
import shlex
import shutil
import subprocess
import sys
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import pytest

from data import ROOT

PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md"))]


@dataclass(frozen=True)
class Block:
    language: str
    line: int
    text: str


def blocks(page: Path) -> list[Block]:
    """The fenced blocks of a page that are to be run, with the number of the line before their text."""
    found, fence, start, lines = [], None, 0, page.read_text(encoding="utf-8").splitlines()
    for number, line in enumerate(lines, 1):
        match = re.match(r"```\s*(\w*)\s*(.*)$", line.strip())
        if not match:
            continue
        if fence is None:
            fence, start = match.groups(), number
        else:
            if "no-run" not in fence[1] and all(map(find_spec, re.findall(r"needs=(\w+)", fence[1]))):
                found.append(Block(fence[0], start, "\n".join(lines[start : number - 1])))
            fence = None
    assert fence is None, f"{page}:{start}: this block never ends"
    return found


def has(language: str) -> list[Any]:
    """The pages with blocks of a language, all but the README marked as slow."""
    pages = [page for page in PAGES if any(block.language == language for block in blocks(page))]
    return [
        pytest.param(page, marks=() if page.name == "README.md" else pytest.mark.slow, id=name_of(page))
        for page in pages
    ]


def name_of(page: Path) -> str:
    return str(page.relative_to(ROOT))


@pytest.mark.parametrize("page", has("python"))
def test_python_blocks_run(page, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    namespace: dict[str, object] = {"__name__": "page"}
    printed: list[str] | None = None
    for block in blocks(page):
        if block.language == "python":
            capsys.readouterr()
            source = "\n" * block.line + block.text
            exec(compile(source, str(page), "exec", dont_inherit=True), namespace)  # the page is ours
            printed = capsys.readouterr().out.splitlines()
        elif block.language == "text":
            assert block.text.splitlines() == printed, (
                f"{page}:{block.line}: the block above prints otherwise"
            )
    assert printed is not None
    assert open_figures() == [], "a page saves the pictures that it draws, which also closes them"


def open_figures() -> list[int]:
    """The numbers of the figures that are open; they are closed, so that no other test meets them."""
    plt = sys.modules.get("matplotlib.pyplot")
    if plt is None:
        return []
    numbers = list(plt.get_fignums())
    plt.close("all")
    return numbers


def run_cspace(words: list[str], folder: Path) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-m", "cspace", *words]
    return subprocess.run(
        command, cwd=folder, capture_output=True, text=True, encoding="utf-8", timeout=120, check=False
    )


def commands(block: Block) -> list[tuple[str, list[str]]]:
    """The `$ …` lines of a console block, each with the output lines printed under it."""
    found: list[tuple[str, list[str]]] = []
    for line in block.text.splitlines():
        if line.startswith("$ "):
            found.append((line[2:], []))
        elif found and found[-1][0].endswith("\\"):
            found[-1] = (found[-1][0][:-1] + line, [])
        elif found and line.strip():
            found[-1][1].append(" ".join(line.split()))
    return found


def check_output(expected: list[str], output: str, where: str) -> None:
    """Each expected line appears in the output, in order; … stands for anything."""
    lines = iter([" ".join(line.split()) for line in output.splitlines()])
    for wanted in expected:
        pattern = re.sub(r"([\[\]?*])", r"[\1]", wanted).replace("…", "*")
        assert any(fnmatch.fnmatchcase(line, pattern) for line in lines), (
            f"{where}: no {wanted!r} in\n{output}"
        )


@pytest.mark.parametrize("page", has("console"))
def test_console_blocks_run(page, tmp_path):
    for name in ("yard.txt", "cell.toml", "two_links.txt", "four_bar.toml", "two_rounds.g2o"):
        shutil.copy(ROOT / "examples" / name, tmp_path)
    shutil.copytree(ROOT / "examples/small_drive", tmp_path / "small_drive")
    for block in blocks(page):
        if block.language != "console":
            continue
        for command, expected in commands(block):
            words = shlex.split(command.split("#")[0])
            assert words[0] == "cspace", f"{page}:{block.line}: only cspace runs here: {command}"
            done = run_cspace(words[1:], tmp_path)
            negative = re.search(r"#\s*exit (\d+)", command)
            wanted = int(negative.group(1)) if negative else 0
            where = f"{page}:{block.line}: {command}"
            assert done.returncode == wanted, f"{where}\n{done.stdout}{done.stderr}"
            check_output(expected, done.stdout + done.stderr, where)


def test_images_and_links_of_the_pages_exist():
    for page in PAGES:
        for target in re.findall(r"\]\(([^)#\s]+)(?:#[^)]*)?\)", page.read_text(encoding="utf-8")):
            if not re.match(r"[a-z]+:", target):
                assert (page.parent / target).exists(), f"{name_of(page)} points to {target}"


def anchors(page: Path) -> set[str]:
    """The anchors of the headings of a page, as GitHub makes them."""
    text = re.sub(r"^```.*?^```", "", page.read_text(encoding="utf-8"), flags=re.M | re.S)
    headings = re.findall(r"^#+ (.+)$", text, re.M)
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings}


def test_links_to_headings_lead_to_headings():
    for page in PAGES:
        for target, anchor in re.findall(r"\]\(([^)#\s:]*)#([^)\s]+)\)", page.read_text(encoding="utf-8")):
            there = page.parent / target if target else page
            assert anchor in anchors(there), f"{name_of(page)} points to {target}#{anchor}"


def test_the_runner_sees_what_is_wrong(tmp_path):
    page = tmp_path / "page.md"
    page.write_text(
        "```python\nx = 1\n```\n\n```python no-run\nboom\n```\n\n```console\n$ cspace\nno …\n```\n"
    )
    python, console = blocks(page)
    assert (python.language, python.line, python.text) == ("python", 1, "x = 1")
    assert commands(console) == [("cspace", ["no …"])]
    check_output(["no …"], "yes\nno  thing here\n", "page")
    with pytest.raises(AssertionError):
        check_output(["no …", "yes"], "yes\nno thing\n", "page")
