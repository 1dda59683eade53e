"""Pictures as files."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from cspace.errors import InputError
from cspace.files import whole_file
from cspace.plot.animation import write_gif


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
