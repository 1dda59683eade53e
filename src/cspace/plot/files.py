"""Pictures as files."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from cspace.errors import InputError
from cspace.files import whole_file

__all__ = ["save"]


def save(artists: Any, path: str | Path, *, dpi: float = 150.0) -> None:
    """Write the figure that some artists belong to, and close it.

    artists: what a function of this room returned: artists, a figure or an animation. path: a file; its
    ending names the format (png, svg, pdf; of an animation gif). dpi: pixels per inch. The file is written
    whole or not at all.
    Raises InputError if there are no artists or the file cannot be written.
    """
    is_figure, moves = hasattr(artists, "savefig"), hasattr(artists, "new_frame_seq")
    if not is_figure and not moves and not artists:
        raise InputError("nothing to save: there are no artists")
    import matplotlib.pyplot as plt

    figure = artists if is_figure else artists._fig if moves else artists[0].figure
    try:
        with whole_file(path) as draft:
            if moves:
                artists.save(draft, writer="pillow", dpi=dpi)
            else:
                figure.savefig(draft, dpi=dpi)
    finally:
        plt.close(figure)
