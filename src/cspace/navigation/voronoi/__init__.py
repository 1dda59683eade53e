"""The Voronoi diagram of free space: points as far from two walls."""
