"""A room is a word of the field: its C++ folder, its bindings, its Python package, its tests and its page of
the docs share it."""

from __future__ import annotations

import re
from itertools import product
from pathlib import Path

import pytest

from house import tree

HEADERS = tree.ROOT / "include/cspace"
LAYERS = [tree.ROOT / "src" / layer for layer in ("bindings", "kernels", "library")]
COMPILED = sorted(path for layer in LAYERS for path in layer.glob("*.?pp"))

CPP_ALONE = {
    "ik/general": "the plan of an arm chooses it",
    "ik/position": "the plan of an arm chooses it",
    "localization/landmarks": "the filters of Python's landmark_slam",
    "math/sparse": "the optimizer of pose graphs calls it",
}
"""Folders of headers that no Python file stands for, and why."""
PYTHON_ALONE = {
    "ik/explain": "sentences",
    "ik/goals": "names and checks of goals; each goal is solved by its own room",
    "localization/evaluation": "errors of recorded poses, in a few numpy calls",
    "localization/filters": "Kalman filters whose measurements may be Python functions",
    "localization/landmark_slam": "the front of C++'s landmarks",
    "localization/laser_slam": "the front of scans/laser_slam.hpp",
    "localization/logs": "files",
    "model/mjcf": "files",
    "planning/joint_space": "names and sentences; its checks are those of collision",
}
"""Packages without headers of their own name, and why."""
NO_ROOM = {"module", "bindings", "arrays", "numpy_api", "dispatch", "once", "scratch", "table"}
"""What all bindings, all kernels or the whole library share."""
PAGES = {"model": "robots", "plan_motion": "planning", "mechanisms": "closed-loops"}
"""Pages that speak of two rooms."""
NO_PAGE = {"math", "search"}
"""What the rooms above are made of."""


def folders(root: Path) -> set[str]:
    """The folders below a folder that hold files of the project, with their paths from there."""
    files = [path for ending in ("*.hpp", "*.py") for path in root.rglob(ending)]
    return {str(path.parent.relative_to(root)) for path in files} - {"."}


def rooms(root: Path) -> set[str]:
    """The first folders, whether files stand in them or in folders below."""
    return {path.split("/")[0] for path in folders(root)}


def is_python(path: str) -> bool:
    """Whether a sub-room has a package, or is small enough for one file."""
    return (tree.PACKAGE / path).is_dir() or (tree.PACKAGE / f"{path}.py").is_file()


def test_every_room_of_the_core_has_a_package():
    assert rooms(HEADERS) <= rooms(tree.PACKAGE)


def test_rooms_in_both_languages_have_the_same_rooms_inside():
    both = rooms(HEADERS) & rooms(tree.PACKAGE)
    cpp = {path for path in folders(HEADERS) if path.split("/")[0] in both and "/" in path}
    python = {path for path in folders(tree.PACKAGE) if path.split("/")[0] in both and "/" in path}
    assert {path for path in cpp if not is_python(path)} == set(CPP_ALONE)
    assert python - cpp == set(PYTHON_ALONE)


def is_other_form(cpp: str, python: str) -> bool:
    """Whether a name is that of a C++ file but for an underscore or its last letter. Python's plural stands
    for arrays of what C++ has one of."""
    a, b = cpp.replace("_", ""), python.replace("_", "")
    same = max(len(a), len(b)) - 1
    return a[:same] == b[:same] and python not in {cpp, f"{cpp}s"}


def test_files_of_one_idea_have_one_name_in_both_languages():
    for folder in sorted(folders(HEADERS)):
        cpp = {path.stem for path in (HEADERS / folder).glob("*.hpp")}
        python = {path.stem for path in (tree.PACKAGE / folder).glob("*.py")}
        found = [pair for pair in product(sorted(cpp), sorted(python)) if is_other_form(*pair)]
        assert not found, f"one idea, one name: {found} in {folder}"


def test_other_forms_of_a_name_are_found():
    assert all(is_other_form(*pair) for pair in [("descent", "descend"), ("roll_out", "rollout")])
    assert not any(is_other_form(*pair) for pair in [("triangle", "triangles"), ("forward", "forces")])


def test_a_room_whose_files_stand_in_folders_is_seen():
    assert "localization" in rooms(HEADERS)


@pytest.mark.parametrize("room", sorted(rooms(tree.PACKAGE)))
def test_every_room_has_tests_and_a_page(room):
    assert list((tree.ROOT / "tests" / room).rglob("test_*.py")), f"no tests/{room}"
    if room not in NO_PAGE:
        page = f"docs/{PAGES.get(room, room)}.md"
        assert (tree.ROOT / page).is_file(), f"no {page}"


def test_folders_of_tests_are_rooms():
    for room in rooms(tree.PACKAGE):
        for path in folders(tree.ROOT / "tests" / room):
            inside = f"{room}/{path}"
            assert is_python(inside) or (HEADERS / inside).is_dir(), f"tests/{inside} is no room"


@pytest.mark.parametrize("path", COMPILED, ids=lambda path: f"{path.parent.name}/{path.name}")
def test_compiled_files_are_named_by_their_room(path):
    known = {room for room in tree.RANK if not room.startswith("_")} | rooms(HEADERS)
    assert path.stem in NO_ROOM or path.stem.split("_")[0] in known, "begin the name with that of a room"


def test_the_guide_for_contributors_shows_the_tiers():
    guide = (tree.ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")
    block = guide.partition("bottom, today:\n\n```\n")[2].partition("\n```")[0]
    shown = [set(re.sub(r"\(.*?\)", "", line).split()) for line in block.splitlines()]
    present = {tree.room_of(path) for path in tree.python_files()} - {"cspace", "__main__"} | {"_core"}
    tiers = [tier & present for tier in reversed(tree.TIERS)]
    assert shown == [tier for tier in tiers if tier]


def test_the_limit_of_the_checks_fits_their_promised_duration():
    guide = (tree.ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")
    workflow = (tree.ROOT / ".github/workflows/ci.yml").read_text(encoding="utf-8")
    promised = int(re.search(r"`bash \.ci/run`.*about (\d+) minutes", guide).group(1))
    job = next(part for part in re.split(r"^  (?=\w+:$)", workflow, flags=re.M) if ".ci/run" in part)
    limit = int(re.search(r"timeout-minutes: (\d+)", job).group(1))
    assert promised <= limit <= 2 * promised
