"""Pictures as files, and searches as GIF files: the world is drawn once, and each frame adds what is new."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from cspace.arrays import Array
from cspace.errors import InputError
from cspace.files import whole_file


def save(artists: Any, path: str | Path, *, dpi: float = 150.0) -> None:
    """Write the figure that some artists belong to, and close it.

    artists: what a function of this room returned: artists, a figure or an animation. path: a file; its
    ending names the format (png, svg, pdf; of an animation gif). dpi: pixels per inch. The file is written
    whole or not at all.
    Raises InputError if there are no artists, on an ending that names no such format, or if the file cannot
    be written.
    """
    is_figure, moves = hasattr(artists, "savefig"), hasattr(artists, "new_frame_seq")
    if not is_figure and not moves and not artists:
        raise InputError("nothing to save: there are no artists")
    import matplotlib.pyplot as plt

    figure = artists if is_figure else artists._fig if moves else artists[0].figure
    try:
        check_ending(path, figure, moves=moves)
        with whole_file(path) as draft:
            if hasattr(artists, "steps"):
                write_gif(figure, artists.steps, draft, dpi)
            elif moves:
                artists.save(draft, writer="pillow", dpi=dpi)
            else:
                figure.savefig(draft, dpi=dpi)
    finally:
        plt.close(figure)


def check_ending(path: str | Path, figure: Any, *, moves: bool) -> None:
    """InputError where the ending of a file names no format of pictures, or of animations."""
    known = {".gif"} if moves else {f".{name}" for name in figure.canvas.get_supported_filetypes()}
    if Path(path).suffix.lower() not in known:
        what = "an animation" if moves else "a picture"
        raise InputError(
            f"cannot write {str(path)!r}: the name of {what} must end with {' or '.join(sorted(known))}"
        )


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
