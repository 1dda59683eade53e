"""Goals of inverse kinematics: poses, points, and partial goals."""

__all__: list[str] = []
