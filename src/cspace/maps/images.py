"""Grey-scale images of maps: PGM (Netpbm), and PNG through pillow."""

from __future__ import annotations

import io
import os
import re
from typing import Any, Final

import numpy as np
import numpy.typing as npt

from cspace.arrays import Array
from cspace.errors import MapError, MissingExtraError
from cspace.maps.files import check_map_path, read_map_bytes
from cspace.tolerances import MAP_CELLS, PNG_PIXELS

PNG_SIGNATURE: Final = b"\x89PNG\r\n\x1a\n"


def read_image(path: str | os.PathLike[str]) -> Array:
    """The grey values of an image, (rows, columns) from 0 (black) to 1 (white), top row first.

    Colours are averaged; fully transparent pixels are NaN. Raises MapError for a file that cannot be read,
    or one of PNG with more than tolerances.PNG_PIXELS pixels, and MissingExtraError for PNG without pillow.
    """
    name, data = check_map_path(path), read_map_bytes(path)
    if data.startswith(PNG_SIGNATURE):
        return _read_png(data, name)
    if data[:2] in (b"P2", b"P5"):
        return _read_pgm(data, name)
    raise MapError("this is neither PGM (P2, P5) nor PNG; save the image as one of them", path=name)


def encode_pgm(grey: npt.NDArray[np.uint8]) -> bytes:
    """A binary PGM file of grey values (rows, columns), top row first."""
    rows, columns = grey.shape
    return b"P5\n%d %d\n255\n" % (columns, rows) + grey.tobytes()


def _check_size(columns: int, rows: int, name: str) -> None:
    if columns < 1 or rows < 1 or columns * rows > MAP_CELLS:
        message = f"the image has {columns} × {rows} pixels; a map has 1 … {MAP_CELLS}"
        raise MapError(message, path=name)


def _read_pgm(data: bytes, name: str) -> Array:
    """The grey values of a PGM file: three numbers, with comments, then numbers as text or as bytes."""
    token = re.compile(rb"(?:\s|#[^\n]*(?:\n|$))*(\d{1,10})")
    numbers, at = [], 2
    for what in ("width", "height", "largest grey"):
        if (found := token.match(data, at)) is None:
            raise MapError(f"byte {at}: expected the {what} as a whole number", path=name)
        numbers.append(int(found.group(1)))
        at = found.end()
    columns, rows, white = numbers
    _check_size(columns, rows, name)
    if not 1 <= white <= 65535:
        raise MapError(f"byte {at}: the largest grey is {white}; it must be 1 … 65535", path=name)
    if data[:2] == b"P2":
        grey = _read_text_pixels(data[at:], rows * columns, at, name)
    else:
        wide = np.dtype(">u2") if white > 255 else np.dtype(np.uint8)
        if (there := len(data) - at - 1) < rows * columns * wide.itemsize:
            message = f"byte {len(data)}: the file ends after {max(there, 0)} bytes of pixels; "
            message += f"{columns} × {rows} of them take {rows * columns * wide.itemsize}"
            raise MapError(message, path=name)
        grey = np.frombuffer(data, wide, rows * columns, at + 1).astype(float)
    if grey.max() > white:
        raise MapError(f"a pixel is {grey.max():g}; the largest grey is {white}", path=name)
    return grey.reshape(rows, columns) / white


def _read_text_pixels(text: bytes, count: int, at: int, name: str) -> Array:
    words = re.sub(rb"#[^\n]*", b"", text).split()
    if len(words) != count:
        raise MapError(f"byte {at}: {len(words)} pixels follow, expected {count} from the size", path=name)
    bad = next((word for word in words if not (word.isdigit() and len(word) <= 5)), None)
    if bad is not None:
        raise MapError(f"a pixel is {ascii(bad[:20])[1:]}; pixels must be whole numbers", path=name)
    return np.array([int(word) for word in words], float)


def _read_png(data: bytes, name: str) -> Array:
    """The grey values of a PNG file; pillow keeps 16 bits per pixel of grey, and 8 per channel of colours."""
    try:
        from PIL.PngImagePlugin import PngImageFile
    except ImportError:
        raise MissingExtraError("plot", f"reading {name!r}, a PNG image,") from None
    try:
        with PngImageFile(io.BytesIO(data)) as image:
            _check_size(*image.size, name)
            if (pixels := image.size[0] * image.size[1]) > PNG_PIXELS:
                size = f"{image.size[0]} × {image.size[1]} = {pixels} pixels"
                remedy = f"at most {PNG_PIXELS} are decompressed: make the image smaller, or save it as PGM"
                raise MapError(f"the PNG image has {size}; {remedy}", path=name)
            return _average_colours(image)
    except MapError:
        raise
    except Exception as error:  # damaged files raise OSError, SyntaxError, ValueError, struct.error …
        raise MapError(f"the PNG file cannot be read: {error}", path=name) from None


def _average_colours(image: Any) -> Array:
    """The mean of the colours of each pixel, 0 … 1; NaN where it is transparent."""
    if image.mode.startswith("I"):
        deep = np.asarray(image, dtype=float)
        clear = deep == image.info.get("transparency", -1)
        return np.where(clear, np.nan, deep / 65535)
    if image.mode in ("1", "L") and "transparency" not in image.info:
        return np.asarray(image.convert("L"), dtype=float) / 255
    colours = np.asarray(image.convert("RGBA"))
    total = np.add(colours[:, :, 0], colours[:, :, 1], dtype=np.uint16)
    total += colours[:, :, 2]
    grey: Array = total / 3
    grey /= 255
    grey[colours[:, :, 3] == 0] = np.nan
    return grey
