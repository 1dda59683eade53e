"""The configuration space of any robot: slices, projections and volumes."""
