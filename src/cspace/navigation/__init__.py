"""Navigation in the plane: from start to goal through a world, by classical planners and new ones."""

from cspace.navigation.approximate_cells import CellEvidence, approximate_cells
from cspace.navigation.boustrophedon import Coverage, coverage
from cspace.navigation.brushfire import BrushfireDiagram, brushfire_diagram
from cspace.navigation.cars import CarRoute, hybrid_a_star
from cspace.navigation.curves import (
    Curve,
    Segment,
    dubins,
    dubins_distance,
    reeds_shepp,
    reeds_shepp_distance,
)
from cspace.navigation.d_star_lite import DStarLite
from cspace.navigation.fast_marching import arrival_times
from cspace.navigation.following import CONTROLLERS, OUTCOMES, Car, Run, Unicycle, cast_rays, follow
from cspace.navigation.harmonic import HarmonicEvidence, harmonic
from cspace.navigation.planners import PLANNERS, Planner
from cspace.navigation.potential_field import PotentialRest, potential
from cspace.navigation.query import World, navigate
from cspace.navigation.rimon_koditschek import NavigationEvidence, NavigationFunction, navigation_function
from cspace.navigation.route import STATUSES, Price, Route
from cspace.navigation.trace import Trace
from cspace.navigation.voronoi import VoronoiDiagram, voronoi_diagram

__all__ = ["PLANNERS", "STATUSES", "Planner", "Price", "Route", "Trace", "World", "navigate"]
__all__ += ["Curve", "Segment", "dubins", "dubins_distance", "reeds_shepp", "reeds_shepp_distance"]
__all__ += ["DStarLite"]
__all__ += ["CONTROLLERS", "OUTCOMES", "Car", "Run", "Unicycle", "cast_rays", "follow"]
__all__ += ["CarRoute", "Coverage", "coverage", "hybrid_a_star"]
__all__ += ["BrushfireDiagram", "brushfire_diagram"]
__all__ += ["PotentialRest", "potential"]
__all__ += ["VoronoiDiagram", "voronoi_diagram"]
__all__ += ["arrival_times"]
__all__ += ["CellEvidence", "approximate_cells"]
__all__ += ["NavigationEvidence", "NavigationFunction", "navigation_function"]
__all__ += ["HarmonicEvidence", "harmonic"]
