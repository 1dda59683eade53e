"""Shared by all planners: their base class, their options and the trace of a search."""

from cspace.search.options import Option, draw_seed, option, options_of
from cspace.search.planner import Planner, Trace

__all__ = ["Option", "Planner", "Trace", "draw_seed", "option", "options_of"]
