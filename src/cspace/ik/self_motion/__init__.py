"""Self-motions: the joints move, the tip stays."""

__all__: list[str] = []
