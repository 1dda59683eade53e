"""A time limit for one verb."""

from __future__ import annotations

import signal
import threading
from _thread import interrupt_main
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType
from typing import Final

from cspace.cli.exits import TimeLimitReached

CARRIER: Final = signal.SIGINT
"""The signal that brings the stop into the main thread: the only one that all platforms handle."""


@contextmanager
def limit_time(seconds: float | None) -> Iterator[None]:
    """Raise TimeLimitReached in the block when it takes longer; None means no limit.

    Compiled code heeds it like Ctrl-C, which works as before.
    """
    if seconds is None:
        yield
        return
    expired = threading.Event()
    before, main = signal.getsignal(CARRIER), threading.get_ident()

    def stop(number: int, frame: FrameType | None) -> None:
        if expired.is_set():
            raise TimeLimitReached(f"stopped after {seconds:g} s (--time-limit)")
        if callable(before):
            before(number, frame)

    def expire() -> None:
        expired.set()
        if hasattr(signal, "pthread_kill"):  # a true signal also ends a sleep
            signal.pthread_kill(main, CARRIER)
        else:
            interrupt_main(CARRIER)

    timer = threading.Timer(seconds, expire)
    timer.daemon = True
    signal.signal(CARRIER, stop)
    try:
        timer.start()
        try:
            yield
        finally:
            timer.cancel()
            timer.join()  # a thread alive when the interpreter ends holds on to what it has seen
    finally:
        signal.signal(CARRIER, before)
