"""Planners by name: the classes of modules, and the choice of one with options."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from contextlib import suppress
from functools import lru_cache
from types import MappingProxyType, ModuleType
from typing import Any, TypeVar, cast

from cspace.errors import InputTypeError, suggest
from cspace.search.planner import Planner

Kind = TypeVar("Kind", bound=Planner)


def collect_planners(modules: Iterable[ModuleType], base: type[Kind]) -> Mapping[str, Kind]:
    """The planners of modules that have a summary, with their default options, by name."""
    classes = (each for module in modules for each in vars(module).values() if isinstance(each, type))
    found = (each() for each in classes if issubclass(each, base) and each.summary)
    return MappingProxyType({planner.name: planner for planner in found})


@lru_cache(maxsize=128, typed=True)
def _with_options(planner: Planner, /, **options: Any) -> Planner:
    """A planner of the library with options, kept: it is immutable, and checks take microseconds."""
    return planner.with_options(options)


def choose_planner(
    planner: object, options: Mapping[str, Any], known: Mapping[str, Kind], base: type[Kind]
) -> Kind:
    """The planner of a name, or a planner itself, with options.

    Raises UnknownNameError with the nearest names, InputTypeError for an option that it does not have and for
    an object of another class.
    """
    found = known.get(planner) if isinstance(planner, str) else planner
    if isinstance(found, base):
        if not options:
            return found
        if found is not planner:
            with suppress(TypeError):  # an array cannot be hashed; a wrong option is named below
                return cast("Kind", _with_options(found, **options))
        return found.with_options(options)
    if isinstance(planner, type) and issubclass(planner, base):
        raise InputTypeError(f"planner is the class {planner.__name__}; give an object: {planner.__name__}()")
    if callable(getattr(planner, "plan", None)):
        kind = type(planner).__name__
        raise InputTypeError(f"planner is an object of type {kind}; derive its class from {base.__name__}")
    raise suggest("planner", planner, known)
