"""Redundancy: locked joints, self-motion, feasible intervals and the arm angle."""
