"""Solids drawn by casting rays: shapes, lights and shadows."""

__all__: list[str] = []
