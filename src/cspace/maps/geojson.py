"""GeoJSON (RFC 7946: Butler et al. 2016): reads and writes polygons as coordinates of the plane."""

from __future__ import annotations

import json
import os
from collections.abc import Iterator
from typing import Any

from cspace.arrays import Array
from cspace.errors import MapError
from cspace.files import write_text
from cspace.maps.files import check_map_path, read_map_text

_SKIPPED = {"Point", "MultiPoint", "LineString", "MultiLineString"}


def read_geojson(source: str | os.PathLike[str] | dict[str, Any]) -> tuple[list[Any], list[float] | None]:
    """The obstacles, each a list of rings, and the bounds where the object has a "bbox" of four numbers."""
    if isinstance(source, dict):
        path, found = None, source
    else:
        path = check_map_path(source)
        found = _parse_file(path)
    obstacles = list(_find_polygons(found, path, "the object"))
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
        raise MapError(f"this is not a GeoJSON object but a {type(found).__name__}", path=path)
    return found


def _find_polygons(thing: Any, path: str | None, where: str) -> Iterator[list[Any]]:
    """The rings of each polygon in a GeoJSON object; geometries without area are skipped."""
    kind = thing.get("type") if isinstance(thing, dict) else None
    if kind == "FeatureCollection":
        for i, feature in enumerate(_get_list(thing, "features", path, where)):
            yield from _find_polygons(feature, path, f"feature {i}")
    elif kind == "GeometryCollection":
        for i, geometry in enumerate(_get_list(thing, "geometries", path, where)):
            yield from _find_polygons(geometry, path, f"{where}, geometry {i}")
    elif kind == "Feature":
        if thing.get("geometry") is not None:
            yield from _find_polygons(thing["geometry"], path, where)
    elif kind == "Polygon":
        yield _drop_heights(_get_list(thing, "coordinates", path, where), path, where)
    elif kind == "MultiPolygon":
        for i, rings in enumerate(_get_list(thing, "coordinates", path, where)):
            yield _drop_heights(rings, path, f"{where}, polygon {i}")
    elif kind not in _SKIPPED:
        raise MapError(f"{where} has the type {kind!r}, which is not a GeoJSON type", path=path)


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
