"""Text files of numbers, plain or compressed: their lines, and rows of numbers with the line of each
fault."""

from __future__ import annotations

import gzip
import io
import os
import zlib
from bisect import bisect_right
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from cspace import tolerances
from cspace.arrays import Array
from cspace.errors import LogError, shorten
from cspace.files import read_regular

GZIP = b"\x1f\x8b"


@dataclass(frozen=True)
class Lines:
    """The lines of a file."""

    path: str
    lines: list[str]

    def rows(self) -> Iterator[tuple[int, list[str]]]:
        """The number of each line, from 1, and its words, without comments and empty lines."""
        for number, line in enumerate(self.lines, 1):
            words = line.split()
            if words and not words[0].startswith("#"):
                yield number, words

    def error(self, line: int, text: str) -> LogError:
        """The error of a line."""
        return LogError(text, path=self.path, line=line)

    def numbers(
        self, line: int, words: Sequence[str], what: str, factors: Sequence[float] | None = None
    ) -> list[float]:
        """Words as finite numbers, times a factor each; LogError for others."""
        try:
            found = [float(word) for word in words]
        except ValueError:
            bad = next(word for word in words if not is_number(word))
            raise self.error(line, f"{shorten(bad, 40)!r} is no number; {what} expected") from None
        if factors is not None:
            found = [value * factor for value, factor in zip(found, factors, strict=True)]
        if not np.isfinite(found).all():
            raise self.error(line, f"{what} must be finite, and one of them is not")
        largest = tolerances.LARGEST_LOGGED
        if max(map(abs, found), default=0.0) > largest:
            raise self.error(line, f"{what} must not exceed {largest:g}, and one of them does")
        return found

    def whole(self, line: int, word: str, what: str) -> int:
        """A word as a whole number from 0 on; LogError for others."""
        (value,) = self.numbers(line, [word], what)
        if value < 0 or value != int(value):
            raise self.error(line, f"{what} must be a whole number from 0 on, and is {shorten(word, 40)}")
        return int(value)

    def table(self, columns: int, what: str) -> Array:
        """All rows as numbers (n, columns); LogError for a row of another length."""
        rows = []
        for number, words in self.rows():
            if len(words) != columns:
                raise self.error(number, f"the line has {len(words)} columns; {columns} expected: {what}")
            rows.append(self.numbers(number, words, what))
        return np.array(rows, dtype=np.float64).reshape(-1, columns)

    def refuse(self, is_bad: npt.NDArray[np.bool_], text: str) -> None:
        """LogError for the first row of a table that is bad, with its line."""
        bad = np.flatnonzero(is_bad)
        if len(bad):
            raise self.error([number for number, _ in self.rows()][int(bad[0])], text)


def read_lines(path: str) -> Lines:
    """The lines of a file, decompressed where it is a gzip; LogError where it cannot be read."""
    data = read_regular(path, "log", tolerances.LOG_BYTES, LogError)
    if data.startswith(GZIP):
        data = unpack_gzip(path, data)
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError as fault:
        line = data.count(b"\n", 0, fault.start) + 1
        raise LogError("this is no log: the text is not UTF-8", path=path, line=line) from None
    return Lines(os.fspath(path), text.splitlines())


def unpack_gzip(path: str, data: bytes) -> bytes:
    """The content of a gzip file; LogError for one that is cut, damaged, or too large."""
    try:
        with gzip.GzipFile(fileobj=io.BytesIO(data)) as file:
            content = file.read(tolerances.LOG_BYTES + 1)
    except (EOFError, OSError, zlib.error) as fault:
        raise LogError(f"the gzip file is damaged or cut: {fault}", path=path) from None
    if len(content) > tolerances.LOG_BYTES:
        raise LogError(f"decompressed, the file exceeds {tolerances.LOG_BYTES} bytes", path=path)
    return content


def is_number(word: str) -> bool:
    """Whether float() reads the word."""
    try:
        float(word)
    except ValueError:
        return False
    return True


def mend_clock(times: Array) -> tuple[Array, list[str]]:
    """Times that never run backwards, and a note if any was moved.

    The fewest stamps that break the order are replaced: each lies between those before and after it, in
    proportion to its place among the rows.
    """
    back = int(np.count_nonzero(np.diff(times) < 0))
    if not back:
        return times, []
    kept = find_longest_order(times)
    mended = np.interp(np.arange(len(times)), kept, times[kept])
    most = float(np.abs(mended - times).max())
    moved = len(times) - len(kept)
    return mended, [f"the clock runs backwards {back} times; {moved} stamps are moved, by up to {most:.3g} s"]


def find_longest_order(values: Array) -> npt.NDArray[np.intp]:
    """The rows of a longest subsequence that never decreases, by patience sorting. Source: Schensted 1961."""
    ends: list[float] = []  # the least end of a subsequence of each length
    rows: list[int] = []
    before = np.full(len(values), -1)
    for k, value in enumerate(values.tolist()):
        length = bisect_right(ends, value)
        ends[length : length + 1] = [value]
        rows[length : length + 1] = [k]
        before[k] = rows[length - 1] if length else -1
    found = [rows[-1]] if rows else []
    while found and before[found[-1]] >= 0:
        found.append(int(before[found[-1]]))
    return np.array(found[::-1], dtype=np.intp)
