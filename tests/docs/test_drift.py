"""The pages say what the library is: generated parts are current, every public name is on some page."""

from __future__ import annotations

import importlib
import re

import pytest

from data import ROOT

PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md"))]
# Each room and the page that documents it.
ROOMS = {
    "spatial": "spatial",
    "model": "robots",
    "robots": "robots",
    "kinematics": "kinematics",
    "dynamics": "dynamics",
    "ik": "ik",
    "plot": "plot",
    "maps": "maps",
    "navigation": "navigation",
    "mobile": "mobile",
    "localization": "localization",
}


def test_generated_parts_are_current(monkeypatch):
    monkeypatch.syspath_prepend(str(ROOT / "tools"))
    import pages

    for page, text in pages.generated().items():
        assert page.read_text(encoding="utf-8") == text, f"{page.name}: run tools/pages.py"


def exports(module: str) -> list[str]:
    """The documented names of a module; empty where the room does not exist yet."""
    try:
        return [name for name in importlib.import_module(module).__all__ if not name.startswith("__")]
    except ModuleNotFoundError as error:
        if error.name != module:
            raise
        return []


def public_names() -> list[str]:
    """What the rooms export by dotted name, then what `import cspace` adds of its own."""
    rooms = [room for room, page in ROOMS.items() if (ROOT / f"docs/{page}.md").exists()]
    found = [f"cspace.{room}.{name}" for room in rooms for name in exports(f"cspace.{room}")]
    in_rooms = {name for room in ROOMS for name in exports(f"cspace.{room}")} | set(ROOMS)
    return found + [f"cspace.{name}" for name in exports("cspace") if name not in in_rooms]


@pytest.mark.parametrize("name", public_names())
def test_every_public_name_is_on_a_page(name):
    word = re.compile(rf"\b{re.escape(name.split('.')[-1])}\b")
    assert any(word.search(page.read_text(encoding="utf-8")) for page in PAGES), "document it in docs/"


def test_every_page_is_in_the_index():
    index = (ROOT / "docs/index.md").read_text(encoding="utf-8")
    pages = {page.name for page in (ROOT / "docs").glob("*.md")} - {"index.md"}
    assert {name for name in pages if f"]({name})" not in index} == set()


def test_errors_of_the_library_are_on_the_page_of_conventions():
    from cspace import errors

    page = (ROOT / "docs/conventions.md").read_text(encoding="utf-8")
    for name in errors.__all__:
        known = getattr(errors, name)
        if isinstance(known, type) and issubclass(known, Exception):
            assert re.search(rf"\b{name}\b", page), f"{name} is not explained"


def test_the_benchmark_page_is_what_the_results_say(monkeypatch):
    monkeypatch.syspath_prepend(str(ROOT / "benchmarks"))
    import report

    page = (ROOT / "docs/benchmarks.md").read_text(encoding="utf-8")
    assert page == report.page(report.load()), "run benchmarks/report.py"


def test_results_older_than_their_sources_are_named(monkeypatch, tmp_path):
    monkeypatch.syspath_prepend(str(ROOT / "benchmarks"))
    import age

    source, result = tmp_path / "code.hpp", tmp_path / "grid.json"
    for name, value in {"ROOT": tmp_path, "RESULTS": tmp_path, "RECORDS": tmp_path / "sources.json"}.items():
        monkeypatch.setattr(age, name, value)
    monkeypatch.setattr(age, "SOURCES", {"": ["code.hpp"]})
    source.write_text("1")
    result.write_text("{}")
    age.record(["grid", "absent"])
    assert age.older(["grid", "absent"]) == ["grid"]  # nobody knows with which sources it was measured
    result.write_text('{"new": 1}')
    age.record(["grid"])
    assert age.older(["grid"]) == []
    source.write_text("2")
    age.record(["grid"])
    assert age.older(["grid"]) == ["grid"]
    assert "grid" in age.section(["grid"])


def test_the_page_of_claims_is_what_the_results_say(monkeypatch):
    monkeypatch.syspath_prepend(str(ROOT / "benchmarks"))
    import claims_page
    from claims.rows import ROWS

    results = claims_page.load()
    assert set(results["rows"]) == set(ROWS), "run benchmarks/navigation_claims.py --missing"
    told = claims_page.PAGE.read_text(encoding="utf-8")
    assert told == claims_page.page(results), "run benchmarks/navigation_claims.py --page"


def test_the_explained_arm_is_explained_as_the_library_does(monkeypatch):
    monkeypatch.syspath_prepend(str(ROOT / "tools"))
    import explained

    assert explained.PAGE.read_text(encoding="utf-8") == explained.page_text(), "run tools/explained.py"


def test_the_names_on_the_page_of_exports_are_in_an_exported_header():
    from cspace import load_robot

    page = (ROOT / "docs/export.md").read_text(encoding="utf-8")
    table = page[page.index("| in the namespace of the arm |") : page.index("**Every arm that")]
    names = set(re.findall(r"[A-Za-z_]+", " ".join(re.findall(r"`([^`]+)`", table)))) - {"robot"}
    names |= set(re.findall(r"panda::(\w+)", page))
    text = load_robot("panda").export("cpp").text
    assert {"unconstrained", "self_motion", "locked_count"} <= names
    assert {name for name in names if not re.search(rf"\b{name}\b", text)} == set()
