"""Self-motions: the joints move, the tip stays."""
