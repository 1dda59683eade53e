"""Files of polygons: GeoJSON (RFC 7946: Butler et al. 2016), read as coordinates of the plane, and
plain text, a point per line and an empty line between rings."""

from __future__ import annotations

import json
import os
from collections.abc import Iterator
from typing import Any

from cspace.arrays import Array
from cspace.errors import MapError, name_type, shown
from cspace.files import write_text
from cspace.maps.files import check_map_path, read_map_text
from cspace.tolerances import GEOJSON_DEPTH

_SKIPPED = ("Point", "MultiPoint", "LineString", "MultiLineString")


def read_geojson(source: str | os.PathLike[str] | dict[str, Any]) -> tuple[list[Any], list[float] | None]:
    """The obstacles, each a list of rings, and the bounds where the object has a "bbox" of four numbers."""
    if isinstance(source, dict):
        path, found = None, source
    else:
        path = check_map_path(source)
        found = _parse_file(path)
    obstacles = list(_find_polygons(found, path, "the object", GEOJSON_DEPTH))
    box = found.get("bbox")
    return obstacles, box if isinstance(box, list) and len(box) == 4 else None


def write_geojson(
    path: str | os.PathLike[str], obstacles: list[list[Array]], bounds: tuple[float, ...]
) -> None:
    """Writes obstacles, each a list of rings (n, 2) [m], as a MultiPolygon whose "bbox" is the bounds."""
    rings = [[[*ring.tolist(), ring[0].tolist()] for ring in polygon] for polygon in obstacles]
    write_text(path, json.dumps({"type": "MultiPolygon", "bbox": bounds, "coordinates": rings}) + "\n")


def _parse_file(path: str) -> dict[str, Any]:
    try:
        found = json.loads(read_map_text(path))
    except RecursionError:
        raise MapError("this is not GeoJSON: it is nested too deeply", path=path) from None
    except json.JSONDecodeError as error:
        raise MapError(f"this is not JSON: {error.msg}", path=path, line=error.lineno) from None
    except ValueError as error:
        raise MapError(f"this JSON cannot be read: {error}", path=path) from None
    if not isinstance(found, dict):
        raise MapError(f"this is not a GeoJSON object but {name_type(found)}", path=path)
    return found


def _find_polygons(thing: Any, path: str | None, where: str, depth: int) -> Iterator[list[Any]]:
    """The rings of each polygon in a GeoJSON object; geometries without area are skipped.

    depth: how many levels of objects may follow.
    """
    if depth == 0:
        raise MapError(
            f"the object is nested more than {GEOJSON_DEPTH} levels deep, or contains itself; list its"
            " geometries in one collection",
            path=path,
        )
    kind = thing.get("type") if isinstance(thing, dict) else None
    if kind == "FeatureCollection":
        for i, feature in enumerate(_get_list(thing, "features", path, where)):
            yield from _find_polygons(feature, path, f"feature {i}", depth - 1)
    elif kind == "GeometryCollection":
        for i, geometry in enumerate(_get_list(thing, "geometries", path, where)):
            yield from _find_polygons(geometry, path, f"{where}, geometry {i}", depth - 1)
    elif kind == "Feature":
        if thing.get("geometry") is not None:
            yield from _find_polygons(thing["geometry"], path, where, depth - 1)
    elif kind == "Polygon":
        yield _drop_heights(_get_list(thing, "coordinates", path, where), path, where)
    elif kind == "MultiPolygon":
        for i, rings in enumerate(_get_list(thing, "coordinates", path, where)):
            yield _drop_heights(rings, path, f"{where}, polygon {i}")
    elif kind not in _SKIPPED:
        given = "missing" if kind is None else f"{shown(kind)}, which is not a GeoJSON type"
        raise MapError(f'the "type" of {where} is {given}', path=path)


def _get_list(thing: dict[str, Any], name: str, path: str | None, where: str) -> list[Any]:
    if not isinstance(found := thing.get(name), list):
        raise MapError(f"{where} has no list of {name!r}", path=path)
    return found


def _drop_heights(rings: Any, path: str | None, where: str) -> list[Any]:
    """The rings with the height coordinates removed."""
    try:
        made = [[[point[0], point[1]] for point in ring] for ring in rings]
    except (TypeError, IndexError, KeyError):
        raise MapError(f"{where}: coordinates must be rings of [x, y] points", path=path) from None
    if not made:
        raise MapError(f"{where}: a polygon without rings", path=path)
    return made


def read_polygons(path: str | os.PathLike[str]) -> tuple[list[Any], list[float] | None]:
    """The obstacles, each a list of rings, and the bounds if a line gives them."""
    name, lines = check_map_path(path), read_map_text(path).splitlines()
    obstacles: list[list[list[list[float]]]] = []
    bounds: list[float] | None = None
    ring: list[list[float]] | None = None
    is_hole = False
    for number, line in enumerate(lines, 1):
        words = line.split("#", 1)[0].replace(",", " ").split()
        if not words:
            ring = None if not line.strip() else ring
        elif words[0] == "hole":
            if not obstacles:
                raise MapError(
                    "a hole before the first polygon; a hole must follow its polygon", path=name, line=number
                )
            ring, is_hole = None, True
        elif words[0] == "bounds":
            bounds = _read_numbers(words[1:], 4, name, number)
        else:
            point = _read_numbers(words, 2, name, number)
            if ring is None:
                ring = []
                if is_hole:
                    obstacles[-1].append(ring)
                else:
                    obstacles.append([ring])
                is_hole = False
            ring.append(point)
    return obstacles, bounds


def write_polygons(
    path: str | os.PathLike[str], obstacles: list[list[Array]], bounds: tuple[float, ...]
) -> None:
    """Writes obstacles, each a list of rings (n, 2) [m], and the bounds, with every digit preserved."""
    rings = [
        ("hole\n" if number else "") + "".join(f"{x!r} {y!r}\n" for x, y in ring.tolist())
        for polygon in obstacles
        for number, ring in enumerate(polygon)
    ]
    write_text(path, "\n".join(["bounds " + " ".join(map(repr, bounds)) + "\n", *rings]))


def _read_numbers(words: list[str], count: int, path: str, line: int) -> list[float]:
    try:
        numbers = [float(word) for word in words]
    except ValueError:
        numbers = []
    if len(numbers) != count:
        wanted = "a point is two numbers" if count == 2 else "bounds are xmin ymin xmax ymax"
        raise MapError(f"cannot read {' '.join(words)[:60]!r}; {wanted}", path=path, line=line)
    return numbers
