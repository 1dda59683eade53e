"""Navigation in the plane: planners that find a path from start to goal in polygonal worlds and grids."""

from cspace.navigation.bugs import BugEvidence
from cspace.navigation.cars import CarRoute, hybrid_a_star
from cspace.navigation.cells import ApproximateCells, CellEvidence, approximate_cells
from cspace.navigation.coverage import Coverage, coverage
from cspace.navigation.curves import (
    Curve,
    Segment,
    dubins,
    dubins_distance,
    reeds_shepp,
    reeds_shepp_distance,
)
from cspace.navigation.fields import (
    BrushfireDiagram,
    HarmonicEvidence,
    NavigationEvidence,
    NavigationFunction,
    PotentialRest,
    arrival_times,
    brushfire_diagram,
    harmonic,
    navigation_function,
    potential,
)
from cspace.navigation.following import CONTROLLERS, OUTCOMES, Car, Run, Unicycle, cast_rays, follow
from cspace.navigation.grid import DStarLite
from cspace.navigation.navigate import World, navigate
from cspace.navigation.planners import PLANNERS, Planner
from cspace.navigation.route import STATUSES, Route, Stats
from cspace.navigation.visibility import VisibilityGraph, visibility_graph
from cspace.navigation.voronoi import VoronoiDiagram, voronoi_diagram
from cspace.search.options import Option
from cspace.search.trace import Trace

__all__ = ["PLANNERS", "STATUSES", "Option", "Planner", "Route", "Stats", "Trace", "World", "navigate"]
__all__ += ["BugEvidence"]
__all__ += ["CarRoute", "hybrid_a_star"]
__all__ += ["ApproximateCells", "CellEvidence", "Coverage", "approximate_cells", "coverage"]
__all__ += ["Curve", "Segment", "dubins", "dubins_distance", "reeds_shepp", "reeds_shepp_distance"]
__all__ += ["BrushfireDiagram", "arrival_times", "brushfire_diagram"]
__all__ += ["HarmonicEvidence", "harmonic"]
__all__ += ["NavigationEvidence", "NavigationFunction", "navigation_function"]
__all__ += ["PotentialRest", "potential"]
__all__ += ["CONTROLLERS", "OUTCOMES", "Car", "Run", "Unicycle", "cast_rays", "follow"]
__all__ += ["DStarLite"]
__all__ += ["VisibilityGraph", "VoronoiDiagram", "visibility_graph", "voronoi_diagram"]
