"""Monte Carlo localisation: particles on grids and on maps of landmarks."""

from cspace.localization.particles.particle_filter import ParticleFilter
from cspace.localization.particles.state import FilterEvent, PoseMode

__all__ = ["FilterEvent", "ParticleFilter", "PoseMode"]
