"""A group of solids as an eye sees it: colour, coverage and depth per pixel.

One ray goes through the middle of each pixel; where what it meets differs from what a neighbour meets, eight
more are cast, so that every outline is smooth and the inside of a body costs one ray per pixel.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Final, NamedTuple

import numpy as np

from cspace.arrays import Array
from cspace.plot.raytrace.solids import Body, Piece, bounding_pieces
from cspace.plot.raytrace.view import Block, View, pixel_centers

SAMPLES: Final = (np.array([[1, 3, 5, 7, 9, 11, 13, 15], [5, 13, 1, 9, 15, 3, 11, 7]]) / 16.0)[:, :, None]
"""Where the rays of an outline pixel go through it: eight rooks that do not attack each other, (2, 8, 1)."""


@dataclass
class Layer:
    """What is seen, pixel by pixel: m pixels that show something.

    pixels: (m,), the numbers of the pixels, row by row. color: (m, 3), times the coverage. coverage: (m,),
    the share of the pixel. depth: (m,) [m]. rim: (m,), whether a pixel of the outline. owner: (m,), the
    number of the body that is nearest.
    """

    pixels: Any
    color: Any
    coverage: Any
    depth: Array
    rim: Any
    owner: Any


class Hits(NamedTuple):
    """What rays met: their places x, y, the distance t and the number of the piece, arrays of one shape."""

    x: Any
    y: Any
    t: Any
    key: Any


def see_solids(view: View, solids: Sequence[Body]) -> Layer | None:
    """Solids as seen and lit, or None if none is in the picture."""
    owned = [(i, solid, piece) for i, solid in enumerate(solids) for piece in bounding_pieces(solid)]
    surfaces, tints = [piece for _, _, piece in owned], [solid.color for _, solid, _ in owned]
    # Pieces of one number meet without a crease.
    smooth = [i if solid.round else len(solids) + k for k, (i, solid, _) in enumerate(owned)]
    spans = [span_pixels(view, piece) for piece in surfaces]
    seen = [each for each in spans if each is not None]
    if not seen:
        return None
    (x0, _, y0, _), (_, x1, _, y1) = np.min(seen, axis=0).tolist(), np.max(seen, axis=0).tolist()
    depth, keys = look_through_middles(view, surfaces, spans, (x0, x1, y0, y1))
    rim, at_edge = find_outlines(np.array([*smooth, -1], np.int32)[keys])
    rows, columns = np.nonzero(at_edge)
    samples = look_around(view, surfaces, spans, columns + x0, rows + y0)
    inside = np.nonzero((keys >= 0) & ~at_edge)
    hit = samples.key >= 0
    clear = Hits(inside[1] + x0 + 0.5, inside[0] + y0 + 0.5, depth[inside], keys[inside])
    both = Hits(*(np.concatenate([one, many[hit]]) for one, many in zip(clear, samples, strict=True)))
    shades = shade_hits(view, surfaces, np.array(tints, np.float32), both)
    spread = np.zeros((*hit.shape, 3), np.float32)
    spread[hit] = shades[len(clear.t) :]
    some = hit.any(axis=0)
    rows, columns = np.concatenate([inside[0], rows[some]]), np.concatenate([inside[1], columns[some]])
    return Layer(
        (rows + y0) * view.width + columns + x0,
        np.concatenate([shades[: len(clear.t)], spread.mean(axis=0)[some]]),
        np.concatenate([np.ones(len(clear.t), np.float32), hit.mean(axis=0, dtype=np.float32)[some]]),
        np.concatenate([clear.t, samples.t.min(axis=0)[some]]),
        rim[rows, columns],
        np.array([i for i, _, _ in owned], np.int32)[
            np.concatenate([clear.key, nearest_keys(samples)[some]])
        ],
    )


def span_pixels(view: View, piece: Piece) -> Block | None:
    """The block of pixels a piece may cover."""
    signs = np.array([[i, j, k] for i in (-1, 1) for j in (-1, 1) for k in (-1, 1)], dtype=np.float64)
    cube = signs @ np.stack([view.right, view.up, view.eye])
    return view.block_of(np.concatenate([center + radius * cube for center, radius in piece.balls]))


def look_through_middles(
    view: View, surfaces: list[Piece], spans: list[Block | None], block: Block
) -> tuple[Array, Any]:
    """What the rays through the middles of a block's pixels meet: depth and piece (h, w), inf and -1."""
    x0, x1, y0, y1 = block
    depth = np.full((y1 - y0, x1 - x0), np.inf)
    keys = np.full(depth.shape, -1, np.int32)
    for key, (piece, each) in enumerate(zip(surfaces, spans, strict=True)):
        if each is None:
            continue
        a, b, c, d = each
        x, y = pixel_centers(a, b)[None, :], pixel_centers(c, d)[:, None]
        place = slice(c - y0, d - y0), slice(a - x0, b - x0)
        t = piece.meet(view.rays, x, y)
        nearer = t < depth[place]
        np.copyto(keys[place], key, where=nearer)
        np.copyto(depth[place], t, where=nearer)
    return depth, keys


def find_outlines(keys: Any) -> tuple[Any, Any]:
    """The pixels of the outline that show something, and all pixels next to a different number."""
    rim, edge = np.zeros(keys.shape, bool), np.zeros(keys.shape, bool)
    padded = np.pad(keys, 1, constant_values=-1)
    for shift in ((0, 1), (2, 1), (1, 0), (1, 2)):
        other = padded[shift[0] : shift[0] + keys.shape[0], shift[1] : shift[1] + keys.shape[1]]
        edge |= other != keys
        rim |= other < 0
    return rim & (keys >= 0), edge


def look_around(
    view: View, surfaces: list[Piece], spans: list[Block | None], columns: Any, rows: Any
) -> Hits:
    """What eight rays through each of some pixels meet, (8, m); the pixels row by row."""
    x, y = columns + SAMPLES[0], rows + SAMPLES[1]
    depth, keys = np.full(x.shape, np.inf), np.full(x.shape, -1, np.int32)
    for key, (piece, each) in enumerate(zip(surfaces, spans, strict=True)):
        if each is None:
            continue
        first, last = np.searchsorted(rows, each[2:])
        inside = columns[first:last]
        near = first + np.flatnonzero((inside >= each[0]) & (inside < each[1]))
        if not len(near):
            continue
        t, known = piece.meet(view.rays, x[:, near], y[:, near]), depth[:, near]
        nearer = t < known
        depth[:, near] = np.where(nearer, t, known)
        keys[:, near] = np.where(nearer, key, keys[:, near])
    return Hits(x, y, depth, keys)


def nearest_keys(samples: Hits) -> Any:
    """The piece that is nearest of what the rays through each pixel meet, (m,)."""
    return np.take_along_axis(samples.key, samples.t.argmin(axis=0)[None], axis=0)[0]


def shade_hits(view: View, surfaces: list[Piece], tints: Any, hits: Hits) -> Any:
    """The colours (m, 3) where rays met something."""
    points = view.rays.points(hits.x, hits.y, hits.t)
    normals = np.empty(points.shape, np.float32)
    order = np.argsort(hits.key, kind="stable")
    bounds = np.searchsorted(hits.key[order], np.arange(len(surfaces) + 1))
    for key, piece in enumerate(surfaces):
        at = order[bounds[key] : bounds[key + 1]]
        if len(at):
            normals[at] = piece.normals(points[at])
    return light_colors(tints[hits.key], normals, view)


def light_colors(colors: Any, normals: Any, view: View) -> Any:
    """The colours under a key light over the viewer's left shoulder, a fill light and a faint gloss."""
    key = 0.55 * view.eye + 0.75 * view.up - 0.45 * view.right
    key /= np.linalg.norm(key)
    half = (key + view.eye) / np.linalg.norm(key + view.eye)
    lights = np.stack([key, 0.5 * view.eye + 0.8 * view.right, view.eye, half]).astype(np.float32)
    diffuse, fill, facing, gloss = np.maximum(np.einsum("ki,mi->km", lights, normals), 0.0)
    away = 1.0 - np.minimum(facing, 1.0)
    gloss = gloss * gloss  # to the power 40 by products: pow is slow
    gloss = gloss * gloss
    gloss = gloss * gloss
    gloss = gloss * (gloss * gloss) * (gloss * gloss)
    shade = 0.56 + 0.42 * diffuse + 0.10 * fill - 0.16 * away * away * away
    return np.minimum(colors * shade[:, None] + (0.16 * gloss)[:, None], np.float32(1.0))
