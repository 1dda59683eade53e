"""Monte Carlo localisation: particles on grids and on maps of landmarks, and the histogram filter."""

from cspace.localization.particles.answer import MapLocalization, MapLocalizationStats
from cspace.localization.particles.histogram import HistogramFilter
from cspace.localization.particles.particle_filter import ParticleFilter
from cspace.localization.particles.state import FilterEvent, PoseMode

__all__ = [
    "FilterEvent",
    "HistogramFilter",
    "MapLocalization",
    "MapLocalizationStats",
    "ParticleFilter",
    "PoseMode",
]
