"""The command line: one file per verb, loaded only when its verb is used."""

from cspace.cli.app import main

__all__ = ["main"]
