"""A header opens the namespace of its room, and the umbrella header reaches every one."""

from __future__ import annotations

import re

import pytest

from house import tree

FOLDER = tree.ROOT / "include/cspace"
UMBRELLA = FOLDER / "cspace.hpp"
HEADERS = sorted(path for path in FOLDER.rglob("*.hpp") if path != UMBRELLA)
ISA = "inline CSPACE_ISA"
# Mathematics is the vocabulary of every room; the thresholds of all rooms stand in one header.
OTHERS = {"math": "cspace", "tolerances.hpp": "cspace::tolerance"}


def namespace_of(room: str) -> str:
    return OTHERS.get(room, f"cspace::{room}")


@pytest.mark.parametrize("path", HEADERS, ids=lambda path: str(path.relative_to(FOLDER)))
def test_headers_open_the_namespace_of_their_room(path):
    own = namespace_of(path.relative_to(FOLDER).parts[0])
    text = path.read_text(encoding="utf-8")
    opened = re.findall(r"^(?:inline )?namespace ([\w: ]*?) ?\{", text, re.M)
    for name in (name for name in opened if name.startswith("cspace")):
        inner = name.removeprefix(own).removeprefix("::")
        assert name.startswith(own), f"{path}: opens {name}, the room is {own}"
        if own == "cspace":
            assert inner in ("", ISA), f"{path}: opens {name}, the room is {own}"
        else:
            assert re.fullmatch(rf"({ISA})?|\w+(::{ISA})?", inner), f"{path}: opens {name}"
    outside = re.sub(r"^namespace cspace.*?^}  // namespace cspace", "", text, flags=re.M | re.S)
    assert not re.search(r"^(using|namespace|inline|template|struct|class)\b", outside, re.M), (
        f"{path}: declares something outside of {own}"
    )


def test_every_namespace_is_on_the_page_and_in_the_umbrella_header():
    spaces = {namespace_of(path.relative_to(FOLDER).parts[0]) for path in HEADERS}
    spaces -= {"cspace", "cspace::version.hpp"}
    page = (tree.ROOT / "docs/cpp.md").read_text(encoding="utf-8")
    assert set(re.findall(r"^\| `(cspace::\w+)` \|", page, re.M)) == spaces
    comment = UMBRELLA.read_text(encoding="utf-8").partition("#pragma once")[0]
    assert set(re.findall(r"cspace::\w+", comment)) == spaces


def includes(path):
    """The headers of the project that a header includes itself."""
    return [
        tree.ROOT / "include" / target.strip('"') for _, target in tree.includes(path) if target[0] == '"'
    ]


def test_the_umbrella_header_includes_every_header():
    listed, reached = includes(UMBRELLA), set()
    waiting = list(listed)
    while waiting:
        path = waiting.pop()
        if path not in reached:
            reached.add(path)
            waiting += includes(path)
    assert reached == set(HEADERS)
    included = {target for path in HEADERS for target in includes(path)}
    assert listed == [path for path in HEADERS if path not in included], "list what no other header includes"


FREE_FUNCTION = re.compile(
    r"^(?:template ?<.*>\n)?(?:(?:inline|constexpr|static|CSPACE_INLINE|CSPACE_ONCE|CSPACE_NOINLINE"
    r"|\[\[nodiscard\]\]) )+(?:const )?[\w:<>,&* ]+?[&* ]+([a-z]\w*)\(",
    re.M,
)
MATHEMATICS = """
    abs acos all any asin atan2 binomial conjugate copysign cross determinant difference distance dot expm1
    inverse max min norm orientation polynomial product quadratic round sign sincos sqrt square tanh transpose
"""
"""Functions that one word of mathematics names."""


def test_free_functions_of_headers_are_a_verb_and_an_object():
    found: dict[str, set[str]] = {}
    for path in HEADERS:
        names = FREE_FUNCTION.findall(path.read_text(encoding="utf-8"))
        words = {name for name in names if "_" not in name} - set(MATHEMATICS.split())
        if words:
            found.setdefault(str(path.relative_to(FOLDER)), set()).update(words)
    assert not found, "give them a verb and an object"


def test_the_page_of_the_core_names_the_rooms_with_instruction_sets():
    page = (tree.ROOT / "docs/cpp.md").read_text(encoding="utf-8")
    sentence = next(part for part in page.split("\n\n") if part.startswith("The kernels of `"))
    named, others = (set(re.findall(r"`(\w+)`", part)) for part in sentence.split("inline namespace"))
    core = tree.ROOT / "include/cspace"
    rooms = {path.name for path in core.iterdir() if path.is_dir()}
    having = {
        path.relative_to(core).parts[0]
        for path in core.rglob("*.hpp")
        if ISA in path.read_text(encoding="utf-8")
    }
    assert named == having
    assert others == rooms - having
