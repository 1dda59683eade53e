"""Damaged robot files: valid ones with pieces cut, doubled, swapped or replaced by what breaks readers."""

import contextlib
import re

import numpy as np

from cspace.errors import CspaceError
from cspace.model import (
    chain,
    default_tip,
    from_mjcf,
    from_toml,
    from_urdf,
    group_ends,
    read_srdf,
    to_dh,
    to_toml,
    to_urdf,
    tree,
    with_srdf,
)

POISON = [
    *(b"nan inf -inf 1e999 -0 1e-320 0x10 1_0 true false null".split()),
    b"9" * 400,
    b"9" * 5000,
    b"",
    b" ",
    b"\x00",
    b"\xff\xfe",
    "é🤖\u2028".encode(),
    b"<",
    b">",
    b"&",
    b"&amp;",
    b"&#0;",
    b"&#x10ffff;",
    b'"',
    b"'''",
    b'"""',
    b"]]>",
    b"<![CDATA[",
    b"<!--",
    b"-->",
    b"<!DOCTYPE x [<!ENTITY y 'z'>]>",
    b"<?xml version='1.1' encoding='utf-16'?>",
    b"[",
    b"]",
    b"[[",
    b"[" * 3000,
    b"{" * 3000,
    b"a." * 3000,
    b"=",
    b"\n",
    b"#",
    b"<link/>",
    b"<joint/>",
    b"[[joints]]",
    b"[dh]",
    b"[screws]",
    b"1979-05-27T07:32:00Z",
    b"..",
    b"package://",
    b"fixed",
    b"floating",
    b"planar",
    b"continuous",
    b"prismatic",
    b"<body/>",
    b"<body><joint/></body>",
    b"<freejoint/>",
    b"<frame>",
    b"<default class='main'>",
    b"<include file='x.xml'/>",
    b"free",
    b"ball",
    b"slide",
    b"<group name='g'>",
    b"<disable_collisions link1='base' link2='hand'/>",
    b"<exclude body1='thigh' body2='shank'/>",
    b"allowed_pairs = [['base', 'hand']]",
]


def mutant(rng, seeds):
    """One of the seeds with one to four pieces damaged."""
    data = bytes(seeds[int(rng.integers(len(seeds)))])
    for _ in range(int(rng.choice([1, 1, 1, 2, 3]))):
        data = damaged(rng, data, seeds) if rng.random() < 0.5 else renumbered(rng, data)
    return data


def renumbered(rng, data):
    """One number of the file replaced by another, most of them readable."""
    places = list(re.finditer(rb"(?<![\w.])-?\d+(\.\d+)?", data))
    if not places:
        return data
    place = places[int(rng.integers(len(places)))]
    odd = [
        b"0",
        b"-1",
        b"1e-7",
        b"1e308",
        b"-1e308",
        b"3.141592653589793",
        b"1e-300",
        b"inf",
        b"nan",
        b"true",
    ]
    return data[: place.start()] + odd[int(rng.integers(len(odd)))] + data[place.end() :]


def damaged(rng, data, seeds):
    i, j = sorted(int(x) for x in rng.integers(0, len(data) + 1, 2))
    short = min(j, i + int(rng.integers(1, 40)))
    other = seeds[int(rng.integers(len(seeds)))]
    k = int(rng.integers(len(other)))
    poison = POISON[int(rng.integers(len(POISON)))]
    words = [
        w
        for w in (b"0", b"1", b"name", b"base", b"link", b"joint", b"revolute", b"body", b'"', b"=")
        if w in data
    ]
    word = words[int(rng.integers(len(words)))] if words else b""
    choices = [
        lambda: data[:i] + data[short:],
        lambda: data[:i] + data[j:],
        lambda: data[:i] + poison + data[i:],
        lambda: data[:i] + poison + data[short:],
        lambda: data[:i] + other[k : k + 200] + data[i:],
        lambda: data[:i] + data[i:short] * 3 + data[short:],
        lambda: data.replace(word, poison, int(rng.integers(1, 4))) if word else data,
        lambda: swapped_lines(rng, data),
        lambda: data[:i] + bytes(rng.integers(0, 256, short - i, dtype=np.uint8)) + data[short:],
    ]
    return choices[int(rng.integers(len(choices)))]()


def swapped_lines(rng, data):
    lines = data.split(b"\n")
    a, b = rng.integers(0, len(lines), 2)
    lines[a], lines[b] = lines[b], lines[a]
    return b"\n".join(lines)


def exercise(data, path):
    """Read `data` as every format and, where that works, use the robot; anything but CspaceError escapes.

    Returns how many of the readers accepted it.
    """
    accepted = 0
    for read, suffix in ((from_urdf, ".urdf"), (from_toml, ".toml"), (from_mjcf, ".xml")):
        file = path.with_suffix(suffix)
        file.write_bytes(data)
        accepted += exercise_file(read, file)
    return accepted


def exercise_srdf(data, description):
    """Read `data` as SRDF of a robot and use its groups; anything but CspaceError escapes.

    Returns whether it worked.
    """
    with contextlib.suppress(CspaceError):
        srdf = read_srdf(data)
        for group in srdf.groups:
            with contextlib.suppress(CspaceError):
                chain(description, *group_ends(description, srdf, group))
        use(with_srdf(description, srdf))
        return True
    return False


def exercise_file(read, file):
    """Read a file and, where that works, use the robot; anything but CspaceError escapes.

    Returns whether it worked.
    """
    robot = None
    with contextlib.suppress(CspaceError):
        robot = read(file)
    if robot is not None:
        use(robot)
    return robot is not None


def use(robot):
    """Everything that a description can be asked for; it may refuse, in its own words."""
    for ask in (tree, to_toml, to_urdf, default_tip):
        with contextlib.suppress(CspaceError):
            ask(robot)
    with contextlib.suppress(CspaceError):
        c = chain(robot)
        for convention in ("standard", "modified"):
            to_dh(c, convention=convention)
