"""Solvers in plain numpy, of which an exported Python file is put together."""
