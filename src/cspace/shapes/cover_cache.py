"""A cache of covers in files, found by the content of the mesh."""

from __future__ import annotations

import hashlib
import logging
import os
import sys
import zipfile
from pathlib import Path
from typing import Final

import numpy as np

from cspace import _core
from cspace.arrays import Array
from cspace.errors import InputError
from cspace.files import whole_file

VARIABLE: Final = "CSPACE_CACHE"
"""The environment variable with the folder of the cache; empty: no cache."""

REVISION: Final = 1
"""Raised by whoever changes the search for covers, so that older files are not read."""

log = logging.getLogger("cspace")


def cache_folder() -> Path | None:
    """Where covers are kept: $CSPACE_CACHE, else the folder of the system for caches; None: nowhere."""
    chosen = os.environ.get(VARIABLE)
    if chosen is not None:
        return Path(chosen) if chosen else None
    parent = os.environ.get("LOCALAPPDATA" if sys.platform == "win32" else "XDG_CACHE_HOME")
    if parent and os.path.isabs(parent):
        return Path(parent) / "cspace"
    try:
        return Path.home() / ".cache" / "cspace"
    except RuntimeError:  # no home
        return None


def find_key(vertices: Array, faces: np.ndarray, *settings: object) -> str:
    """A hash of vertices (k, 3), faces (m, 3), settings and the version of the library."""
    digest = hashlib.sha256(repr((_core.__version__, REVISION, vertices.shape, settings)).encode())
    digest.update(np.ascontiguousarray(vertices, dtype="<f8").tobytes())
    digest.update(np.ascontiguousarray(faces, dtype="<i4").tobytes())
    return digest.hexdigest()


def load_cover(key: str) -> tuple[Array, float, int] | None:
    """Spheres (n, 4), stick-out and number of parts under a key; None without a file that can be used."""
    folder = cache_folder()
    if folder is None:
        return None
    path = folder / f"cover-{key}.npz"
    try:
        with np.load(path, allow_pickle=False) as file:
            spheres, numbers, stored = file["spheres"], file["numbers"], str(file["key"])
        stick_out, parts = numbers.tolist()
        good = spheres.ndim == 2 and spheres.shape[1] == 4 and spheres.dtype == np.float64 and len(spheres)
        if good and stored == key and np.isfinite(spheres).all() and (spheres[:, 3] > 0.0).all():
            return spheres, float(stick_out), int(parts)
    except FileNotFoundError:
        return None
    except (OSError, ValueError, KeyError, EOFError, TypeError, zipfile.BadZipFile) as fault:
        log.debug("%s cannot be read: %s", path, fault)
    log.debug("%s is not a cover; it is computed again", path)
    return None


def store_cover(key: str, spheres: Array, stick_out: float, parts: int) -> None:
    """Write a cover under its key, whole or not at all; where that is impossible nothing is kept."""
    folder = cache_folder()
    if folder is None:
        return
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with whole_file(folder / f"cover-{key}.npz") as draft:
            np.savez(draft, spheres=spheres, numbers=np.array([stick_out, parts]), key=np.array(key))
    except (OSError, InputError) as fault:
        log.debug("the cover is not kept: %s", fault)
