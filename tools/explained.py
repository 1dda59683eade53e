"""Writes the explanation of the UR5e into docs/lectures/explained.md, as the library gives it.

Usage: python tools/explained.py
"""

from __future__ import annotations

import re
import sys
from pathlib import Path

import cspace as cs

PAGE = Path(__file__).resolve().parent.parent / "docs/lectures/explained.md"


def page_text() -> str:
    """The page with the explanation between its markers."""
    plan = cs.load_robot("ur5e").ik_plan().to_markdown()
    text = PAGE.read_text(encoding="utf-8")
    return re.sub(r"(<!-- plan -->\n).*?(<!-- end -->)", lambda m: f"{m[1]}{plan}{m[2]}", text, flags=re.S)


if __name__ == "__main__":
    PAGE.write_text(page_text(), encoding="utf-8")
    sys.exit(0)
