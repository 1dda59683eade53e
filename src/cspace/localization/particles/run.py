"""Filters of maps by name, along a log."""

from __future__ import annotations

from math import inf
from time import perf_counter
from typing import Any

from cspace._core import TimeOver, set_deadline
from cspace.errors import InputError, TimeLimitError
from cspace.localization.log import Log
from cspace.localization.particles.answer import MapLocalization
from cspace.localization.particles.histogram import HistogramFilter
from cspace.localization.particles.localize_on_map import MapFilter, localize_on_map
from cspace.localization.particles.particle_filter import ParticleFilter


def run_map_filter(
    name: str, log: Log, grid: Any, options: dict[str, Any], limit: float | None
) -> MapLocalization:
    """The answer of "mcl" or "histogram" with the keywords of its class. Raises InputError without a map."""
    if grid is None:
        raise InputError(f"filter={name!r} needs a map, and the log has none; give a grid or Landmarks")
    begun = perf_counter()
    outer = set_deadline(inf if limit is None else limit)
    try:
        made: MapFilter = (
            ParticleFilter(grid, **options) if name == "mcl" else HistogramFilter(grid, **options)
        )
        return localize_on_map(name, log, grid, made, options["sensor"], begun, limit)
    except TimeOver:
        if limit is None or perf_counter() - begun < limit:
            raise  # that of a caller
        raise TimeLimitError(f"the filter did not finish within its time_limit of {limit:g} s") from None
    finally:
        set_deadline(outer - (perf_counter() - begun))
