"""Fields over the world: wavefronts, distance fields and potentials, and descent along them."""

from cspace.navigation.fields.brushfire import BrushfireDiagram, brushfire_diagram
from cspace.navigation.fields.fast_marching import arrival_times
from cspace.navigation.fields.harmonic import HarmonicEvidence, harmonic
from cspace.navigation.fields.potential_field import PotentialRest, potential
from cspace.navigation.fields.rimon_koditschek import (
    NavigationEvidence,
    NavigationFunction,
    navigation_function,
)

__all__ = ["BrushfireDiagram", "arrival_times", "brushfire_diagram"]
__all__ += ["HarmonicEvidence", "harmonic"]
__all__ += ["NavigationEvidence", "NavigationFunction", "navigation_function"]
__all__ += ["PotentialRest", "potential"]
