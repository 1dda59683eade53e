"""Navigation in the plane: from start to goal through a world, by classical planners and new ones."""

from cspace.navigation.bugs import BugEvidence
from cspace.navigation.cars import CarRoute, hybrid_a_star
from cspace.navigation.cells import ApproximateCells, CellEvidence, Coverage, approximate_cells, coverage
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
from cspace.navigation.options import Option
from cspace.navigation.planners import PLANNERS, Planner
from cspace.navigation.query import World, navigate
from cspace.navigation.roadmaps import VisibilityGraph, VoronoiDiagram, visibility_graph, voronoi_diagram
from cspace.navigation.route import STATUSES, Price, Route
from cspace.navigation.trace import Trace

__all__ = ["PLANNERS", "STATUSES", "Option", "Planner", "Price", "Route", "Trace", "World", "navigate"]
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
