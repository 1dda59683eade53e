"""Grey images as maps use them: PGM (Netpbm) and PNG (W3C, Portable Network Graphics, 2003), without more
than zlib."""

from __future__ import annotations

import os
import re
import struct
import zlib
from collections.abc import Iterator
from typing import Final, NamedTuple

import numpy as np
import numpy.typing as npt

from cspace import _core
from cspace.arrays import Array
from cspace.errors import MapError
from cspace.maps.files import map_bytes, map_path
from cspace.tolerances import MAP_CELLS

__all__ = ["pgm_of", "read_image"]

PNG_SIGNATURE: Final = b"\x89PNG\r\n\x1a\n"
CHANNELS: Final = {0: 1, 2: 3, 3: 1, 4: 2, 6: 4}
"""Numbers per pixel of each colour type: grey, colour, palette, grey with alpha, colour with alpha."""
DEPTHS: Final = {0: (1, 2, 4, 8, 16), 2: (8, 16), 3: (1, 2, 4, 8), 4: (8, 16), 6: (8, 16)}


def read_image(path: str | os.PathLike[str]) -> Array:
    """The grey of an image, (rows, columns) from 0 (black) to 1 (white), its top row first.

    Colours are averaged; pixels that are wholly transparent are NaN. MapError names the byte at fault.
    """
    name, data = map_path(path), map_bytes(path)
    if data.startswith(PNG_SIGNATURE):
        return _png(data, name)
    if data[:2] in (b"P2", b"P5"):
        return _pgm(data, name)
    raise MapError("this is neither PGM (P2, P5) nor PNG; save the image as one of them", path=name)


def pgm_of(grey: npt.NDArray[np.uint8]) -> bytes:
    """A binary PGM file of grey values (rows, columns), top row first."""
    rows, columns = grey.shape
    return b"P5\n%d %d\n255\n" % (columns, rows) + grey.tobytes()


def _check_size(columns: int, rows: int, name: str) -> None:
    if columns < 1 or rows < 1 or columns * rows > MAP_CELLS:
        message = f"the image has {columns} × {rows} pixels; a map has 1 … {MAP_CELLS}"
        raise MapError(message, path=name)


def _pgm(data: bytes, name: str) -> Array:
    """The grey of a PGM file: header of three numbers, with comments, then numbers as text or as bytes."""
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
        grey = _text_pixels(data[at:], rows * columns, at, name)
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


def _text_pixels(text: bytes, count: int, at: int, name: str) -> Array:
    words = re.sub(rb"#[^\n]*", b"", text).split()
    if len(words) != count:
        raise MapError(f"byte {at}: {len(words)} pixels follow; the size says {count}", path=name)
    if not all(word.isdigit() and len(word) <= 5 for word in words):
        bad = next(word for word in words if not (word.isdigit() and len(word) <= 5))
        raise MapError(f"a pixel is {ascii(bad[:20])[1:]}; pixels are whole numbers", path=name)
    return np.array([int(word) for word in words], float)


class _Header(NamedTuple):
    columns: int
    rows: int
    depth: int
    colour: int


def _png(data: bytes, name: str) -> Array:
    header: _Header | None = None
    palette, transparent, packed = b"", b"", []
    for kind, body, at in _chunks(data, name):
        if header is None:
            header = _png_header(kind, body, name)
        elif kind == b"PLTE":
            palette = body
        elif kind == b"tRNS":
            transparent = body
        elif kind == b"IDAT":
            packed.append(body)
        elif not kind[0] & 32:
            raise MapError(
                f"byte {at}: an unknown chunk {ascii(kind)[1:]} that may not be ignored", path=name
            )
    if header is None or not packed:
        raise MapError("the PNG file holds no image", path=name)
    pixels = _unpacked(header, b"".join(packed), name)
    return _grey(header, pixels, palette, transparent, name)


def _chunks(data: bytes, name: str) -> Iterator[tuple[bytes, bytes, int]]:
    """Kind, body and place of every chunk up to IEND, their checksums checked."""
    at = len(PNG_SIGNATURE)
    while True:
        if at + 12 > len(data):
            raise MapError(f"byte {len(data)}: the PNG file ends before its last chunk", path=name)
        size, kind = struct.unpack_from(">I4s", data, at)
        if at + 12 + size > len(data):
            raise MapError(f"byte {at}: a chunk of {size} bytes goes beyond the end of the file", path=name)
        body = data[at + 8 : at + 8 + size]
        if zlib.crc32(data[at + 4 : at + 8 + size]) != int.from_bytes(
            data[at + 8 + size : at + 12 + size], "big"
        ):
            message = f"byte {at}: the checksum of chunk {ascii(kind)[1:]} does not fit; the file is damaged"
            raise MapError(message, path=name)
        if kind == b"IEND":
            return
        yield kind, body, at
        at += 12 + size


def _png_header(kind: bytes, body: bytes, name: str) -> _Header:
    if kind != b"IHDR" or len(body) != 13:
        raise MapError("byte 8: a PNG file begins with an IHDR chunk of 13 bytes", path=name)
    columns, rows, depth, colour, method, filters, interlaced = struct.unpack(">IIBBBBB", body)
    _check_size(columns, rows, name)
    if depth not in DEPTHS.get(colour, ()) or method or filters:
        message = f"byte 16: depth {depth}, colour type {colour}, methods {method} and {filters} are no PNG"
        raise MapError(message, path=name)
    if interlaced:
        raise MapError("byte 28: an interlaced PNG; save it without interlacing", path=name)
    return _Header(columns, rows, depth, colour)


def _unpacked(header: _Header, packed: bytes, name: str) -> npt.NDArray[np.uint16]:
    """The numbers of the pixels, (rows, columns, channels)."""
    channels = CHANNELS[header.colour]
    width = (header.columns * channels * header.depth + 7) // 8
    expected = header.rows * (width + 1)
    unpacker = zlib.decompressobj()
    try:
        raw = unpacker.decompress(packed, expected)
    except zlib.error as error:
        raise MapError(f"the pixels cannot be unpacked: {error}", path=name) from None
    if len(raw) < expected:
        raise MapError(f"{len(raw)} bytes of pixels; the size says {expected}", path=name)
    lines = np.frombuffer(raw, np.uint8).reshape(header.rows, width + 1)
    pixels = np.empty((header.rows, width), np.uint8)
    step = max(channels * header.depth // 8, 1)
    if (row := _core._png_unfilter(lines, step, pixels)) >= 0:
        raise MapError(f"row {row} has the filter {lines[row, 0]}; filters are 0 … 4", path=name)
    if header.depth == 16:
        numbers = pixels.view(">u2").astype(np.uint16)
    elif header.depth == 8:
        numbers = pixels.astype(np.uint16)
    else:
        bits = np.unpackbits(pixels, axis=1)[:, : header.columns * header.depth]
        weights = 1 << np.arange(header.depth - 1, -1, -1, dtype=np.uint16)
        numbers = bits.reshape(header.rows, -1, header.depth) @ weights
    return numbers.reshape(header.rows, header.columns, channels)


def _grey(
    header: _Header, pixels: npt.NDArray[np.uint16], palette: bytes, transparent: bytes, name: str
) -> Array:
    """The mean of the colours of each pixel, 0 … 1; NaN where it is transparent."""
    white = (1 << header.depth) - 1
    if header.colour == 3:
        colours = np.frombuffer(palette, np.uint8)
        if not palette or len(palette) % 3 or int(pixels.max()) * 3 >= len(palette):
            raise MapError(f"a pixel asks for colour {pixels.max()} of {len(palette) // 3}", path=name)
        grey = colours.reshape(-1, 3).mean(axis=1) / 255
        clear = np.frombuffer(transparent, np.uint8)[: len(grey)] == 0
        grey[: len(clear)][clear] = np.nan
        found: Array = grey[pixels[:, :, 0]]
        return found
    of_colour = 1 if header.colour in (0, 4) else 3
    mean: Array = pixels[:, :, :of_colour].mean(axis=2) / white
    if header.colour in (4, 6):
        mean[pixels[:, :, -1] == 0] = np.nan
    elif len(transparent) == 2 * of_colour:
        mean[(pixels == np.frombuffer(transparent, ">u2")).all(axis=2)] = np.nan
    return mean
