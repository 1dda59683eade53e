"""Readers of logs: CARMEN, MRCLAM, Victoria Park and TUM, told apart by their content."""

from cspace.localization.logs.read_log import read_log

__all__ = ["read_log"]
