"""Filters and smoothers of a pose on maps of landmarks."""

from cspace.localization.filters.localize import localize
from cspace.localization.filters.run import Localization, LocalizationStats

__all__ = ["Localization", "LocalizationStats", "localize"]
