"""The words of the reader: what `words.toml` bans stands in no identifier and in no sentence."""

from __future__ import annotations

import fnmatch
import re
import sys

import pytest

from house import tree

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

TABLE = tomllib.loads((tree.ROOT / "tests/house/words.toml").read_text(encoding="utf-8"))
OLD_NAMES = "src/cspace/errors.py"
"""The file of the errors that name what has another name today."""
READ = ("src/", "include/", "docs/", "README.md", "CHANGELOG.md")
TEXTS = {
    "py": re.compile(r'[rR]?"""[\s\S]*?"""|#[^\n]*|"(?:\\.|[^"\\\n])*"'),
    "c": re.compile(r'R"doc\([\s\S]*?\)doc"|//[^\n]*|/\*[\s\S]*?\*/|"(?:\\.|[^"\\\n])*"'),
}
"""Comments, docstrings and other texts."""


def texts() -> list[tuple[str, str]]:
    endings = (".py", ".hpp", ".cpp", ".in", ".md")
    return [(n, t) for n, t in tree.tracked_texts() if n.startswith(READ) and n.endswith(endings)]


def code_of(name: str, text: str) -> str:
    """A file without its comments, and without texts that have a space in them."""
    if name.endswith(".md"):
        return "\n".join(re.findall(r"^```python\b[^\n]*\n([\s\S]*?)^```", text, re.M))
    pattern = TEXTS["py" if name.endswith((".py", ".py.in")) else "c"]
    return pattern.sub(
        lambda found: "" if re.search(r"\s|^[#/]|^[rR]?\"{3}", found.group()) else found.group(), text
    )


FILES = [(name, text, code_of(name, text)) for name, text in texts()]


def phrase(text: str) -> re.Pattern[str]:
    """A phrase as a whole, over the ends of lines and the marks of comments too."""
    return re.compile(r"\b" + r"(?:\s|//|#)+".join(map(re.escape, text.split())) + r"\b", re.I)


@pytest.mark.parametrize("row", TABLE["identifier"], ids=lambda row: row["pattern"])
def test_no_identifier_is_banned(row):
    pattern = re.compile(row["pattern"])
    for name, _, code in FILES:
        if name != OLD_NAMES and any(fnmatch.fnmatch(name, where) for where in row["where"]):
            found = pattern.search(code)
            assert not found, f"{name}: {found.group() if found else ''}; write {row['write']}"


@pytest.mark.parametrize("row", TABLE["phrase"], ids=lambda row: row.get("text", row.get("regex")))
def test_no_phrase_is_banned(row):
    pattern = phrase(row["text"]) if "text" in row else re.compile(row["regex"])
    for name, text, _ in FILES:
        if any(fnmatch.fnmatch(name, where) for where in row.get("where", ("*",))):
            found = pattern.search(text)
            assert not found, f"{name}: {found.group() if found else ''!r}; write {row['write']!r}"


def test_a_banned_word_is_found():
    assert phrase("joints to spare").search("an arm with joints\n// to spare")
    assert not phrase("twin").search("twins")
    assert "held" not in code_of("a.py", '"""held"""\nx = 1  # held\n')
    assert "held" not in code_of("a.hpp", "int x;  // held\n/* held */")
