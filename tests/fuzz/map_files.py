"""Damages map files for as long as you like: python tests/fuzz/map_files.py [seconds] [seed].

Prints the bytes that got through to anything but a CspaceError, or took longer than two seconds.
"""

import random
import struct
import sys
import tempfile
import time
import zlib
from pathlib import Path

import cspace as cs
from cspace.errors import CspaceError

GEOJSON = (
    b'{"type": "FeatureCollection", "bbox": [0, 0, 10, 10], "features": [{"type": "Feature", "geometry": '
    b'{"type": "Polygon", "coordinates": [[[4, 4], [6, 4], [6, 6], [4, 6], [4, 4]]]}}, {"type": "Feature", '
    b'"geometry": {"type": "MultiPolygon", "coordinates": [[[[1, 1], [2, 1], [2, 2]]]]}}]}'
)
TEXT = b"# a yard\nbounds 0 0 10 10\n2 2\n8 2\n8, 8\n2 8\n\nhole\n4 4\n6 4\n6 6\n\n0 0\n1 0\n0 1\n"
PGM = b"P5\n# grey\n4 3\n255\n" + bytes(range(0, 240, 20))
ROS = (
    b"image: m.pgm\nresolution: 0.05\norigin: [0.0, -1, 0]\nnegate: 0\noccupied_thresh: 0.65\n"
    b"free_thresh: 0.196\nmode: trinary\n"
)
READERS = {
    "geojson": (lambda path: cs.PolygonWorld.from_geojson(path, repair=True), [GEOJSON]),
    "txt": (lambda path: cs.PolygonWorld.from_text(path, repair=True), [TEXT]),
    "pgm": (cs.OccupancyGrid.from_image, [PGM, b"P2\n3 2\n9\n0 1 2 3 4 9\n"]),
    "map": (cs.OccupancyGrid.from_movingai, [b"type octile\nheight 2\nwidth 3\nmap\n.@.\nT..\n"]),
    "scen": (cs.maps.read_scenarios, [b"version 1\n0\ta.map\t3\t2\t0\t0\t2\t1\t2.4\n"]),
    "yaml": (cs.OccupancyGrid.from_ros, [ROS]),
    "png": (cs.OccupancyGrid.from_image, []),
}
WORDS = b"nan inf 1e999 -1 0 99999999999 null [ { ] 1e308 1e-320 true .. hole bounds - 4294967295 1_0".split()
WORDS += [b"\x00", b"\xff\xfe", b"\n", b" ", b"\xd9\xa3"]
PNGS = ((1, 0), (4, 0), (8, 0), (16, 0), (8, 2), (1, 3), (4, 3), (8, 4), (16, 4), (8, 6))


def chunk(kind, body):
    return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))


def png(draw):
    depth, colour = draw.choice(PNGS)
    width = (7 * {0: 1, 2: 3, 3: 1, 4: 2, 6: 4}[colour] * depth + 7) // 8
    lines = b"".join(bytes([draw.randrange(5)]) + draw.randbytes(width) for _ in range(5))
    header = (
        damaged(draw, struct.pack(">IIBBBBB", 7, 5, depth, colour, 0, 0, 0)) if draw.random() < 0.1 else None
    )
    header = header or struct.pack(">IIBBBBB", 7, 5, depth, colour, 0, 0, 0)
    body = zlib.compress(damaged(draw, lines) if draw.random() < 0.3 else lines)
    parts = [
        chunk(b"IHDR", header),
        chunk(b"PLTE", bytes(range(48))),
        chunk(b"IDAT", body),
        chunk(b"IEND", b""),
    ]
    return b"\x89PNG\r\n\x1a\n" + b"".join(parts)


def damaged(draw, data):
    made = bytearray(data)
    for _ in range(draw.choice([1, 1, 2, 3, 8])):
        i = draw.randrange(len(made) + 1)
        j = min(len(made), i + draw.randrange(1, 12))
        change = draw.randrange(6)
        if change == 0 and i < len(made):
            made[i] = draw.randrange(256)
        elif change == 1:
            del made[i:j]
        elif change == 2:
            made[i:i] = draw.choice(WORDS)
        elif change == 3:
            made[i:j] = draw.choice(WORDS)
        elif change == 4:
            made[i:i] = made[i:j] * draw.choice([1, 2, 50])
        else:
            del made[i:]
    return bytes(made)


def main():
    seconds = float(sys.argv[1]) if len(sys.argv) > 1 else 60.0
    seed = int(sys.argv[2]) if len(sys.argv) > 2 else int(time.time())
    draw = random.Random(seed)
    end = time.monotonic() + seconds
    tried = accepted = faults = 0
    with tempfile.TemporaryDirectory() as folder:
        (Path(folder) / "m.pgm").write_bytes(PGM)
        while time.monotonic() < end:
            kind = draw.choice(list(READERS))
            read, seeds = READERS[kind]
            data = damaged(draw, draw.choice(seeds)) if seeds else png(draw)
            path = Path(folder) / f"x.{kind}"
            path.write_bytes(data)
            start = time.perf_counter()
            try:
                read(path)
                accepted += 1
            except CspaceError:
                pass
            except Exception as error:
                faults += 1
                print(f"{kind}: {type(error).__name__}: {error}\n{data!r}\n")
            if (took := time.perf_counter() - start) > 2:
                faults += 1
                print(f"{kind}: {took:.1f} s\n{data!r}\n")
            tried += 1
    print(f"seed {seed}: {tried} files, {accepted} readable, {faults} faults")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
