"""TimeLimit: time that several stages of a plan share."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from math import inf
from time import perf_counter

from cspace._core import set_deadline


class TimeLimit:
    """So many seconds from now on; inf for no limit."""

    def __init__(self, seconds: float) -> None:
        self._end = perf_counter() + seconds

    @property
    def is_endless(self) -> bool:
        """Whether there is no limit."""
        return self._end == inf

    @property
    def left(self) -> float:
        """What is left of it [s], 0 or more."""
        return max(0.0, self._end - perf_counter())

    @contextmanager
    def enforce(self) -> Iterator[None]:
        """Raises TimeOver in the block once nothing is left, wherever compiled code heeds Ctrl-C."""
        if self.is_endless:
            yield
            return
        outer, begin = set_deadline(self.left), perf_counter()
        try:
            yield
        finally:
            set_deadline(outer - (perf_counter() - begin))
