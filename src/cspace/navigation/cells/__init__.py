"""Cell decompositions of free space: convex polygons, trapezoids, squares."""
