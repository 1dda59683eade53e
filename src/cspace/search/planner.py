"""Planner: the base of all planners, a frozen dataclass whose fields are its options; Trace: what one did."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from functools import cache, cached_property
from inspect import Parameter, signature
from typing import TYPE_CHECKING, Any, ClassVar, TypeVar

import numpy as np
import numpy.typing as npt

from cspace.arrays import Array
from cspace.errors import InputTypeError, attribute_error, suggest
from cspace.search.options import Option, options_of
from cspace.tables import one_line, tabulate

Same = TypeVar("Same", bound="Planner")


class _OldName:
    """An attribute that has another name, which the error gives."""

    def __set_name__(self, owner: type, name: str) -> None:
        self.name = name

    def __get__(self, planner: object, owner: type) -> None:
        raise attribute_error(owner if planner is None else planner, self.name)


@tabulate()
@dataclass(frozen=True, eq=False)
class Planner:
    """A planner with its options.

    A subclass is a dataclass(frozen=True) whose fields are declared by `option`. Values are checked when the
    planner is made: UnknownNameError for an unknown word, InputError or InputTypeError for a wrong value.
    """

    name: ClassVar[str] = ""
    """The word that selects it; the name of the class unless given."""
    summary: ClassVar[str] = ""
    """A line on what it does."""

    if not TYPE_CHECKING:  # type checkers report such names themselves; __getattr__ would slow every access
        line, sees = _OldName(), _OldName()

    def __init_subclass__(cls) -> None:
        cls.name = vars(cls).get("name", cls.__name__)

    def __new__(cls: type[Same], *values: Any, **options: Any) -> Same:
        """Raises InputTypeError for an option that the class does not have."""
        own: Any = cls
        if options and (known := parameters_of(own)) is not None:
            check_names(options, known, cls.name or cls.__name__)
        return super().__new__(cls)

    def __post_init__(self) -> None:
        for name, each in self.options.items():
            if (value := getattr(self, name)) is not each.default:
                object.__setattr__(self, name, each.check_value(value))

    @property
    def options(self) -> Mapping[str, Option]:
        """Its options by name: the type, default, unit, meaning and rule of each."""
        own: Any = type(self)
        return options_of(own)

    @cached_property
    def values(self) -> Mapping[str, Any]:
        """The values of its options by name."""
        return {name: getattr(self, name) for name in self.options}

    def with_options(self: Same, options: Mapping[str, Any]) -> Same:
        """The same planner with other options; InputTypeError for an unknown name, else as for new ones."""
        check_names(options, self.options, self.name)
        return type(self)(**{**self.values, **options})

    def _in_force(self: Same, **values: Any) -> Same:
        """A copy with values that depend on the world, and seeds, as used, unchecked; the last is kept."""
        kept = vars(self).get("_kept")
        if kept is None or kept[0] != values:
            made = object.__new__(type(self))
            vars(made).update(self.values, **values)
            kept = vars(self)["_kept"] = values, made
        found: Same = kept[1]
        return found

    def __getstate__(self) -> dict[str, Any]:
        """The options, without what is cached with them."""
        return dict(self.values)

    def __eq__(self, other: object) -> bool:
        """Whether the other is of the same class with equal values, arrays included."""
        if type(self) is not type(other) or not isinstance(other, Planner):
            return NotImplemented
        return all(map(np.array_equal, self.values.values(), other.values.values()))

    def __hash__(self) -> int:
        return hash((type(self), *(value for value in self.values.values() if not np.ndim(value))))


@cache
def parameters_of(cls: type[Any]) -> tuple[str, ...] | None:
    """The names that objects of a class are made with; None if it takes any."""
    found = signature(cls.__init__).parameters
    takes_any = any(each.kind is Parameter.VAR_KEYWORD for each in found.values())
    return None if takes_any else tuple(found)[1:]


def check_names(options: Iterable[str], known: Iterable[str], planner: str) -> None:
    """Raises InputTypeError for the first option that is not known, with the nearest names."""
    for name in options:
        if name not in known:
            raise InputTypeError(str(suggest("option", name, known, owner=f"planner {planner!r}")))


@tabulate()
@dataclass(frozen=True, eq=False)
class Trace:
    """The events of a search in chronological order.

    words: the kinds of events of the planner ("expand", "hit", "follow", …). kind: (k,) index of each event
    into words. start, end: (k, 2) [m] the segment of the event, or the same point twice. value: (k,) the
    number that the planner records with the event (a cost, a clearance, an arc length; its page states
    which).
    """

    words: tuple[str, ...]
    kind: npt.NDArray[np.int8]
    start: Array
    end: Array
    value: Array

    def __repr__(self) -> str:
        return one_line("Trace", f"of {len(self)} events: {', '.join(self.words)}")

    def __len__(self) -> int:
        """The number of events."""
        return len(self.kind)

    def __iter__(self) -> Iterator[tuple[str, Array, Array, float]]:
        """(word, start (2,), end (2,), value) of each event."""
        for kind, start, end, value in zip(self.kind, self.start, self.end, self.value, strict=True):
            yield self.words[kind], start, end, float(value)

    def only(self, word: str) -> Trace:
        """The events of one kind: a Trace with the same arrays (k, 2), fewer rows."""
        kept = self.kind == (self.words.index(word) if word in self.words else -1)
        return Trace(self.words, self.kind[kept], self.start[kept], self.end[kept], self.value[kept])
