"""Each public name, keyword, planner, robot and option in backticks in the changelog exists."""

from __future__ import annotations

import importlib
import inspect
import re
from collections.abc import Iterator
from typing import Any

import pytest

import cspace as cs
from cspace import errors
from cspace.ik.solve import solve
from data import ROOT

TEXT = (ROOT / "CHANGELOG.md").read_text(encoding="utf-8")
SPANS = sorted(set(re.findall(r"`([^`\n]+)`", TEXT)))
MODULES = [
    importlib.import_module(f"cspace{room}")
    for room in (
        "",
        ".cartesian",
        ".collision",
        ".dynamics",
        ".errors",
        ".export",
        ".ik",
        ".kinematics",
        ".localization",
        ".maps",
        ".mobile",
        ".model",
        ".navigation",
        ".planning",
        ".plot",
        ".robots",
        ".trajectory",
    )
]
# The object that a short name stands for in a sentence.
OWNERS: dict[str, Any] = {
    "cs": cs,
    "robot": cs.Robot,
    "s": cs.ik.Solutions,
    "route": cs.navigation.Route,
    "world": cs.PolygonWorld,
    "self_motion": cs.ik.SelfMotion,
    "planner": cs.navigation.PlanePlanner,
}
NOT_PYTHON = {"fk", "into_limits", "yam", "cspace", "co_await", "NULL", "INT_MAX"}
"""Functions of exported files, which have names of their own, a robot of a test, the command, words of C."""


def members(owner: Any) -> set[str]:
    """The attributes of a module or a class, fields of its instances included."""
    fields = [vars(kind).get("__annotations__", {}) for kind in getattr(owner, "__mro__", ())]
    return set(dir(owner)).union(*fields)


def exports() -> Iterator[tuple[str, Any]]:
    for module in MODULES:
        for name in module.__all__:
            yield name, getattr(module, name)


def callables() -> Iterator[Any]:
    for _, value in exports():
        yield value
        if inspect.isclass(value):
            yield from (getattr(value, name, None) for name in vars(value) if not name.startswith("_"))


def keywords() -> set[str]:
    """Every keyword that a public function takes, options of planners included."""
    found = {name for planner in cs.navigation.PLANNERS.values() for name in planner.options}
    for function in (*callables(), solve):  # robot.ik and Solver.solve are compiled, without a signature
        try:
            found.update(inspect.signature(function).parameters)
        except (TypeError, ValueError):  # a constant, or a compiled function without a signature
            continue
    return found


KEYWORDS = keywords()
PUBLIC = {name for name, _ in exports()}
MEMBERS = set().union(*(members(value) for _, value in exports() if inspect.isclass(value)))
DATA = {*cs.navigation.PLANNERS, *cs.planning.PLANNERS, *cs.navigation.STATUSES, *cs.robots.names()}
DATA.update(*(cs.robots.load_description(name).link_by_name for name in cs.robots.names()))


def resolves(value: Any, names: list[str]) -> bool:
    """Whether a dotted name exists, up to the first field, whose type is not followed."""
    for name in names:
        if name not in members(value):
            return False
        if not hasattr(value, name):
            return True
        value = getattr(value, name)
    return True


def unknown_names(span: str) -> list[str]:
    """The names in a span of code that nothing in the library has."""
    missing = []
    dotted = re.findall(rf"(?<![\w./])({'|'.join(OWNERS)})((?:\.[A-Za-z_]\w*)+)", span)
    missing += [owner + path for owner, path in dotted if not resolves(OWNERS[owner], path[1:].split("."))]
    missing += [f"{name}=" for name in re.findall(r"(?<![\w-])([a-z_]\w*)=", span) if name not in KEYWORDS]
    if bare := re.fullmatch(r'"?([A-Za-z_]\w*)"?(?:\(\))?', span):
        if bare[1] not in PUBLIC | MEMBERS | DATA | NOT_PYTHON:
            missing.append(bare[1])
    elif member := re.fullmatch(r"([A-Z]\w*)\.(\w+)(?:\(.*\))?", span):
        owners = [value for name, value in exports() if name == member[1]]
        if not owners or member[2] not in members(owners[0]):
            missing.append(span)
    return missing


@pytest.mark.parametrize("span", SPANS)
def test_each_name_in_the_changelog_exists(span):
    old = {name for name in errors.RENAMED if re.search(rf"(?:^|\.){name}\b", span)}
    if not old:
        assert unknown_names(span) == []


def test_an_old_name_stands_where_its_new_name_is_told():
    """A name that was replaced stands in the section of changes alone."""
    added = TEXT[TEXT.index("### Added") : TEXT.index("### Changed")]
    for name in errors.RENAMED:
        assert not re.search(rf"`(?:\w+\.)?{name}=?`", added), name


def test_options_in_the_changelog_exist():
    sources = "".join(path.read_text(encoding="utf-8") for path in (ROOT / "src/cspace/cli").rglob("*.py"))
    for option in set(re.findall(r"`(--[\w-]+)", TEXT)) - {"--deg", "--json"}:
        assert re.search(f'"{option}[" ]', sources), option


def test_a_name_that_does_not_exist_is_found():
    assert unknown_names("robot.inverse") == ["robot.inverse"]
    assert unknown_names("s.families") == ["s.families"]
    assert unknown_names("robot.ik(T, nearest_to=q)") == ["nearest_to="]
    assert unknown_names("PolygonWorlds") == ["PolygonWorlds"]
    assert unknown_names("Scenarios.starts(line)") == ["Scenarios.starts(line)"]
