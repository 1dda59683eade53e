"""Following a path: vehicles with limits in a small simulator, and the controllers that steer them."""

from cspace.maps import cast_rays
from cspace.mobile import Car, Unicycle
from cspace.navigation.following.follow import CONTROLLERS, follow
from cspace.navigation.following.run import OUTCOMES, Run

__all__ = ["CONTROLLERS", "OUTCOMES", "Car", "Run", "Unicycle", "cast_rays", "follow"]
