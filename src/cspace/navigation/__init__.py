"""Navigation in the plane: planners that find a path from start to goal in polygonal worlds and grids."""

from cspace.navigation.any_angle import AnyAngle
from cspace.navigation.bugs import Bug1, Bug2, BugEvidence, TangentBug, VoronoiBug
from cspace.navigation.cars import CarRoute, hybrid_a_star
from cspace.navigation.cells import (
    ApproximateCells,
    ApproximateCellsSearch,
    CellEvidence,
    ExactCells,
    approximate_cells,
)
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
    Brushfire,
    BrushfireDiagram,
    FastMarching,
    Harmonic,
    HarmonicEvidence,
    NavigationEvidence,
    NavigationFunction,
    PotentialAStar,
    PotentialField,
    PotentialRest,
    RimonKoditschek,
    arrival_times,
    brushfire_diagram,
    harmonic,
    navigation_function,
    potential,
)
from cspace.navigation.following import CONTROLLERS, OUTCOMES, Car, Run, Unicycle, cast_rays, follow
from cspace.navigation.grid import (
    AStar,
    Dijkstra,
    DStarLite,
    DStarLiteSearch,
    FocalSearch,
    GreedyBestFirst,
    JumpPointSearch,
    ThetaStar,
    Wavefront,
    WeightedAStar,
)
from cspace.navigation.navigate import World, navigate
from cspace.navigation.planner import PlanePlanner
from cspace.navigation.planners import PLANNERS
from cspace.navigation.route import STATUSES, Route, Stats
from cspace.navigation.sampling import PRM, RRT, RRTStar
from cspace.navigation.visibility import VisibilityGraph, VisibilityGraphSearch, visibility_graph
from cspace.navigation.voronoi import Voronoi, VoronoiDiagram, voronoi_diagram
from cspace.search import Option, Planner, Trace, option

__all__ = ["PLANNERS", "STATUSES", "Option", "PlanePlanner", "Planner", "Route", "Stats", "Trace", "World"]
__all__ += ["navigate", "option"]
__all__ += ["AnyAngle", "Bug1", "Bug2", "BugEvidence", "TangentBug", "VoronoiBug"]
__all__ += ["CarRoute", "hybrid_a_star"]
__all__ += ["ApproximateCells", "ApproximateCellsSearch", "CellEvidence", "ExactCells", "approximate_cells"]
__all__ += ["Coverage", "coverage"]
__all__ += ["Curve", "Segment", "dubins", "dubins_distance", "reeds_shepp", "reeds_shepp_distance"]
__all__ += ["Brushfire", "BrushfireDiagram", "FastMarching", "arrival_times", "brushfire_diagram"]
__all__ += ["Harmonic", "HarmonicEvidence", "harmonic"]
__all__ += ["NavigationEvidence", "NavigationFunction", "RimonKoditschek", "navigation_function"]
__all__ += ["PotentialAStar", "PotentialField", "PotentialRest", "potential"]
__all__ += ["CONTROLLERS", "OUTCOMES", "Car", "Run", "Unicycle", "cast_rays", "follow"]
__all__ += ["AStar", "DStarLite", "DStarLiteSearch", "Dijkstra", "FocalSearch", "GreedyBestFirst"]
__all__ += ["JumpPointSearch", "ThetaStar", "Wavefront", "WeightedAStar"]
__all__ += ["PRM", "RRT", "RRTStar"]
__all__ += ["VisibilityGraph", "VisibilityGraphSearch", "Voronoi", "VoronoiDiagram"]
__all__ += ["visibility_graph", "voronoi_diagram"]
