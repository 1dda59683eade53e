"""Solids drawn by casting rays: shapes, lights and shadows."""
