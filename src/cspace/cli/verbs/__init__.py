"""One file per verb; the table of contents is cspace.cli.app."""
