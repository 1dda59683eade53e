"""Coverage: a robot sweeps all of free space."""
