"""`cspace nav`: a path through a map, by one planner or by all of them for comparison."""

from __future__ import annotations

import argparse
import math
import time
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from cspace.cli.arguments import add_option, named_value, read_length, read_number
from cspace.cli.exits import Exit, UsageError
from cspace.cli.output import Cell, Output, Table, check_format, check_writable
from cspace.cli.verbs.planners import options_given, typed_value
from cspace.errors import InputError

if TYPE_CHECKING:
    from cspace.navigation import PlanePlanner, Route


EXAMPLES: Final = """
cspace nav map.yaml --start 1 1 --goal 9 7 --planner all --plot ways.png
cspace nav yard.geojson --start 0 0 --goal 20 5 --radius 0.3 --planner visibility_graph --json
cspace nav yard.geojson --start 0 0 --goal 20 5 --planner rrt,rrt_star --seed 7 --option rrt.samples=500
"""

NUMBERS: Final = (
    ("length [m]", "length", "{:.3f}".format),
    ("/ shortest", "ratio_to_shortest", "{:.3f}".format),
    ("clearance [m]", "clearance", "{:.3f}".format),
    ("nodes", "nodes", str),
    ("first [ms]", "seconds_first", lambda seconds: f"{1e3 * seconds:.3f}"),
    ("again [ms]", "seconds_again", lambda seconds: f"{1e3 * seconds:.3f}"),
)
"""The numbers of a result: the heading of their column, their name in the document, and their form."""

MOST_POINTS: Final = 20
"""The longest path of which every point is printed without --details."""

PATIENCE: Final = 5.0
"""A first call that took longer [s] is not repeated."""


def arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "map", type=Path, help="ROS map (.yaml), MovingAI .map, image, GeoJSON or text of polygons"
    )
    add_option(parser, "--start X Y", "[m]", read_number, required=True)
    add_option(parser, "--goal X Y", "[m]", read_number, required=True)
    text = "name of a planner, several separated by commas, or all (default: any_angle)"
    add_option(parser, "--planner PLANNER", text, default="any_angle")
    text = "an option of the planners (cspace planners NAME); may be repeated"
    add_option(parser, "--option [PLANNER.]NAME=VALUE", text, named_value, action="append", default=[])
    add_option(parser, "--seed N", "the seed of sampling-based planners", int)
    add_option(parser, "--radius RADIUS", "radius of the robot [m] (default: 0)", read_length, default=0.0)
    text = "side of a cell [m], for images and for polygons converted to cells"
    add_option(parser, "--resolution RESOLUTION", text, read_length)
    add_option(parser, "--details", "all points of a long path")
    add_option(parser, "--plot FILE", "draw the routes side by side (.png, .svg, .pdf)", Path)
    add_option(parser, "--animate FILE.gif", "animate the search of the first planner", Path)


def run(args: argparse.Namespace, out: Output) -> int:
    """Run the planners and print their results in one table."""
    given = options_given(args.option, args.seed, planners_of(args.planner))
    for path in filter(None, (args.plot, args.animate)):
        check_writable(path)
    if args.plot:
        check_format(args.plot)
    if args.animate and args.animate.suffix.lower() != ".gif":
        raise UsageError(f"an animation is a GIF file, but {str(args.animate)!r} does not end with .gif")
    world = load_world(args.map, args.resolution)
    answers, refused = collect_answers(world, given, args)
    best, routes = ask_planner(world, "any_angle", args, {}), [each.route for each in answers]
    found = [answer_document(each, best) for each in answers]
    written = draw_pictures(args, routes)
    if out.as_json:
        asked = {"map": str(args.map), "start": args.start, "goal": args.goal, "radius": args.radius}
        results = {"routes": found, "refused": refused, "written": written}
        out.document({"schema": "cspace.nav/1", **asked, **results})
    else:
        print_answers(found, out, details=args.details)
        for name, cause in refused.items():
            out.line(f"{name}: {cause}")
        if args.animate:
            out.line(f"{args.animate}: the search of {routes[0].planner}")
        for path in written:
            out.line(f"wrote {path}")
    return Exit.DONE if any(routes) else Exit.NEGATIVE


def draw_pictures(args: argparse.Namespace, routes: list[Route]) -> list[str]:
    """Draw the requested pictures; returns the files that were written."""
    if not (args.plot or args.animate):
        return []
    from cspace import plot

    if args.plot:
        plot.save(plot.routes(routes), args.plot)
    if args.animate:
        plot.save(plot.animation(routes[0]), args.animate, dpi=80)
    return [str(path) for path in (args.plot, args.animate) if path]


def planners_of(text: str) -> dict[str, PlanePlanner]:
    """The selected planners, by name."""
    from cspace.navigation import PLANNERS
    from cspace.navigation.planners import find_planner

    if text == "all":
        return {name: PLANNERS[name] for name in sorted(PLANNERS)}
    found = [find_planner(name.strip()) for name in text.split(",")]
    return {each.name: each for each in found}


def load_world(path: Path, resolution: float | None) -> Any:
    """The world in a file, by its ending."""
    from cspace.maps import OccupancyGrid, PolygonWorld

    ending = path.suffix.lower()
    if ending in {".yaml", ".yml"}:
        return OccupancyGrid.from_ros(path)
    if ending == ".map":
        return OccupancyGrid.from_movingai(path)
    if ending in {".png", ".pgm"}:
        return OccupancyGrid.from_image(path, resolution=resolution or 1.0)
    if ending in {".geojson", ".json"}:
        return PolygonWorld.from_geojson(path)
    if ending == ".txt":
        return PolygonWorld.from_text(path)
    raise UsageError(
        f"unknown kind of map {str(path)!r}; its name must end with .yaml, .map, .png, .pgm, .geojson or .txt"
    )


def ask_planner(world: Any, planner: str, args: argparse.Namespace, options: dict[str, Any]) -> Route:
    """The result of one planner."""
    from cspace.navigation import PLANNERS, navigate

    becomes_cells = world.kind == "polygons" and PLANNERS[planner].world == "grid"
    more = {"resolution": args.resolution} if becomes_cells and args.resolution else {}
    return navigate(world, args.start, args.goal, planner, radius=args.radius, **more, **options)


@dataclass(frozen=True)
class Answer:
    """A route, and how long the calls took [s]."""

    route: Route
    first: float
    again: float | None
    """The same call once more, when what the planner keeps with the map is there; None if it took too long
    to ask twice."""


def time_planner(world: Any, planner: str, args: argparse.Namespace, options: dict[str, Any]) -> Answer:
    """Ask a planner twice: the second time with the same seed."""
    began = time.perf_counter()
    route = ask_planner(world, planner, args, options)
    first, again = time.perf_counter() - began, None
    if first < PATIENCE:
        seed = {"rng": route.options["rng"]} if "rng" in route.options else {}
        began = time.perf_counter()
        ask_planner(world, planner, args, {**options, **seed})
        again = time.perf_counter() - began
    return Answer(route, first, again)


def collect_answers(
    world: Any, given: dict[str, dict[str, Any]], args: argparse.Namespace
) -> tuple[list[Answer], dict[str, str]]:
    """What planners answer, and why others refuse; InputError where all do. given: the options of each."""
    found, refused = [], {}
    for planner, options in given.items():
        try:
            found.append(time_planner(world, planner, args, options))
        except InputError as error:
            if len(given) == 1:
                raise
            refused[planner] = str(error)
    if not found:
        raise InputError(next(iter(refused.values())))
    return found, refused


def answer_document(each: Answer, best: Route) -> dict[str, Any]:
    """One result as JSON data; numbers that do not exist are null."""
    route, length, clearance = each.route, each.route.length, each.route.clearance
    ratio = (length / best.length if best.length else 1.0) if route and best else None
    return {
        "planner": route.planner,
        "status": route.status,
        "reason": route.reason,
        "length": length if math.isfinite(length) else None,
        "ratio_to_shortest": ratio if math.isfinite(length) else None,
        "clearance": None if math.isnan(clearance) else clearance,
        **route.stats._asdict(),
        "seconds_first": each.first,
        "seconds_again": each.again,
        "options": {name: typed_value(value) for name, value in route.options.items()},
        "path": route.path.tolist(),
    }


def print_answers(found: list[dict[str, Any]], out: Output, *, details: bool) -> None:
    """One line a planner, the seeds, and why some found nothing; of a single one the reason and the path too.

    details: all points of the path; else of a long one the first and the last.
    """
    columns = ["planner", "status", *(heading for heading, _, _ in NUMBERS)]
    table = Table(columns, left=frozenset({0, 1}))
    for row in found:
        status = Cell(row["status"], "" if row["status"] == "found" else "yellow")
        numbers = [(row[name], form) for _, name, form in NUMBERS]
        table.add(row["planner"], status, *("-" if x is None else form(x) for x, form in numbers))
    out.table(table)
    if len(found) > 1:
        for row in found:
            if row["status"] != "found":
                out.line(f"{row['planner']}: {row['reason']}")
    else:
        out.line(found[0]["reason"])
        print_path(found[0]["path"], out, MOST_POINTS if not details else len(found[0]["path"]))
    for row in found:
        seed = row["options"].get("rng")
        if seed is not None and row["options"].get("noise") != 0:  # without noise nothing is drawn
            out.line(f"{row['planner']}: --seed {seed}")


def print_path(path: list[list[float]], out: Output, most: int) -> None:
    """A point a line; of more than `most` the first and the last, and how many are left out between them."""
    lines = [f"{x:12.6f} {y:12.6f}" for x, y in path]
    if len(lines) > most:
        half = most // 2
        said = f"… {len(lines) - 2 * half} of {len(lines)} points; --details prints all …"
        lines = [*lines[:half], said, *lines[-half:]]
    for line in lines:
        out.line(line)
