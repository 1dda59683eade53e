"""A line on the error stream that says what takes long, and for how long already."""

from __future__ import annotations

import sys
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any, Final

PATIENCE: Final = 1.0
"""A call that is done sooner [s] shows nothing."""
PERIOD: Final = 0.5
"""Time between two states of the line [s]."""
CLEAR: Final = "\r\x1b[K"
"""Back to the start of the line, and the line erased (ECMA-48)."""


@contextmanager
def show_progress(text: str) -> Iterator[None]:
    """Show a text and the seconds passed while the block runs, if it is slow and a person watches.

    The line is erased at the end of the block, whatever ends it.
    """
    stream = sys.stderr
    if stream is None or not stream.isatty():
        yield
        return
    done = threading.Event()
    clock = threading.Thread(target=count_seconds, args=(text, stream, done), daemon=True)
    clock.start()
    try:
        yield
    finally:
        done.set()
        clock.join()


def count_seconds(text: str, stream: Any, done: threading.Event) -> None:
    """Write the text with the seconds passed until the work is done, then erase it."""
    began, shown = time.monotonic(), False
    while not done.wait(PERIOD if shown else PATIENCE):
        stream.write(f"{CLEAR}{text} … {time.monotonic() - began:.0f} s")
        stream.flush()
        shown = True
    if shown:
        stream.write(CLEAR)
        stream.flush()
