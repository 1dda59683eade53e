"""Shared by all planners: their options and the trace of a search."""

from cspace.search.options import Option
from cspace.search.trace import Trace

__all__ = ["Option", "Trace"]
