"""Random points of free space, joined where they are mutually visible."""
