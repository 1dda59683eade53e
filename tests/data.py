"""Where the shared data is: facts about real arms that stay outside the repository."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent


def shared_data() -> Path:
    """The folder $CSPACE_DATA, or ../shared/data beside the repository; skips the test where it is absent."""
    folder = Path(os.environ.get("CSPACE_DATA") or ROOT.parent / "shared" / "data")
    if not folder.is_dir():
        pytest.skip(f"no shared data at {folder}; set CSPACE_DATA")
    return folder
