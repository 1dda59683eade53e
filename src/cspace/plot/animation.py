"""Searches as GIF files: the world is drawn once, and each frame adds the new elements."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from cspace.arrays import Array


@dataclass(frozen=True)
class Steps:
    """A film of something that grows, picture by picture."""

    frames: int
    """How many pictures there are."""
    interval: float
    """How long each is shown [ms]."""
    show: Callable[[int], tuple[Iterable[Any], Iterable[Any]]]
    """The artists that a picture adds to those before it, and those that lie over all of them."""


def write_gif(figure: Any, steps: Steps, path: str | Path, dpi: float) -> None:
    """Write a film over what a figure shows. dpi: pixels per inch."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from PIL import Image

    figure.set_dpi(dpi)
    canvas = FigureCanvasAgg(figure)
    pictures = list(draw_frames(figure, canvas, steps))
    # One palette for all: that of the last picture, which has every colour.
    palette = Image.fromarray(pictures[-1]).quantize(
        256, Image.Quantize.MAXCOVERAGE, dither=Image.Dither.NONE
    )
    first, *others = (
        Image.fromarray(each).quantize(palette=palette, dither=Image.Dither.NONE) for each in pictures
    )
    first.save(path, format="GIF", save_all=True, append_images=others, duration=steps.interval, loop=0)


def draw_frames(figure: Any, canvas: Any, steps: Steps) -> Iterable[Array]:
    """The pictures as bytes (height, width, 3)."""
    added, over = steps.show(0)
    moving = [*added, *over]
    for artist in moving:
        artist.set_animated(True)
    canvas.draw()
    below = canvas.copy_from_bbox(figure.bbox)
    for frame in range(steps.frames):
        canvas.restore_region(below)
        added, over = steps.show(frame)
        for artist in added:
            artist.axes.draw_artist(artist)
        below = canvas.copy_from_bbox(figure.bbox)
        for artist in over:
            artist.axes.draw_artist(artist)
        yield np.asarray(canvas.buffer_rgba())[..., :3].copy()
    for artist in moving:
        artist.set_animated(False)
