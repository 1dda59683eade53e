"""Fields over the world: wavefronts, distance fields and potentials, and descent along them."""

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

__all__ = ["Brushfire", "BrushfireDiagram", "FastMarching", "Harmonic", "HarmonicEvidence"]
__all__ += ["NavigationEvidence", "NavigationFunction", "PotentialAStar", "PotentialField", "PotentialRest"]
__all__ += ["RimonKoditschek", "arrival_times", "brushfire_diagram", "harmonic", "navigation_function"]
__all__ += ["potential"]
