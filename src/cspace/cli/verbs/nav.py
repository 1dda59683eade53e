"""`cspace nav`: a way through a map, by one planner or by all of them side by side."""

from __future__ import annotations

import argparse
import math
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from cspace.cli.arguments import number
from cspace.cli.exits import Exit, UsageError
from cspace.cli.output import Cell, Output, Table
from cspace.cli.pictures import check_format
from cspace.errors import InputError

if TYPE_CHECKING:
    from cspace.maps import PolygonWorld
    from cspace.navigation import Route

__all__ = ["EXAMPLES", "arguments", "run"]

EXAMPLES: Final = """
cspace nav map.yaml --start 1 1 --goal 9 7 --planner all --plot ways.png
cspace nav yard.geojson --start 0 0 --goal 20 5 --radius 0.3 --planner visibility_graph --json
"""

SAMPLES: Final = 400
"""Places along a path at which its clearance is taken."""


def arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments."""
    parser.add_argument(
        "map", type=Path, help="ROS map (.yaml), MovingAI .map, image, GeoJSON or text of polygons"
    )
    for name in ("start", "goal"):
        parser.add_argument(f"--{name}", nargs=2, type=number, required=True, metavar=("X", "Y"), help="[m]")
    parser.add_argument(
        "--planner",
        default="any_angle",
        help="a planner's name, several with commas, or all (default: any_angle)",
    )
    parser.add_argument("--radius", type=number, default=0.0, help="radius of the robot [m] (default: 0)")
    parser.add_argument(
        "--resolution", type=number, help="side of a cell [m], of images and where polygons become cells"
    )
    parser.add_argument(
        "--plot", type=Path, metavar="FILE", help="save the routes side by side (.png, .svg, .pdf)"
    )
    parser.add_argument(
        "--animate", type=Path, metavar="FILE.gif", help="save the search of the first planner, moving"
    )


def run(args: argparse.Namespace, out: Output) -> int:
    """Ask the planners and print what they answer, side by side."""
    names = planners_of(args.planner)
    if args.plot:
        check_format(args.plot)
    if args.animate and args.animate.suffix.lower() != ".gif":
        raise UsageError(f"an animation is a GIF; end {str(args.animate)!r} with .gif")
    world = load(args.map, args.resolution)
    routes, refused = answers(world, names, args)
    best, walls = ask(world, "any_angle", args), polygons(world)
    if out.as_json:
        out.document(document(args, routes, best, walls) | {"refused": refused})
    else:
        show(routes, best, walls, out)
        for name, why in refused.items():
            out.line(f"{name}: {why}")
    if args.plot:
        from cspace import plot

        plot.save(plot.routes(routes), args.plot)
    if args.animate:
        from cspace import plot

        plot.save(plot.animation(routes[0]), args.animate, dpi=80)
    return Exit.DONE if any(routes) else Exit.NEGATIVE


def planners_of(text: str) -> list[str]:
    """The planners that are asked for."""
    from cspace.navigation import PLANNERS
    from cspace.navigation.planners import planner_named

    if text == "all":
        return sorted(PLANNERS)
    return [planner_named(name.strip()).name for name in text.split(",")]


def load(path: Path, resolution: float | None) -> Any:
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
        f"cannot tell the kind of map of {str(path)!r}; end it with .yaml, .map, .png, .pgm, .geojson or .txt"
    )


def ask(world: Any, planner: str, args: argparse.Namespace) -> Route:
    """The answer of one planner."""
    from cspace.navigation import PLANNERS, navigate

    becomes_cells = world.kind == "polygons" and PLANNERS[planner].world == "grid"
    more = {"resolution": args.resolution} if becomes_cells and args.resolution else {}
    return navigate(world, args.start, args.goal, planner, radius=args.radius, **more)


def answers(world: Any, names: list[str], args: argparse.Namespace) -> tuple[list[Route], dict[str, str]]:
    """The routes of planners, and why others refuse the question; InputError where all do.

    Of several planners times are compared, without what is made once and kept with the map.
    """
    routes, refused = [], {}
    for name in names:
        try:
            route = ask(world, name, args)
        except InputError as error:
            if len(names) == 1:
                raise
            refused[name] = str(error)
        else:
            routes.append(route if len(names) == 1 else ask(world, name, args))
    if not routes:
        raise InputError(next(iter(refused.values())))
    return routes, refused


def polygons(world: Any) -> PolygonWorld:
    """The map as it was read, as polygons."""
    from cspace.maps import PolygonWorld

    return world if isinstance(world, PolygonWorld) else PolygonWorld.from_grid(world)


def clearance(route: Route, walls: PolygonWorld) -> float | None:
    """The least distance [m] between the path and a wall of the map, at many places along it."""
    if not len(route.path):
        return None
    along = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(route.path, axis=0).T))])
    at = np.unique(np.concatenate([along, np.linspace(0, along[-1], SAMPLES)]))
    points = np.stack([np.interp(at, along, route.path[:, k]) for k in (0, 1)], axis=1)
    return float(walls.clearance(points).min())


def ratio(route: Route, best: Route) -> float | None:
    """How many times the shortest path a route is long."""
    if not (route and best) or not math.isfinite(route.length):
        return None
    return route.length / best.length if best.length else 1.0


def show(routes: list[Route], best: Route, walls: PolygonWorld, out: Output) -> None:
    """One line a planner, and why some found nothing; of a single one, the reason and the corners too."""
    table = Table(("planner", "status", "length [m]", "/ shortest", "clearance [m]", "nodes", "time [µs]"))
    table.left = frozenset({0, 1})
    for route in routes:
        share, free = ratio(route, best), clearance(route, walls)
        table.add(
            route.planner,
            Cell(route.status, "" if route else "yellow"),
            f"{route.length:.3f}" if math.isfinite(route.length) else "-",
            "-" if share is None else f"{share:.3f}",
            "-" if free is None else f"{free:.3f}",
            str(route.price.nodes),
            f"{1e6 * route.price.seconds:.1f}",
        )
    out.table(table)
    if len(routes) > 1:
        for route in routes:
            if not route:
                out.line(f"{route.planner}: {route.reason}")
    else:
        out.line(routes[0].reason)
        for x, y in routes[0].path:
            out.line(f"{x:12.6f} {y:12.6f}")


def document(
    args: argparse.Namespace, routes: list[Route], best: Route, walls: PolygonWorld
) -> dict[str, Any]:
    """The answers for machines."""
    found = [
        {
            "planner": route.planner,
            "status": route.status,
            "reason": route.reason,
            "length": route.length if math.isfinite(route.length) else None,
            "ratio_to_shortest": ratio(route, best),
            "clearance": clearance(route, walls),
            "nodes": route.price.nodes,
            "edges": route.price.edges,
            "seconds": route.price.seconds,
            "path": route.path.tolist(),
        }
        for route in routes
    ]
    given = {"map": str(args.map), "start": list(args.start), "goal": list(args.goal), "radius": args.radius}
    return {"schema": "cspace.nav/1", **given, "routes": found}
