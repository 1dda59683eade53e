"""Writes the generated parts of docs/: the index of rooms, the index of the lectures, the examples in C++,
the options of planners, the measurements of planning.

Usage: python tools/pages.py [--check]
"""

from __future__ import annotations

import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
DOCS = ROOT / "docs"
sys.path[:0] = [str(ROOT / "src"), str(ROOT / "benchmarks")]
COURSE = ("spatial", "robots", "catalogue", "kinematics", "ik", "subproblems", "redundancy", "tracking")
COURSE += (
    "differential-kinematics",
    "dynamics",
    "closed-loops",
    "simulation",
    "trajectory",
    "path-timing",
    "cartesian",
    "export",
    "shapes",
    "collision",
    "planning",
    "two-joint-space",
    "joint-space",
    "motion",
    "maps",
    "navigation",
    "planners",
    "cars",
    "mobile",
    "localization",
    "kalman-filters",
    "monte-carlo",
    "landmark-slam",
    "pose-graphs",
    "slam",
)
COURSE += ("plot", "cli", "cpp")
"""The pages of the rooms, in the order in which they build on each other."""


def heading(page: Path) -> str:
    return page.read_text(encoding="utf-8").splitlines()[0].lstrip("# ")


def first_sentence(page: Path) -> str:
    """The first sentence of the first paragraph under the title."""
    paragraph = page.read_text(encoding="utf-8").split("\n\n")[1]
    return re.split(r"(?<=[.!?:])\s", " ".join(paragraph.split()))[0].rstrip(".:")


def rooms() -> str:
    """A table of the pages of the rooms with their first sentences."""
    pages = [DOCS / f"{name}.md" for name in COURSE]
    rows = [f"| [{heading(page)}]({page.name}) | {first_sentence(page)} |" for page in pages]
    return "\n".join(["| page | what |", "|---|---|", *rows])


def anchor(title: str) -> str:
    """The anchor that GitHub gives a heading."""
    kept = re.sub(r"[^\w\- ]", "", title.lower())
    return kept.replace(" ", "-")


def lectures() -> str:
    """A list of the lecture pages and their sections, each section a worked example."""
    lines = []
    for page in sorted((DOCS / "lectures").glob("*.md")):
        lines.append(f"- [{heading(page)}](lectures/{page.name})")
        sections = re.findall(r"^## (.+)$", page.read_text(encoding="utf-8"), re.M)
        lines += [f"  - [{title}](lectures/{page.name}#{anchor(title)})" for title in sections]
    return "\n".join(lines)


def source(path: str, language: str) -> str:
    """A file of the repository as a block of code that the page does not run."""
    return f"```{language} no-run\n{(ROOT / path).read_text(encoding='utf-8')}```"


def options() -> str:
    """Of each planner a table of its options, as the fields of its class declare them."""
    from cspace.navigation import PLANNERS

    lines, without = [], []
    for planner in PLANNERS.values():
        kind = type(planner).__name__
        if not planner.options:
            without.append(f"`{planner.name}` (`{kind}`)")
            continue
        summary = planner.summary[0].upper() + planner.summary[1:]
        lines += [f"## {planner.name}", "", f"{summary}. Class: `cs.navigation.{kind}`.", ""]
        lines += ["| option | type | default | unit | meaning |", "|---|---|---|---|---|"]
        for each in planner.options.values():
            default = "" if each.default is None else f"`{each.default}`"
            kind, meaning = each.type.replace("|", "or"), each.meaning.replace("*", "\\*")
            lines.append(f"| `{each.name}` | {kind} | {default} | {each.unit} | {meaning} |")
        lines.append("")
    return "\n".join([*lines, f"No options: {', '.join(without)}."])


def filled(page: Path, parts: dict[str, str]) -> str:
    """The page with the part between each marker and the next end marker replaced."""
    text = page.read_text(encoding="utf-8")
    for marker, part in parts.items():
        pattern = rf"(<!-- {re.escape(marker)} -->\n).*?(<!-- end -->)"
        text = re.sub(pattern, lambda m, part=part: f"{m[1]}{part}\n{m[2]}", text, flags=re.S)
    return text


def generated() -> dict[Path, str]:
    """Each page with generated parts and the text it should have."""
    import planning_page

    parts = {
        DOCS / "planning.md": planning_page.parts(),
        DOCS / "index.md": {"rooms": rooms()},
        DOCS / "lectures.md": {"lectures": lectures()},
        DOCS / "planners.md": {"options": options()},
        DOCS / "cpp.md": {
            path: source(path, language)
            for path, language in (
                ("examples/cpp/CMakeLists.txt", "cmake"),
                ("examples/cpp/reach.cpp", "cpp"),
                ("examples/cpp/shortest_path.cpp", "cpp"),
            )
        },
    }
    return {page: filled(page, of_page) for page, of_page in parts.items()}


def main() -> int:
    drifted = [(page, text) for page, text in generated().items() if page.read_text(encoding="utf-8") != text]
    for page, text in drifted:
        if "--check" in sys.argv[1:]:
            print(f"{page.name} has drifted; run tools/pages.py")
        else:
            page.write_text(text, encoding="utf-8")
    return int(bool(drifted) and "--check" in sys.argv[1:])


if __name__ == "__main__":
    sys.exit(main())
