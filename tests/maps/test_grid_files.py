"""Maps from files: MovingAI, ROS, PGM and PNG; and that no damaged file does more than raise a clear
error."""

from __future__ import annotations

import struct
import sys
import zlib

import numpy as np
import pytest

import cspace as cs
from cspace.errors import CspaceError, MapError, MissingExtraError

MAP = "type octile\nheight 2\nwidth 3\nmap\n.G@\nTSW\n"
YAML = """# a map
image: cells.pgm
resolution: 0.05
origin: [-1.5, 2.0, 0.0]
negate: 0
occupied_thresh: 0.65
free_thresh: 0.196
"""


def write(tmp_path, name, content):
    path = tmp_path / name
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    return path


def filtered(line, above, step, kind):
    """A line of bytes as PNG's filter of that number stores it, byte by byte."""
    out = []
    for k, value in enumerate(line):
        a = int(line[k - step]) if k >= step else 0
        b = int(above[k])
        c = int(above[k - step]) if k >= step else 0
        guess = a + b - c
        paeth = min((abs(guess - a), 0, a), (abs(guess - b), 1, b), (abs(guess - c), 2, c))[2]
        out.append((int(value) - (0, a, b, (a + b) // 2, paeth)[kind]) % 256)
    return bytes([kind, *out])


def png(pixels, colour, depth, *, extra=(), kinds=None):
    """A PNG file of packed lines (rows, bytes); kinds: the filter of each row."""
    rows, columns, packed = pixels
    channels = {0: 1, 2: 3, 3: 1, 4: 2, 6: 4}[colour]
    step = max(channels * depth // 8, 1)
    above, body = np.zeros(packed.shape[1], np.uint8), b""
    for row, line in enumerate(packed):
        body += filtered(line, above, step, 0 if kinds is None else kinds[row])
        above = line
    chunks = [(b"IHDR", struct.pack(">IIBBBBB", columns, rows, depth, colour, 0, 0, 0)), *extra]
    chunks += [(b"IDAT", part) for part in halves(zlib.compress(body))] + [(b"IEND", b"")]
    return b"\x89PNG\r\n\x1a\n" + b"".join(
        struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
        for kind, data in chunks
    )


def halves(data):
    return [data[: len(data) // 2], data[len(data) // 2 :]]


def packed(numbers, depth):
    """Rows of numbers (rows, columns, channels) as the bytes of PNG's lines."""
    rows = numbers.reshape(len(numbers), -1)
    if depth == 16:
        return rows.astype(">u2").view(np.uint8)
    if depth == 8:
        return rows.astype(np.uint8)
    bits = (rows[:, :, None] >> np.arange(depth - 1, -1, -1)) & 1
    return np.packbits(bits.reshape(len(rows), -1).astype(np.uint8), axis=1)


def grey_png(tmp_path, numbers, colour, depth, **more):
    rows, columns, _ = numbers.shape
    return write(tmp_path, "a.png", png((rows, columns, packed(numbers, depth)), colour, depth, **more))


def test_movingai_maps_begin_with_row_0(tmp_path):
    grid = cs.OccupancyGrid.from_movingai(write(tmp_path, "a.map", MAP), 2.0, (1, 1))
    assert np.array_equal(grid.blocked, [[0, 0, 1], [1, 0, 1]])
    assert grid.bounds == (1, 1, 7, 5)
    windows = cs.OccupancyGrid.from_movingai(write(tmp_path, "b.map", MAP.replace("\n", "\r\n")))
    assert np.array_equal(windows.blocked, grid.blocked)


@pytest.mark.parametrize(
    ("text", "line", "message"),
    [
        ("", 1, "the first line of a MovingAI map must be 'type octile'"),
        (MAP.replace("octile", "tile"), 1, "the first line"),
        (MAP.replace("height 2", "height two"), 2, "'height', 'width' and a whole number"),
        (MAP.replace("height 2", "height 0"), 2, "the number of cells of a side must be 1"),
        (MAP.replace("width 3", "width 99999999999"), 3, "the number of cells of a side must be 1"),
        (MAP.replace("width 3\n", ""), 3, "come before the cells"),
        (MAP.replace(".G@", ".G"), 5, "this row has 2 cells; the width is 3"),
        (MAP.replace("TSW\n", ""), 6, "1 rows of cells; the height is 2"),
        (MAP + "...\n", 7, "3 rows of cells; the height is 2"),
        (MAP.replace("S", "x"), 6, "cell 1 is 'x'; cells are"),
    ],
)
def test_movingai_maps_that_cannot_be_read(tmp_path, text, line, message):
    path = write(tmp_path, "a.map", text)
    with pytest.raises(MapError, match=message) as caught:
        cs.OccupancyGrid.from_movingai(path)
    assert caught.value.line == line
    assert str(caught.value).startswith(f"{path}:{line}: ")


def test_scenarios(tmp_path):
    text = "version 1\n0\tmaps/my map.map\t49\t49\t1\t11\t1\t12\t1\n3 a.map 49 49 0 1 2 3 3.41421\n"
    lines = cs.maps.read_scenarios(write(tmp_path, "a.scen", text))
    assert np.array_equal(lines.start, [(1, 11), (0, 1)])
    assert np.array_equal(lines.goal, [(1, 12), (2, 3)])
    assert np.array_equal(lines.length, [1, 3.41421])
    grid = cs.OccupancyGrid(np.zeros((20, 8), bool), resolution=0.5, origin=(1, 2))
    assert np.array_equal(lines.ends(1, grid), [(1.25, 2.75), (2.25, 3.75)])
    with pytest.raises(ValueError, match="line is 2; the file has 2 lines, numbered from 0"):
        lines.ends(2, grid)
    with pytest.raises(ValueError, match="line 0 has cells outside this grid of 9 × 8"):
        lines.ends(0, cs.OccupancyGrid(np.zeros((9, 8), bool)))
    with pytest.raises(MapError, match=":2: expected bucket, map, width"):
        cs.maps.read_scenarios(write(tmp_path, "b.scen", "version 1\n0 a.map 1 1 0 0 0\n"))
    with pytest.raises(MapError, match="start and goal, length"):
        cs.maps.read_scenarios(write(tmp_path, "b.scen", "version 1\n0 a.map 2 2 0 0 1 1\n"))
    with pytest.raises(MapError, match="version 1"):
        cs.maps.read_scenarios(write(tmp_path, "b.scen", "version x\n"))
    with pytest.raises(MapError, match="the first line of a scenario file must be 'version 1'"):
        cs.maps.read_scenarios(write(tmp_path, "c.scen", ""))


def test_a_ros_map_has_its_lowest_pixels_in_row_0(tmp_path):
    write(tmp_path, "cells.pgm", b"P5\n# by hand\n3 2\n255\n" + bytes([0, 254, 205, 254, 254, 0]))
    grid = cs.OccupancyGrid.from_ros(write(tmp_path, "a.yaml", YAML))
    assert np.array_equal(grid.blocked, [[0, 0, 1], [1, 0, 1]])
    assert (grid.resolution, grid.bounds[:2]) == (0.05, (-1.5, 2.0))
    free = cs.OccupancyGrid.from_ros(tmp_path / "a.yaml", unknown="free")
    assert np.array_equal(free.blocked, [[0, 0, 1], [1, 0, 0]])
    negated = cs.OccupancyGrid.from_ros(write(tmp_path, "b.yaml", YAML.replace("negate: 0", "negate: 1")))
    assert np.array_equal(negated.blocked, [[1, 1, 0], [0, 1, 1]])


def test_the_yaml_that_map_files_have(tmp_path):
    write(tmp_path, "it's #1.pgm", b"P2 1 1 255 0")
    text = "---\nimage: 'it''s #1.pgm'  # an image\nmode: trinary\nresolution: 5e-2\n"
    text += "origin:\n  - 1\n  - -2.5\n  - 0\n"
    text += "negate: false\noccupied_thresh: .65\nfree_thresh: 0.25\nextra:\n  nested: 1\n"
    grid = cs.OccupancyGrid.from_ros(write(tmp_path, "a.yaml", text))
    assert grid.bounds == (1, -2.5, 1.05, -2.45)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("image: cells.pgm\n", "", "the field 'image:' is missing"),
        ("cells.pgm", "none.pgm", "no such file"),
        ("resolution: 0.05", "resolution: 0", ":3: resolution must be positive"),
        ("resolution: 0.05", "resolution: five", ":3: resolution must be a finite number"),
        ("0.0]", "0.3]", ":4: the map is turned by 0.3 rad; turn the image"),
        ("[-1.5, 2.0, 0.0]", "[-1.5]", r":4: origin must be a list \[x, y, yaw\]"),
        ("[-1.5, 2.0, 0.0]", "[-1.5, 2.0", ":4: a list in brackets must end in the line"),
        ("[-1.5, 2.0, 0.0]", "[-1.5, y, 0]", ":4: origin must contain finite numbers"),
        ("negate: 0", "negate: 2", ":5: negate must be 0 or 1"),
        ("free_thresh: 0.196", "free_thresh: 0.9", ":6: free_thresh 0.9 and occupied_thresh 0.65 must be"),
        ("negate: 0", "mode: scale\nnegate: 0", "mode 'scale' has partly free cells"),
        ("negate: 0", "negate 0", ":5: expected 'field: value'"),
        ("negate: 0", "image: b.pgm", ":5: the field 'image:' appears for the second time"),
    ],
)
def test_ros_maps_that_cannot_be_read(tmp_path, old, new, message):
    write(tmp_path, "cells.pgm", b"P5 1 1 255\n\0")
    with pytest.raises(MapError, match=message):
        cs.OccupancyGrid.from_ros(write(tmp_path, "a.yaml", YAML.replace(old, new)))


def test_what_is_written_is_read_again(tmp_path):
    rng = np.random.default_rng(1)
    for name in ("a.yaml", "a b: #'c.yml"):
        grid = cs.OccupancyGrid(rng.random((7, 5)) < 0.4, 0.1, (0.1 + 0.2, -1e-3))
        grid.save_ros(tmp_path / name)
        again = cs.OccupancyGrid.from_ros(tmp_path / name)
        assert np.array_equal(again.blocked, grid.blocked)
        assert again.bounds == grid.bounds
    with pytest.raises(ValueError, match=r"the name of a ROS map must end in \.yaml"):
        grid.save_ros(tmp_path / "a.png")


@pytest.mark.parametrize("white", [1, 100, 255, 256, 65535])
@pytest.mark.parametrize("kind", [b"P2", b"P5"])
def test_pgm(tmp_path, white, kind):
    from cspace.maps.images import read_image

    grey = np.random.default_rng(white).integers(0, white + 1, (6, 9))
    if kind == b"P2":
        body = b"# text\n" + "\n".join(" ".join(map(str, row)) for row in grey).encode()
    else:
        body = grey.astype(">u2" if white > 255 else np.uint8).tobytes()
    path = write(tmp_path, "a.pgm", b"%s #x\n# y\n9\t6 %d\n" % (kind, white) + body)
    assert np.allclose(read_image(path), grey / white, rtol=0, atol=1e-15)


@pytest.mark.parametrize(
    ("data", "message"),
    [
        (b"", "neither PGM"),
        (b"P6 1 1 255\n\0\0\0", "neither PGM"),
        (b"P5 1", "byte 4: expected the height"),
        (b"P5 0 1 255\n", "the image has 0 × 1 pixels"),
        (b"P5 99999999 99999999 255\n", "pixels; a map has"),
        (b"P5 2 2 0\n1234", "the largest grey is 0"),
        (b"P5 2 2 255\n123", "byte 14: the file ends after 3 bytes of pixels; 2 × 2 of them take 4"),
        (b"P5 2 2 70000\n123", "the largest grey is 70000"),
        (b"P5 1 1 9\n\x10", "a pixel is 16; the largest grey is 9"),
        (b"P2 2 2 9 1 2 3", "3 pixels follow, expected 4"),
        (b"P2 1 1 9 x", "a pixel is 'x'; pixels must be whole numbers"),
    ],
)
def test_pgm_that_cannot_be_read(tmp_path, data, message):
    with pytest.raises(MapError, match=message):
        cs.OccupancyGrid.from_image(write(tmp_path, "a.pgm", data))


@pytest.mark.parametrize(
    ("colour", "depth"),
    [*((0, d) for d in (1, 2, 4, 8, 16)), (2, 8), (2, 16), (4, 8), (4, 16), (6, 8), (6, 16)],
)
def test_png(tmp_path, colour, depth):
    from cspace.maps.images import read_image

    channels = {0: 1, 2: 3, 4: 2, 6: 4}[colour]
    rng = np.random.default_rng(10 * colour + depth)
    numbers = rng.integers(0, 1 << depth, (10, 13, channels))
    numbers[3, 4, -1] = 0
    path = grey_png(tmp_path, numbers, colour, depth, kinds=np.arange(10) % 5)
    grey = read_image(path)
    truth = numbers[:, :, : 1 if colour in (0, 4) else 3].mean(axis=2) / ((1 << depth) - 1)
    if colour in (4, 6):
        truth[numbers[:, :, -1] >> max(depth - 8, 0) == 0] = np.nan
    lost = 1 / 255 if depth == 16 and colour else 1e-12  # pillow keeps 8 bits of a channel of colours
    assert np.allclose(grey, truth, rtol=0, atol=lost, equal_nan=True)


@pytest.mark.parametrize(("depth", "colour"), [(1, 0), (8, 0), (16, 0), (8, 2)])
def test_a_colour_of_a_png_may_be_transparent(tmp_path, depth, colour):
    from cspace.maps.images import read_image

    numbers = np.random.default_rng(depth).integers(0, 1 << depth, (6, 7, 3 if colour else 1))
    clear = numbers[2, 3]
    extra = [(b"tRNS", clear.astype(">u2").tobytes())]
    grey = read_image(grey_png(tmp_path, numbers, colour, depth, extra=extra))
    assert np.array_equal(np.isnan(grey), (numbers == clear).all(axis=2))


@pytest.mark.parametrize("depth", [1, 2, 4, 8])
def test_png_with_a_palette(tmp_path, depth):
    from cspace.maps.images import read_image

    rng = np.random.default_rng(depth)
    palette = rng.integers(0, 256, (1 << depth, 3)).astype(np.uint8)
    numbers = rng.integers(0, 1 << depth, (5, 11, 1))
    extra = [(b"PLTE", palette.tobytes()), (b"tRNS", b"\xff\0")]
    grey = read_image(grey_png(tmp_path, numbers, 3, depth, extra=extra))
    truth = palette.mean(axis=1)[numbers[:, :, 0]] / 255
    truth[numbers[:, :, 0] == 1] = np.nan
    assert np.allclose(grey, truth, rtol=0, atol=1e-12, equal_nan=True)


def test_images_are_dark_where_blocked(tmp_path):
    numbers = np.array([[0, 255], [100, 200]])[:, :, None]
    grid = cs.OccupancyGrid.from_image(grey_png(tmp_path, numbers, 0, 8), 0.5)
    assert np.array_equal(grid.blocked, [[1, 0], [1, 0]])
    lighter = cs.OccupancyGrid.from_image(tmp_path / "a.png", blocked_below=0.9)
    assert np.array_equal(lighter.blocked, [[1, 1], [1, 0]])


@pytest.mark.parametrize(("rows", "columns"), [(1 << 14, (1 << 13) + 1), (1 << 28, 1), (1, 1 << 30)])
@pytest.mark.parametrize(("colour", "depth"), [(0, 1), (0, 8), (2, 8), (6, 16)])
def test_the_pixels_of_a_png_are_counted_before_they_are_decompressed(tmp_path, rows, columns, colour, depth):
    from cspace.maps.images import read_image

    path = write(tmp_path, "a.png", png((rows, columns, np.zeros((1, 1), np.uint8)), colour, depth))
    with pytest.raises(MapError, match=f"{rows * columns} pixels; at most 134217728"):
        read_image(path)


def test_png_that_cannot_be_read(tmp_path):
    good = png((1, 2, packed(np.array([[[1], [2]]]), 8)), 0, 8)
    for data in (good[:20], good[:45], good[:30] + b"x" + good[31:], good.replace(b"IDAT", b"IDAX")):
        with pytest.raises(MapError, match=r"a\.png: the PNG file cannot be read: \S"):
            cs.OccupancyGrid.from_image(write(tmp_path, "a.png", data))
    huge = write(tmp_path, "a.png", png((2**31 - 1, 2**31 - 1, np.zeros((1, 1), np.uint8)), 0, 8))
    with pytest.raises(MapError, match="2147483647 × 2147483647 pixels; a map has"):
        cs.OccupancyGrid.from_image(huge)


def test_png_without_pillow_names_the_extra(tmp_path, monkeypatch):
    path = grey_png(tmp_path, np.array([[[0], [255]]]), 0, 8)
    monkeypatch.setitem(sys.modules, "PIL.PngImagePlugin", None)
    with pytest.raises(MissingExtraError, match=r"a\.png', a PNG image, needs .*'cspace\[plot\]'"):
        cs.OccupancyGrid.from_image(path)


def test_damaged_files_raise_clear_errors_and_no_others(tmp_path):
    rng = np.random.default_rng(5)
    numbers = rng.integers(0, 256, (6, 7, 1))
    write(tmp_path, "cells.pgm", b"P5 1 1 255\n\0")
    wholes = [
        ("a.map", MAP.encode(), cs.OccupancyGrid.from_movingai),
        ("a.scen", b"version 1\n0 a.map 49 49 1 11 1 12 1\n", cs.maps.read_scenarios),
        ("a.yaml", YAML.encode(), cs.OccupancyGrid.from_ros),
        ("a.pgm", b"P5\n3 2\n255\n\0\1\2\3\4\5", cs.OccupancyGrid.from_image),
        ("b.pgm", b"P2\n3 2\n255\n0 1 2 3 4 5\n", cs.OccupancyGrid.from_image),
        (
            "a.png",
            png((6, 7, packed(numbers, 8)), 0, 8, kinds=(0, 1, 2, 3, 4, 3)),
            cs.OccupancyGrid.from_image,
        ),
    ]
    messages = []
    for name, whole, read in wholes:
        for _ in range(300):
            data = bytearray(whole)
            for _ in range(rng.integers(1, 4)):
                at = int(rng.integers(len(data)))
                match rng.integers(4):
                    case 0:
                        data[at] = int(rng.integers(256))
                    case 1:
                        del data[at : at + int(rng.integers(1, 9))]
                    case 2:
                        data[at:at] = bytes(rng.integers(0, 256, 3).astype(np.uint8))
                    case 3:
                        data[at:at] = data[at : at + 6]
                data = data or bytearray(b"x")
            try:
                read(write(tmp_path, name, bytes(data)))
            except CspaceError as error:
                messages.append((name, str(error)))
    assert len(messages) > 300
    assert all(message.startswith(str(tmp_path)) for _, message in messages)


def test_folders_and_missing_files(tmp_path):
    with pytest.raises(MapError, match="this is a folder"):
        cs.OccupancyGrid.from_movingai(tmp_path)
    with pytest.raises(MapError, match="no such file"):
        cs.OccupancyGrid.from_ros(tmp_path / "a.yaml")
    with pytest.raises(TypeError, match="a map file is given by its path, got int"):
        cs.OccupancyGrid.from_image(3)
    with pytest.raises(KeyError, match="did you mean 'blocked'"):
        cs.OccupancyGrid.from_ros(tmp_path / "a.yaml", unknown="block")
