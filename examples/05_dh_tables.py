"""Denavit-Hartenberg tables: derived from any serial arm in either convention, and made into robots."""

from __future__ import annotations

import numpy as np

import cspace as cs
from cspace.model import from_dh, to_dh


def main() -> None:
    puma = cs.load_robot("puma560")
    for convention in ("standard", "modified"):
        print(to_dh(puma.chain, convention=convention))

    # The other way: rows (alpha, a, d, theta). The conventions never mix, so it has to be named.
    half = np.pi / 2
    rows = [
        [half, 0.0, 0.0, 0.0],
        [0.0, 0.4318, 0.0, 0.0],
        [-half, 0.0203, 0.15005, 0.0],
        [half, 0.0, 0.4318, 0.0],
        [-half, 0.0, 0.0, 0.0],
        [0.0, 0.0, 0.0, 0.0],
    ]
    mine = cs.Robot(from_dh(rows, convention="standard", name="my_puma"))
    q = np.array([0.1, -0.5, 0.4, 1.0, 0.7, -0.2])
    print("tip of the table      :", np.round(mine.fk(q)[:3, 3], 6))
    print("tip of the catalogue's:", np.round(puma.fk(q)[:3, 3], 6))
    assert np.allclose(to_dh(mine.chain, convention="standard").fk(q), mine.fk(q))


if __name__ == "__main__":
    main()
