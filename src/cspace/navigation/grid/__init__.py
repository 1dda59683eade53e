"""Searches over the cells of an occupancy grid."""
