"""Cars on grids: paths with a minimum turning radius, around obstacles."""

from cspace.navigation.cars.car_route import CarRoute
from cspace.navigation.cars.hybrid_a_star import hybrid_a_star

__all__ = ["CarRoute", "hybrid_a_star"]
