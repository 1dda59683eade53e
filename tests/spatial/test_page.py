"""The table of names on the page of poses lists every name of the room, and no other."""

import re

import cspace as cs
from data import ROOT


def test_the_page_names_everything_there_is():
    page = (ROOT / "docs/spatial.md").read_text(encoding="utf-8")
    table = page.split("## All names")[1].split("```")[0]
    named = set(re.findall(r"`(\w+)`", table))
    assert named | {"SEQUENCES"} == set(cs.spatial.__all__)
