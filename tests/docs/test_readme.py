"""The README's commands."""

from __future__ import annotations

import re

from data import ROOT


def commands() -> list[str]:
    """The shell commands of the README, one per fenced block."""
    return re.findall(r"```sh\n(.+?)\n```", (ROOT / "README.md").read_text(encoding="utf-8"))


def test_there_are_two_commands_and_each_does_all_set_up():
    assert len(commands()) == 2
    for command in commands():
        assert command.startswith("python3 -m venv .venv && . .venv/bin/activate && pip install '.[plot")
