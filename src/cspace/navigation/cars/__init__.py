"""Cars on grids: ways that a smallest turning circle allows, around obstacles."""

from cspace.navigation.cars.car_route import CarRoute
from cspace.navigation.cars.hybrid_a_star import hybrid_a_star

__all__ = ["CarRoute", "hybrid_a_star"]
