"""Goals of inverse kinematics: poses, points, and partial goals."""
