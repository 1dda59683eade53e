"""Curves for cars: shortest paths between poses with a minimum turning radius."""
