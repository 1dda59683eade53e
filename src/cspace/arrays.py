"""What callers pass as numbers becomes float64 arrays of the right shape here, or a clear error."""

from __future__ import annotations

import math
import operator
import sys
import warnings
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from typing import Any, Final, NoReturn

import numpy as np
import numpy.typing as npt

from cspace.errors import InputError, InputTypeError, name_type, shown
from cspace.tolerances import FARTHEST

__all__ = ["Array", "as_arrays", "as_floats", "as_generator", "leading_axes", "one_number", "positive_number"]
__all__ += ["any_array", "bounded_number", "guard_memory", "one_array", "shape_of", "truth_value"]
__all__ += ["outside_level", "warn_of_degrees", "whole_number"]

Array = npt.NDArray[np.float64]
UnknownRank = np.ndarray[tuple[NoReturn, NoReturn, NoReturn, NoReturn, NoReturn], np.dtype[Any]]
"""Matches only arrays of whose number of axes type checkers know nothing, as of most functions of numpy."""
Matrix = np.ndarray[tuple[int, int], np.dtype[Any]]
Stack = np.ndarray[tuple[int, int, int], np.dtype[Any]] | np.ndarray[tuple[int, int, int, int], np.dtype[Any]]
"""Matrices with one or two leading axes."""

LARGEST_FLOAT: Final = sys.float_info.max


def as_floats(
    value: Any,
    subject: str,
    *,
    last: tuple[int | None, ...] = (),
    finite: bool = True,
    largest: float | None = None,
) -> Array:
    """A float64 array (..., *last): its trailing axes have the sizes `last` (None: any size), all finite.

    value: anything numpy reads as numbers. subject: its name in messages. largest: no entry may be larger.
    Raises InputTypeError if it is not numeric, InputError on a wrong shape, on NaN or inf, or beyond largest.
    """
    array = value if type(value) is np.ndarray and value.dtype == np.float64 else _converted(value, subject)
    if not array.flags.aligned:  # the compiled loops read numbers in place
        array = array.copy()
    shape = array.shape[array.ndim - len(last) :] if last else ()
    if shape != last and not _fits(shape, last):
        wanted = "(..., " + ", ".join("k" if n is None else str(n) for n in last) + ")"
        raise InputError(f"{subject} has shape {array.shape}, expected {wanted}")
    if (not finite and largest is None) or _all_within(array, LARGEST_FLOAT if largest is None else largest):
        return array
    if finite and not np.isfinite(array).all():
        bad = tuple(map(int, np.argwhere(~np.isfinite(array))[0]))
        raise InputError(f"{subject} {_entry(array, bad)}; all must be finite")
    if largest is not None and (np.abs(array) > largest).any():
        beyond = np.argwhere(np.abs(array) > largest)[0]
        raise InputError(
            f"{subject} {_entry(array, tuple(map(int, beyond)))}; the largest allowed value is ±{largest:g}"
        )
    return array


def shape_of(value: Any, subject: str) -> tuple[int, ...]:
    """The shape that numpy reads; InputTypeError for rows of different lengths."""
    try:
        return np.shape(value)
    except ValueError:
        return as_floats(value, subject).shape  # raises, with the subject


def any_array(value: Any, subject: str) -> npt.NDArray[Any]:
    """The array (...) that numpy reads; InputError for rows of different lengths."""
    _refuse_masked(value, subject)
    try:
        return np.asarray(value)
    except ValueError:
        raise InputError(f"{subject} has rows of different lengths; all rows need as many entries") from None


def truth_value(value: Any, subject: str) -> bool:
    """True or False, also as 0 and 1; InputTypeError for anything else."""
    if isinstance(value, (bool, np.bool_)) or (isinstance(value, (int, np.integer)) and value in (0, 1)):
        return bool(value)
    raise InputTypeError(f"{subject} is {shown(value)}; give True or False")


def as_arrays(
    values: Mapping[str, tuple[Any, tuple[int, ...]]], *, largest: float | None = None
) -> dict[str, Array]:
    """Several arguments at once, each (..., *last) with leading axes that fit together.

    values: from subject to (value, last); the result: from subject to array.

    Raises InputTypeError and InputError as of as_floats and leading_axes.
    """
    out = {name: as_floats(v, name, last=last, largest=largest) for name, (v, last) in values.items()}
    if len(out) > 1:
        leading_axes(**{name: a.shape[: a.ndim - len(values[name][1])] for name, a in out.items()})
    return out


def one_array(
    value: Any,
    subject: str,
    shape: tuple[int | None, ...],
    meaning: str = "",
    *,
    largest: float | None = None,
) -> Array:
    """A contiguous float64 array of exactly this shape, (3,) or (n, 2) for (3,) or (None, 2), all finite.

    meaning: what messages say after the shape. Raises InputTypeError and InputError as of as_floats.
    """
    array = as_floats(value, subject, largest=largest)
    if not _fits(array.shape, shape):
        wanted = str(shape).replace("None", "n") + (f": {meaning}" if meaning else "")
        raise InputError(f"{subject} has shape {array.shape}, expected {wanted}")
    return np.ascontiguousarray(array)


def one_number(value: Any, subject: str, *, largest: float | None = None) -> float:
    """A finite number, alone; InputTypeError and InputError as of as_floats."""
    if type(value) is float and value == 0:
        return 0.0
    number = as_floats(value, subject, largest=largest)
    if number.ndim:
        raise InputError(f"{subject} has shape {number.shape}; it must be one number")
    return float(number)


def positive_number(
    value: Any, subject: str, rule: str = "it must be one positive number", *, largest: float = FARTHEST
) -> float:
    """A number above zero and at most `largest`, alone. rule: what a message says after the value.

    Raises InputTypeError for a value that is not a number, InputError for any other, and for NaN.
    """
    if type(value) is float and 0.0 < value <= largest:
        return value
    number = as_floats(value, subject, finite=largest < math.inf, largest=largest)
    if number.ndim or not number > 0:
        given = f"has shape {number.shape}" if number.ndim else f"is {value!r}"
        raise InputError(f"{subject} {given}; {rule}")
    return float(number)


def bounded_number(value: Any, subject: str, least: float, rule: str, largest: float | None = None) -> float:
    """A number not below `least`, alone; rule and errors as of positive_number."""
    if type(value) is float and least <= value <= (math.inf if largest is None else largest) < math.inf:
        return value
    number = as_floats(value, subject, largest=largest)
    if number.ndim or number < least:
        raise InputError(f"{subject} is {value!r}; {rule}")
    return float(number)


def whole_number(value: Any, subject: str, least: int, most: int, note: str = "") -> int:
    """The value as an int between two bounds.

    Raises InputTypeError for a value that is not an integer, InputError outside the bounds.
    """
    try:
        count = operator.index(value)
    except TypeError:
        count = None
    if count is None or isinstance(value, (bool, np.bool_)):
        raise InputTypeError(f"{subject} is {name_type(value)}; it must be a whole number")
    if not least <= count <= most:
        also = f"; {note}" if note else ""
        raise InputError(f"{subject} is {count}; it must be {least} to {most}{also}")
    return count


@contextmanager
def guard_memory(subject: str, value: Any, numbers: float, remedy: str) -> Iterator[None]:
    """InputError that names the argument where arrays of so many numbers exceed the memory.

    remedy: what a message says last. Arrays are allocated in the block.
    """
    largest = sys.maxsize // np.dtype(np.float64).itemsize
    if numbers < largest:
        try:
            yield
            return
        except MemoryError:
            pass
    raise InputError(
        f"{subject} is {value}; arrays of {numbers:.3g} numbers exceed the memory, {remedy}"
    ) from None


def leading_axes(**shapes: tuple[int, ...]) -> tuple[int, ...]:
    """The axes to which the leading axes of several arguments broadcast; InputError if they do not fit."""
    try:
        return np.broadcast_shapes(*shapes.values())
    except ValueError:
        each = " and ".join(f"{name} {shape}" for name, shape in shapes.items())
        raise InputError(
            f"the leading axes of {each} do not broadcast; give equally many of each, or one for all"
            " ([:, None] adds an axis)"
        ) from None


def _converted(value: Any, subject: str) -> Array:
    """The numbers of anything as float64; text, complex numbers, dates and truth values are refused."""
    try:
        array = np.asarray(value)
        numbers = array.astype(np.float64, copy=False) if array.dtype.kind in "iufO" else None
    except OverflowError:
        raise InputError(
            f"{subject} contains an integer beyond the range of float64; all must be finite"
        ) from None
    except (TypeError, ValueError) as error:
        raise InputTypeError(f"{subject} must be numbers, got {type(value).__name__}: {error}") from None
    _refuse_masked(value, subject)
    if _holds_truth(array) or _holds_truth(value):
        what = f"a number, got the truth value {value}" if array.ndim == 0 else "numbers, got truth values"
        raise InputTypeError(f"{subject} must be {what}")
    if isinstance(value, str):
        raise InputTypeError(f"{subject} must be numbers, got the text {shown(value)}")
    if numbers is None:
        raise InputTypeError(f"{subject} must be numbers, got {type(value).__name__} of {array.dtype}")
    return numbers


def _refuse_masked(value: Any, subject: str) -> None:
    """InputError for a masked array with masked entries, also in a list: numpy reads what they hide."""
    if isinstance(value, (list, tuple)):
        if not set(map(type, value)) <= {float, int, np.ndarray}:
            for part in value:
                _refuse_masked(part, subject)
    elif isinstance(value, np.ndarray) and type(value) is not np.ndarray:
        masked = np.argwhere(np.broadcast_to(getattr(value, "mask", False), value.shape))
        if len(masked):
            at = f" at index {tuple(map(int, masked[0]))}" if value.ndim else ""
            raise InputError(f"{subject} has a masked entry{at}; fill the masked entries or leave them out")


def _holds_truth(value: Any) -> bool:
    """Whether a boolean is among the entries; numpy would convert it to 0 or 1 among numbers."""
    if isinstance(value, np.ndarray):
        return value.dtype == bool or (value.dtype == object and _holds_truth(value.ravel().tolist()))
    if not isinstance(value, (list, tuple)):
        return isinstance(value, (bool, np.bool_))
    kinds = set(map(type, value))
    return not kinds <= {float, int} and any(map(_holds_truth, value))


def _entry(array: Array, index: tuple[int, ...]) -> str:
    """An entry of an array as text; a single number has no index."""
    return f"holds {array[index]:g}" + (f" at index {index}" if index else "")


def _fits(shape: tuple[int, ...], last: tuple[int | None, ...]) -> bool:
    return len(shape) == len(last) and all(n is None or n == m for n, m in zip(last, shape, strict=True))


def _all_within(array: Array, largest: float) -> bool:
    """Whether no entry is NaN or larger than that; a few numbers are faster looked at one by one."""
    if array.size <= 16:
        return all(abs(value) <= largest for value in array.ravel().tolist())
    return bool(array.min() >= -largest and array.max() <= largest)


def as_generator(rng: int | np.random.Generator | None) -> np.random.Generator:
    """The random generator behind every `rng=` argument: an int is a seed, None draws a fresh one.

    Raises InputTypeError for anything else (a bool included), InputError for a negative seed.
    """
    if isinstance(rng, np.random.Generator):
        return rng
    if rng is not None and (isinstance(rng, bool) or not isinstance(rng, (int, np.integer))):
        raise InputTypeError(f"rng is {name_type(rng)}; use an int seed, a numpy Generator or None")
    if rng is not None and rng < 0:
        raise InputError(f"rng is {rng}; a seed must be 0 or more")
    return np.random.default_rng(rng)


def warn_of_degrees(subject: str, values: Array, doubted: tuple[float, float], remedy: str) -> None:
    """Warn the caller of the library of values (...) [rad] in the doubted range, which look like degrees."""
    sizes = np.abs(values)
    if not ((sizes > doubted[0]) & (sizes <= doubted[1])).any():
        return
    largest = float(sizes[sizes <= doubted[1]].max())
    text = f"{subject} holds {largest:g}: angles are in radians, are these degrees? {remedy}"
    warnings.warn(text, stacklevel=outside_level(sys._getframe(1)))


def outside_level(frame: Any) -> int:
    """The stacklevel of a warning that names the first line outside the library, seen from a frame in it."""
    level = 2
    while frame is not None and str(frame.f_globals.get("__name__", "")).partition(".")[0] == "cspace":
        frame, level = frame.f_back, level + 1
    return level
