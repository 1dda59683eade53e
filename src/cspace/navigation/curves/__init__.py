"""Curves for cars: shortest paths between poses with a minimum turning radius."""

from cspace.navigation.curves.curve import Curve, Segment
from cspace.navigation.curves.shortest import dubins, dubins_distance, reeds_shepp, reeds_shepp_distance

__all__ = ["Curve", "Segment", "dubins", "dubins_distance", "reeds_shepp", "reeds_shepp_distance"]
