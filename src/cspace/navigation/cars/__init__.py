"""Cars on grids: paths with a minimum turning radius, around obstacles."""
