"""Shared by all planners: their base class, their options and the trace of a search."""

from cspace.search.options import Option, draw_seed, option, options_of
from cspace.search.planner import Planner, Trace
from cspace.search.registry import choose_planner, collect_planners

__all__ = ["Option", "Planner", "Trace", "choose_planner", "collect_planners", "draw_seed", "option"]
__all__ += ["options_of"]
