"""Localisation of mobile robots: logs, filters and smoothers on maps of landmarks."""

__all__: list[str] = []
