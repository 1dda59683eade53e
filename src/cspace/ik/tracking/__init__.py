"""Tracking: the branches of solutions that follow a path of poses, and where the others end."""
