"""Numeric differential kinematics: descents to a pose, velocities, several tasks at once; for every robot."""
