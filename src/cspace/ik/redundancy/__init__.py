"""Redundancy: locked joints, self-motion, feasible intervals and the arm angle."""

__all__: list[str] = []
