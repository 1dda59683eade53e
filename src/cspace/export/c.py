"""One arm as a C99 header and one C++17 file."""

from __future__ import annotations

from pathlib import PurePath

from cspace.export.arm import ExportedArm
from cspace.export.cpp import cpp_header, words_of
from cspace.export.words import fill_template


def c_files(arm: ExportedArm, header: str) -> dict[str, str]:
    """File names and texts: the header and the source."""
    source = PurePath(header).with_suffix(".cpp").name
    words = {**words_of(arm), "source": source, "object": PurePath(header).with_suffix(".o").name}
    body = (
        f'#include "{header}"\n\n{cpp_header(arm, one_file=True)}\n{fill_template("interface.c.in", words)}'
    )
    return {header: fill_template("interface.h.in", words), source: body}
