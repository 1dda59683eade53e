"""Imports of rooms when they are first used, which Ctrl-C does not leave half done."""

from __future__ import annotations

import signal
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from importlib import import_module
from types import FrameType, ModuleType
from typing import Any

__all__ = ["import_room", "postpone_interrupts"]


def import_room(name: str) -> ModuleType:
    """The module of a name; Ctrl-C comes after it. Rooms that are half imported could not be imported again:
    their modules need each other in one order."""
    with postpone_interrupts():
        return import_module(name)


@contextmanager
def postpone_interrupts() -> Iterator[None]:
    """Ctrl-C in the block comes at its end. Threads that receive no signals are left as they are."""
    handler, came = signal.getsignal(signal.SIGINT), list[tuple[int, FrameType | None]]()

    def keep(number: int, frame: FrameType | None) -> None:
        came.append((number, frame))

    if not callable(handler) or not _set_handler(keep):
        yield
        return
    try:
        yield
    finally:
        _set_handler(handler)
        if came:
            handler(*came[-1])


def _set_handler(handler: Callable[[int, FrameType | None], Any]) -> bool:
    """Sets the handler of Ctrl-C; false where this thread may not."""
    with suppress(ValueError):
        signal.signal(signal.SIGINT, handler)
        return True
    return False
