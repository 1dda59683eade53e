"""Bug algorithms: robots without a map that sense walls, and know their own position and the goal's."""
