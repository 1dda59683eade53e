"""The visibility graph: corners that are mutually visible."""
