"""The README's main job does what it says, with the words that are printed there."""

from __future__ import annotations

import re
import shlex
import subprocess
import sys

import pytest

from data import ROOT


def commands() -> list[str]:
    """The shell commands of the README, one per fenced block."""
    return re.findall(r"```sh\n(.+?)\n```", (ROOT / "README.md").read_text(encoding="utf-8"))


def test_there_are_two_commands_and_each_does_all_set_up():
    assert len(commands()) == 2
    for command in commands():
        assert command.startswith("python3 -m venv .venv && . .venv/bin/activate && pip install '.[plot")


def test_the_main_job_answers_and_draws(tmp_path):
    pytest.importorskip("matplotlib", reason="the picture needs the extra [plot]")
    words = shlex.split(commands()[0].split(" && ")[-1])
    assert words[0] == "cspace"
    done = subprocess.run(
        [sys.executable, "-m", "cspace", *words[1:]],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        timeout=300,
    )
    assert done.returncode == 0, done.stderr
    assert "elbow" in done.stdout
    picture = tmp_path / words[words.index("--plot") + 1]
    assert picture.stat().st_size > 20_000
