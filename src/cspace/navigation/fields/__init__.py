"""Fields over the world: wavefronts, distance fields and potentials, and descent along them."""
