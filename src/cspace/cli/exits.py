"""What the exit codes mean, and which error ends in which."""

from __future__ import annotations

from enum import IntEnum

from cspace.errors import CspaceError, DescriptionError, LogError, MapError, MissingExtraError, RoadmapError


class Exit(IntEnum):
    """The exit codes of every verb."""

    DONE = 0
    NEGATIVE = 1
    USAGE = 2
    BAD_FILE = 3
    MISSING_EXTRA = 4
    TIME_LIMIT = 5
    INTERNAL = 70
    INTERRUPTED = 130
    CLOSED_PIPE = 141


class UsageError(CspaceError):
    """A command line that cannot be carried out as written."""


class TimeLimitReached(BaseException):
    """The time of --time-limit has elapsed; like an interrupt, no error handler catches it."""


def exit_of(error: CspaceError) -> Exit:
    """The exit code of an error that cspace raised on purpose."""
    if isinstance(error, DescriptionError | LogError | MapError | RoadmapError):
        return Exit.BAD_FILE
    if isinstance(error, MissingExtraError):
        return Exit.MISSING_EXTRA
    return Exit.USAGE
