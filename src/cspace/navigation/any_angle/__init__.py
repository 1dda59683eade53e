"""Any-angle planning: shortest paths through convex polygons and over cells."""
