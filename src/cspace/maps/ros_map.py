"""ROS maps: a YAML file and an image, as map_server reads them."""

from __future__ import annotations

import math
import os
import re
from dataclasses import dataclass
from typing import Any, Final

import numpy as np
import numpy.typing as npt

from cspace.arrays import Array
from cspace.errors import InputError, MapError
from cspace.files import unquote, whole_file, write_text, yaml_lines
from cspace.maps.files import check_map_path, read_map_text
from cspace.maps.images import encode_pgm, read_image

MODES: Final = ("trinary", "scale", "raw")
NEEDED: Final = ("image", "resolution", "origin", "negate", "occupied_thresh", "free_thresh")


@dataclass(frozen=True)
class RosMap:
    """A ROS map: cells (rows, columns), how likely each is occupied from 0 to 1, NaN where it is unknown, the
    lowest row first."""

    cells: Array
    resolution: float
    origin: tuple[float, float]


def read_ros(path: str | os.PathLike[str], modes: tuple[str, ...] = ("trinary",)) -> RosMap:
    """The map of a YAML file; MapError names the line or byte at fault.

    trinary: a cell is occupied where its darkness exceeds occupied_thresh, free where it is below
    free_thresh, unknown between and where the image is transparent. scale: the same, but between the
    thresholds the probability rises linearly. raw: a grey of 0 to 100, of 255, is the probability in per
    cent, any other unknown. Fields other than those of map_server are ignored.

    modes: those that are accepted.
    """
    name = check_map_path(path)
    fields = _read_fields(read_map_text(path), name)
    for field in NEEDED:
        if field not in fields and not (field == "negate" and "occupied_thresh" in fields):
            raise MapError(f"the field '{field}:' is missing", path=name)
    mode = _get_mode(fields, modes, name)
    resolution = _get_number(fields, "resolution", name)
    if not 0 < resolution < math.inf:
        raise MapError("resolution must be positive [m]", path=name, line=fields["resolution"][1])
    occupied, free = _get_number(fields, "occupied_thresh", name), _get_number(fields, "free_thresh", name)
    if not 0 <= free <= occupied <= 1:
        message = f"free_thresh {free:g} and occupied_thresh {occupied:g} must be 0 <= free <= occupied <= 1"
        raise MapError(message, path=name, line=fields["occupied_thresh"][1])
    image = fields["image"][0]
    if not isinstance(image, str) or not image:
        raise MapError("image must be the path of a PGM or PNG file", path=name, line=fields["image"][1])
    grey = read_image(os.path.join(os.path.dirname(name), image))[::-1]
    shade = grey if _get_negate(fields, name) else 1 - grey
    cells = _read_raw(1 - shade) if mode == "raw" else _read_shades(shade, occupied, free, mode == "scale")
    return RosMap(cells, resolution, _get_origin(fields, name))


def _get_mode(fields: _Fields, modes: tuple[str, ...], name: str) -> str:
    mode, line = fields.get("mode", ("trinary", 0))
    if mode not in MODES:
        raise MapError(f"mode is {mode!r}; it must be one of {', '.join(MODES)}", path=name, line=line)
    if mode not in modes:
        raise MapError(
            f"mode {mode!r} has partly free cells; cs.maps.EvidenceGrid.from_ros reads them",
            path=name,
            line=line,
        )
    return str(mode)


def _read_shades(darkness: Array, occupied: float, free: float, is_scaled: bool) -> Array:
    """Probabilities by darkness: 0 below one threshold, 1 above the other, NaN or a straight line between."""
    cells = np.full(darkness.shape, np.nan)
    if is_scaled and occupied > free:
        cells = (darkness - free) / (occupied - free)
    cells[darkness < free] = 0.0
    cells[darkness > occupied] = 1.0
    return cells


def _read_raw(grey: Array) -> Array:
    """Probabilities in per cent; NaN for a grey that is none."""
    percent = np.rint(grey * 255)
    return np.where(percent <= 100, percent / 100, np.nan)


def write_ros(
    path: str | os.PathLike[str],
    grey: npt.NDArray[np.uint8],
    resolution: float,
    x: float,
    y: float,
    mode: str,
) -> None:
    """Writes a map of grey values (rows, columns), the lowest row first, that mean what its mode says: a YAML
    file at the path, and a PGM image next to it."""
    name = check_map_path(path)
    stem, ending = os.path.splitext(name)
    if ending not in {".yaml", ".yml"}:
        raise InputError(
            f"path is {name!r}; the name of a ROS map must end in .yaml; its image is written to the same "
            "folder"
        )
    image = stem + ".pgm"
    with whole_file(image) as draft:
        draft.write_bytes(encode_pgm(grey[::-1]))
    text = f"image: {_quote_name(os.path.basename(image))}\nmode: {mode}\nresolution: {resolution!r}\n"
    text += f"origin: [{x!r}, {y!r}, 0.0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n"
    write_text(name, text)


def _quote_name(text: str) -> str:
    """A file name as a YAML scalar."""
    return text if re.fullmatch(r"[\w.-]+", text, re.ASCII) else "'" + text.replace("'", "''") + "'"


# a value and the number of its line
_Fields = dict[str, tuple[Any, int]]


def _read_fields(document: str, name: str) -> _Fields:
    """The fields of a single-level YAML map file: numbers, texts and lists of them."""
    fields: _Fields = {}
    open_list: list[Any] | None = None
    for entry in yaml_lines(document):
        number, field, value = entry.line, entry.key, entry.value
        if field == "-" and open_list is not None:
            open_list.append(_read_scalar(value))
            continue
        if field in ("", "-"):
            raise MapError("expected 'field: value'", path=name, line=number)
        if entry.indent:
            continue  # inside a field that map files do not have
        if field in fields:
            raise MapError(
                f"the field '{field}:' appears for the second time; keep one", path=name, line=number
            )
        open_list = None
        if not value:
            open_list = []
            fields[field] = (open_list, number)
        elif value.startswith("["):
            if not value.endswith("]"):
                raise MapError(
                    "a list in brackets must end in the line in which it begins", path=name, line=number
                )
            fields[field] = ([_read_scalar(part) for part in value[1:-1].split(",") if part.strip()], number)
        else:
            fields[field] = (_read_scalar(value), number)
    return fields


def _read_scalar(text: str) -> str | float:
    text = text.strip()
    if re.fullmatch(r"[-+]?(\d+(\.\d*)?|\.\d+)([eE][-+]?\d+)?", text, re.ASCII):
        return float(text)
    return unquote(text)


def _get_number(fields: _Fields, field: str, name: str) -> float:
    value, line = fields[field]
    if not isinstance(value, float) or not math.isfinite(value):
        raise MapError(f"{field} must be a finite number", path=name, line=line)
    return value


def _get_negate(fields: _Fields, name: str) -> bool:
    value, line = fields.get("negate", (0.0, 0))
    if value in (0.0, 1.0, "true", "false", "True", "False"):
        return value in (1.0, "true", "True")
    raise MapError("negate must be 0 or 1", path=name, line=line)


def _get_origin(fields: _Fields, name: str) -> tuple[float, float]:
    value, line = fields["origin"]
    if not isinstance(value, list) or len(value) not in (2, 3):
        raise MapError("origin must be a list [x, y, yaw]", path=name, line=line)
    if not all(isinstance(part, float) and math.isfinite(part) for part in value):
        raise MapError("origin must contain finite numbers", path=name, line=line)
    if len(value) == 3 and value[2] != 0:
        message = f"the map is turned by {value[2]:g} rad; turn the image and give it a yaw of 0"
        raise MapError(message, path=name, line=line)
    return value[0], value[1]
