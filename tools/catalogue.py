"""Writes what is made from the catalogue files: src/cspace/robots/index.json and docs/catalogue.md.

Run it after a change in src/cspace/robots/catalogue: python tools/catalogue.py
"""

from __future__ import annotations

import json
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "src"))

from cspace.model import Description, chain, from_toml  # noqa: E402

FOLDER = ROOT / "src/cspace/robots/catalogue"


def descriptions() -> list[Description]:
    """Every robot of the catalogue, in the order of the names."""
    return [from_toml(path) for path in sorted(FOLDER.glob("*.toml"))]


def joint_word(types: str) -> str:
    """6R for six turns, else the letters."""
    return f"{len(types)}R" if set(types) == {"R"} else types


def row(robot: Description) -> tuple[object, ...]:
    about = robot.provenance
    types = chain(robot).joint_types
    source = about.sources["joints"]
    return (
        robot.name,
        len(types),
        joint_word(types),
        about.title,
        about.vendor,
        source.source,
        source.licence,
        about.aliases,
        about.missing,
    )


def rated(robots: list[Description]) -> int:
    """How many robots have limits of velocity and effort."""
    return sum(not {"velocity", "effort"} & set(robot.provenance.missing) for robot in robots)


def weighed(robots: list[Description]) -> int:
    """How many robots have masses, centres of mass and inertia tensors."""
    return sum("inertia" not in robot.provenance.missing for robot in robots)


def posed(robots: list[Description]) -> int:
    """How many robots have named poses."""
    return sum(bool(robot.poses) for robot in robots)


def index_text(robots: list[Description]) -> str:
    """The rows of cspace.robots, one line each: the fields of CatalogueRow."""
    return "[\n" + ",\n".join(json.dumps(row(robot), ensure_ascii=False) for robot in robots) + "\n]\n"


FIELDS = ("velocity", "acceleration", "jerk", "effort", "inertia", "collision", "visual")
"""The groups of numbers besides joint axes, ranges and named poses, as `missing` names them."""


def fields_text(robot: Description) -> str:
    """What a file has besides joint axes and ranges; the names of its poses."""
    missing = robot.provenance.missing
    known = [] if "link frames" in missing else ["frames"]
    known += [field for field in FIELDS if field not in missing]
    poses = f"poses: {', '.join(robot.poses)}" if robot.poses else ""
    return "; ".join(filter(None, [", ".join(known), poses]))


def page_text(robots: list[Description]) -> str:
    """The page docs/catalogue.md."""
    framed = sum("link frames" not in robot.provenance.missing for robot in robots)
    lines = [
        "# The catalogue",
        "",
        f"{len(robots)} robots come with the library; `cs.load_robot(name)` takes any of their names.",
        "Capitals, blanks, dashes, underscores and full stops do not count: `UR-5e` is `ur5e`. This page is",
        "made by `tools/catalogue.py` from `src/cspace/robots/catalogue`, where every number is.",
        "",
        f"Every robot has joint axes and, where published, ranges. {framed} robots have link frames:",
        "links and joints have the names and the frames of the maker's description (of a textbook arm: of",
        "its table), and the flanges of one maker's arms are alike. The others are screws: their base and",
        "tip are links of the source, and the frames between stand on the joint axes, parallel to the base",
        "at zero. Both are [TOML files of robots](robots.md#toml); a",
        "[decision](decisions/catalogue-format.md) gives the reasons.",
        f"{weighed(robots)} robots have masses and inertia tensors, {rated(robots)} have velocity and effort",
        f"limits, {posed(robots)} have named poses. Each file lists what it lacks under `missing` and says",
        "where each group of numbers is from. For masses and limits",
        "[a table below](#masses-and-limits) says it, too.",
        "A limit that the source prints as a multiple of half a degree with nine digits or more is that",
        "angle to the last digit. One with fewer digits (3.1415, 3.14158, 3.1416) stays the number of the",
        "source. Right angles of the axes that the source rounds to 1.5708 or 3.1416 are exact, which",
        "moves no tip by more than 0.01 mm and 2e-5 rad; the source column says where.",
        "",
        "| name | joints | robot | vendor | other names | fields | source | licence |",
        "|---|---|---|---|---|---|---|---|",
    ]
    for robot in robots:
        name, _, joints, title, vendor, source, licence, aliases, _ = map(str_or_tuple, row(robot))
        lines.append(
            table_row([f"`{name}`", joints, title, vendor, aliases, fields_text(robot), source, licence])
        )
    return "\n".join([*lines, *masses_and_limits(robots)]) + "\n"


def table_row(cells: list[str]) -> str:
    return "| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |"


GROUPS = (("inertia",), ("velocity", "effort"), ("acceleration", "jerk"), ("damping", "friction", "armature"))
"""The groups of sources that share a column of the second table."""


def masses_and_limits(robots: list[Description]) -> list[str]:
    """The lines of the second table: per robot the total mass, and the sources of masses and limits."""
    lines = [
        "",
        "## Masses and limits",
        "",
        "The mass is that of all links in the file, with the base where the source gives its mass. A tensor",
        "is about the centre of mass of its link, in the axes of the link. The last column is about damping,",
        "friction and the inertia of the rotors as the joints feel it. An empty cell means that no source",
        "was found.",
        "",
        "| name | mass [kg] | masses, tensors | velocity, effort | acceleration, jerk | friction |",
        "|---|---|---|---|---|---|",
    ]
    for robot in robots:
        cells = [sources_text(robot, group) for group in GROUPS]
        mass = sum(link.inertial.mass for link in robot.links if link.inertial)
        if any(cells):
            lines.append(table_row([f"`{robot.name}`", f"{mass:.2f}" if mass else "", *cells]))
    return lines


def sources_text(robot: Description, groups: tuple[str, ...]) -> str:
    """The sources of the groups and their licences, each once, after the groups that it is the source of."""
    found: dict[str, list[str]] = {}
    for group in groups:
        if (entry := robot.provenance.sources.get(group)) is not None:
            found.setdefault(f"{entry.source}; {entry.licence}", []).append(group)
    if list(found.values()) == [list(groups)]:
        return next(iter(found))
    return "<br>".join(f"{', '.join(named)}: {text}" for text, named in found.items())


def str_or_tuple(value: object) -> str:
    return ", ".join(f"`{item}`" for item in value) if isinstance(value, tuple) else str(value)


def outputs() -> dict[Path, str]:
    """Each file that is made, and its text."""
    robots = descriptions()
    return {
        ROOT / "src/cspace/robots/index.json": index_text(robots),
        ROOT / "docs/catalogue.md": page_text(robots),
    }


if __name__ == "__main__":
    for path, text in outputs().items():
        path.write_text(text, encoding="utf-8", newline="\n")
        print(f"{path.relative_to(ROOT)}: {len(text.splitlines())} lines")
