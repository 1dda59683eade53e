"""Navigation in the plane: planners that find a path from start to goal in polygonal worlds and grids."""

from typing import TYPE_CHECKING

from cspace.navigation.any_angle.any_angle import AnyAngle
from cspace.navigation.bugs.voronoi_bug import VoronoiBug
from cspace.navigation.bugs.wall_followers import Bug1, Bug2, BugEvidence, TangentBug
from cspace.navigation.cars.car_route import CarRoute
from cspace.navigation.cars.hybrid_a_star import hybrid_a_star
from cspace.navigation.cells.approximate_cells import (
    ApproximateCells,
    ApproximateCellsSearch,
    CellEvidence,
    approximate_cells,
)
from cspace.navigation.cells.exact_cells import ExactCells
from cspace.navigation.coverage.boustrophedon import Coverage, coverage
from cspace.navigation.curves.curve import Curve, Segment
from cspace.navigation.curves.shortest import dubins, dubins_distance, reeds_shepp, reeds_shepp_distance
from cspace.navigation.fields.brushfire import Brushfire, BrushfireDiagram, brushfire_diagram
from cspace.navigation.fields.fast_marching import FastMarching, arrival_times
from cspace.navigation.fields.harmonic import Harmonic, HarmonicEvidence, harmonic
from cspace.navigation.fields.potential_a_star import PotentialAStar
from cspace.navigation.fields.potential_field import PotentialField, PotentialRest, potential
from cspace.navigation.fields.rimon_koditschek import (
    NavigationEvidence,
    NavigationFunction,
    RimonKoditschek,
    navigation_function,
)
from cspace.navigation.following import CONTROLLERS, OUTCOMES, Car, Run, Unicycle, cast_rays, follow
from cspace.navigation.grid.best_first import (
    AStar,
    Dijkstra,
    FocalSearch,
    GreedyBestFirst,
    JumpPointSearch,
    ThetaStar,
    Wavefront,
    WeightedAStar,
)
from cspace.navigation.grid.d_star_lite import DStarLite, DStarLiteSearch
from cspace.navigation.navigate import World, navigate
from cspace.navigation.planner import PlanePlanner
from cspace.navigation.planners import PLANNERS
from cspace.navigation.route import STATUSES, Route, Stats
from cspace.navigation.sampling.planners import PRM, RRT, RRTStar
from cspace.navigation.visibility.visibility_graph import (
    VisibilityGraph,
    VisibilityGraphSearch,
    visibility_graph,
)
from cspace.navigation.voronoi.voronoi import Voronoi, VoronoiDiagram, voronoi_diagram
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

if not TYPE_CHECKING:  # type checkers report such names themselves

    def __getattr__(name: str) -> object:
        import sys

        from cspace.errors import module_error

        raise module_error(sys.modules[__name__], name)
