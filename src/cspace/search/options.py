"""Options of planners: the fields of a frozen dataclass, each declared by `option` with its rule."""

from __future__ import annotations

import operator
from collections.abc import Iterable, Mapping
from dataclasses import MISSING, Field, dataclass, field, fields
from functools import cache
from math import inf
from types import MappingProxyType
from typing import Any

import numpy as np

from cspace.arrays import as_floats, as_generator
from cspace.errors import InputError, InputTypeError, name_type, suggest
from cspace.tables import show_fields


@show_fields
@dataclass(frozen=True)
class Option:
    """One option of a planner."""

    name: str
    type: str
    """The annotation of the field: "float", "int", "str", "bool" or another type."""
    default: Any
    """None where the default depends on the world or the option is off; the meaning states which."""
    unit: str = ""
    """ "m" and the like; empty for words and for numbers without a unit."""
    meaning: str = ""
    """What the option does, the values it accepts and its default behaviour."""
    choices: tuple[str, ...] = ()
    """The words it accepts; empty where any are."""
    subject: str = ""
    """What an unknown word is called in the error; the option's name if empty."""
    minimum: float = -inf
    above: float = -inf
    maximum: float = inf
    """The accepted numbers: at least `minimum`, greater than `above`, at most `maximum`."""
    may_be_infinite: bool = False

    def check_value(self, value: Any) -> Any:
        """The value in the option's type. Raises InputTypeError for another type, InputError for a number out
        of range, UnknownNameError for an unknown word. An array (…) is left to the planner."""
        kinds = self.type.split(" | ")
        if value is None and self.default is None:
            return None
        if "Generator" in kinds:
            return value if isinstance(value, np.random.Generator) else draw_seed(value)
        if kinds[0] not in {"bool", "float", "int", "str"}:
            return value
        several = hasattr(value, "__len__") and not isinstance(value, (str, bytes))
        if getattr(value, "ndim", several):
            raise InputTypeError(f"option {self.name!r} is {name_type(value)}; it must be one value")
        if kinds[0] == "bool":
            if not isinstance(value, (bool, np.bool_)):
                raise InputTypeError(f"{self.name} must be True or False, got {value!r}")
            return bool(value)
        if kinds[0] == "str":
            if self.choices and not (isinstance(value, str) and value in self.choices):
                raise suggest(self.subject or self.name, value, self.choices)
            return value
        number = self._whole(value) if kinds[0] == "int" else self._real(value)
        if not (self.minimum <= number <= self.maximum and number > self.above):
            shown = number if isinstance(number, int) else f"{number:g}"
            or_none = ", or None for the default" if self.default is None else ""
            raise InputError(f"{self.name} is {shown}; it must be {self._numbers()}{or_none}")
        return number

    def _whole(self, value: Any) -> int:
        try:
            if not isinstance(value, bool):
                return operator.index(value)
        except TypeError:
            pass
        raise InputTypeError(f"{self.name} is {name_type(value)}; it must be a whole number")

    def _real(self, value: Any) -> float:
        return inf if self.may_be_infinite and value == inf else float(as_floats(value, self.name))

    def _numbers(self) -> str:
        """The accepted numbers in words."""
        if self.maximum < inf:
            return f"{self.minimum} to {self.maximum}"
        unit = f" [{self.unit}]" if self.unit else ""
        if self.may_be_infinite:
            return f"{'more than zero' if self.above == 0 else 'zero or more'}{unit}, or inf"
        return f"positive{unit}" if self.above == 0 else f"{self.minimum or 'zero'} or more{unit}"


def option(
    default: Any,
    meaning: str,
    *,
    unit: str = "",
    choices: Iterable[str] = (),
    subject: str = "",
    minimum: float = -inf,
    above: float = -inf,
    maximum: float = inf,
    may_be_infinite: bool = False,
) -> Any:
    """A field of a planner: its default, meaning, unit and the rule for its values, as in Option."""
    rule = {"minimum": minimum, "above": above, "maximum": maximum, "may_be_infinite": may_be_infinite}
    words = {"unit": unit, "meaning": meaning, "choices": tuple(choices), "subject": subject}
    return field(default=default, metadata=words | rule)


@cache
def options_of(planner: type[Any]) -> Mapping[str, Option]:
    """The options of a class of planners by name, in the order of its fields."""
    return MappingProxyType({each.name: _option_of(each) for each in fields(planner)})


def _option_of(declared: Field[Any]) -> Option:
    """The option of a field; None in its type only marks the default."""
    kind: Any = declared.type  # a string where annotations are postponed
    text: str = kind if isinstance(kind, str) else getattr(kind, "__name__", str(kind))
    default = None if declared.default is MISSING else declared.default
    text = text.removesuffix(" | None") if default is None else text
    return Option(declared.name, text.replace("np.random.", ""), default, **declared.metadata)


def draw_seed(rng: int | np.random.Generator | None) -> int:
    """64 bits from an int, a Generator or None; InputError for an int that does not fit."""
    if isinstance(rng, (int, np.integer)) and not isinstance(rng, bool) and 0 <= rng < 2**64:
        return int(rng)
    generator = as_generator(rng)
    if rng is None or isinstance(rng, np.random.Generator):
        return int(generator.integers(2**64, dtype=np.uint64))
    raise InputError(f"rng is {rng}; a seed must be below 2**64")
