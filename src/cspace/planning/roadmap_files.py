"""Files of roadmaps: a line of words, a line of JSON, then the nodes and the edges as numbers.

The first line is `cspace roadmap 1`. The second is a JSON object with the robot's name and fingerprint, dof,
samples, neighbours (0: as PRM* needs), margin [m], seed, nodes, edges, and the SHA-256 of all else. Then
follow the nodes (n, dof) as little-endian floats of 32 bits and the edges (e, 2) as integers of 32 bits, the
larger node first, in ascending order.
"""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from typing import Any, Final

import numpy as np
import numpy.typing as npt

from cspace.arrays import Array
from cspace.errors import RoadmapError
from cspace.files import path_of, read_regular, whole_file

TITLE: Final = b"cspace roadmap 1\n"
"""The first line; another version has another number."""

MOST_SAMPLES: Final = 1 << 18
"""Samples of a roadmap at most: to find the nearest of so many takes a minute."""

MOST_BYTES: Final = 1 << 33
"""The largest file that is read."""

FIELDS: Final = {
    "robot": str,
    "fingerprint": str,
    "dof": int,
    "samples": int,
    "neighbours": int,
    "margin": float,
    "seed": int,
    "nodes": int,
    "edges": int,
    "sha256": str,
}
"""What the second line holds."""


def write_roadmap(
    path: str | os.PathLike[str], header: Mapping[str, Any], nodes: Array, edges: npt.NDArray[np.int32]
) -> None:
    """Write nodes (n, dof) and edges (e, 2); the file is complete or untouched."""
    payload = nodes.astype("<f4").tobytes() + edges.astype("<i4").tobytes()
    sizes = {"dof": nodes.shape[1], "nodes": len(nodes), "edges": len(edges)}
    whole = dict(header) | sizes
    line = json.dumps(whole | {"sha256": digest_of(whole, payload)}).encode()
    with whole_file(path) as draft:
        draft.write_bytes(TITLE + line + b"\n" + payload)


def digest_of(header: Mapping[str, Any], payload: bytes) -> str:
    """The SHA-256 of the header without its own, and of the numbers."""
    from hashlib import sha256

    named = {name: header[name] for name in sorted(header) if name != "sha256"}
    return sha256(json.dumps(named).encode() + payload).hexdigest()


def read_roadmap(
    path: str | os.PathLike[str], robot: str, fingerprint: str, dof: int
) -> tuple[dict[str, Any], Array, npt.NDArray[np.int32]]:
    """Header, nodes (n, dof) and edges (e, 2) of a file; RoadmapError if it is not one of this robot."""
    name = path_of(path, "a roadmap is given by the path of its file")
    data = read_regular(name, "roadmap", MOST_BYTES, RoadmapError)
    if not data.startswith(TITLE):
        raise RoadmapError("this is no roadmap of this version; the first line differs", path=name)
    line, _, payload = data[len(TITLE) :].partition(b"\n")
    header = read_header(line, name)
    if header["fingerprint"] != fingerprint:
        differs = f"{dof} joints" if header["dof"] != dof else "other joints, limits or spheres"
        raise RoadmapError(
            f"the roadmap is of {header['robot']} with {header['dof']} joints, and {robot} has {differs};"
            " make one with cs.planning.Roadmap(robot)",
            path=name,
        )
    count, pairs = header["nodes"], header["edges"]
    split = 4 * count * dof
    if header["dof"] != dof or len(payload) != split + 8 * pairs:
        raise RoadmapError(
            f"the file is incomplete: {len(payload)} bytes of numbers instead of {split + 8 * pairs}; save"
            " the roadmap again",
            path=name,
        )
    if digest_of(header, payload) != header["sha256"]:
        raise RoadmapError("the file is damaged: its checksum differs; save the roadmap again", path=name)
    nodes = np.frombuffer(payload[:split], "<f4").astype(np.float64).reshape(count, dof)
    edges = np.frombuffer(payload[split:], "<i4").astype(np.int32).reshape(pairs, 2)
    return header, nodes, edges


def read_header(line: bytes, name: str) -> dict[str, Any]:
    """The fields of the second line; RoadmapError for others."""
    try:
        header: dict[str, Any] = json.loads(line)
    except (ValueError, RecursionError):
        raise RoadmapError(
            "the file is damaged: its second line is no JSON; save the roadmap again", path=name
        ) from None
    is_whole = isinstance(header, dict) and header.keys() == FIELDS.keys()
    if not is_whole or any(type(header[key]) is not kind for key, kind in FIELDS.items()):
        fields = ", ".join(FIELDS)
        raise RoadmapError(
            f"the file is damaged: its second line must hold {fields}; save the roadmap again", path=name
        )
    if min(header[key] for key, kind in FIELDS.items() if kind is not str) < 0:
        raise RoadmapError("the file is damaged: a count is negative; save the roadmap again", path=name)
    return header
